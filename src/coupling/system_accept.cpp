// Steps: begin of a trial, acceptance, archive.
#include <algorithm>
#include <cmath>

#include "base/broadcast.hpp"
#include "coupling/system.hpp"
#include "engine/linear_train.hpp"

namespace traverse::coupling {
namespace {

constexpr double same_place = 1e-9;  // m or rad

}  // namespace

void System::begin_trial() {
  for (int i = 0; i < fleet_.contacts(); ++i) fleet_.contact(i).touched = false;
}

void System::record_touched() {
  for (int i = 0; i < fleet_.contacts(); ++i)
    if (fleet_.contact(i).force.normal > 0.0) fleet_.contact(i).touched = true;
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
  if (structure_ && motion_) structure_->complete_step(y, y + n_);
  if (structure_ && !motion_) structure_->update_slip(y, loaded(t, 0.0));
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
  const auto n = static_cast<std::size_t>(n_);
  archive.cut({y, n});
  archive.cut({y + n, n});
  std::vector<double> other_entries(y + 2 * n, y + local_size());
  archive.same(other_entries);
  if (rank_ == 0) std::copy(other_entries.begin(), other_entries.end(), y + 2 * n);
  if (motion_) {
    Motion& m = *motion_;
    if (rank_ != 0 && !share_.distributed()) m.powers[0] = {};  // which are valid on the first rank only
    archive.same(m.length, m.p, m.pd, m.pdd[0], m.energy_scale);
    archive.sum(m.powers[0].dissipation, m.powers[0].work, m.dissipated, m.worked);
    if (archive.reads() && m.length > 0.0) set_step(m.length);
  }
  archive.same(on_beam_, braking_force_, loads_, p_, c_p_, pdd_, pd_, evaluated_, evaluated_time_, flags_);
  std::vector<int> owners = share_.owners(fleet_.vehicles.size());
  archive.same(owners);
  fleet_.keep(archive, owners);
  archive.same(events_, newton_);
  if (train_) archive.same(*train_);
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

}  // namespace traverse::coupling
