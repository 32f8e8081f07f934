// Rail and bridge along the track, assembled without code of the program: the energies of bars and Hermite elements are
// added to sparse matrices. The states of sliding sleepers (held, sliding in one of both directions) are changed until
// they are consistent.
#pragma once

#include <Eigen/Sparse>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace traverse::test {

struct HandRail {
  double rail_EA = 0.0, rail_EI = 0.0, rail_strain = 0.0;  // N, N m2; strain of its temperature
  double start = 0.0, element = 0.0;                       // m
  int elements = 0, each = 1;                              // number of rail elements in all; between two sleepers
  int device = -1;                                         // a node of the rail where u may jump; below 0: none
  double EA = 0.0, EI = 0.0, strain = 0.0, length = 0.0;   // properties of the deck, which begins at x = 0
  int deck = 0;                                            // elements
  double height = 0.0;                                     // height of the running surface, m
  double bearing_k = 0.0, bearing_depth = 0.0;             // N/m, m: at x = 0
  double pad_k = 0.0;                                      // N/m
  double k = 0.0, limit = 0.0, loaded_k = 0.0, loaded_limit = 0.0;
  double rail_mass = 0.0, mass = 0.0, pad_c = 0.0, c = 0.0;  // kg/m, kg/m, N s/m, N s/m: only for the motion in time
};

/// Loads with the same meaning as in rail::Loads.
struct HandLoads {
  bool strains = false;
  double from = 0.0, to = 0.0, weight = 0.0, along_from = 0.0, along_to = 0.0, along = 0.0;
};

struct HandState {
  Eigen::VectorXd v;
  std::vector<double> force, displacement;  // forces and displacements of sleepers along x
  std::vector<double> stretch;              // EA u' of each rail element, N
  double bearing = 0.0;                     // force on the bridge, N
  double opening = 0.0;                     // opening of the device, m
};

/// A motion at an instant, with the slip history of the sleepers.
struct HandMotion {
  Eigen::VectorXd v, w, a;
  HandState settled;
};

class HandRailModel {
 public:
  explicit HandRailModel(const HandRail& t)
      : t_(t), n_(3 * (t.elements + 1) + 3 * (t.deck + 1) + (t.device < 0 ? 0 : 1)) {
    for (int e = 0; e < t.elements; ++e) {
      add_bar_and_beam(left_u(e), 3 * e, t.element, t.rail_EA, t.rail_EI);
      add_mass(left_u(e), 3 * e, t.element, t.rail_mass);
    }
    for (int e = 0; e < t.deck; ++e) {
      add_bar_and_beam(deck(e), deck(e), t.length / t.deck, t.EA, t.EI);
      add_mass(deck(e), deck(e), t.length / t.deck, t.mass);
    }
    for (int i = 0; i <= t.elements; i += t.each) {
      const double x = t.start + i * t.element;
      Terms down{{3 * i + 1, 1.0}}, along{{3 * i, 1.0}};
      if (x > -1e-9 && x < t.length + 1e-9) add_deck(x, down, along);
      add_energy(down, t.pad_k);
      add_energy(down, t.pad_c, dampers_);
      add_energy(along, t.c, dampers_);
      sleepers_.push_back({x, along});
    }
    add_energy({{deck(0), 1.0}, {deck(0) + 2, t.bearing_depth}}, t.bearing_k);
    held_ = {0, 3 * t.elements, deck(0) + 1, deck(t.deck) + 1};
  }

  /// The static state: the rail's ends are held along x, the deck is on two supports. before: the previous state; null:
  /// the track is free of forces.
  HandState rest(const HandLoads& loads, const HandState* before = nullptr) const {
    const std::size_t count = sleepers_.size();
    std::vector<int> slides(count, 0);
    for (int round = 0; round < 200; ++round) {
      HandState state = solve(loads, before, slides);
      bool agree = true;
      for (std::size_t i = 0; i < count; ++i) {
        const auto [k, limit, then, at] = law(i, loads, before);
        const double trial = then - k * (state.displacement[i] - at);
        const int wanted = std::abs(trial) <= limit * (1.0 + 1e-12) ? 0 : trial > 0.0 ? 1 : -1;
        agree = agree && wanted == slides[i];
        slides[i] = wanted;
      }
      if (agree) return state;
    }
    return {};
  }

