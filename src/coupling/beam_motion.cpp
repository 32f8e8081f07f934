#include "traverse/coupling/beam_motion.hpp"

#include <algorithm>

namespace traverse::coupling {
namespace {

constexpr int tile = beam::ElementRows::tile;
constexpr int most_terms = most_accelerations + 2;  // with v and w

/// Vectors and their weights in two sums.
struct Terms {
  std::array<const double*, most_terms> x{};
  std::array<double, most_terms> first{}, second{};
  int count = 0;
  void add(const double* vector, double in_first, double in_second) {
    if (in_first == 0.0 && in_second == 0.0) return;
    x[count] = vector;
    first[count] = in_first;
    second[count++] = in_second;
  }
};

// Two sums of N vectors' entries [from, from + size) at once.
template <int N>
void add_up(const Terms& terms, std::ptrdiff_t from, int size, double* first, double* second) {
  std::array<const double*, N> x;
  for (int j = 0; j < N; ++j) x[j] = terms.x[j] + from;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    double a = 0.0, b = 0.0;
    for (int j = 0; j < N; ++j) {
      a += terms.first[j] * x[j][i];
      b += terms.second[j] * x[j][i];
    }
    first[i] = a;
    second[i] = b;
  }
}

template <class Call>
void with_count(int count, Call call) {
  switch (count) {
    case 0:
      return call(std::integral_constant<int, 0>());
    case 1:
      return call(std::integral_constant<int, 1>());
    case 2:
      return call(std::integral_constant<int, 2>());
    case 3:
      return call(std::integral_constant<int, 3>());
    case 4:
      return call(std::integral_constant<int, 4>());
    case 5:
      return call(std::integral_constant<int, 5>());
    case 6:
      return call(std::integral_constant<int, 6>());
    case 7:
      return call(std::integral_constant<int, 7>());
    default:
      return call(std::integral_constant<int, most_terms>());
  }
}

}  // namespace

/// Numbers of the nodes from the one before a tile to the one behind it: (v, theta) one after the other, and apart.
struct BeamMotion::Tile {
  std::array<double, 2 * (tile + 2)> together;
  std::array<double, tile + 2> v, theta;

  void separate(int first, int count) {
    for (int i = 0; i < count; ++i) {
      v[first + i] = together[2 * i];
      theta[first + i] = together[2 * i + 1];
    }
  }
  void set(int node, double v_there, double theta_there) {
    v[node] = v_there;
    theta[node] = theta_there;
  }
  beam::NodalPair nodes() { return {v.data(), theta.data()}; }
};

BeamMotion::BeamMotion(const beam::Beam& beam, BeamOperator& op, const double* dead_load)
    : beam_(beam), operator_(op), dead_load_(dead_load), n_(beam.local_unknowns()), nodes_(beam.local_columns()), past_(nodes_) {
  if (beam::ElementRows::fit(beam) && !beam.model().foundation.nonlinear()) rows_.emplace(beam);
  for (int i = 0; i < n_; ++i)
    if (beam.fixed()[i] != 0) held_.push_back(i);
}

void BeamMotion::prepare(int count) {
  for (int j = 0; j < count; ++j) accelerations_[j].assign(n_, 0.0);
}

void BeamMotion::solve(const StageRule& rule, const double* v, const double* w, const std::vector<NodalLoad>& loads) {
  v_ = v;
  w_ = w;
  loads_ = &loads;
  const auto [a, b] = beam_.rayleigh();
  elastic_ = {1.0, rule.w_in_v + b, rule.a_in_v, rule.known};
  drag_ = {0.0, a, rule.a_in_w, rule.known};
  for (int j = 0; j < rule.known; ++j) {
    elastic_.a[j] += b * rule.a_in_w[j];
    drag_.a[j] *= a;
  }
  measuring_ = rule.known == 1 && operator_.damped();
  dissipation_ = {};
  exchange_borders();
  scale_ = 1.0 / rule.displacement;
  target_ = acceleration(rule.known);
  const BeamFactor& factor = operator_.factored(rule.rate / rule.displacement, 1.0 / rule.displacement);
  if (windowed_)
    factor.solve_window(target_, first_, past_, *this);
  else
    factor.solve(target_, *this);
  ++operator_.solves;
}

// The combinations at the columns next to this rank's.
void BeamMotion::exchange_borders() {
  if (nodes_ == 0 || !operator_.shared()) return;
  constexpr int size = 6;
  std::array<double, size> first, last, left{}, right{};
  const Combination rate{0.0, 1.0, {}, 0};
  int i = 0;
  for (const Combination* c : std::array<const Combination*, 3>{&elastic_, &drag_, &rate}) {
    std::tie(first[i], first[i + 1]) = at_node(*c, 0);
    std::tie(last[i], last[i + 1]) = at_node(*c, nodes_ - 1);
    i += 2;
  }
  operator_.exchange(first.data(), last.data(), size, left.data(), right.data());
  for (int c = 0; c < 3; ++c) ghosts_[c] = {left[2 * c], left[2 * c + 1], right[2 * c], right[2 * c + 1]};
}

