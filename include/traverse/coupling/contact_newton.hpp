// Newton's method for one implicit stage of all vehicles and contacts, the beam condensed onto the elements under
// the wheels. Unknowns: the independent coordinates p of every vehicle and the contact kinematics of every wheel
// (penetration, its rate, sliding speed); the contact law enters as a function of these, which keeps the problem
// convex in flight and under impact. A vehicle's Newton matrix is dense and small, or banded where
// couplers join many; wheels on the beam are coupled by a dense system of their number.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "traverse/coupling/band_lu.hpp"
#include "traverse/coupling/compliance.hpp"
#include "traverse/coupling/fleet.hpp"

namespace traverse::coupling {

/// The stage's data. The unknown is the change x of p against p at zero acceleration: p = p_still + x,
/// p' = pd_still + shift*x, p'' = shift2*x. Being small it keeps the digits that p itself would lose in p''. The
/// elements' unknowns are v = v0 + z, w = w0 + shift*z with z = (compliance) loads. Shifts of 0: the static problem.
struct StageData {
  double t = 0.0;
  double shift = 0.0;   // dp'/dp, 1/s
  double shift2 = 0.0;  // dp''/dp, 1/s2: shift*shift for Runge-Kutta types
  const double* p_still = nullptr;
  const double* pd_still = nullptr;
  const std::vector<double>* v0 = nullptr;  // free response at the elements in touch, 2*per_node each
  const std::vector<double>* w0 = nullptr;  // its rate
  const Compliance* compliance = nullptr;   // null without a beam
  int per_node = 2;
};

class ContactNewton {
 public:
  /// x (freedom values): in a guess, out the solution. False when it does not converge.
  bool solve(Fleet& fleet, const StageData& stage, double* x);
  /// Nodal loads on the elements in touch that belong to the solution, 2*per_node each.
  const std::vector<double>& element_loads() const { return loads_; }
  /// Residual and change of force of the last iteration over the train's weight, for messages.
  double last_change() const { return change_; }

 private:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct VehicleWork {
    Eigen::MatrixXd J, own, Z, T, NB;  // own: J without contacts
    Eigen::MatrixXd projector;         // in place of B where joints rub
    RowMatrix G, DG, projected;  // contact directions times B, the law's tangent times G, directions times projector
    Eigen::Matrix<double, Eigen::Dynamic, 2> D;  // that tangent: by the row before (of a tangential one), by the row
    Eigen::VectorXd R, dp, f_hat, correction, r;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    BandLu band_lu;
    std::vector<int> contact, component;        // of every row of G: which contact, 0 normal or 1 tangential
    std::vector<multibody::ColumnRange> range;  // of every row of G
    std::vector<multibody::ColumnRange> everything;
    std::vector<int> on_beam;  // the rows whose contact is on the beam
  };
  struct Row {  // of the coupled system: a row of a vehicle's G, its column of T and Z, the element that carries it
    int vehicle, index, column, slot;
    bool operator==(const Row&) const = default;
  };
  enum class Tangent { kept, fresh, full };
  bool evaluate(Fleet& fleet, const StageData& s, const double* x);
  void beam_field(const StageData& s, const Fleet& fleet);
  static void contact_directions(const Fleet& fleet, const VehicleWork& w,
                                 const std::vector<multibody::ColumnRange>& columns, const Eigen::MatrixXd& B,
                                 RowMatrix& G);
  void vehicle_system(Fleet& fleet, int k, const StageData& s, Tangent own);
  static bool tangential_behind(const VehicleWork& w, int row);
  static void solve_vehicle(VehicleWork& w, bool singular);
  bool list_rows(const Fleet& fleet);
  void mutual_compliance(const Fleet& fleet, const StageData& s);
  void couple_beam(const Fleet& fleet, const StageData& s, Tangent own);
  double update(Fleet& fleet, const StageData& s, double* x);

  std::vector<VehicleWork> work_;
  std::vector<double> loads_, v_, w_, p_, pd_, pdd_;
  Eigen::MatrixXd W_, coupled_;
  Eigen::VectorXd du_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  std::vector<Row> rows_, previous_rows_;
  double change_ = 0.0;
};

}  // namespace traverse::coupling
