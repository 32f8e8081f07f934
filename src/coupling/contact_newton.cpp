// The Newton iteration of a stage: residuals of the vehicles, condensation onto the contacts, update of coordinates and
// forces, and convergence tests based on the measured contraction rate.
#include "coupling/contact_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::coupling {
namespace {

/// The shares of the ends at jumps in height of the surface in a static equilibrium (train::WheelContact). The forces
/// jump where two ends are level, so that Newton's method would alternate between both sides of the jump. Each
/// equilibrium is computed with held shares; if the heights of the ends contradict them, new shares follow by regula
/// falsi.
class EdgeShares {
 public:
  explicit EdgeShares(train::Fleet& fleet) : fleet_(fleet) {}
  ~EdgeShares() {
    for (const Edge& edge : edges_) edge.contact->share_held = false;
  }
  EdgeShares(const EdgeShares&) = delete;
  EdgeShares& operator=(const EdgeShares&) = delete;

  /// Holds the shares that the fleet has at the evaluated state.
  void hold() {
    for (train::WheelContact& c : fleet_.wheels) {
      if (!c.at_height_jump || c.candidates == 0) continue;
      c.share_held = true;
      edges_.push_back({&c});
    }
  }
  bool any() const { return !edges_.empty(); }
  /// Whether the equilibrium agrees with the held shares; otherwise other shares are held.
  bool settle() {
    bool settled = true;
    for (Edge& edge : edges_) settled = settle(edge) && settled;
    return settled;
  }

 private:
  /// A jump whose right end has been higher with the share `low` of the left end, and lower with the share `high`.
  struct Edge {
    train::WheelContact* contact = nullptr;
    double low = 0.0, high = 1.0;
    double above = std::numeric_limits<double>::quiet_NaN(), below = above;  // m
    int side = 0;                                                            // of the last equilibrium
  };

  static bool settle(Edge& edge) {
    double& share = edge.contact->share;
    const double height = edge.contact->jump;
    if (std::abs(height) <= 0.1 * train::level || (height > 0.0 ? share == 1.0 : share == 0.0)) return true;
    const int side = height > 0.0 ? 1 : -1;
    (side > 0 ? edge.low : edge.high) = share;
    (side > 0 ? edge.above : edge.below) = height;
    // Where one end of the interval remains, the height there is halved: the Illinois method.
    if (side == edge.side) (side > 0 ? edge.below : edge.above) *= 0.5;
    edge.side = side;
    const double other = side > 0 ? edge.below : edge.above;
    if (std::isnan(other))
      share = side > 0 ? 1.0 : 0.0;
    else
      share = edge.low + (edge.high - edge.low) * edge.above / (edge.above - edge.below);
    return false;
  }

  train::Fleet& fleet_;
  std::vector<Edge> edges_;
};

constexpr int most_iterations = 40;
constexpr int most_static_iterations = 400;   // with changes of shares at jumps in height
constexpr int reuse_iterations = 4;           // limit of iterations of a stage with reused matrices
constexpr int most_tangents = 20;             // iterations on the contact laws in one iteration
constexpr double smooth_tolerance = 1e-10;    // remaining error of forces, relative to the weight
constexpr double friction_tolerance = 1e-12;  // this error with friction, whose tangent is steep near sticking
constexpr double static_tolerance = 1e-13;
constexpr double best_ratio = 1e-4;  // least ratio of two successive changes that is assumed
constexpr double poor_ratio =
    1e-3;  // ratio of successive residuals or changes above which the matrices are computed again
constexpr double first_share = 0.1;     // part of the ratio of a stage's first changes that is due to reused matrices
constexpr double growth = 1.1;          // factor of a ratio that is assumed again without a new measurement
constexpr double measurable = 1e-8;     // relative to the weight: a ratio is computed only from larger changes
constexpr double safety = 0.1;          // relative to the tolerance: a smaller predicted second change is not computed
constexpr double least_decrease = 0.1;  // least new ratio over the previous one
constexpr int not_comparable = -1;
constexpr double rounding = 1e-9;  // relative to the weight: a smaller change that does not decrease is due to rounding

}  // namespace

