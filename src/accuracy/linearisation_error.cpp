// Peaks of the same run with linear vehicles and with the mechanisms.
#include "accuracy/linearisation_error.hpp"

#include <algorithm>
#include <limits>

#include "accuracy/accuracy.hpp"
#include "accuracy/search_constants.hpp"
#include "accuracy/trials.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {
namespace {

constexpr double steps_a_sample = 32.0;  // of the energies; peaks are looked for at every step
constexpr double reach = 3.0;            // steps between peaks of both runs that are the same one

}  // namespace

double most_defect(const Scene& scene) { return search::share_of_linear * scene.accuracy; }

bool may_exceed(double defect, const Scene& scene) { return search::most_growth * defect > most_defect(scene); }

double tolerable_defect(MPI_Comm comm, Scene scene) {
  scene.output.interval = steps_a_sample * *scene.model.step;
  scene.model.most_defect = std::numeric_limits<double>::infinity();
  const auto run = [&](VehicleModel vehicles) {
    scene.model.vehicles = vehicles;
    return peaks_of(comm, scene);
  };
  try {
    const RunPeaks linear = run(VehicleModel::linear), mechanisms = run(VehicleModel::full);
    double error = 0.0;
    for (std::size_t q = 0; q < quantities; ++q)
      if (asks_for(scene, q))
        error = std::max(
            error, difference(linear.peaks, mechanisms.peaks, static_cast<Quantity>(q), reach * *scene.model.step));
    const double allowed = most_defect(scene);
    if (error > allowed) return allowed;
    return std::max(allowed,
                    linear.defect * (search::most_growth * error > allowed ? allowed / error : search::most_growth));
  } catch (const SolverError&) {  // too long a step, most likely
    return most_defect(scene);
  }
}

}  // namespace traverse::app
