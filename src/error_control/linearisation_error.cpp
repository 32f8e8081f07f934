// Compares the peaks of the same run with linear vehicles and with the mechanisms.
#include "error_control/linearisation_error.hpp"

#include <algorithm>
#include <limits>

#include "error_control/accuracy.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "traverse/base/error.hpp"

namespace traverse::error_control {
namespace {

constexpr double steps_per_sample =
    32.0;                          // output interval in steps, for the energies; peaks are evaluated at every step
constexpr double max_shift = 3.0;  // steps: largest time difference between the peaks of both runs

}  // namespace

double default_residual_limit(const scene::Scene& scene) { return search::share_of_linear * scene.accuracy; }

bool may_exceed(double residual, const scene::Scene& scene) {
  return search::max_growth * residual > default_residual_limit(scene);
}

double measured_residual_limit(MPI_Comm comm, scene::Scene scene) {
  scene.output.interval = steps_per_sample * *scene.model.step;
  scene.model.residual_limit = std::numeric_limits<double>::infinity();
  const auto run = [&](scene::VehicleModel vehicles) {
    scene.model.vehicles = vehicles;
    return peaks_of(comm, scene);
  };
  try {
    const RunPeaks linear = run(scene::VehicleModel::linear), mechanisms = run(scene::VehicleModel::full);
    double error = 0.0;
    for (std::size_t q = 0; q < run::quantities; ++q)
      if (is_controlled(scene, q))
        error = std::max(error, run::difference(linear.peaks, mechanisms.peaks, static_cast<run::Quantity>(q),
                                                max_shift * *scene.model.step));
    const double allowed = default_residual_limit(scene);
    if (error > allowed) return allowed;
    return std::max(allowed,
                    linear.residual * (search::max_growth * error > allowed ? allowed / error : search::max_growth));
  } catch (const SolverError&) {  // the step is probably too long
    return default_residual_limit(scene);
  }
}

}  // namespace traverse::error_control
