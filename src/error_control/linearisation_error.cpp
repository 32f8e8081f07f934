// Peaks of the same run with linear vehicles and with the mechanisms.
#include "error_control/linearisation_error.hpp"

#include <algorithm>
#include <limits>

#include "error_control/accuracy.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {
namespace {

constexpr double steps_a_sample = 32.0;  // of the energies; peaks are looked for at every step
constexpr double reach = 3.0;            // steps between peaks of both runs that are the same one

}  // namespace

double most_residual(const Scene& scene) { return search::share_of_linear * scene.accuracy; }

bool may_exceed(double defect, const Scene& scene) { return search::most_growth * defect > most_residual(scene); }

double tolerable_defect(MPI_Comm comm, Scene scene) {
  scene.output.interval = steps_a_sample * *scene.model.step;
  scene.model.most_residual = std::numeric_limits<double>::infinity();
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
    const double allowed = most_residual(scene);
    if (error > allowed) return allowed;
    return std::max(allowed,
                    linear.defect * (search::most_growth * error > allowed ? allowed / error : search::most_growth));
  } catch (const SolverError&) {  // too long a step, most likely
    return most_residual(scene);
  }
}

}  // namespace traverse::app
