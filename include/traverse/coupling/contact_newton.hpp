// Newton's method for one implicit stage of all vehicles and contacts, the beam condensed onto the elements under
// the wheels. Unknowns: the independent coordinates p of every vehicle and the contact kinematics of every wheel
// (penetration, its rate, sliding speed); the contact law enters as a function of these, which keeps the problem
// convex in flight and under impact. A vehicle's Newton matrix is dense and small; wheels on the beam are coupled
// by a dense system of their number.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "traverse/coupling/compliance.hpp"
#include "traverse/coupling/fleet.hpp"

namespace traverse::coupling {

/// The stage's data: p' = shift*p + c, p'' = shift*p' + c', element unknowns v = v0 + (compliance) loads,
/// their rates w = shift*v + c_v. A shift of 0 with zero c is the static problem.
struct StageData {
  double t = 0.0;
  double shift = 0.0;
  const double* c_p = nullptr;              // freedom values, then those of p'
  const std::vector<double>* v0 = nullptr;  // free response at the elements in touch, 2*per_node each
  const std::vector<double>* c_v = nullptr;
  const Compliance* compliance = nullptr;  // null without a beam
  int per_node = 2;
};

class ContactNewton {
 public:
  /// p (freedom values): in a guess, out the solution. False when it does not converge.
  bool solve(Fleet& fleet, const StageData& stage, double* p);
  /// Nodal loads on the elements in touch that belong to the solution, 2*per_node each.
  const std::vector<double>& element_loads() const { return loads_; }
  /// Residual and change of force of the last iteration over the train's weight, for messages.
  double last_change() const { return change_; }

 private:
  struct VehicleWork {
    Eigen::MatrixXd J, own, G, D, Z, T, NB;  // own: J without contacts; G: contact directions times B; D: law's tangent
    Eigen::MatrixXd projector, projected;    // in place of B, and of G = directions times B, where joints rub
    Eigen::VectorXd R, dp, f_hat, correction, r;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    std::vector<int> contact, component;  // of every row of G: which contact, 0 normal or 1 tangential
  };
  struct Row {  // of the coupled system: a row of a vehicle's G, and the element that carries it
    int vehicle, index, slot;
    bool operator==(const Row&) const = default;
  };
  enum class Tangent { kept, fresh, full };
  bool evaluate(Fleet& fleet, const StageData& s, const double* p);
  void beam_field(const StageData& s, const Fleet& fleet);
  static void contact_directions(const Fleet& fleet, const VehicleWork& w, const Eigen::MatrixXd& B,
                                 Eigen::MatrixXd& G);
  void vehicle_system(Fleet& fleet, int k, const StageData& s, Tangent own);
  bool list_rows(const Fleet& fleet);
  void mutual_compliance(const Fleet& fleet, const StageData& s);
  void couple_beam(const Fleet& fleet, const StageData& s, Tangent own);
  double update(Fleet& fleet, const StageData& s, double* p);

  std::vector<VehicleWork> work_;
  std::vector<double> loads_, v_, w_, pd_, pdd_;
  Eigen::MatrixXd W_, coupled_;
  Eigen::VectorXd du_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  std::vector<Row> rows_, previous_rows_;
  double change_ = 0.0;
};

}  // namespace traverse::coupling