  /// The static state under downward forces on the rail, before anything slides along x.
  HandMotion at_rest(const std::vector<std::pair<double, double>>& forces) const {
    HandMotion m;
    m.settled.force.assign(sleepers_.size(), 0.0);
    m.settled.displacement.assign(sleepers_.size(), 0.0);
    auto entries = entries_;
    for (const Sleeper& s : sleepers_) add_energy(s.along, t_.k, entries);
    m.v = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix(entries, true)).solve(on_rail(forces));
    m.w = m.a = Eigen::VectorXd::Zero(n_);
    update_slip(m, {}, std::vector<int>(sleepers_.size(), 0));
    return m;
  }

  /// One step h of Newmark's average acceleration method. `forces`: forces at its end; loads.from and loads.to: ends of
  /// the range in which sleepers are loaded.
  void step(HandMotion& m, const std::vector<std::pair<double, double>>& forces, const HandLoads& loads, double h) {
    const Eigen::SparseMatrix<double> M = matrix(masses_, false), C = matrix(dampers_, false);
    const Eigen::VectorXd rhs =
        on_rail(forces) + M * (4.0 / (h * h) * m.v + 4.0 / h * m.w + m.a) + C * (2.0 / h * m.v + m.w);
    std::vector<int> slides(sleepers_.size(), 0);
    HandMotion next = m;
    for (int round = 0; round < 100; ++round) {
      auto entries = entries_;
      Eigen::VectorXd P = rhs;
      for (const auto& e : masses_) entries.emplace_back(e.row(), e.col(), 4.0 / (h * h) * e.value());
      for (const auto& e : dampers_) entries.emplace_back(e.row(), e.col(), 2.0 / h * e.value());
      for (std::size_t i = 0; i < sleepers_.size(); ++i) {
        const auto [k, limit, then, at] = law(i, loads, &m.settled);
        for (const auto& [a, x] : sleepers_[i].along) P[a] += x * (slides[i] == 0 ? then + k * at : slides[i] * limit);
        if (slides[i] == 0) add_energy(sleepers_[i].along, k, entries);
      }
      next.v = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix(entries, true)).solve(P);
      bool agree = true;
      for (std::size_t i = 0; i < sleepers_.size(); ++i) {
        const auto [k, limit, then, at] = law(i, loads, &m.settled);
        const double trial = then - k * (along(i, next.v) - at);
        const int wanted = std::abs(trial) <= limit ? 0 : trial > 0.0 ? 1 : -1;
        agree = agree && wanted == slides[i];
        slides[i] = wanted;
      }
      if (agree) break;
    }
    next.w = 2.0 / h * (next.v - m.v) - m.w;
    next.a = 4.0 / (h * h) * (next.v - m.v) - 4.0 / h * m.w - m.a;
    m.v = next.v;
    m.w = next.w;
    m.a = next.a;
    update_slip(m, loads, slides);
  }
  double opening(const Eigen::VectorXd& v) const { return t_.device < 0 ? 0.0 : v[n_ - 1] - v[3 * t_.device]; }
  double rail_u(const HandMotion& m, int node) const { return m.v[3 * node]; }
  double deck_u(const HandMotion& m, int node) const { return m.v[deck(node)]; }
  double deck_v(const HandMotion& m, int node) const { return m.v[deck(node) + 1]; }

 private:
  using Terms = std::vector<std::pair<int, double>>;
  struct Sleeper {
    double x = 0.0;
    Terms along;
  };
  struct Law {
    double k, limit, then, at;
  };

  int deck(int node) const { return 3 * (t_.elements + 1) + 3 * node; }
  /// The unknown along x at the left end of a rail element; behind the device it is a separate unknown.
  int left_u(int element) const { return element == t_.device ? n_ - 1 : 3 * element; }
  using Entries = std::vector<Eigen::Triplet<double>>;
  static void add_energy(const Terms& d, double k, Entries& to) {
    for (const auto& [i, a] : d)
      for (const auto& [j, b] : d) to.emplace_back(i, j, k * a * b);
  }
  void add_energy(const Terms& d, double k) { add_energy(d, k, entries_); }
  /// Kinetic energy by Gauss's rule of four points, which is exact.
  void add_mass(int u, int first, double h, double mass) {
    const double near = 0.3399810435848563, far = 0.8611363115940526;
    for (const auto& [at, weight] : {std::pair{-far, 0.3478548451374538},
                                     {-near, 0.6521451548625461},
                                     {near, 0.6521451548625461},
                                     {far, 0.3478548451374538}}) {
      const double s = 0.5 * (1.0 + at), m = 0.5 * weight * mass * h;
      add_energy({{u, 1 - s}, {first + 3, s}}, m, masses_);
      const auto psi = hermite_at(s, h);
      add_energy({{first + 1, psi[0]}, {first + 2, psi[1]}, {first + 4, psi[2]}, {first + 5, psi[3]}}, m, masses_);
    }
  }
  static std::array<double, 4> hermite_at(double s, double h) {
    return {1 - 3 * s * s + 2 * s * s * s, h * s * (1 - s) * (1 - s), 3 * s * s - 2 * s * s * s, h * s * s * (s - 1)};
  }
  void add_bar_and_beam(int u, int first, double h, double EA, double EI) {
    add_energy({{u, -1.0}, {first + 3, 1.0}}, EA / h);
    // The elastic energy of a cubic: the mean curvature and the change of curvature.
    add_energy({{first + 2, -1.0}, {first + 5, 1.0}}, EI / h);
    add_energy({{first + 1, 2.0 / h}, {first + 4, -2.0 / h}, {first + 2, 1.0}, {first + 5, 1.0}}, 3.0 * EI / h);
  }
  /// Subtracts the deck's displacements below a sleeper: its deflection, and u - e theta.
  void add_deck(double x, Terms& down, Terms& along) const {
    const double h = t_.length / t_.deck;
    const int e = std::min(static_cast<int>(x / h + 1e-9), t_.deck - 1);
    const double s = x / h - e, e_ = t_.height;
    const std::array<double, 4> psi = hermite_at(s, h);
    const std::array<double, 4> slope = {6 * s * (s - 1) / h, 1 - 4 * s + 3 * s * s, 6 * s * (1 - s) / h,
                                         s * (3 * s - 2)};
    const std::array<int, 4> at = {deck(e) + 1, deck(e) + 2, deck(e + 1) + 1, deck(e + 1) + 2};
    for (std::size_t i = 0; i < 4; ++i) {
      down.emplace_back(at[i], -psi[i]);
      along.emplace_back(at[i], e_ * slope[i]);
    }
    along.emplace_back(deck(e), -(1 - s));
    along.emplace_back(deck(e + 1), -s);
  }
  Law law(std::size_t i, const HandLoads& loads, const HandState* before) const {
    const double x = sleepers_[i].x;
    const bool loaded = loads.to > loads.from && x >= loads.from - 1e-6 && x <= loads.to + 1e-6;
    Law law{loaded ? t_.loaded_k : t_.k, loaded ? t_.loaded_limit : t_.limit, 0.0, 0.0};
    if (before != nullptr) {
      law.then = std::clamp(before->force[i], -law.limit, law.limit);
      law.at = before->displacement[i];
    }
    return law;
  }

  Eigen::SparseMatrix<double> matrix(Entries entries, bool held) const {
    for (const int i : held_)
      if (held) entries.emplace_back(i, i, 1e25);
    Eigen::SparseMatrix<double> A(n_, n_);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
  }

  double along(std::size_t i, const Eigen::VectorXd& v) const {
    double d = 0.0;
    for (const auto& [a, x] : sleepers_[i].along) d += x * v[a];
    return d;
  }
  void update_slip(HandMotion& m, const HandLoads& loads, const std::vector<int>& slides) const {
    for (std::size_t i = 0; i < sleepers_.size(); ++i) {
      const auto [k, limit, then, at] = law(i, loads, &m.settled);
      const double d = along(i, m.v);
      m.settled.force[i] = slides[i] == 0 ? then - k * (d - at) : slides[i] * limit;
      m.settled.displacement[i] = d;
    }
  }
  Eigen::VectorXd on_rail(const std::vector<std::pair<double, double>>& forces) const {
    Eigen::VectorXd P = Eigen::VectorXd::Zero(n_);
    for (const auto& [x, force] : forces) {
      const double s = (x - t_.start) / t_.element;
      const int e = static_cast<int>(s);
      const auto psi = hermite_at(s - e, t_.element);
      for (int i = 0; i < 4; ++i) P[3 * (e + i / 2) + 1 + i % 2] -= force * psi[static_cast<std::size_t>(i)];
    }
    for (const int i : held_) P[i] = 0.0;
    return P;
  }

  HandState solve(const HandLoads& loads, const HandState* before, const std::vector<int>& slides) const {
    Eigen::VectorXd P = forces(loads);
    auto entries = entries_;
    for (std::size_t i = 0; i < sleepers_.size(); ++i) {
      const auto [k, limit, then, at] = law(i, loads, before);
      const double constant = slides[i] == 0 ? then + k * at : slides[i] * limit;
      for (const auto& [a, x] : sleepers_[i].along) {
        P[a] += x * constant;
        if (slides[i] != 0) continue;
        for (const auto& [b, y] : sleepers_[i].along) entries.emplace_back(a, b, k * x * y);
      }
    }
    const Eigen::SparseMatrix<double> K = matrix(entries, true);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(K);
    HandState state;
    state.v = solver.solve(P);
    state.v += solver.solve(P - K * state.v);
    for (std::size_t i = 0; i < sleepers_.size(); ++i) {
      const double d = along(i, state.v);
      const auto [k, limit, then, at] = law(i, loads, before);
      state.displacement.push_back(d);
      state.force.push_back(slides[i] == 0 ? then - k * (d - at) : slides[i] * limit);
    }
    for (int e = 0; e < t_.elements; ++e)
      state.stretch.push_back(t_.rail_EA * (state.v[3 * e + 3] - state.v[left_u(e)]) / t_.element);
    state.opening = opening(state.v);
    state.bearing = -t_.bearing_k * (state.v[deck(0)] + t_.bearing_depth * state.v[deck(0) + 2]);
    return state;
  }

  Eigen::VectorXd forces(const HandLoads& loads) const {
    Eigen::VectorXd P = Eigen::VectorXd::Zero(n_);
    for (int e = 0; e < t_.elements; ++e) {
      const double h = t_.element, left = t_.start + e * h;
      if (loads.strains) P[left_u(e)] -= t_.rail_EA * t_.rail_strain, P[3 * e + 3] += t_.rail_EA * t_.rail_strain;
      // Loads begin and end at nodes.
      if (left > loads.from - 1e-6 && left + h < loads.to + 1e-6) {
        const double q = -loads.weight;
        P[3 * e + 1] += q * h / 2, P[3 * e + 4] += q * h / 2;
        P[3 * e + 2] += q * h * h / 12, P[3 * e + 5] -= q * h * h / 12;
      }
      if (left > loads.along_from - 1e-6 && left + h < loads.along_to + 1e-6)
        P[left_u(e)] += loads.along * h / 2, P[3 * e + 3] += loads.along * h / 2;
    }
    for (int e = 0; e < t_.deck && loads.strains; ++e)
      P[deck(e)] -= t_.EA * t_.strain, P[deck(e + 1)] += t_.EA * t_.strain;
    for (const int i : held_) P[i] = 0.0;
    return P;
  }

  HandRail t_;
  int n_;
  Entries entries_, masses_, dampers_;
  std::vector<Sleeper> sleepers_;
  std::vector<int> held_;
};

}  // namespace traverse::test
