// The choice of independent coordinates by full pivoting, and the checks of dropped rows.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "multibody/mechanism.hpp"
#include "sparse_ldl.hpp"
#include "traverse/base/error.hpp"

namespace traverse::multibody {

namespace {

constexpr double rank_tolerance = 1e-8;  // scaled pivots below this value are due to rounding or inaccurate geometry
constexpr double tie = 1e-9;  // pivots closer than this are equal, so that the choice is independent of rounding
constexpr double nearly_singular = 1e-2;     // smallest scaled pivot of a new choice
constexpr double poor_quality = 0.05;        // least quality of a partition, relative to its quality when it was chosen
constexpr double position_tolerance = 1e-6;  // relative to the mechanism's size
constexpr double rate_tolerance = 1e-6;      // relative to the terms that should cancel
constexpr double rate_floor = 1e-9;          // relative to the mechanism's size, per s or s2: smaller rates are zero
constexpr double repeat_distance =
    1e-3;                       // relative to the mechanism's size: after a larger motion the choice is repeated
constexpr double probe = 1e-3;  // displacement that detects a dead point, relative to the mechanism's size
constexpr double probe_tolerance = 1e-9;  // relative to the mechanism's size

/// Gaussian elimination with full pivoting on a scaled copy of Phi_q.
class FullPivoting {
 public:
  explicit FullPivoting(const Eigen::MatrixXd& scaled) : column_used_(scaled.cols(), false) { A_.assign(scaled); }

  /// Eliminates with the rows in [from, to) while there is a pivot.
  void eliminate(int from, int to) {
    int row, column;
    while (find(from, to, row, column)) {
      column_used_[column] = true;
      row_used_.push_back(row);
      A_.eliminate(row, column);
    }
  }

  double least_pivot() const { return least_pivot_; }

  Partition partition() const {
    Partition p;
    p.rows = row_used_;
    std::sort(p.rows.begin(), p.rows.end());
    for (int j = 0; j < A_.columns(); ++j) (column_used_[j] ? p.dependent : p.independent).push_back(j);
    return p;
  }

 private:
  /// Finds the largest pivot. Of equal pivots the one in the last column and the first row is chosen, so that the
  /// coordinates of a body listed first remain independent.
  bool find(int from, int to, int& row, int& column) {
    double best = 0.0;
    for (int i = from; i < to; ++i) {
      if (!A_.active(i)) continue;
      for (const ActiveRows::Entry& e : A_.row(i)) best = std::max(best, std::abs(e.value));
    }
    if (!(best > rank_tolerance)) return false;
    column = -1;
    for (int i = from; i < to; ++i) {
      if (!A_.active(i)) continue;
      for (const ActiveRows::Entry& e : A_.row(i)) {
        if (e.column <= column || std::abs(e.value) * (1.0 + tie) < best) continue;
        column = e.column;
        row = i;
      }
    }
    least_pivot_ = std::min(least_pivot_, best);
    return true;
  }