std::pair<double, double> BeamMotion::at_node(const Combination& c, int node) const {
  std::array<double, 2> sum{};
  for (int i = 0; i < 2; ++i) {
    const int k = 2 * node + i;
    sum[i] = c.v * v_[k] + c.w * w_[k];
    for (int j = 0; j < c.known; ++j) sum[i] += c.a[j] * accelerations_[j][k];
  }
  return {sum[0], sum[1]};
}

// Two combinations on a tile and its neighbours, with their values beyond this rank's nodes.
void BeamMotion::combine(const Combination& a, const Combination& b, int first, int past, const Ghosts& ghosts_a,
                         const Ghosts& ghosts_b, Tile& to_a, Tile& to_b) const {
  Terms terms;
  terms.add(v_, a.v, b.v);
  terms.add(w_, a.w, b.w);
  for (int j = 0; j < std::max(a.known, b.known); ++j) terms.add(accelerations_[j].data(), a.a[j], b.a[j]);
  const int from = std::max(first - 1, 0), count = std::min(past + 1, nodes_) - from, place = from - (first - 1);
  with_count(terms.count, [&](auto N) {
    add_up<N>(terms, 2 * static_cast<std::ptrdiff_t>(from), 2 * count, to_a.together.data(), to_b.together.data());
  });
  to_a.separate(place, count);
  to_b.separate(place, count);
  if (first == 0) {
    to_a.set(0, ghosts_a[0], ghosts_a[1]);
    to_b.set(0, ghosts_b[0], ghosts_b[1]);
  }
  if (past == nodes_) {
    to_a.set(past - first + 1, ghosts_a[2], ghosts_a[3]);
    to_b.set(past - first + 1, ghosts_b[2], ghosts_b[3]);
  }
}

void BeamMotion::fill(std::ptrdiff_t first, std::ptrdiff_t past) {
  for (std::ptrdiff_t node = first; node < past; node += tile)
    fill_tile(static_cast<int>(node), static_cast<int>(std::min<std::ptrdiff_t>(past, node + tile)));
}

// w^T C w and a^T C w at the start of the step.
void BeamMotion::measure_dissipation(int first, int past, Tile& elastic, Tile& drag, Tile& force) {
  const auto [a, b] = beam_.rayleigh();
  const auto scaled = [](const Ghosts& g, double by) { return Ghosts{by * g[0], by * g[1], by * g[2], by * g[3]}; };
  combine({0.0, b, {}, 0}, {0.0, a, {}, 0}, first, past, scaled(ghosts_[2], b), scaled(ghosts_[2], a), elastic, drag);
  rows_->multiply(first, past, elastic.nodes(), drag.nodes(), force.nodes());
  const double* w = w_ + 2 * static_cast<std::ptrdiff_t>(first);
  const double* acceleration = accelerations_[0].data() + 2 * static_cast<std::ptrdiff_t>(first);
  constexpr int lanes = 8;
  std::array<double, lanes> by_w{}, by_a{};
  const auto add = [&](int lane, int i) {
    by_w[lane] += w[2 * i] * force.v[i] + w[2 * i + 1] * force.theta[i];
    by_a[lane] += acceleration[2 * i] * force.v[i] + acceleration[2 * i + 1] * force.theta[i];
  };
  int i = 0;
  for (; i + lanes <= past - first; i += lanes)
    for (int lane = 0; lane < lanes; ++lane) add(lane, i + lane);
  for (; i < past - first; ++i) add(0, i);
  for (int lane = 0; lane < lanes; ++lane) {
    dissipation_.power += by_w[lane];
    dissipation_.rate += 2.0 * by_a[lane];
  }
}

void BeamMotion::fill_tile(int first, int past) {
  const int nodes = past - first;
  Tile elastic, drag, force;
  if (measuring_) measure_dissipation(first, past, elastic, drag, force);
  combine(elastic_, drag_, first, past, ghosts_[0], ghosts_[1], elastic, drag);
  const bool drags = beam_.rayleigh().a != 0.0;
  rows_->multiply(first, past, elastic.nodes(), drags ? drag.nodes() : beam::NodalPair{}, force.nodes());
  double* to = target_ + 2 * static_cast<std::ptrdiff_t>(first);
  const double minus = -scale_;
  for (int i = 0; i < nodes; ++i) {
    to[2 * i] = minus * force.v[i];
    to[2 * i + 1] = minus * force.theta[i];
  }
  if (dead_load_ != nullptr) {
    const double* dead = dead_load_ + 2 * static_cast<std::ptrdiff_t>(first);
    for (int i = 0; i < 2 * nodes; ++i) to[i] += scale_ * dead[i];
  }
  const auto before = [](const NodalLoad& load, int unknown) { return load.unknown < unknown; };
  for (auto load = std::lower_bound(loads_->begin(), loads_->end(), 2 * first, before);
       load != loads_->end() && load->unknown < 2 * past; ++load)
    target_[load->unknown] += scale_ * load->force;
  for (auto held = std::lower_bound(held_.begin(), held_.end(), 2 * first); held != held_.end() && *held < 2 * past;
       ++held)
    target_[*held] = 0.0;
}

