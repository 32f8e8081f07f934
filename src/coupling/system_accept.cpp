// Steps: begin of a trial, acceptance, archive, and errors of steps in second-order form by an embedded method, divided
// by the static response of the structure and by gravity and the accelerations of the vehicles.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/broadcast.hpp"
#include "coupling/system.hpp"
#include "engine/linear_trains.hpp"
#include "traverse/base/error.hpp"

namespace traverse::coupling {
namespace {

constexpr double same_place = 1e-9;  // m or rad

}  // namespace

void System::begin_trial() {
  for (int i = 0; i < fleet_.contacts(); ++i) fleet_.contact(i).touched = fleet_.contact(i).lifted = false;
}

void System::record_touched() {
  for (int i = 0; i < fleet_.contacts(); ++i) {
    train::Contact& c = fleet_.contact(i);
    (c.force.normal > 0.0 ? c.touched : c.lifted) = true;
  }
}

void System::set_vehicles(double t, const double* y) {
  const int f = fleet_.freedom();
  bool moved = (flags_ & train::VehicleShare::moved) != 0;
  if (!motion_) {
    evaluated_.assign(p_.begin(), p_.begin() + f);
    share_coordinates(y);
    for (int i = 0; i < f; ++i) moved = moved || std::abs(p_[i] - evaluated_[i]) > same_place;
  }
  if (t != evaluated_time_ || moved) evaluate_fleet(t, y);
}

bool System::accept(double t, double* y) {
  accepted_ = y;
  if (is_shared()) sharing_->request(TrainSharing::accept);
  if (structure_) structure_->accept(y, y + n_, motion_ ? reaches_ : loaded(t, 0.0));
  if (fleet_.vehicles.empty()) return false;
  set_vehicles(t, y);
  const double lost = events_.accept(t);
  const bool badly_conditioned =
      share_.distributed() ? (flags_ & train::VehicleShare::badly_conditioned) != 0 : fleet_.badly_conditioned();
  if (badly_conditioned) evaluate_fleet(t, y);
  bool renewed = fleet_.accept();
  if (renewed) is_evaluated_ = false;
  if (badly_conditioned && share_.distributed()) {
    renewed = share_.exchange(renewed ? train::VehicleShare::renewed : 0U) != 0;
    if (renewed) share_.partitions(fleet_);
  }
  if (renewed) fleet_.assign_coordinates(t);
  if (rank_ == 0) y[2 * (n_ + fleet_.freedom())] += lost;
  if (!renewed) return lost != 0.0;
  if (rank_ == 0) fleet_.coordinates_of_state(t, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
  return true;
}

void System::keep(base::Archive& archive, double* y) {
  if (is_shared()) recall(y);
  const auto n = static_cast<std::size_t>(n_);
  archive.cut({y, n});
  archive.cut({y + n, n});
  std::vector<double> other_entries(y + 2 * n, y + local_size());
  archive.same(other_entries);
  if (rank_ == 0) std::copy(other_entries.begin(), other_entries.end(), y + 2 * n);
  if (motion_) {
    Motion& m = *motion_;
    if (rank_ != 0 && !share_.distributed()) m.powers.at[0] = {};  // which are valid on the first rank only
    if (trains_ && rank_ == 0 && !archive.reads()) m.powers.at[0] = trains_->powers_at_start();
    archive.same(m.length, m.p, m.pd, m.pdd[0], m.energy_scale);
    archive.sum(m.powers.at[0].dissipation, m.powers.at[0].work, m.powers.sum.dissipation, m.powers.sum.work);
    if (archive.reads() && m.length > 0.0) set_step(m.length);
  }
  archive.same(step_middle_, returned_);
  if (archive.reads()) select_sides();
  archive.same(on_beam_, braking_force_, loads_, p_, c_p_, pdd_, pd_, evaluated_, evaluated_time_, flags_);
  std::vector<int> owners = share_.owners(fleet_.vehicles.size());
  archive.same(owners);
  fleet_.keep(archive, owners);
  archive.same(events_, newton_);
  if (trains_) archive.same(*trains_);
  if (trains_ && archive.reads()) trains_->set_powers_at_start(motion_->powers.at[0]);
  if (structure_) structure_->keep(archive);
}

std::string System::failure_reason() const {
  std::string text = fleet_.failure_reason();
  if (share_.distributed()) {  // the first rank with a reason sends it to the others
    int sender = text.empty() ? ranks_ : rank_;
    MPI_Allreduce(MPI_IN_PLACE, &sender, 1, MPI_INT, MPI_MIN, comm_);
    if (sender < ranks_) text = base::broadcast(comm_, std::move(text), sender);
  }
  if (!text.empty()) return text;
  return "the contact iteration does not converge: try a smaller -ts_dt, softer contacts, or look at the state just "
         "before";
}

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
  for (int i = first; i < past; ++i) x_[i] = base::combined(rule.error_in_a, rule.known, m.pdd, i);
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
