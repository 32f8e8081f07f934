#include "traverse/coupling/contact_newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace traverse::coupling {
namespace {

constexpr int most_iterations = 40;
constexpr int small_vehicle = 24;    // degrees of freedom up to which its Newton matrix is taken as full
constexpr double tolerance = 1e-13;  // of the weight: what is left in forces after the last step
constexpr double best_ratio = 1e-3;
constexpr double rounding = 1e-9;  // of the weight: below this a change that stays is taken as rounding

// Tangent of the forces (normal, tangential) with respect to displacements along the contact's two directions,
// when rates are shift times displacements.
Eigen::Matrix2d tangent(const contact::Force& f, double shift) {
  Eigen::Matrix2d D;
  D << f.normal_by_penetration + shift * f.normal_by_rate, 0.0,
      f.tangential_by_penetration + shift * f.tangential_by_rate, shift * f.tangential_by_sliding;
  return D;
}

// What the linearised law gives at the geometry's kinematics, less the force at the kinematics held: per component.
Eigen::Vector2d force_correction(const Contact& c) {
  const double a = c.touch.kinematics.penetration - c.kinematics.penetration;
  const double r = c.touch.kinematics.penetration_rate - c.kinematics.penetration_rate;
  const double s = c.touch.kinematics.sliding_speed - c.kinematics.sliding_speed;
  return {c.force.normal_by_penetration * a + c.force.normal_by_rate * r,
          c.force.tangential_by_penetration * a + c.force.tangential_by_rate * r + c.force.tangential_by_sliding * s};
}

template <class Right>
void solve_in_place(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu, Right& x) {
  x = lu.permutationP() * x;
  lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(x);
  lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace(x);
}

}  // namespace

bool ContactNewton::solve(Fleet& fleet, const StageData& s, double* x) {
  work_.resize(fleet.vehicles.size());
  p_.resize(fleet.freedom());
  pd_.resize(fleet.freedom());
  pdd_.resize(fleet.freedom());
  for (int i = 0; i < most_iterations; ++i) {
    // The vehicles' own part of the Newton matrix hardly changes within a stage: kept after the first iteration,
    // and taken in full, constraint curvature included, where that turns out not to be enough.
    const Tangent own = s.shift == 0.0 || i > 2 ? Tangent::full : i == 0 ? Tangent::fresh : Tangent::kept;
    if (!evaluate(fleet, s, x)) return false;
    for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) vehicle_system(fleet, static_cast<int>(k), s, own);
    for (const MovingVehicle& vehicle : fleet.vehicles)
      if (vehicle.state.friction.jammed) return false;
    couple_beam(fleet, s, own);
    const double before = change_;
    change_ = update(fleet, s, x);
    if (!std::isfinite(change_)) return false;
    // The next change would be smaller by about the ratio of the last two, which is not trusted beyond best_ratio
    // (at the start of a run not at all); where rounding rules it no longer falls.
    const double ratio = std::clamp(change_ / before, s.shift > 0.0 ? best_ratio : 1.0, 1.0);
    if (i > 0 &&
        (change_ <= tolerance || change_ * ratio <= tolerance || (change_ <= rounding && change_ > 0.1 * before))) {
      fleet.contact_forces();
      fleet.element_loads(s.per_node, loads_);
      return true;
    }
  }
  return false;
}

// Vehicles at p_still + x, contacts from the kinematics held, the beam under these forces, the geometry at all of it.
bool ContactNewton::evaluate(Fleet& fleet, const StageData& s, const double* x) {
  for (int i = 0; i < fleet.freedom(); ++i) {
    p_[i] = s.p_still[i] + x[i];
    pd_[i] = s.pd_still[i] + s.shift * x[i];
    pdd_[i] = s.shift2 * x[i];
  }
  if (!fleet.set(s.t, p_.data(), pd_.data())) return false;
  fleet.contact_forces();
  fleet.element_loads(s.per_node, loads_);
  beam_field(s, fleet);
  return fleet.touch(s.per_node, v_.data(), w_.data());
}

