// The Newton iteration of a stage: residuals of the vehicles, condensation onto the contacts, update of coordinates and
// forces, and convergence tests based on the measured contraction rate.
#include "coupling/contact_newton.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::coupling {
namespace {

constexpr int most_iterations = 40;
constexpr int kept_iterations = 4;           // of a stage with matrices that are kept
constexpr int most_tangents = 20;            // of the contacts in one iteration
constexpr double smooth_tolerance = 1e-10;   // of the weight: what is left in forces after the last step
constexpr double rubbing_tolerance = 1e-12;  // the same with friction, whose slope is steep near sticking
constexpr double static_tolerance = 1e-13;
constexpr double best_ratio = 1e-4;  // of two successive changes that is trusted
constexpr double poor_ratio = 1e-3;  // of successive residuals or changes: what is kept no longer serves
constexpr double first_share = 0.1;  // of the ratio of a stage's first changes that the kept matrices account for
constexpr double growth = 1.1;       // of a ratio that is trusted without having been measured again
constexpr double measurable = 1e-8;  // of the weight: changes above it tell a ratio
constexpr double caution = 0.1;      // of the tolerance: a second change that is foreseen and left out
constexpr double forgetting = 0.1;   // of the ratio that foresees it, once it has been found smaller
constexpr int not_alike = -1;
constexpr double rounding = 1e-9;  // of the weight: below this a change that stays is taken as rounding

}  // namespace

bool ContactNewton::solve(train::Fleet& fleet, const StageData& s, double* x) {
  work_.resize(fleet.vehicles.size());
  for (std::vector<double>* v : {&p_, &pd_, &pdd_, &moved_}) v->resize(static_cast<std::size_t>(fleet.freedom()));
  tolerance_ = smooth_tolerance;
  for (int i = 0; i < fleet.contacts(); ++i)
    if (fleet.contact(i).law.friction > 0.0) tolerance_ = rubbing_tolerance;
  const bool found = iterate(fleet, s, x);
  for (train::MovingVehicle& vehicle : fleet.vehicles) vehicle.rests = false;
  if (!found) return false;
  if (s.shift2 > 0.0) fleet.shift(moved_.data(), s.shift);
  bool touched = true;
  if (once_) {  // the forces are known, and now where they act
    beam_field(s, fleet, Loads::found);
    touched = fleet.touch(s.per_node, v_.data(), w_.data());
  }
  const unsigned signs = share_contacts(
      s, fleet,
      (touched ? 0U : train::VehicleShare::failed) | (fleet.wheels_in_place() ? 0U : train::VehicleShare::misplaced));
  if ((signs & train::VehicleShare::failed) != 0) return false;
  in_place_ = (signs & train::VehicleShare::misplaced) == 0;
  fleet.element_loads(s.per_node, loads_);
  return true;
}

bool ContactNewton::iterate(train::Fleet& fleet, const StageData& s, double* x) {
  fleet.contact_forces();
  const bool statics = s.shift2 == 0.0;
  bool kept = true;
  for (int i = 0; i < most_iterations; ++i) {
    const Loads loads = i > 0 ? Loads::found : statics ? Loads::none : Loads::expected;
    const bool reached = evaluate(fleet, s, x, loads);
    if (i == 0) contacts_.list(fleet);
    const unsigned signs =
        share_contacts(s, fleet, reached ? condense_own(fleet, s, i) : unsigned{train::VehicleShare::failed});
    if ((signs & train::VehicleShare::failed) != 0) return false;
    const bool renewed = (signs & train::VehicleShare::renewed) != 0;
    if (renewed) share_matrices(s);
    kept = kept && !renewed;
    if (loads != Loads::none && s.compliance != nullptr) follow_loads(s, fleet);
    if (contacts_.moved() || i == 0 || renewed)
      contacts_.couple(fleet.elements().empty() ? nullptr : s.compliance, s.per_node);
    // In statics the vehicles' matrices hold the tangent of the contacts, which is taken anew with them.
    const double left = contacts_.solve(s.shift, loads != Loads::none, statics ? 1 : most_tangents);
    const double before = change_;
    change_ = update(fleet, x);
    if (!std::isfinite(change_)) return false;
    if (i == 0) {
      once_ =
          kept && !statics && left <= tolerance_ && second_.negligible(carrying(fleet), change_, caution * tolerance_);
      if (once_) return true;
      continue;
    }
    if (i == 1) second_.note(kept ? carrying(fleet) : not_alike, before, change_);
    if (settled(statics, kept && i == 1, before, left)) return true;
    for (std::size_t k = 0; k < work_.size(); ++k)
      fleet.vehicles[k].rests = !statics && work_[k].change * contraction_ <= tolerance_;
  }
  return false;
}