  ActiveRows A_;
  std::vector<int> row_used_;
  std::vector<bool> column_used_;
  double least_pivot_ = 1.0;
};

std::string number(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

}  // namespace

Mechanism::Choice Mechanism::pivot(const MechanismState& s) const {
  FullPivoting elimination(scaling_.row.asDiagonal() * s.Phi_q * scaling_.column.asDiagonal());
  elimination.eliminate(joint_row_count_, constraints());  // drivers are kept before joints
  elimination.eliminate(0, joint_row_count_);
  return {elimination.partition(), elimination.least_pivot()};
}

std::vector<std::string> Mechanism::choose_partition(MechanismState& s, double t) {
  assemble(s, t);
  check_dropped_positions(s);
  fit_velocities(s);
  const std::vector<int> dropped = dropped_rows();
  if (!dropped.empty()) {
    check_dropped_rates(s);
    check_dead_point(s);
    check_dropped_accelerations(s);
    check_dropped_friction();
  }
  std::vector<std::string> names;
  for (const int row : dropped) {
    const std::string& name = part_name(row);  // the rows of a part are consecutive
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  chosen_quality_ = partition_quality(s);
  return names;
}

bool Mechanism::badly_conditioned(MechanismState& s) const {
  if (partition_.rows.empty() || !s.velocities_set) return false;
  return s.dependent_block.nearly_singular() || partition_quality(s) < poor_quality * chosen_quality_;
}

bool Mechanism::renew_partition(MechanismState& s) {
  if (!badly_conditioned(s)) return false;
  compute_Phi_q(s);
  const Choice choice = pivot(s);
  const bool singular = choice.partition.rows.size() < partition_.rows.size() || choice.least_pivot < nearly_singular;
  if (singular || choice.partition.independent == partition_.independent) return false;
  adopt_partition(s, choice.partition);
  return true;
}

void Mechanism::adopt_partition(MechanismState& s, const Partition& partition) {
  if (partition.independent == partition_.independent) return;
  partition_ = partition;
  ++partition_version_;
  prepare_workspaces(s);
  Eigen::VectorXd pd(freedom());
  for (int k = 0; k < freedom(); ++k) pd[k] = s.qd[partition_.independent[k]];
  set_velocities(s, s.time, pd.data());
  chosen_quality_ = partition_quality(s);
}

/// Chooses the partition and solves the constraints; repeats this if the bodies move far.
void Mechanism::assemble(MechanismState& s, double t) {
  for (int pass = 0; pass < 4; ++pass) {
    place_frames(s);
    compute_Phi_q(s);
    partition_ = pivot(s).partition;
    ++partition_version_;
    prepare_workspaces(s);
    s.factored = s.factors_current = false;
    const Eigen::VectorXd start = s.q;
    if (!solve_dependent(s, t)) {
      throw InputError("vehicle '" + model_.name + "' cannot be put together at t = " + number(t) +
                       " s: " + worst_row(s) + "; check positions and drivers");
    }
    const double moved = (s.q - start).cwiseQuotient(scaling_.column).cwiseAbs().maxCoeff();
    if (moved <= repeat_distance * length_) return;
  }
}

std::string Mechanism::worst_row(const MechanismState& s) const {
  int worst = 0;
  for (int row = 0; row < constraints(); ++row)
    if (std::abs(s.Phi[row]) * scaling_.row[row] > std::abs(s.Phi[worst]) * scaling_.row[worst]) worst = row;
  return row_name(worst) + " is off by " + number(s.Phi[worst]) + " " + row_unit(worst);
}

/// Sets velocities that satisfy the constraints: the given velocities, or the nearest velocities in the metric of the
/// masses, as after an impact of the joints.
void Mechanism::fit_velocities(MechanismState& s) const {
  const Eigen::VectorXd wanted = s.qd;
  Eigen::VectorXd pd(freedom());
  for (int k = 0; k < freedom(); ++k) pd[k] = wanted[partition_.independent[k]];
  set_velocities(s, s.time, pd.data());
  const Eigen::VectorXd error = wanted - s.qd;
  if (error.cwiseAbs().maxCoeff() <= 1e-9 * wanted.cwiseAbs().maxCoeff()) return;
  factor_mass(s);
  s.dependent_block.project(mass_.cwiseProduct(error), s.reduced);
  solve_mass(s);
  pd += s.reduced;
  set_velocities(s, s.time, pd.data());
}

std::vector<int> Mechanism::dropped_rows() const {
  std::vector<int> dropped;
  for (int row = 0; row < constraints(); ++row)
    if (!std::binary_search(partition_.rows.begin(), partition_.rows.end(), row)) dropped.push_back(row);
  return dropped;
}

/// A message such as "vehicle 'x': driver 'b' contradicts driver 'a'": a dropped row and the kept rows that it depends
/// on.
std::string Mechanism::conflict(MechanismState& s, int row, const std::string& verb) const {
  factor(s);
  Eigen::VectorXd share = Eigen::VectorXd::Zero(constraints());
  s.dependent_block.solve_transposed(s.Phi_q.row(row).transpose(), share);
  std::string others;
  std::string last = row_name(row);  // the rows of a part are consecutive
  for (const int kept : partition_.rows) {
    const bool shares = std::abs(share[kept]) * scaling_.row[row] / scaling_.row[kept] > 1e-6;
    if (!shares || row_name(kept) == last || row_name(kept) == row_name(row)) continue;
    last = row_name(kept);
    others += (others.empty() ? "" : ", ") + last;
  }
  return "vehicle '" + model_.name + "': " + row_name(row) + " " + verb + " " + (others.empty() ? "itself" : others);
}

void Mechanism::check_dropped_positions(MechanismState& s) const {
  for (const int row : dropped_rows()) {
    if (std::abs(s.Phi[row]) * scaling_.row[row] <= position_tolerance * length_) continue;
    throw InputError(conflict(s, row, "contradicts") + ": with these met it is off by " + number(s.Phi[row]) + " " +
                     row_unit(row) + " at t = " + number(s.time) + " s");
  }
}

void Mechanism::check_dropped_rates(MechanismState& s) const {
  for (const int row : dropped_rows()) {
    const double error = s.Phi_q.row(row).dot(s.b) + s.Phi_t[row];
    const double terms = s.Phi_q.row(row).cwiseAbs().dot(s.b.cwiseAbs()) + std::abs(s.Phi_t[row]);
    if (std::abs(error) <= rate_tolerance * terms + rate_floor * length_ / scaling_.row[row]) continue;
    throw InputError(conflict(s, row, "contradicts") + ": their speeds differ by " + number(error) + " " +
                     row_unit(row) + "/s at t = " + number(s.time) + " s");
  }
}

void Mechanism::check_dropped_accelerations(MechanismState& s) const {
  for (const int row : dropped_rows()) {
    const double error = s.Phi_q.row(row).dot(s.d) - s.gamma[row];
    const double terms = s.Phi_q.row(row).cwiseAbs().dot(s.d.cwiseAbs()) + std::abs(s.gamma[row]);
    if (std::abs(error) <= rate_tolerance * terms + rate_floor * length_ / scaling_.row[row]) continue;
    throw InputError(conflict(s, row, "contradicts") + ": their accelerations differ by " + number(error) + " " +
                     row_unit(row) + "/s2 at t = " + number(s.time) + " s");
  }
}

/// A normal force that other joints can carry too is not determined; therefore its friction is not determined.
void Mechanism::check_dropped_friction() const {
  const std::vector<int> dropped = dropped_rows();
  for (const int j : friction_joints_) {
    if (joints_[j].friction.coefficient == 0.0) continue;
    if (std::binary_search(dropped.begin(), dropped.end(), joints_[j].row))
      throw InputError("vehicle '" + model_.name + "', joint '" + model_.joints[j].name +
                       "': other joints guide the same motion, so its normal force is not determined and friction "
                       "cannot follow from it; give friction_force instead, or leave the other joints out");
  }
}

/// Detects a dead point. There rows depend on other rows; after a small displacement they are independent.
void Mechanism::check_dead_point(MechanismState& s) const {
  const Eigen::VectorXd q = s.q;
  const Eigen::VectorXd Phi = s.Phi;
  Eigen::VectorXd pd(freedom());
  for (int k = 0; k < freedom(); ++k) {
    const int i = partition_.independent[k];
    pd[k] = s.qd[i];
    s.q[i] += probe * length_ * scaling_.column[i] * std::cos(1.0 + k);
  }
  const bool solved = solve_dependent(s, s.time);
  const Eigen::VectorXd change = (s.Phi - Phi).cwiseProduct(scaling_.row).cwiseAbs();
  s.q = q;
  place_frames(s);
  compute_Phi(s);
  set_velocities(s, s.time, pd.data());
  for (const int row : dropped_rows()) {
    if (solved && change[row] <= probe_tolerance * length_) continue;
    throw InputError(conflict(s, row, "at a dead point follows from") + ": start from another position");
  }
}

}  // namespace traverse::multibody