void ContactNewton::beam_field(const StageData& s, const Fleet& fleet) {
  const int m = 2 * s.per_node;
  const int count = static_cast<int>(fleet.elements().size());
  v_.assign(static_cast<std::size_t>(std::max(1, count)) * m, 0.0);
  w_.assign(v_.size(), 0.0);
  std::array<double, most_element_unknowns> z;
  for (int a = 0; a < count; ++a) {
    z.fill(0.0);
    for (int b = 0; b < count; ++b) {
      const double* f = &loads_[static_cast<std::size_t>(b) * m];
      const double* C = s.compliance->block(a, b);
      for (int j = 0; j < m; ++j)
        if (f[j] != 0.0)
          for (int i = 0; i < m; ++i) z[i] += C[i + j * m] * f[j];
    }
    for (int i = 0; i < m; ++i) {
      const std::size_t at = static_cast<std::size_t>(a) * m + i;
      v_[at] = (*s.v0)[at] + z[i];
      w_[at] = (*s.w0)[at] + s.shift * z[i];
    }
  }
}

// Contact directions times B, whose rows of a body reach into the columns given.
void ContactNewton::contact_directions(const Fleet& fleet, const VehicleWork& w,
                                       const std::vector<multibody::ColumnRange>& columns, const Eigen::MatrixXd& B,
                                       RowMatrix& G) {
  G.setZero(static_cast<Eigen::Index>(w.contact.size()), B.cols());
  for (int i = 0; i < G.rows(); ++i) {
    const Contact& c = fleet.contact(w.contact[i]);
    const auto add = [&](int body, const Eigen::Vector3d& direction) {
      const auto [first, last] = columns[body];
      G.row(i).segment(first, last - first).noalias() +=
          direction.transpose() * B.block(3 * static_cast<Eigen::Index>(body), first, 3, last - first);
    };
    const bool normal = w.component[i] == 0;
    add(c.body, normal ? c.touch.normal_on_body : c.touch.tangent_on_body);
    if (c.other_body != multibody::ground)
      add(c.other_body, normal ? c.touch.normal_on_other : c.touch.tangent_on_other);
  }
}