std::size_t ContactNewton::worst_vehicle() const {
  const auto less = [](const VehicleWork& a, const VehicleWork& b) { return a.change < b.change; };
  return static_cast<std::size_t>(std::max_element(work_.begin(), work_.end(), less) - work_.begin());
}

// What this rank's vehicles have at their contacts.
unsigned ContactNewton::condense_own(train::Fleet& fleet, const StageData& s, int i) {
  unsigned signs = 0;
  for (int k = fleet.first_own(); k < fleet.past_own(); ++k) {
    train::MovingVehicle& vehicle = fleet.vehicles[k];
    train::ContactCompliance& compliance = contacts_.compliance(k);
    const double before = compliance.residual;
    if (vehicle.rests)
      rest(fleet, k);
    else if (!find_residual(vehicle, k))
      return train::VehicleShare::failed;
    const bool poor = i >= kept_iterations || (i > 1 && !vehicle.rests && contraction_ > poor_ratio) ||
                      (i > 1 && compliance.residual > poor_ratio * before && compliance.residual > tolerance_);
    if (poor || !compliance.known || !vehicle.dynamics->serves(vehicle, s.shifts(), i > 0)) {
      renew(vehicle, k, s, s.shifts().statics() || i > 0);
      compliance.known = true;
      signs |= train::VehicleShare::renewed;
    }
    vehicle.dynamics->go_by_itself(compliance);
  }
  return signs;
}

// The next change would be smaller by about the ratio of the last two, in statics it is not trusted to be. A stage's
// first change is a large one, and its ratio to the second tells more of that than of the matrices that are kept: there
// the ratio measured in earlier stages counts too. Where rounding rules changes no longer fall.
bool ContactNewton::settled(bool statics, bool as_before, double before, double left) {
  if (change_ == 0.0) return true;
  const double measured = change_ / before;
  contraction_ = std::clamp(measured, best_ratio, 1.0);
  if (as_before && measured <= poor_ratio) {
    contraction_ = std::max(ratio_, first_share * measured);
    ratio_ = std::min(growth * ratio_, 1.0);
  } else if (!statics && before > measurable) {
    ratio_ = std::min(measured, 1.0);
  }
  if (change_ <= rounding && measured > 0.1) return true;
  return statics ? change_ <= static_tolerance : change_ * contraction_ <= tolerance_ && left <= tolerance_;
}

// The ratio grows with the first change, at most as this does.
bool ContactNewton::SecondChange::negligible(int contacts, double change, double limit) {
  const double curved = std::max(1.0, change / first);
  if (contacts < 0 || contacts != carrying || change * ratio * curved > limit) return false;
  ratio *= growth;
  return true;
}

void ContactNewton::SecondChange::note(int contacts, double change, double next) {
  carrying = contacts;
  if (!(change > 0.0)) return;
  first = change;
  ratio = std::max(next / change, forgetting * ratio);
}

// The contacts that carry force; no number where a wheel near a kink may touch on either side of it, or one rubs.
int ContactNewton::carrying(const train::Fleet& fleet) {
  int count = 0;
  for (const train::WheelContact& c : fleet.wheels) {
    if (c.candidates > 1 || (c.candidates == 1 && fleet.has_points(c)) || c.law.friction > 0.0) return not_alike;
    if (c.force.normal != 0.0) ++count;
  }
  return count;
}

