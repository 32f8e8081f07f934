// The contacts of all vehicles with everything else condensed onto them. Unknowns are the displacements delta along the
// contacts' directions (rows: a contact's normal, behind it its tangent where there is friction) from the geometry
// last evaluated. With the forces F(delta) by the contacts' laws and F_held those that this geometry belongs to,
//
//   P delta + A (F(delta) - F_held) = c,   A = H + P W,   P = 1 - H D0
//
// where H says how the vehicles yield to forces at their contacts (D0: the law's tangent that H already includes; 0
// but in statics), W how the beam does, and c where the vehicles go by themselves. Penetration rates and sliding speeds
// change by shift times delta.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "solve/band_lu.hpp"
#include "structure/compliance.hpp"
#include "train/fleet.hpp"
#include "train/vehicle_dynamics.hpp"

namespace traverse::coupling {

/// The row of a train::RowTangent: the derivatives of the row's force by the displacement along the row before (of a
/// tangential row: the normal one) and by that along its own, N/m.
Eigen::RowVector2d row_tangent(const train::ContactRow& row, double shift);

class CondensedContacts {
 public:
  /// Takes the fleet's contacts, vehicle by vehicle.
  void list(train::Fleet& fleet);
  int first(int vehicle) const { return first_[vehicle]; }
  int rows(int vehicle) const { return first_[vehicle + 1] - first_[vehicle]; }
  const train::ContactRow& row(int i) const { return rows_[i]; }
  train::ContactRows rows_of(int vehicle) const {
    return train::ContactRows(rows_).subspan(static_cast<std::size_t>(first(vehicle)),
                                             static_cast<std::size_t>(rows(vehicle)));
  }
  /// Whether some contact has gone over to another element since it was listed or asked last.
  bool moved();

  train::ContactCompliance& compliance(int vehicle) { return yield_[vehicle]; }
  void keep(base::Bytes& bytes) { bytes(yield_); }
  /// A from the vehicles' H and P and from the beam (null: none).
  void couple(const structure::ElementCompliance* compliance, int per_node);

  /// Newton from the kinematics held in the contacts, which take those found and their forces. loaded: the geometry
  /// has the beam under the forces held, else under none. Returns what is left over a vehicle's weight: the law's
  /// deviation from its last tangent.
  double solve(double shift, bool loaded, int most_iterations);

  /// The change of the forces found: by the law's last tangent.
  double change(int row) const { return change_[row]; }
  /// The displacement found but for the beam's part of it.
  double displacement(int row) const { return delta_[row] - beam_[row]; }

 private:
  struct Response {  // row a moves by `value` with a unit force of row b, through the beam
    int a, b;
    double value;
  };
  template <int m>
  void respond(const structure::ElementCompliance& compliance);
  void find_band(bool whole);
  void fill();
  double& A(int i, int j) { return A_(band_ + i - j, j); }
  int top(int j) const { return std::max(0, j - band_); }
  int bottom(int j) const { return std::min(size() - 1, j + band_); }
  int size() const { return static_cast<int>(rows_.size()); }
  void factor(double shift);
  void deflect(const Eigen::VectorXd& forces);
  void subtract_A_times(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  double move_contacts(double shift);

  std::vector<train::ContactRow> rows_;
  std::vector<int> first_;                 // row of every vehicle, and one past the last
  std::vector<int> on_slot_, slot_begin_;  // rows by the slot that carries them
  std::vector<train::ContactCompliance> yield_;
  std::vector<Response> responses_;
  int band_ = 0;
  Eigen::MatrixXd A_;    // entry (i, j) at (band + i - j, j)
  train::RowTangent D_;  // in lu_
  solve::BandLu lu_;
  bool factored_ = false;
  Eigen::VectorXd held_, delta_, change_, deviation_, right_;
  Eigen::VectorXd beam_;  // displacement of the beam along the rows
};

}  // namespace traverse::coupling
