#include "traverse/coupling/contact_newton.hpp"

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
constexpr double same_shift = 1e-6;  // relative
constexpr double rounding = 1e-9;    // of the weight: below this a change that stays is taken as rounding

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
    VehicleWork& w = work_[k];
    const double before = w.residual;
    if (vehicle.rests)
      rest(k);
    else
      find_residual(vehicle, w);
    if (vehicle.state.friction.jammed) return train::VehicleShare::failed;
    const bool poor = i >= kept_iterations || (i > 1 && !vehicle.rests && contraction_ > poor_ratio) ||
                      (i > 1 && w.residual > poor_ratio * before && w.residual > tolerance_);
    if (poor || !serves(vehicle, w, s, i > 0)) {
      renew(vehicle, k, s, s.shift2 == 0.0 || i > 0);
      signs |= train::VehicleShare::renewed;
    }
    condense(w, contacts_.yield(k));
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
    if (c.candidates > 1 || c.further > 0 || c.law.friction > 0.0) return not_alike;
    if (c.force.normal != 0.0) ++count;
  }
  return count;
}

// Vehicles at p_still + x, the beam under the forces of the kinematics held, the geometry at all of it. At first where
// these forces act is not known quite; but without them the beam's slope would turn the forces on the vehicles by 1e-6.
bool ContactNewton::evaluate(train::Fleet& fleet, const StageData& s, const double* x, Loads loads) {
  const auto [first, past] = fleet.own_coordinates();
  for (int i = first; i < past; ++i) {
    p_[i] = s.p_still[i] + x[i];
    pd_[i] = s.pd_still[i] + s.shift * x[i];
    pdd_[i] = s.shift2 * x[i];
  }
  if (!fleet.set(s.t, p_.data(), pd_.data())) return false;
  beam_field(s, fleet, loads);
  return fleet.touch(s.per_node, v_.data(), w_.data());
}

// Whether what is kept of a vehicle belongs to this stage. Nothing is kept where bodies touch each other: their
// contacts turn with them.
bool ContactNewton::serves(const train::MovingVehicle& vehicle, const VehicleWork& w, const StageData& s, bool curved) {
  const auto same = [](double a, double b) { return std::abs(a - b) <= same_shift * b; };
  return s.shift2 > 0.0 && !vehicle.mechanism.rubs() && vehicle.contacts.empty() &&
         w.partition_version == vehicle.state.partition_version && (w.curved || !curved) && same(w.shift, s.shift) &&
         same(w.shift2, s.shift2);
}

// Where a vehicle goes by itself, and its contacts with it.
void ContactNewton::condense(VehicleWork& w, VehicleYield& yield) {
  w.inverse.apply(w.R, w.dx);
  w.dx = -w.dx;
  for (int i = 0; i < yield.c.size(); ++i) {
    const auto [first, last] = w.range[i];
    yield.c[i] = w.G.row(i).segment(first, last - first).dot(w.dx.segment(first, last - first));
  }
}

// An iteration has done with the vehicle: it goes where the last one has put it.
void ContactNewton::rest(int k) {
  VehicleWork& w = work_[k];
  w.R.setZero();
  w.residual = 0.0;
  for (int i = contacts_.first(k); i < contacts_.first(k + 1); ++i) {
    train::Contact& c = *contacts_.row(i).contact;
    c.touch.kinematics = c.kinematics;
  }
}

// R = B^T (N q'' - g - Q) at the contact forces held.
void ContactNewton::find_residual(train::MovingVehicle& vehicle, VehicleWork& w) const {
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  const int k = static_cast<int>(&w - work_.data());
  vehicle.Q.setZero();
  for (int i = contacts_.first(k); i < contacts_.first(k) + contacts_.rows(k); ++i) {
    const train::Contact& c = *contacts_.row(i).contact;
    if (contacts_.row(i).normal) train::Fleet::add_load(c, c.force.normal, c.force.tangential, vehicle.Q);
  }
  const double* pdd = pdd_.data() + vehicle.offset;
  w.r = state.d;
  state.dependent_block.expand(pdd, w.r);
  w.r = mechanism.mass_diagonal().cwiseProduct(w.r) - state.g - vehicle.Q;
  if (mechanism.rubs()) {
    mechanism.recover(state, vehicle.Q, pdd);
    for (int i = 0; i < state.friction.force.size(); ++i) w.r -= state.friction.force[i] * state.friction.A.col(i);
  }
  w.R.resize(mechanism.freedom());
  state.dependent_block.project(w.r, w.R);
  w.residual = w.R.size() > 0 ? w.R.lpNorm<Eigen::Infinity>() / vehicle.scale : 0.0;
}

// Contact directions times B, whose rows of a body reach into the columns given.
void ContactNewton::contact_directions(int k, const std::vector<multibody::ColumnRange>& columns,
                                       const Eigen::MatrixXd& B, RowMatrix& G) const {
  G.setZero(contacts_.rows(k), B.cols());
  for (int i = 0; i < G.rows(); ++i) {
    const auto& row = contacts_.row(contacts_.first(k) + i);
    const train::Contact& c = *row.contact;
    const auto add = [&](int body, const Eigen::Vector3d& direction) {
      const auto [first, last] = columns[body];
      G.row(i).segment(first, last - first).noalias() +=
          direction.transpose() * B.block(3 * static_cast<Eigen::Index>(body), first, 3, last - first);
    };
    add(c.body, row.normal ? c.touch.normal_on_body : c.touch.tangent_on_body);
    if (c.other_body != multibody::ground)
      add(c.other_body, row.normal ? c.touch.normal_on_other : c.touch.tangent_on_other);
  }
}