// Vehicles at p_predicted + x, the beam under the forces of the kinematics held, the geometry at all of it. At first
// where these forces act is not known quite; but without them the beam's slope would turn the forces on the vehicles by
// 1e-6.
bool ContactNewton::evaluate(train::Fleet& fleet, const StageData& s, const double* x, Loads loads) {
  const auto [first, past] = fleet.own_coordinates();
  for (int i = first; i < past; ++i) {
    p_[i] = s.p_predicted[i] + x[i];
    pd_[i] = s.pd_still[i] + s.shift * x[i];
    pdd_[i] = s.shift2 * x[i];
  }
  if (!fleet.set(s.t, p_.data(), pd_.data())) return false;
  beam_field(s, fleet, loads);
  return fleet.touch(s.per_node, v_.data(), w_.data());
}

// The last iteration has put the vehicle where it belongs: it goes there.
void ContactNewton::rest(train::Fleet& fleet, int k) {
  fleet.vehicles[k].dynamics->rest();
  contacts_.compliance(k).residual = 0.0;
  for (const train::ContactRow& row : contacts_.rows_of(k)) row.contact->touch.kinematics = row.contact->kinematics;
}

// At the contact forces held.
bool ContactNewton::find_residual(train::MovingVehicle& vehicle, int k) {
  vehicle.Q.setZero();
  for (const train::ContactRow& row : contacts_.rows_of(k)) {
    const train::Contact& c = *row.contact;
    if (row.normal) train::Fleet::add_load(c, c.force.normal, c.force.tangential, vehicle.Q);
  }
  return vehicle.dynamics->find_residual(vehicle, pdd_.data() + vehicle.offset, contacts_.compliance(k));
}

// In statics the contacts' tangent is part of the vehicle's matrix, which may be singular without it.
void ContactNewton::renew(train::MovingVehicle& vehicle, int k, const StageData& s, bool curved) {
  const train::ContactRows rows = contacts_.rows_of(k);
  const auto count = static_cast<Eigen::Index>(rows.size());
  train::ContactCompliance& compliance = contacts_.compliance(k);
  compliance.P.resize(0, 0);
  if (!s.shifts().statics()) {
    compliance.D.resize(0, 2);
    vehicle.dynamics->renew(vehicle, s.shifts(), curved, rows, compliance);
    return;
  }
  compliance.D.resize(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) compliance.D.row(i) = row_tangent(rows[static_cast<std::size_t>(i)], 0.0);
  vehicle.dynamics->renew(vehicle, s.shifts(), curved, rows, compliance);
  compliance.P.setIdentity(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    compliance.P.col(i) -= compliance.H.col(i) * compliance.D(i, 1);
    if (compliance.D(i, 0) != 0.0) compliance.P.col(i - 1) -= compliance.H.col(i) * compliance.D(i, 0);
  }
}

// Applies the step to x. Returns the largest residual or change of force over the vehicle's weight.
double ContactNewton::update(train::Fleet& fleet, double* x) {
  double change = 0.0;
  for (int k = 0; k < static_cast<int>(work_.size()); ++k) {
    VehicleWork& w = work_[k];
    w.change = contacts_.compliance(k).residual;
    for (int i = contacts_.first(k); i < contacts_.first(k + 1); ++i)
      w.change = std::max(w.change, std::abs(contacts_.change(i)) / fleet.vehicles[k].scale);
    change = std::max(change, w.change);
  }
  for (int k = fleet.first_own(); k < fleet.past_own(); ++k) {
    train::MovingVehicle& vehicle = fleet.vehicles[k];
    const train::RowTangent& D = contacts_.compliance(k).D;
    Eigen::VectorXd& forces = work_[k].forces;
    const int from = contacts_.first(k);
    forces.resize(contacts_.rows(k));
    for (int i = 0; i < forces.size(); ++i) {
      forces[i] = contacts_.change(from + i);
      if (D.size() == 0) continue;
      forces[i] -= D(i, 1) * contacts_.displacement(from + i);
      if (D(i, 0) != 0.0) forces[i] -= D(i, 0) * contacts_.displacement(from + i - 1);
    }
    const Eigen::VectorXd& dx = vehicle.dynamics->take(forces);
    for (int i = 0; i < dx.size(); ++i) {
      x[vehicle.offset + i] += dx[i];
      moved_[vehicle.offset + i] = dx[i] + (vehicle.rests ? moved_[vehicle.offset + i] : 0.0);
    }
  }
  return change;
}

}  // namespace traverse::coupling
