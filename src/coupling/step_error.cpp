// Errors of steps in second-order form by an embedded method, divided by the static response of the structure and by
// gravity and the accelerations of the vehicles.
#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/system.hpp"
#include "traverse/base/error.hpp"

namespace traverse::coupling {
void System::measure_errors() {
  if (!structure_) return;
  structure_->measure_errors();
  const beam::Mesh& mesh = beam()->mesh();
  const std::vector<double>& ends = mesh.span_ends();
  double station = 0.0, longest = 0.0;
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i] - ends[i - 1] > longest * (1.0 + 1e-9)) {
      longest = ends[i] - ends[i - 1];
      station = 0.5 * (ends[i] + ends[i - 1]);
    }
  motion_->energy_scale = weights_.static_energy(station);
  if (motion_->energy_scale == 0.0)
    throw InputError(
        "ts_adapt_type = ladder: the structure's errors are measured by its deflection at rest under the weights, and "
        "there is none (no weights, a foundation that is not linear, train and forces of different speeds); allowed: "
        "none, or a ts_type of PETSc's own such as arkimex");
}

double System::step_error(const double* y) {
  const Motion& m = *motion_;
  const base::StepRule& rule = m.method.step;
  const auto [first, past] = fleet_.own_coordinates();
  for (int i = first; i < past; ++i) {
    x_[i] = 0.0;
    for (int j = 0; j < rule.known; ++j) x_[i] += rule.error_in_a[j] * m.pdd[j][i];
  }
  double worst = 0.0;
  for (train::MovingVehicle& vehicle : fleet_.own())
    worst = std::max(worst, vehicle.step_error(&x_[vehicle.offset], &m.pdd[rule.known - 1][vehicle.offset]));
  if (structure_) worst = std::max(worst, structure_error(y));
  if (!std::isfinite(worst)) worst = std::numeric_limits<double>::max();
  if (ranks_ > 1) MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, comm_);
  return worst;
}

double System::structure_error(const double* y) {
  double energy = structure_->error_energy(y, y + n_);
  if (ranks_ > 1) MPI_Allreduce(MPI_IN_PLACE, &energy, 1, MPI_DOUBLE, MPI_SUM, comm_);
  return std::sqrt(energy / motion_->energy_scale);
}

}  // namespace traverse::coupling