// A vehicle's Newton matrix and what it makes of its contacts, at the state last evaluated.
void ContactNewton::renew(train::MovingVehicle& vehicle, int k, const StageData& s, bool with_curvature) {
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  VehicleWork& w = work_[k];
  const int f = mechanism.freedom();
  const int rows = contacts_.rows(k);
  const bool rubs = mechanism.rubs();
  const bool curved = (with_curvature || rubs) && mechanism.constraints() > 0;
  w.curved = curved || mechanism.constraints() == 0;
  if (rubs)
    mechanism.friction_projector(state, w.projector);
  else if (curved)
    mechanism.recover(state, vehicle.Q, pdd_.data() + vehicle.offset);
  mechanism.multiply_tangent(state, -1.0, -s.shift, curved ? 1.0 : 0.0, w.NB);
  for (std::size_t b = 0; b < state.columns.size(); ++b) {
    const auto [first, last] = state.columns[b];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(b);
    w.NB.block(row, first, 3, last - first) +=
        s.shift2 * mechanism.mass_diagonal().segment<3>(row).asDiagonal() * state.B.block(row, first, 3, last - first);
  }
  w.J.resize(f, f);
  if (rubs) {  // whose slope changes too much to be kept
    w.J.noalias() = w.projector.transpose() * w.NB;
  } else {
    for (int j = 0; j < f; ++j) state.dependent_block.project(w.NB.col(j), w.J.col(j));
  }

  contact_directions(k, state.columns, state.B, w.G);
  if (rubs) {
    w.everything.assign(state.columns.size(), {0, f});
    contact_directions(k, w.everything, w.projector, w.projected);
  }
  w.range.resize(static_cast<std::size_t>(rows));
  for (int i = 0; i < rows; ++i) {
    const train::Contact& c = *contacts_.row(contacts_.first(k) + i).contact;
    w.range[i] = state.columns[c.body];
    if (c.other_body == multibody::ground) continue;
    const multibody::ColumnRange other = state.columns[c.other_body];
    w.range[i] = {std::min(w.range[i].first, other.first), std::max(w.range[i].last, other.last)};
  }
  const RowMatrix& left = rubs ? w.projected : w.G;
  const bool statics = s.shift2 == 0.0;
  if (statics) add_contacts(w, k, left);
  w.inverse.compute(w.J, statics);
  w.Y.resize(f, rows);
  for (int i = 0; i < rows; ++i) {
    w.s = left.row(i).transpose();
    w.inverse.apply(w.s, w.dx);
    w.Y.col(i) = w.dx;
  }
  VehicleYield& yield = contacts_.yield(k);
  yield.H.resize(rows, rows);
  yield.c.resize(rows);
  for (int i = 0; i < rows; ++i) {
    const auto [first, last] = w.range[i];
    yield.H.row(i).noalias() = w.G.row(i).segment(first, last - first) * w.Y.middleRows(first, last - first);
  }
  yield.P.resize(0, 0);
  if (statics) {
    yield.P.setIdentity(rows, rows);
    for (int i = 0; i < rows; ++i) {
      yield.P.col(i) -= yield.H.col(i) * w.D(i, 1);
      if (w.D(i, 0) != 0.0) yield.P.col(i - 1) -= yield.H.col(i) * w.D(i, 0);
    }
  }
  w.shift = s.shift;
  w.shift2 = s.shift2;
  w.partition_version = state.partition_version;
}

// J += G^T D G.
void ContactNewton::add_contacts(VehicleWork& w, int k, const RowMatrix& left) {
  const int rows = contacts_.rows(k);
  w.D.resize(rows, 2);
  w.DG.resize(rows, w.G.cols());
  for (int i = 0; i < rows; ++i) {
    const auto& row = contacts_.row(contacts_.first(k) + i);
    const Eigen::Matrix2d D = contact_tangent(row.contact->force, 0.0);
    w.D.row(i) << (row.normal ? 0.0 : D(1, 0)), (row.normal ? D(0, 0) : D(1, 1));
    w.DG.row(i) = w.D(i, 1) * w.G.row(i);
    if (!row.normal) w.DG.row(i) += w.D(i, 0) * w.G.row(i - 1);
  }
  w.J.noalias() += left.transpose() * w.DG;
}

// Applies the step to x. Returns the largest residual or change of force over the vehicle's weight.
double ContactNewton::update(train::Fleet& fleet, double* x) {
  double change = 0.0;
  for (int k = 0; k < static_cast<int>(work_.size()); ++k) {
    VehicleWork& w = work_[k];
    w.change = w.residual;
    for (int i = contacts_.first(k); i < contacts_.first(k + 1); ++i)
      w.change = std::max(w.change, std::abs(contacts_.change(i)) / fleet.vehicles[k].scale);
    change = std::max(change, w.change);
  }
  for (int k = fleet.first_own(); k < fleet.past_own(); ++k) {
    VehicleWork& w = work_[k];
    const train::MovingVehicle& vehicle = fleet.vehicles[k];
    const int from = contacts_.first(k);
    const bool statics = w.shift2 == 0.0;
    for (int i = 0; i < contacts_.rows(k); ++i) {
      double force = contacts_.change(from + i);
      if (statics) {
        force -= w.D(i, 1) * contacts_.displacement(from + i);
        if (!contacts_.row(from + i).normal) force -= w.D(i, 0) * contacts_.displacement(from + i - 1);
      }
      w.dx -= force * w.Y.col(i);
    }
    for (int i = 0; i < w.dx.size(); ++i) {
      x[vehicle.offset + i] += w.dx[i];
      moved_[vehicle.offset + i] = w.dx[i] + (vehicle.rests ? moved_[vehicle.offset + i] : 0.0);
    }
  }
  return change;
}

}  // namespace traverse::coupling
