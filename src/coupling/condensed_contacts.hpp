// Newton's method for the contacts of all vehicles, with the vehicles and the beam condensed onto them. The unknowns
// are the displacements delta along the contact directions from the geometry evaluated last. Each contact has a row for
// its normal and, with friction, the next row for its tangent. With the contact forces F(delta) and the forces F_ref of
// the evaluated geometry,
//
//   P delta + A (F(delta) - F_ref) = c,   A = H + P W,   P = 1 - H D0
//
// H is the compliance of the vehicles at their contacts, W the compliance of the beam, and c the displacement of the
// vehicles under unchanged contact forces. D0 is the tangent of the contact law that H includes; it is zero except in
// statics. Penetration rates and sliding speeds change by shift times delta.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "solve/band_lu.hpp"
#include "structure/compliance.hpp"
#include "train/fleet.hpp"
#include "train/vehicle_dynamics.hpp"

namespace traverse::coupling {

/// The row of a train::RowTangent, N/m: the derivatives of the row's force by the displacement along the previous row
/// (for a tangential row: the normal row) and by the displacement along the row itself.
Eigen::RowVector2d row_tangent(const train::ContactRow& row, double shift);

class CondensedContacts {
 public:
  /// Lists the contacts of the fleet, vehicle by vehicle, in the order of the vehicles' places at the first call.
  void list(train::Fleet& fleet);
  int first(int vehicle) const { return first_[vehicle]; }
  int rows(int vehicle) const { return count_[vehicle]; }
  int size() const { return static_cast<int>(rows_.size()); }
  const train::ContactRow& row(int i) const { return rows_[i]; }
  train::ContactRows rows_of(int vehicle) const {
    return train::ContactRows(rows_).subspan(static_cast<std::size_t>(first(vehicle)),
                                             static_cast<std::size_t>(rows(vehicle)));
  }
  /// Whether a contact has moved to another element since the last call of list() or moved().
  bool moved();

  train::ContactCompliance& compliance(int vehicle) { return compliances_[vehicle]; }
  void keep(base::Bytes& bytes) { bytes(compliances_); }
  /// Computes A from H and P of the vehicles and W of the beam (null: no beam).
  void couple(const structure::ElementCompliance* compliance, int per_node);

  /// Computes the contact forces by Newton's method from the kinematics stored in the contacts, and stores the solution
  /// in the contacts. loaded: the geometry was evaluated with the beam under the present contact forces, otherwise
  /// under no contact forces. Returns the remaining deviation of a force from the last tangent of the law, over the
  /// vehicle's weight.
  double solve(double shift, bool loaded, int most_iterations);

  /// The computed change of the force by the last tangent of the law.
  double change(int row) const { return change_[row]; }
  /// The computed displacement without the part of the beam.
  double displacement(int row) const { return delta_[row] - beam_[row]; }

 private:
  struct Response {  // a unit force of row b displaces row a by `value` through the beam
    int a, b;
    double value;
  };
  template <int m>
  void respond(const structure::ElementCompliance& compliance);
  int band_of_blocks() const;
  void find_band();
  void fill_A();
  double& A(int i, int j) { return A_(band_ + i - j, j); }
  int top(int j) const { return std::max(0, j - band_); }
  int bottom(int j) const { return std::min(size() - 1, j + band_); }
  void factor(double shift);
  void set_beam_displacement(const Eigen::VectorXd& forces);
  void subtract_A_times(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  void subtract_all_times(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  void add_band_times(double factor, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  double largest_weak_change() const;
  double update_contacts(double shift);

  std::vector<train::ContactRow> rows_;
  std::vector<int> first_, count_;         // for each vehicle: its first row, and their number
  std::vector<std::size_t> order_;         // the vehicles, from the greatest x on at the first call
  std::vector<int> on_slot_, slot_begin_;  // rows in the order of the slots of their elements
  std::vector<train::ContactCompliance> compliances_;
  std::vector<Response> responses_;
  int band_ = 0;
  bool has_weak_ = false;  // weak couplings are outside the band, not negligible
  Eigen::MatrixXd A_;      // entry (i, j) is at (band + i - j, j)
  train::RowTangent D_;    // the tangent in lu_
  solve::BandLu lu_;
  bool factored_ = false;
  Eigen::VectorXd reference_, delta_, change_, step_, deviation_, right_;
  Eigen::VectorXd beam_;  // displacement of the beam along the rows
};

}  // namespace traverse::coupling