std::pair<double, double> BeamMotion::state(const StageRule& rule, const double* v, const double* w, int i) const {
  const double a = accelerations_[rule.known][i];
  double vi = v[i] + rule.w_in_v * w[i] + rule.displacement * a, wi = w[i] + rule.rate * a;
  for (int j = 0; j < rule.known; ++j) {
    vi += rule.a_in_v[j] * accelerations_[j][i];
    wi += rule.a_in_w[j] * accelerations_[j][i];
  }
  return {vi, wi};
}

namespace {

// Both sums into v and w in place, a stretch in the cache at a time.
void replace(const Terms& terms, int begin, int end, double* v, double* w) {
  std::array<double, 4 * tile> new_v, new_w;
  for (int from = begin; from < end; from += 4 * tile) {
    const int size = std::min(end - from, 4 * tile);
    with_count(terms.count, [&](auto N) { add_up<N>(terms, from, size, new_v.data(), new_w.data()); });
    std::copy_n(new_v.data(), size, v + from);
    std::copy_n(new_w.data(), size, w + from);
  }
}

}  // namespace

void BeamMotion::still(const StageRule& rule, const double* v, const double* w, double* v_still,
                       double* w_still) const {
  Terms terms;
  terms.add(v, 1.0, 0.0);
  terms.add(w, rule.w_in_v, 1.0);
  for (int j = 0; j < rule.known; ++j) terms.add(accelerations_[j].data(), rule.a_in_v[j], rule.a_in_w[j]);
  replace(terms, 0, n_, v_still, w_still);
}

void BeamMotion::finish(const StepRule& rule, double* v, double* w) {
  Terms terms;
  terms.add(v, 1.0, 0.0);
  terms.add(w, rule.w_in_v, 1.0);
  for (int j = 0; j < rule.known; ++j) terms.add(accelerations_[j].data(), rule.a_in_v[j], rule.a_in_w[j]);
  const int begin = fused() ? 2 * first_ : 0, end = fused() ? 2 * past_ : n_;
  replace(terms, begin, end, v, w);
  if (rule.a_next[rule.known - 1] == 1.0) {  // it is the last one
    accelerations_[0].swap(accelerations_[rule.known - 1]);
    return;
  }
  const double a0 = rule.a_next[0], a1 = rule.a_next[1];
  for (int i = begin; i < end; ++i) accelerations_[0][i] = a0 * accelerations_[0][i] + a1 * accelerations_[1][i];
}

void BeamMotion::set_window(int first, int past) {
  windowed_ = true;
  first_ = first;
  past_ = past;
}

double BeamMotion::put_to_rest(int first, int past, const double* rest, double* v, double* w) {
  double energy = 0.0;
  for (int from = first; from < past; from += tile) {
    const int to = std::min(past, from + tile), begin = std::max(from - 1, 0), end = std::min(to + 1, nodes_);
    Tile displacement, rate, force;
    for (Tile* t : {&displacement, &rate}) t->v = t->theta = {};
    const auto energy_of = [&](const Tile& t) {
      double sum = 0.0;
      for (int i = 0; i < to - from; ++i) sum += t.v[i + 1] * force.v[i] + t.theta[i + 1] * force.theta[i];
      return 0.5 * sum;
    };
    for (int node = begin; node < end; ++node) {
      const int i = node - (from - 1), k = 2 * node;
      displacement.set(i, v[k] - (rest != nullptr ? rest[k] : 0.0), v[k + 1] - (rest != nullptr ? rest[k + 1] : 0.0));
      rate.set(i, w[k], w[k + 1]);
    }
    Tile none;
    none.v = none.theta = {};
    rows_->multiply(from, to, displacement.nodes(), {}, force.nodes());
    energy += energy_of(displacement);
    rows_->multiply(from, to, none.nodes(), rate.nodes(), force.nodes());
    energy += energy_of(rate);
  }
  for (int k = 2 * first; k < 2 * past; ++k) {
    v[k] = rest != nullptr ? rest[k] : 0.0;
    w[k] = 0.0;
    for (std::vector<double>& a : accelerations_)
      if (!a.empty()) a[k] = 0.0;
  }
  return energy;
}

}  // namespace traverse::coupling
