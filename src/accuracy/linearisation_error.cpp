#include "accuracy/linearisation_error.hpp"

#include <algorithm>
#include <limits>

#include "accuracy/accuracy.hpp"
#include "accuracy/trials.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {
namespace {

constexpr double part_for_linear = 0.1;  // of the wanted error
constexpr double most_growth = 4.0;      // of what is out of balance, from a trial run to others
constexpr double reach = 3.0;            // steps between peaks of both runs that are the same one

}  // namespace

double most_defect(const Scene& scene) { return part_for_linear * scene.accuracy; }

bool may_exceed(double defect, const Scene& scene) { return most_growth * defect > most_defect(scene); }

double tolerable_defect(MPI_Comm comm, Scene scene) {
  scene.most_defect = std::numeric_limits<double>::infinity();
  const auto run = [&](VehicleModel vehicles) {
    scene.vehicle_model = vehicles;
    return peaks_of(comm, scene);
  };
  try {
    const RunPeaks linear = run(VehicleModel::linear), mechanisms = run(VehicleModel::full);
    double error = 0.0;
    for (std::size_t q = 0; q < quantities; ++q)
      if (asks_for(scene, q))
        error = std::max(
            error, difference(linear.peaks, mechanisms.peaks, static_cast<Quantity>(q), reach * *scene.time_step));
    const double allowed = most_defect(scene);
    if (error > allowed) return allowed;
    return std::max(allowed, linear.defect * std::min(most_growth, allowed / std::max(error, 1e-300)));
  } catch (const SolverError&) {  // too long a step, most likely
    return most_defect(scene);
  }
}

}  // namespace traverse::app