bool ContactNewton::solve(train::Fleet& fleet, const StageData& s, double* x) {
  work_.resize(fleet.vehicles.size());
  for (std::vector<double>* v : {&p_, &pd_, &pdd_, &moved_}) v->resize(static_cast<std::size_t>(fleet.freedom()));
  tolerance_ = smooth_tolerance;
  for (int i = 0; i < fleet.contacts(); ++i)
    if (fleet.contact(i).law.friction > 0.0) tolerance_ = friction_tolerance;
  const bool found = iterate(fleet, s, x);
  for (train::MovingVehicle& vehicle : fleet.vehicles) vehicle.converged = false;
  if (!found) return false;
  if (s.shift2 > 0.0) fleet.shift(moved_.data(), s.shift);
  bool touched = true;
  if (single_evaluation_) {  // the forces are known; evaluate the geometry under them
    beam_field(s, fleet, Loads::found);
    touched = fleet.touch(s.per_node, v_.data(), w_.data());
  }
  const unsigned flags = share_contacts(
      s, fleet,
      (touched ? 0U : train::VehicleShare::failed) | (fleet.wheels_in_place() ? 0U : train::VehicleShare::misplaced));
  if ((flags & train::VehicleShare::failed) != 0) return false;
  in_place_ = (flags & train::VehicleShare::misplaced) == 0;
  fleet.element_loads(s.per_node, loads_);
  return true;
}

bool ContactNewton::iterate(train::Fleet& fleet, const StageData& s, double* x) {
  fleet.contact_forces();
  const bool statics = s.shift2 == 0.0;
  bool reused = true;
  EdgeShares edges(fleet);
  int last_change = 0;  // the last iteration that changed the shares
  for (int i = 0; i < last_change + most_iterations && i < most_static_iterations; ++i) {
    const Loads loads = i > 0 ? Loads::found : statics ? Loads::none : Loads::expected;
    const bool evaluated = evaluate(fleet, s, x, loads);
    if (i == 0) contacts_.list(fleet);
    if (i == 0 && s.shift == 0.0) edges.hold();
    if (evaluated && edges.any()) fleet.contact_forces();  // with the shares held last
    const unsigned flags =
        share_contacts(s, fleet, evaluated ? condense_own(fleet, s, i) : unsigned{train::VehicleShare::failed});
    if ((flags & train::VehicleShare::failed) != 0) return false;
    const bool renewed = (flags & train::VehicleShare::renewed) != 0;
    if (renewed) share_matrices(s);
    reused = reused && !renewed;
    if (loads != Loads::none && s.compliance != nullptr) correct_kinematics(s, fleet);
    if (contacts_.moved() || i == 0 || renewed)
      contacts_.couple(fleet.elements().empty() ? nullptr : s.compliance, s.per_node);
    // In statics the vehicles' matrices include the contacts' tangents, which are computed again with them.
    const double deviation = contacts_.solve(s.shift, loads != Loads::none, statics ? 1 : most_tangents);
    const double before = change_;
    change_ = update(fleet, x);
    if (!std::isfinite(change_)) return false;
    if (i == 0) {
      single_evaluation_ = reused && !statics && deviation <= tolerance_ &&
                           second_.negligible(loaded_contacts(fleet), change_, safety * tolerance_);
      if (single_evaluation_) return true;
      continue;
    }
    if (i == 1) second_.record(reused ? loaded_contacts(fleet) : not_comparable, before, change_);
    if (has_converged(statics, reused && i == 1, before, deviation)) {
      if (edges.settle()) return true;
      last_change = i;
    }
    for (std::size_t k = 0; k < work_.size(); ++k)
      fleet.vehicles[k].converged = !statics && work_[k].change * contraction_ <= tolerance_;
  }
  return false;
}

std::size_t ContactNewton::worst_vehicle() const {
  const auto less = [](const VehicleWork& a, const VehicleWork& b) { return a.change < b.change; };
  return static_cast<std::size_t>(std::max_element(work_.begin(), work_.end(), less) - work_.begin());
}

// Evaluates and condenses this rank's vehicles.
unsigned ContactNewton::condense_own(train::Fleet& fleet, const StageData& s, int i) {
  unsigned flags = 0;
  for (int k = fleet.first_own(); k < fleet.past_own(); ++k) {
    train::MovingVehicle& vehicle = fleet.vehicles[k];
    train::ContactCompliance& compliance = contacts_.compliance(k);
    const double before = compliance.residual;
    if (vehicle.converged)
      clear_residual(fleet, k);
    else if (!find_residual(vehicle, k))
      return train::VehicleShare::failed;
    const bool converges_slowly =
        i >= reuse_iterations || (i > 1 && !vehicle.converged && measured_ > poor_ratio) ||
        (i > 1 && compliance.residual > poor_ratio * before && compliance.residual > tolerance_);
    if (converges_slowly || !compliance.known || !vehicle.dynamics->matrix_is_valid(vehicle, s.shifts(), i > 0)) {
      renew(vehicle, k, s, s.shifts().statics() || i > 0);
      compliance.known = true;
      flags |= train::VehicleShare::renewed;
    }
    vehicle.dynamics->compute_free_displacement(compliance);
  }
  return flags;
}

