// Compares the peaks of the same run with linear vehicles and with the mechanisms.
#include "error_control/linearisation_error.hpp"

#include <algorithm>
#include <limits>

#include "error_control/accuracy.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {
namespace {

constexpr double steps_per_sample =
    32.0;                          // output interval in steps, for the energies; peaks are evaluated at every step
constexpr double max_shift = 3.0;  // steps: largest time difference between the peaks of both runs

}  // namespace

double default_residual_limit(const Scene& scene) { return search::share_of_linear * scene.accuracy; }

bool may_exceed(double residual, const Scene& scene) {
  return search::max_growth * residual > default_residual_limit(scene);
}

double measured_residual_limit(MPI_Comm comm, Scene scene) {
  scene.output.interval = steps_per_sample * *scene.model.step;
  scene.model.residual_limit = std::numeric_limits<double>::infinity();
  const auto run = [&](VehicleModel vehicles) {
    scene.model.vehicles = vehicles;
    return peaks_of(comm, scene);
  };
  try {
    const RunPeaks linear = run(VehicleModel::linear), mechanisms = run(VehicleModel::full);
    double error = 0.0;
    for (std::size_t q = 0; q < quantities; ++q)
      if (is_controlled(scene, q))
        error = std::max(
            error, difference(linear.peaks, mechanisms.peaks, static_cast<Quantity>(q), max_shift * *scene.model.step));
    const double allowed = default_residual_limit(scene);
    if (error > allowed) return allowed;
    return std::max(allowed,
                    linear.residual * (search::max_growth * error > allowed ? allowed / error : search::max_growth));
  } catch (const SolverError&) {  // the step is probably too long
    return default_residual_limit(scene);
  }
}

}  // namespace traverse::app