// One vehicle with its contacts linearised and the surface held: J dp0 = -R, and what a displacement of the beam
// along the contacts would do to dp (-Z) and to the forces (T).
void ContactNewton::vehicle_system(Fleet& fleet, int k, const StageData& s, Tangent own) {
  MovingVehicle& vehicle = fleet.vehicles[k];
  multibody::MechanismState& state = vehicle.state;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  VehicleWork& w = work_[k];
  const int f = mechanism.freedom();
  w.contact.clear();
  w.component.clear();
  for (const int i : vehicle.touching)
    for (int component = 0; component < (fleet.contact(i).law.friction > 0.0 ? 2 : 1); ++component) {
      w.contact.push_back(i);
      w.component.push_back(component);
    }
  const int rows = static_cast<int>(w.contact.size());
  contact_directions(fleet, w, state.columns, state.B, w.G);
  w.DG.setZero(rows, f);
  w.D.resize(rows, 2);
  w.correction.resize(rows);
  w.range.resize(static_cast<std::size_t>(rows));
  w.on_beam.clear();
  vehicle.Q.setZero();
  for (int i = 0; i < rows; ++i) {
    const Contact& c = fleet.contact(w.contact[i]);
    const bool normal = w.component[i] == 0;
    const multibody::ColumnRange own_range = state.columns[c.body];
    w.range[i] = own_range;
    if (c.other_body != multibody::ground) {
      const multibody::ColumnRange other = state.columns[c.other_body];
      w.range[i] = {std::min(own_range.first, other.first), std::max(own_range.last, other.last)};
    }
    const Eigen::Matrix2d D = tangent(c.force, s.shift);
    w.D.row(i) << (normal ? 0.0 : D(1, 0)), D(w.component[i], w.component[i]);
    w.DG.row(i) = w.D(i, 1) * w.G.row(i);
    if (!normal) w.DG.row(i) += w.D(i, 0) * w.G.row(i - 1);
    if (c.slot() >= 0) w.on_beam.push_back(i);
    w.correction[i] = force_correction(c)[w.component[i]];
    const double force = (normal ? c.force.normal : c.force.tangential) + w.correction[i];
    Fleet::add_load(c, normal ? force : 0.0, normal ? 0.0 : force, vehicle.Q);
  }

  const Eigen::Map<const Eigen::VectorXd> pdd(pdd_.data() + vehicle.offset, f);
  const Eigen::VectorXd& N = mechanism.mass_diagonal();
  w.r = state.d;
  state.dependent_block.expand(pdd.data(), w.r);
  w.r = N.cwiseProduct(w.r) - state.g - vehicle.Q;
  const bool rubs = mechanism.rubs();
  if (rubs) {  // whose slope changes too much to be kept
    mechanism.recover(state, vehicle.Q, pdd.data());
    mechanism.friction_projector(state, w.projector);
    for (int i = 0; i < state.friction.force.size(); ++i) w.r -= state.friction.force[i] * state.friction.A.col(i);
    own = Tangent::full;
  }
  w.R.resize(f);
  state.dependent_block.project(w.r, w.R);

  if (own != Tangent::kept) {
    const bool full = own == Tangent::full && mechanism.constraints() > 0;
    if (full && !rubs) mechanism.recover(state, vehicle.Q, pdd.data());
    mechanism.multiply_tangent(state, -1.0, -s.shift, full ? 1.0 : 0.0, w.NB);
    for (std::size_t b = 0; b < state.columns.size(); ++b) {
      const auto [first, last] = state.columns[b];
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(b);
      w.NB.block(row, first, 3, last - first) +=
          s.shift2 * N.segment<3>(row).asDiagonal() * state.B.block(row, first, 3, last - first);
    }
    w.own.resize(f, f);
    if (rubs) {
      w.own.noalias() = w.projector.transpose() * w.NB;
    } else {
      for (int j = 0; j < f; ++j) state.dependent_block.project(w.NB.col(j), w.own.col(j));
    }
  }
  w.J = w.own;
  if (rubs) {
    w.everything.assign(state.columns.size(), {0, f});
    contact_directions(fleet, w, w.everything, w.projector, w.projected);
  }
  const RowMatrix& G = rubs ? w.projected : w.G;
  for (int i = 0; i < rows; ++i) {
    const auto [first, last] = w.range[i];
    const int from = rubs ? 0 : first, width = rubs ? f : last - first;
    w.J.block(from, first, width, last - first).noalias() +=
        G.row(i).segment(from, width).transpose() * w.DG.row(i).segment(first, last - first);
  }

  // Right-hand sides: -R and, of every row on the beam, G^T D, whose solution says how dp follows the beam.
  const int on_beam = static_cast<int>(w.on_beam.size());
  w.NB.resize(f, on_beam + 1);
  w.NB.col(0) = -w.R;
  for (int j = 0; j < on_beam; ++j) {
    const int i = w.on_beam[j];
    w.NB.col(j + 1) = w.D(i, 1) * G.row(i).transpose();
    if (tangential_behind(w, i)) w.NB.col(j + 1) += w.D(i + 1, 0) * G.row(i + 1).transpose();
  }
  solve_vehicle(w, s.shift2 == 0.0);
  w.dp = w.NB.col(0);
  w.Z = w.NB.rightCols(on_beam);
  w.f_hat.resize(rows);
  w.T.resize(rows, on_beam);
  for (int i = 0; i < rows; ++i) {
    const auto [first, last] = w.range[i];
    const auto row = w.DG.row(i).segment(first, last - first);
    w.f_hat[i] = w.correction[i] + row.dot(w.dp.segment(first, last - first));
    w.T.row(i).noalias() = -row * w.Z.middleRows(first, last - first);
  }
  for (int j = 0; j < on_beam; ++j) {
    const int i = w.on_beam[j];
    w.T(i, j) += w.D(i, 1);
    if (tangential_behind(w, i)) w.T(i + 1, j) += w.D(i + 1, 0);
  }
}

bool ContactNewton::tangential_behind(const VehicleWork& w, int row) {
  return static_cast<std::size_t>(row) + 1 < w.component.size() && w.component[row + 1] == 1;
}

// J X = NB in place.
void ContactNewton::solve_vehicle(VehicleWork& w, bool singular) {
  const int f = static_cast<int>(w.J.rows());
  if (f == 0) return;
  if (singular) {  // statics may have neutral coordinates
    w.NB = w.J.completeOrthogonalDecomposition().solve(w.NB).eval();
    return;
  }
  const int band = f > small_vehicle ? half_bandwidth(w.J) : f;
  if (3 * band < f) {
    w.band_lu.compute(w.J, band);
    w.band_lu.solve_in_place(w.NB);
  } else {
    w.lu.compute(w.J);
    solve_in_place(w.lu, w.NB);
  }
}

