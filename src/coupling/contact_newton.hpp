// Newton's method for one implicit stage of all vehicles and contacts, with the beam condensed onto the elements under
// the wheels. The unknowns are the independent coordinates p of each vehicle and the kinematics of each contact
// (penetration, its rate, sliding speed). The contact force is a function of these kinematics, so that the problem is
// convex for open contacts and during impacts. With the contact forces F along their directions G, the residual R of a
// vehicle at the previous forces and its Newton matrix J (train::VehicleDynamics),
//
//   J dx = -R - G^T dF
//
// is condensed onto the contacts and solved there (CondensedContacts). J changes little: the matrices derived from it
// are reused in later stages and steps, and computed again if the iteration converges slowly. In statics J may be
// singular, therefore it includes the contacts' tangents. If ranks share the vehicles, each rank evaluates and
// condenses its own vehicles, and all ranks solve for the contacts.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "coupling/condensed_contacts.hpp"
#include "structure/compliance.hpp"
#include "train/fleet.hpp"
#include "train/vehicle_share.hpp"

namespace traverse::coupling {

/// The data of a stage. The unknown is the change x of p from p at zero acceleration: p = p_predicted + x, p' =
/// pd_predicted + shift*x, p'' = shift2*x. x is small, so that p'' keeps the digits that it would lose if p were the
/// unknown. The elements' unknowns are v = v0 + z, w = w0 + shift*z with z = (compliance) loads. Shifts of 0: the
/// static problem.
struct StageData {
  double t = 0.0;
  double shift = 0.0;   // dp'/dp, 1/s
  double shift2 = 0.0;  // dp''/dp, 1/s2: shift*shift for Runge-Kutta types
  train::StageShifts shifts() const { return {shift, shift2}; }
  const double* p_predicted = nullptr;
  const double* pd_predicted = nullptr;
  const std::vector<double>* v0 = nullptr;  // free response at the elements under wheels, 2*per_node each
  const std::vector<double>* w0 = nullptr;  // its rate
  const structure::ElementCompliance* compliance = nullptr;  // null without a beam
  int per_node = 2;
  train::VehicleShare* share = nullptr;  // null: this rank has all vehicles
};

class ContactNewton {
 public:
  /// Collective if ranks share the vehicles. x (the freedom values of this rank) is the initial guess and then the
  /// solution, to which the vehicles are set. Returns false if the iteration does not converge.
  bool solve(train::Fleet& fleet, const StageData& stage, double* x);
  /// Whether all wheels are on their patches at the solution.
  bool in_place() const { return in_place_; }
  /// Nodal loads of the solution on the elements under wheels, 2*per_node each.
  const std::vector<double>& element_loads() const { return loads_; }
  /// The largest residual or change of force of the last iteration over the weight, for messages.
  double last_change() const { return change_; }
  /// The vehicle with this largest value.
  std::size_t worst_vehicle() const;
  /// Reads or writes the data that later stages reuse.
  void keep(base::Bytes& bytes) {
    bytes(contacts_, loads_, tolerance_, change_, measured_, contraction_, second_, single_evaluation_, in_place_,
          ratio_);
  }

 private:
  struct VehicleWork {
    double change = 0.0;     // larger of the residual and the largest change of force, over the weight
    Eigen::VectorXd forces;  // changes of the forces of its rows
  };
  bool iterate(train::Fleet& fleet, const StageData& s, double* x);
  /// The contact forces on the beam: none, estimated from the wheels' positions, or computed with the evaluated
  /// geometry.
  enum class Loads { none, expected, found };
  bool evaluate(train::Fleet& fleet, const StageData& s, const double* x, Loads loads);
  unsigned condense_own(train::Fleet& fleet, const StageData& s, int iteration);
  unsigned share_contacts(const StageData& s, train::Fleet& fleet, unsigned flags);
  void share_matrices(const StageData& s);
  void beam_field(const StageData& s, const train::Fleet& fleet, Loads loads);
  void correct_kinematics(const StageData& s, train::Fleet& fleet);
  bool has_converged(bool statics, bool reused, double before, double deviation);
  static int loaded_contacts(const train::Fleet& fleet);
  void clear_residual(train::Fleet& fleet, int vehicle);
  bool find_residual(train::MovingVehicle& vehicle, int k);
  void renew(train::MovingVehicle& vehicle, int k, const StageData& s, bool curved);
  double update(train::Fleet& fleet, double* x);

  std::vector<VehicleWork> work_;
  CondensedContacts contacts_;
  std::vector<double> loads_, before_, v_, w_, p_, pd_, pdd_;
  std::vector<double> moved_;  // change of x since the vehicles were set
  double tolerance_ = 0.0;     // tolerance of forces, relative to the weight
  double change_ = 0.0;
  double measured_ = 1.0;     // ratio of the last two changes
  double contraction_ = 1.0;  // expected ratio of the next change to the last one
  /// The ratio of a stage's second change to its first one, measured in the last stage with reused matrices. If the
  /// predicted second change is negligible, the stage ends after one evaluation.
  struct SecondChange {
    double ratio = 1.0, first = 1.0;  // ratio of the second change to the first one; the first change
    int loaded_contacts = -1;         // contacts with force in that stage; -1: not comparable
    bool negligible(int contacts, double change, double limit);
    void record(int contacts, double change, double next);
  };
  SecondChange second_;
  bool single_evaluation_ = false;  // the stage ended after one evaluation
  bool in_place_ = true;
  double ratio_ = 1.0;  // last measured ratio of successive changes with reused matrices
};

}  // namespace traverse::coupling
