#include "traverse/coupling/beam_motion.hpp"

#include <algorithm>

namespace traverse::coupling {
namespace {

constexpr int tile = beam::ElementRows::tile;
constexpr int most_terms = most_accelerations + 2;  // with v and w

struct Terms {  // of a combination: where its vectors begin, and their weights
  std::array<const double*, most_terms> x{};
  std::array<double, most_terms> weight{};
  int count = 0;
  void add(const double* vector, double by) {
    if (by == 0.0) return;
    x[count] = vector;
    weight[count++] = by;
  }
};

// (v, theta)[i] = sum over N vectors of node i of each.
template <int N>
void sum_nodes(const Terms& terms, int first, int nodes, double* v, double* theta) {
  std::array<const double*, N> x;
  for (int j = 0; j < N; ++j) x[j] = terms.x[j] + 2 * static_cast<std::ptrdiff_t>(first);
  for (int i = 0; i < nodes; ++i) {
    double sum_v = 0.0, sum_theta = 0.0;
    for (int j = 0; j < N; ++j) {
      sum_v += terms.weight[j] * x[j][2 * i];
      sum_theta += terms.weight[j] * x[j][2 * i + 1];
    }
    v[i] = sum_v;
    theta[i] = sum_theta;
  }
}

// x += sum over N vectors.
template <int N>
void add_vectors(const Terms& terms, std::ptrdiff_t first, std::ptrdiff_t past, double* to) {
  for (std::ptrdiff_t i = first; i < past; ++i) {
    double sum = 0.0;
    for (int j = 0; j < N; ++j) sum += terms.weight[j] * terms.x[j][i];
    to[i] += sum;
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

struct BeamMotion::Tile {
  std::array<double, tile + 2> v, theta;  // from the node before the tile to the one behind it
  beam::NodalPair at(int node) { return {v.data() + node, theta.data() + node}; }
};

BeamMotion::BeamMotion(const beam::Beam& beam, BeamOperator& op, const double* dead_load)
    : beam_(beam), operator_(op), dead_load_(dead_load), n_(beam.local_unknowns()), nodes_(beam.local_columns()) {
  if (beam::ElementRows::fit(beam) && !beam.model().foundation.nonlinear()) rows_.emplace(beam);
  for (int i = 0; i < n_; ++i)
    if (beam.fixed()[i] != 0) held_.push_back(i);
}

void BeamMotion::prepare(int count) {
  for (int j = 0; j < count; ++j) accelerations_[j].assign(n_, 0.0);
}

void BeamMotion::solve(const StageRule& rule, const Weights& before, const double* v, const double* w,
                       const std::vector<NodalLoad>& loads) {
  v_ = v;
  w_ = w;
  loads_ = &loads;
  const auto [a, b] = beam_.rayleigh();
  elastic_ = {1.0, rule.w_in_v + b, rule.a_in_v, rule.known};
  drag_ = {0.0, a, rule.a_in_w, rule.known};
  before_ = {0.0, 1.0, before, rule.known};
  for (int j = 0; j < rule.known; ++j) {
    elastic_.a[j] += b * rule.a_in_w[j];
    drag_.a[j] *= a;
  }
  exchange_borders();
  scale_ = 1.0 / rule.displacement;
  target_ = acceleration(rule.known);
  dissipation_ = 0.0;
  operator_.factored(rule.rate / rule.displacement, 1.0 / rule.displacement).solve(target_, *this);
  ++operator_.solves;
}

// The combinations at the columns next to this rank's.
void BeamMotion::exchange_borders() {
  if (nodes_ == 0) return;
  constexpr int size = 6;
  std::array<double, size> first, last, left{}, right{};
  int i = 0;
  for (const Combination* c : {&elastic_, &drag_, &before_}) {
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

void BeamMotion::combine(const Combination& c, int first, int past, const std::array<double, 4>& ghosts,
                         Tile& to) const {
  Terms terms;
  terms.add(v_, c.v);
  terms.add(w_, c.w);
  for (int j = 0; j < c.known; ++j) terms.add(accelerations_[j].data(), c.a[j]);
  const int from = std::max(first - 1, 0), count = std::min(past + 1, nodes_) - from;
  const beam::NodalPair at = to.at(from - (first - 1));
  with_count(terms.count, [&](auto N) { sum_nodes<N>(terms, from, count, at.v, at.theta); });
  if (first == 0) {
    to.v[0] = ghosts[0];
    to.theta[0] = ghosts[1];
  }
  if (past == nodes_) {
    to.v[past - first + 1] = ghosts[2];
    to.theta[past - first + 1] = ghosts[3];
  }
}

void BeamMotion::fill(std::ptrdiff_t first, std::ptrdiff_t past) {
  for (std::ptrdiff_t node = first; node < past; node += tile)
    fill_tile(static_cast<int>(node), static_cast<int>(std::min<std::ptrdiff_t>(past, node + tile)));
}

void BeamMotion::fill_tile(int first, int past) {
  const int nodes = past - first;
  Tile elastic, drag, force;
  const auto [a, b] = beam_.rayleigh();
  if (a != 0.0 || b != 0.0) {
    combine(before_, first, past, ghosts_[2], elastic);
    Tile rates = elastic;
    for (int i = 0; i < nodes + 2; ++i) {
      drag.v[i] = a * elastic.v[i];
      drag.theta[i] = a * elastic.theta[i];
      elastic.v[i] *= b;
      elastic.theta[i] *= b;
    }
    rows_->multiply(first, past, elastic.at(0), drag.at(0), force.at(0));
    double sum = 0.0;
    for (int i = 0; i < nodes; ++i) sum += rates.v[i + 1] * force.v[i] + rates.theta[i + 1] * force.theta[i];
    dissipation_ += sum;
  }
  combine(elastic_, first, past, ghosts_[0], elastic);
  combine(drag_, first, past, ghosts_[1], drag);
  rows_->multiply(first, past, elastic.at(0), drag.at(0), force.at(0));
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
  const auto begins = [](const NodalLoad& load, int unknown) { return load.unknown < unknown; };
  for (auto load = std::lower_bound(loads_->begin(), loads_->end(), 2 * first, begins);
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

void BeamMotion::still(const StageRule& rule, const double* v, const double* w, double* v_still,
                       double* w_still) const {
  Terms terms;
  terms.add(w, rule.w_in_v);
  for (int j = 0; j < rule.known; ++j) terms.add(accelerations_[j].data(), rule.a_in_v[j]);
  std::copy_n(v, n_, v_still);
  with_count(terms.count, [&](auto N) { add_vectors<N>(terms, 0, n_, v_still); });
  terms.count = 0;
  for (int j = 0; j < rule.known; ++j) terms.add(accelerations_[j].data(), rule.a_in_w[j]);
  std::copy_n(w, n_, w_still);
  with_count(terms.count, [&](auto N) { add_vectors<N>(terms, 0, n_, w_still); });
}

void BeamMotion::finish(const StepRule& rule, double* v, double* w) {
  Terms displacement, rate, next;
  displacement.add(w, rule.w_in_v);
  for (int j = 0; j < rule.known; ++j) {
    displacement.add(accelerations_[j].data(), rule.a_in_v[j]);
    rate.add(accelerations_[j].data(), rule.a_in_w[j]);
  }
  for (int from = 0; from < n_; from += 2 * tile) {
    const int past = std::min(n_, from + 2 * tile);
    with_count(displacement.count, [&](auto N) { add_vectors<N>(displacement, from, past, v); });
    with_count(rate.count, [&](auto N) { add_vectors<N>(rate, from, past, w); });
  }
  if (rule.a_next[rule.known - 1] == 1.0) {  // it is the last one
    accelerations_[0].swap(accelerations_[rule.known - 1]);
    return;
  }
  const double a0 = rule.a_next[0], a1 = rule.a_next[1];
  for (int i = 0; i < n_; ++i) accelerations_[0][i] = a0 * accelerations_[0][i] + a1 * accelerations_[1][i];
}

}  // namespace traverse::coupling
