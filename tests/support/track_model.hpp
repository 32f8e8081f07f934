// A layered track over a simply supported bridge, assembled without code of the program: the energies of Hermite
// elements are added to dense matrices, and Newmark's average acceleration method includes sleepers over one-sided
// gaps.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace traverse::test {

/// One station of the grid of sleepers, for the computation by hand.
struct DenseSleeper {
  double x = 0.0;
  double pad_k = 0.0, pad_c = 0.0, mass = 0.0, k = 0.0, c = 0.0, ballast_mass = 0.0, sub_k = 0.0, sub_c = 0.0;
  double gap = 0.0;
  bool there = true;
};

struct DenseTrack {
  double rail_EI = 0.0, rail_mass = 0.0, rail_start = 0.0, rail_element = 0.0;
  int rail_elements = 0;
  double EI = 0.0, mass = 0.0, length = 0.0;  // properties of the bridge, which begins at x = 0
  int elements = 0;
  std::vector<DenseSleeper> sleepers;
  double shear_k = 0.0, shear_c = 0.0;
  bool own_mass = false;
  std::function<double(double)> rail_EI_at = {};
};

/// A one-sided spring and damper over a gap: the displacement d is the sum of shape*unknown.
struct DenseGap {
  Eigen::VectorXd shape;
  double k = 0.0, c = 0.0, gap = 0.0;
};

class DenseTrackModel {
 public:
  explicit DenseTrackModel(const DenseTrack& t) : t_(t) {
    bridge_ = 2 * (t.rail_elements + 1);
    first_sleeper_ = bridge_ + 2 * (t.elements + 1);
    first_ballast_ = first_sleeper_ + static_cast<int>(t.sleepers.size());
    n_ = first_ballast_ + static_cast<int>(t.sleepers.size());
    for (Eigen::MatrixXd* A : {&M, &C, &K}) A->setZero(n_, n_);
    free_.assign(static_cast<std::size_t>(n_), 1);
    for (int e = 0; e < t.rail_elements; ++e) {
      const double middle = t.rail_start + (e + 0.5) * t.rail_element;
      add_element(2 * e, t.rail_element, t.rail_EI_at ? t.rail_EI_at(middle) : t.rail_EI, t.rail_mass);
    }
    for (int e = 0; e < t.elements; ++e) add_element(bridge_ + 2 * e, t.length / t.elements, t.EI, t.mass);
    free_[static_cast<std::size_t>(bridge_)] = free_[static_cast<std::size_t>(bridge_ + 2 * t.elements)] = 0;
    for (std::size_t i = 0; i < t.sleepers.size(); ++i) add_sleeper(static_cast<int>(i));
    for (std::size_t i = 0; i + 1 < t.sleepers.size(); ++i) {
      const bool left = on_bridge(t.sleepers[i].x), right = on_bridge(t.sleepers[i + 1].x);
      if ((left || right) && !t.own_mass) continue;
      const Eigen::VectorXd d = unit(ballast(static_cast<int>(i) + 1)) - unit(ballast(static_cast<int>(i)));
      add_spring(d, t.shear_k, t.shear_c);
    }
    for (int i = 0; i < n_; ++i)
      if (M(i, i) == 0.0) free_[static_cast<std::size_t>(i)] = 0;
    for (int i = 0; i < n_; ++i) {
      if (free_[static_cast<std::size_t>(i)] != 0) continue;
      for (Eigen::MatrixXd* A : {&M, &C, &K}) {
        A->row(i).setZero();
        A->col(i).setZero();
      }
      M(i, i) = K(i, i) = 1.0;
    }
    for (DenseGap& gap : gaps)
      for (int i = 0; i < n_; ++i)
        if (free_[static_cast<std::size_t>(i)] == 0) gap.shape[i] = 0.0;
  }

  Eigen::MatrixXd M, C, K;
  std::vector<DenseGap> gaps;

