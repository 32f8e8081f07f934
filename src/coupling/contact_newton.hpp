// Newton's method for one implicit stage of all vehicles and contacts, the beam condensed onto the elements under
// the wheels. Unknowns: the independent coordinates p of every vehicle and the contact kinematics of every wheel
// (penetration, its rate, sliding speed); the contact law enters as a function of these, which keeps the problem
// convex in flight and under impact. With the contacts' forces F along their directions G, a vehicle's residual R at
// the forces held and its own Newton matrix J (train::VehicleDynamics),
//
//   J dx = -R - G^T dF
//
// is condensed onto the contacts and solved there (CondensedContacts). J hardly changes: what follows from it is kept
// over stages and steps, and computed anew where the iteration tells that it no longer serves. In statics, where J may
// be singular without them, the contacts' tangents are part of it. Where ranks share the vehicles each one evaluates
// and condenses its own, and all solve for the contacts.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "coupling/condensed_contacts.hpp"
#include "structure/compliance.hpp"
#include "train/fleet.hpp"
#include "train/vehicle_share.hpp"

namespace traverse::coupling {

/// The stage's data. The unknown is the change x of p against p at zero acceleration: p = p_predicted + x,
/// p' = pd_still + shift*x, p'' = shift2*x. Being small it keeps the digits that p itself would lose in p''. The
/// elements' unknowns are v = v0 + z, w = w0 + shift*z with z = (compliance) loads. Shifts of 0: the static problem.
struct StageData {
  double t = 0.0;
  double shift = 0.0;   // dp'/dp, 1/s
  double shift2 = 0.0;  // dp''/dp, 1/s2: shift*shift for Runge-Kutta types
  train::StageShifts shifts() const { return {shift, shift2}; }
  const double* p_predicted = nullptr;
  const double* pd_still = nullptr;
  const std::vector<double>* v0 = nullptr;                   // free response at the elements in touch, 2*per_node each
  const std::vector<double>* w0 = nullptr;                   // its rate
  const structure::ElementCompliance* compliance = nullptr;  // null without a beam
  int per_node = 2;
  train::VehicleShare* share = nullptr;  // null: this rank has all vehicles
};

class ContactNewton {
 public:
  /// Collective where vehicles are shared. x (freedom values): in a guess, out the solution, where the vehicles are
  /// moved; of this rank's. False when it does not converge.
  bool solve(train::Fleet& fleet, const StageData& stage, double* x);
  /// Whether all wheels are still on their patches then.
  bool in_place() const { return in_place_; }
  /// Nodal loads on the elements in touch that belong to the solution, 2*per_node each.
  const std::vector<double>& element_loads() const { return loads_; }
  /// Residual and change of force of the last iteration over the train's weight, for messages.
  double last_change() const { return change_; }
  /// The vehicle of the largest of these.
  std::size_t worst_vehicle() const;
  /// What is kept from stage to stage.
  void keep(base::Bytes& bytes) {
    bytes(contacts_, loads_, tolerance_, change_, contraction_, second_, once_, in_place_, ratio_);
  }

 private:
  struct VehicleWork {
    double change = 0.0;     // larger of the residual and the largest change of force, over the weight
    Eigen::VectorXd forces;  // changes of its rows' forces
  };
  bool iterate(train::Fleet& fleet, const StageData& s, double* x);
  /// The contacts' forces that the beam is taken under: where the wheels' places let them be expected, or where the
  /// geometry has found them.
  enum class Loads { none, expected, found };
  bool evaluate(train::Fleet& fleet, const StageData& s, const double* x, Loads loads);
  unsigned condense_own(train::Fleet& fleet, const StageData& s, int iteration);
  unsigned share_contacts(const StageData& s, train::Fleet& fleet, unsigned signs);
  void share_matrices(const StageData& s);
  void beam_field(const StageData& s, const train::Fleet& fleet, Loads loads);
  void follow_loads(const StageData& s, train::Fleet& fleet);
  bool settled(bool statics, bool as_before, double before, double left);
  static int carrying(const train::Fleet& fleet);
  void rest(train::Fleet& fleet, int vehicle);
  bool find_residual(train::MovingVehicle& vehicle, int k);
  void renew(train::MovingVehicle& vehicle, int k, const StageData& s, bool curved);
  double update(train::Fleet& fleet, double* x);

  std::vector<VehicleWork> work_;
  CondensedContacts contacts_;
  std::vector<double> loads_, before_, v_, w_, p_, pd_, pdd_;
  std::vector<double> moved_;  // of x since the vehicles were set
  double tolerance_ = 0.0;     // of the weight
  double change_ = 0.0;
  double contraction_ = 1.0;  // of the changes to come
  /// A stage's second change by its ratio to the first one, as measured last in a stage with kept matrices: where it
  /// would be too small to matter the stage is left with one evaluation.
  struct SecondChange {
    double ratio = 1.0, first = 1.0;  // to the first change, and this
    int carrying = -1;                // contacts with force then; -1: none like it
    bool negligible(int contacts, double change, double limit);
    void note(int contacts, double change, double next);
  };
  SecondChange second_;
  bool once_ = false;  // left the stage so
  bool in_place_ = true;
  double ratio_ = 1.0;  // of successive changes with the matrices that are kept, as measured last
};

}  // namespace traverse::coupling