// Rows of the coupled system: contact components of the wheels on the beam. Their mutual compliance W is a Newton
// matrix's, and kept as the vehicles' own parts are, unless a wheel has gone over to another element.
bool ContactNewton::list_rows(const Fleet& fleet) {
  previous_rows_.swap(rows_);
  rows_.clear();
  for (std::size_t k = 0; k < work_.size(); ++k)
    for (std::size_t j = 0; j < work_[k].on_beam.size(); ++j) {
      const int i = work_[k].on_beam[j];
      rows_.push_back({static_cast<int>(k), i, static_cast<int>(j), fleet.contact(work_[k].contact[i]).slot()});
    }
  return rows_ != previous_rows_;
}

void ContactNewton::mutual_compliance(const Fleet& fleet, const StageData& s) {
  const int n = static_cast<int>(rows_.size());
  const int m = 2 * s.per_node;
  auto direction_of = [&](const Row& row) {
    const Touch& touch = fleet.contact(work_[row.vehicle].contact[row.index]).touch;
    return (work_[row.vehicle].component[row.index] == 0 ? touch.normal_on_beam : touch.tangent_on_beam).data();
  };
  W_.resize(n, n);
  for (int b = 0; b < n; ++b) {
    const double* from = direction_of(rows_[b]);
    for (int a = 0; a < n; ++a) {
      const double* to = direction_of(rows_[a]);
      const double* C = s.compliance->block(rows_[a].slot, rows_[b].slot);
      double sum = 0.0;
      for (int j = 0; j < m; ++j)
        for (int i = 0; i < m; ++i) sum += to[i] * C[i + j * m] * from[j];
      W_(a, b) = sum;
    }
  }
}

// The beam answers the change of force: (I + W T) du = -W f_hat along the directions of the wheels on the beam.
void ContactNewton::couple_beam(const Fleet& fleet, const StageData& s, Tangent own) {
  const bool moved = list_rows(fleet);
  const int n = static_cast<int>(rows_.size());
  du_.setZero(n);
  if (n == 0) return;
  if (moved || own != Tangent::kept) mutual_compliance(fleet, s);
  coupled_.setIdentity(n, n);
  du_.setZero(n);
  for (int b = 0; b < n; ++b) {
    const VehicleWork& w = work_[rows_[b].vehicle];
    du_ -= W_.col(b) * w.f_hat[rows_[b].index];
    for (int c = 0; c < n; ++c)
      if (rows_[c].vehicle == rows_[b].vehicle) coupled_.col(c) += W_.col(b) * w.T(rows_[b].index, rows_[c].column);
  }
  lu_.compute(coupled_);
  solve_in_place(lu_, du_);
}

// Applies the step to x and to the contact kinematics. Returns the largest residual or change of force over the
// train's weight.
double ContactNewton::update(Fleet& fleet, const StageData& s, double* x) {
  double change = 0.0;
  int row = 0;
  for (std::size_t k = 0; k < work_.size(); ++k) {
    VehicleWork& w = work_[k];
    const MovingVehicle& vehicle = fleet.vehicles[k];
    const int rows = static_cast<int>(w.contact.size());
    if (w.R.size() > 0) change = std::max(change, w.R.lpNorm<Eigen::Infinity>() / vehicle.scale);
    const int on_beam = static_cast<int>(w.on_beam.size());
    const auto beam = du_.segment(row, on_beam);  // its displacement along the rows on it
    row += on_beam;
    w.f_hat.noalias() += w.T * beam;
    w.dp.noalias() -= w.Z * beam;
    for (int i = 0; i < rows; ++i) {
      const auto [first, last] = w.range[i];
      w.correction[i] = w.G.row(i).segment(first, last - first).dot(w.dp.segment(first, last - first));
    }
    for (int j = 0; j < on_beam; ++j) w.correction[w.on_beam[j]] += beam[j];
    for (int i = 0; i < rows; ++i) {
      Contact& c = fleet.contact(w.contact[i]);
      change = std::max(change, std::abs(w.f_hat[i]) / vehicle.scale);
      if (w.component[i] == 0) {
        c.kinematics.penetration = c.touch.kinematics.penetration + w.correction[i];
        c.kinematics.penetration_rate = c.touch.kinematics.penetration_rate + s.shift * w.correction[i];
        c.kinematics.sliding_speed = c.touch.kinematics.sliding_speed;
      } else {
        c.kinematics.sliding_speed = c.touch.kinematics.sliding_speed + s.shift * w.correction[i];
      }
    }
    for (int i = 0; i < w.dp.size(); ++i) x[vehicle.offset + i] += w.dp[i];
  }
  return change;
}

}  // namespace traverse::coupling