  int size() const { return n_; }
  int rail(int node) const { return 2 * node; }
  int sleeper(int i) const { return first_sleeper_ + i; }
  int ballast(int i) const { return first_ballast_ + i; }
  /// Nodal forces of a unit force downward on the rail.
  Eigen::VectorXd force_at(double x) const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(n_);
    const double s = (x - t_.rail_start) / t_.rail_element;
    if (s < 0.0 || s >= t_.rail_elements) return f;
    const int e = static_cast<int>(s);
    const auto psi = hermite_values(s - e, t_.rail_element);
    for (int i = 0; i < 4; ++i) f[2 * e + i] -= psi[static_cast<std::size_t>(i)];
    return f;
  }
  /// Deflection of the bridge as a sum over the unknowns.
  Eigen::VectorXd bridge_at(double x) const {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n_);
    const double h = t_.length / t_.elements;
    const int e = std::clamp(static_cast<int>(x / h + 1e-9), 0, t_.elements - 1);
    const auto psi = hermite_values(x / h - e, h);
    for (int i = 0; i < 4; ++i) d[bridge_ + 2 * e + i] += psi[static_cast<std::size_t>(i)];
    return d;
  }

 private:
  static std::array<double, 4> hermite_values(double s, double h) {
    return {1 - 3 * s * s + 2 * s * s * s, h * s * (1 - s) * (1 - s), 3 * s * s - 2 * s * s * s, h * s * s * (s - 1)};
  }
  Eigen::VectorXd unit(int i) const { return Eigen::VectorXd::Unit(n_, i); }
  bool on_bridge(double x) const { return x >= -1e-9 && x <= t_.length + 1e-9; }

  void add_element(int first, double h, double EI, double mass) {
    Eigen::Matrix4d k, m;
    k << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h, -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h, -6 * h,
        4 * h * h;
    m << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h, 54, 13 * h, 156, -22 * h, -13 * h, -3 * h * h,
        -22 * h, 4 * h * h;
    K.block<4, 4>(first, first) += EI / (h * h * h) * k;
    M.block<4, 4>(first, first) += mass * h / 420 * m;
  }
  void add_spring(const Eigen::VectorXd& d, double k, double c) {
    K += k * d * d.transpose();
    C += c * d * d.transpose();
  }
  void add_sleeper(int i) {
    const DenseSleeper& s = t_.sleepers[static_cast<std::size_t>(i)];
    const int node = static_cast<int>(std::lround((s.x - t_.rail_start) / t_.rail_element));
    const bool rides = on_bridge(s.x) && !t_.own_mass;
    const Eigen::VectorXd below = rides ? bridge_at(s.x) : unit(ballast(i));
    M += s.ballast_mass * below * below.transpose();
    if (!rides) add_spring(on_bridge(s.x) ? unit(ballast(i)) - bridge_at(s.x) : unit(ballast(i)), s.sub_k, s.sub_c);
    if (!s.there) return;
    M(sleeper(i), sleeper(i)) += s.mass;
    add_spring(unit(rail(node)) - unit(sleeper(i)), s.pad_k, s.pad_c);
    const Eigen::VectorXd d = unit(sleeper(i)) - below;
    if (s.gap > 0.0)
      gaps.push_back({d, s.k, s.c, s.gap});
    else
      add_spring(d, s.k, s.c);
  }

  DenseTrack t_;
  int bridge_ = 0, first_sleeper_ = 0, first_ballast_ = 0, n_ = 0;
  std::vector<char> free_;
};

/// Newmark's average acceleration method for M a + C w + K v = P + gaps, from given v without velocity.
class DenseNewmark {
 public:
  DenseNewmark(Eigen::MatrixXd M, Eigen::MatrixXd C, Eigen::MatrixXd K, std::vector<DenseGap> gaps, double h)
      : M_(std::move(M)), C_(std::move(C)), K_(std::move(K)), gaps_(std::move(gaps)), h_(h) {
    solver_.compute(4.0 / (h * h) * M_ + 2.0 / h * C_ + K_);
    const auto m = static_cast<Eigen::Index>(gaps_.size());
    N_.resize(M_.rows(), m);
    for (Eigen::Index j = 0; j < m; ++j) N_.col(j) = gaps_[static_cast<std::size_t>(j)].shape;
    if (m > 0) W_ = N_.transpose() * solver_.solve(N_);
    force = Eigen::VectorXd::Zero(m);
  }
  void start(const Eigen::VectorXd& v0, const Eigen::VectorXd& P) {
    v = v0;
    w = Eigen::VectorXd::Zero(v.size());
    a = M_.llt().solve(P - K_ * v);
  }
  void step(const Eigen::VectorXd& P) {
    const Eigen::VectorXd of_mass = 4.0 / (h_ * h_) * v + 4.0 / h_ * w + a, of_damping = 2.0 / h_ * v + w;
    Eigen::VectorXd next = solver_.solve(P + M_ * of_mass + C_ * of_damping);
    if (!gaps_.empty()) {
      const Eigen::VectorXd d0 = N_.transpose() * next, back = N_.transpose() * of_damping;
      // With few gaps, each force is computed with the others held, until all are consistent.
      for (int i = 0; i < 10000; ++i) {
        double change = 0.0;
        for (Eigen::Index j = 0; j < force.size(); ++j) {
          const double old = force[j], own = W_(j, j), others = d0[j] + W_.row(j).dot(force) - own * old;
          const DenseGap& g = gaps_[static_cast<std::size_t>(j)];
          // In compression d = others + own F and F = -(k (d + gap) + c d'), d' = 2/h d - back.
          const double F =
              (-g.k * (others + g.gap) - g.c * (2.0 / h_ * others - back[j])) / (1.0 + (g.k + 2.0 / h_ * g.c) * own);
          force[j] = F > 0.0 && others + own * F < -g.gap ? F : 0.0;
          change = std::max(change, std::abs(force[j] - old));
        }
        if (change < 1e-9) break;
      }
      next += solver_.solve(N_ * force);
    }
    const Eigen::VectorXd rate = 2.0 / h_ * (next - v) - w;
    a = 4.0 / (h_ * h_) * (next - v) - 4.0 / h_ * w - a;
    v = next;
    w = rate;
  }

  Eigen::VectorXd v, w, a, force;  // force: forces of the gaps

 private:
  Eigen::MatrixXd M_, C_, K_, N_, W_;
  std::vector<DenseGap> gaps_;
  double h_;
  Eigen::LLT<Eigen::MatrixXd> solver_;
};

}  // namespace traverse::test