// Test of convergence. The next change is assumed to be smaller by the ratio of the last two changes, but not in
// statics. A stage's first change is large; its ratio to the second one depends more on its size than on the reused
// matrices. For it the ratio measured in earlier stages is used too. Changes due to rounding do not decrease.
bool ContactNewton::has_converged(bool statics, bool reused, double before, double deviation) {
  if (statics && deviation > rounding) return false;  // a contact has closed, or a share has changed
  if (change_ == 0.0) return true;
  const double measured = measured_ = change_ / before;
  contraction_ = std::clamp(measured, best_ratio, 1.0);
  if (reused && measured <= poor_ratio) {
    contraction_ = std::max(ratio_, first_share * measured);
    ratio_ = std::min(growth * ratio_, 1.0);
  } else if (!statics && before > measurable) {
    ratio_ = std::min(measured, 1.0);
  }
  if (change_ <= rounding && measured > 0.1) return true;
  return statics ? change_ <= static_tolerance : change_ * contraction_ <= tolerance_ && deviation <= tolerance_;
}

// The ratio grows with the first change, at most in proportion.
bool ContactNewton::SecondChange::negligible(int contacts, double change, double limit) {
  const double curved = std::max(1.0, change / first);
  if (contacts < 0 || contacts != loaded_contacts || change * ratio * curved > limit) return false;
  ratio *= growth;
  return true;
}

void ContactNewton::SecondChange::record(int contacts, double change, double next) {
  loaded_contacts = contacts;
  if (!(change > 0.0)) return;
  first = change;
  ratio = std::max(next / change, least_decrease * ratio);
}

// Number of contacts with force; not_comparable if a wheel near a kink may touch both sides, or if a contact has
// friction.
int ContactNewton::loaded_contacts(const train::Fleet& fleet) {
  int count = 0;
  for (const train::WheelContact& c : fleet.wheels) {
    if (c.candidates > 1 || (c.candidates == 1 && fleet.has_points(c)) || c.law.friction > 0.0) return not_comparable;
    if (c.force.normal != 0.0) ++count;
  }
  return count;
}

// Sets the vehicles to p_predicted + x and the beam under the forces of the stored kinematics, and evaluates the
// contact geometry. In the first iteration the points of action of these forces are approximate; without the forces the
// error of the beam's slope would change the directions of the forces on the vehicles by 1e-6.
bool ContactNewton::evaluate(train::Fleet& fleet, const StageData& s, const double* x, Loads loads) {
  const auto [first, past] = fleet.own_coordinates();
  for (int i = first; i < past; ++i) {
    p_[i] = s.p_predicted[i] + x[i];
    pd_[i] = s.pd_predicted[i] + s.shift * x[i];
    pdd_[i] = s.shift2 * x[i];
  }
  if (!fleet.set(s.t, p_.data(), pd_.data())) return false;
  beam_field(s, fleet, loads);
  return fleet.touch(s.per_node, v_.data(), w_.data());
}

// The last iteration has moved the vehicle to its solution.
void ContactNewton::clear_residual(train::Fleet& fleet, int k) {
  fleet.vehicles[k].dynamics->clear_residual();
  contacts_.compliance(k).residual = 0.0;
  for (const train::ContactRow& row : contacts_.rows_of(k)) row.contact->touch.kinematics = row.contact->kinematics;
}

// The residual of a vehicle at the stored contact forces.
bool ContactNewton::find_residual(train::MovingVehicle& vehicle, int k) {
  vehicle.Q.setZero();
  for (const train::ContactRow& row : contacts_.rows_of(k)) {
    const train::Contact& c = *row.contact;
    if (row.normal) train::Fleet::add_load(c, c.force.normal, c.force.tangential, vehicle.Q);
  }
  return vehicle.dynamics->find_residual(vehicle, pdd_.data() + vehicle.offset, contacts_.compliance(k));
}

// In statics the vehicle's matrix may be singular, therefore it includes the contacts' tangents.
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

// Adds the step to x. Returns the largest residual or change of force over the vehicle's weight.
double ContactNewton::update(train::Fleet& fleet, double* x) {
  double change = 0.0;
  for (int k = 0; k < static_cast<int>(work_.size()); ++k) {
    VehicleWork& w = work_[k];
    w.change = contacts_.compliance(k).residual;
    for (int i = contacts_.first(k); i < contacts_.first(k) + contacts_.rows(k); ++i)
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
    const Eigen::VectorXd& dx = vehicle.dynamics->coordinate_change(forces);
    for (int i = 0; i < dx.size(); ++i) {
      x[vehicle.offset + i] += dx[i];
      moved_[vehicle.offset + i] = dx[i] + (vehicle.converged ? moved_[vehicle.offset + i] : 0.0);
    }
  }
  return change;
}

}  // namespace traverse::coupling
