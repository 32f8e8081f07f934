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

// v and w at the end of the step.
void end_step(const StepRule& rule, const std::array<const double*, most_accelerations>& a, int begin, int end,
              double* v, double* w) {
  Terms terms;
  terms.add(v, 1.0, 0.0);
  terms.add(w, rule.w_in_v, 1.0);
  for (int j = 0; j < rule.known; ++j) terms.add(a[j], rule.a_in_v[j], rule.a_in_w[j]);
  replace(terms, begin, end, v, w);
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
    : beam_(beam),
      operator_(op),
      dead_load_(dead_load),
      n_(beam.local_unknowns()),
      nodes_(beam.local_columns()),
      past_(nodes_) {
  if (beam::ElementRows::fit(beam) && !beam.model().foundation.nonlinear()) rows_.emplace(beam);
  for (int i = 0; i < n_; ++i)
    if (beam.fixed()[i] != 0) held_.push_back(i);
}

void BeamMotion::prepare(int count) {
  for (int j = 0; j < count; ++j) accelerations_[j].assign(n_, 0.0);
}

BeamMotion::Setup BeamMotion::set_up(const StageRule& rule) const {
  const auto [a, b] = beam_.rayleigh();
  Setup setup{{1.0, rule.w_in_v + b, rule.a_in_v, rule.known},
              {0.0, a, rule.a_in_w, rule.known},
              1.0 / rule.displacement,
              rule.known == 1 && operator_.damped()};
  for (int j = 0; j < rule.known; ++j) {
    setup.elastic.a[j] += b * rule.a_in_w[j];
    setup.drag.a[j] *= a;
  }
  return setup;
}

void BeamMotion::solve(const StageRule& rule, const double* v, const double* w, const std::vector<NodalLoad>& loads) {
  view_ = {v, w, {}, 0, nodes_};
  for (int j = 0; j < rule.known; ++j) view_.a[j] = acceleration(j);
  loads_ = &loads;
  setup_ = set_up(rule);
  if (setup_.measuring) dissipation_ = {};
  exchange_borders();
  target_ = acceleration(rule.known);
  const BeamFactor& factor = operator_.factored(rule.rate / rule.displacement, 1.0 / rule.displacement);
  if (windowed_)
    factor.solve_window(target_, first_, past_, *this);
  else
    factor.solve(target_, *this);
  ++operator_.solves;
}

void BeamMotion::step_free(const Method& method, int first, int past, double* v, double* w, Dissipation& dissipation) {
  if (first >= past) return;
  static const std::vector<NodalLoad> none;
  loads_ = &none;
  ghosts_ = {};
  dissipation_ = {};
  setups_.clear();
  for (const StageRule& rule : method.stages) setups_.push_back(set_up(rule));
  const StageRule& any = method.stages.front();
  const BeamFactor& factor = operator_.factored(any.rate / any.displacement, 1.0 / any.displacement);
  const int known = method.step.known;
  const solve::Parts& layout = *operator_.parts();
  const solve::Parts::Part* part = &layout.at(first);
  const solve::Parts::Part* const end = layout.parts.data() + layout.parts.size();
  while (part != end && part->first < past) {
    const solve::Parts::Part* const next = layout.together(part, past);
    const int from = static_cast<int>(part->first), to = static_cast<int>(next[-1].past), size = 2 * (to - from);
    double* const a0 = acceleration(0) + 2 * static_cast<std::ptrdiff_t>(from);
    double* const v_here = v + 2 * static_cast<std::ptrdiff_t>(from);
    double* const w_here = w + 2 * static_cast<std::ptrdiff_t>(from);
    view_ = {v_here, w_here, {a0}, from, to};
    for (int j = 1; j < known; ++j) {
      scratch_[j].resize(std::max(scratch_[j].size(), static_cast<std::size_t>(size)));
      view_.a[j] = scratch_[j].data();
    }
    for (int stage = 0; stage + 1 < known; ++stage) {
      setup_ = setups_[static_cast<std::size_t>(stage)];
      target_ = scratch_[stage + 1].data();
      fill(from, to);
      factor.parts().solve_together(*part, target_, static_cast<int>(next - part));
    }
    end_step(method.step, view_.a, 0, size, v_here, w_here);
    const double a_first = method.step.a_next[0], a_last = method.step.a_next[known - 1];
    for (int i = 0; i < size; ++i) a0[i] = a_first * a0[i] + a_last * view_.a[known - 1][i];
    if (a_last != 1.0)
      std::copy_n(view_.a[known - 1], size, acceleration(known - 1) + 2 * static_cast<std::ptrdiff_t>(from));
    part = next;
  }
  dissipation.power += dissipation_.power;
  dissipation.rate += dissipation_.rate;
}

// The combinations at the columns next to this rank's.
void BeamMotion::exchange_borders() {
  if (nodes_ == 0 || !operator_.shared()) return;
  constexpr int size = 6;
  std::array<double, size> first, last, left{}, right{};
  const Combination rate{0.0, 1.0, {}, 0};
  int i = 0;
  for (const Combination* c : std::array<const Combination*, 3>{&setup_.elastic, &setup_.drag, &rate}) {
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
    sum[i] = c.v * view_.v[k] + c.w * view_.w[k];
    for (int j = 0; j < c.known; ++j) sum[i] += c.a[j] * view_.a[j][k];
  }
  return {sum[0], sum[1]};
}

// Two combinations on a tile and its neighbours, with their values beyond this rank's nodes.
void BeamMotion::combine(const Combination& a, const Combination& b, int first, int past, const Ghosts& ghosts_a,
                         const Ghosts& ghosts_b, Tile& to_a, Tile& to_b) const {
  const int from = std::max(first - 1, view_.first), count = std::min(past + 1, view_.past) - from;
  const int place = from - (first - 1);
  const std::ptrdiff_t offset = 2 * static_cast<std::ptrdiff_t>(from - view_.first);
  Terms terms;
  terms.add(view_.v, a.v, b.v);
  terms.add(view_.w, a.w, b.w);
  for (int j = 0; j < std::max(a.known, b.known); ++j) terms.add(view_.a[j], a.a[j], b.a[j]);
  with_count(terms.count,
             [&](auto N) { add_up<N>(terms, offset, 2 * count, to_a.together.data(), to_b.together.data()); });
  to_a.separate(place, count);
  to_b.separate(place, count);
  if (first == view_.first) {
    to_a.set(0, ghosts_a[0], ghosts_a[1]);
    to_b.set(0, ghosts_b[0], ghosts_b[1]);
  }
  if (past == view_.past) {
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
  const std::ptrdiff_t offset = 2 * static_cast<std::ptrdiff_t>(first - view_.first);
  const double* const w = view_.w + offset;
  const double* const a0 = view_.a[0] + offset;
  constexpr int lanes = 8;
  std::array<double, lanes> by_w{}, by_a{};
  const auto add = [&](int lane, int i) {
    by_w[lane] += w[2 * i] * force.v[i] + w[2 * i + 1] * force.theta[i];
    by_a[lane] += a0[2 * i] * force.v[i] + a0[2 * i + 1] * force.theta[i];
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
  if (setup_.measuring) measure_dissipation(first, past, elastic, drag, force);
  combine(setup_.elastic, setup_.drag, first, past, ghosts_[0], ghosts_[1], elastic, drag);
  const bool drags = beam_.rayleigh().a != 0.0;
  rows_->multiply(first, past, elastic.nodes(), drags ? drag.nodes() : beam::NodalPair{}, force.nodes());
  double* const to = target_ + 2 * static_cast<std::ptrdiff_t>(first - view_.first);
  const double scale = setup_.scale;
  for (int i = 0; i < nodes; ++i) {
    to[2 * i] = -scale * force.v[i];
    to[2 * i + 1] = -scale * force.theta[i];
  }
  const int begin = 2 * first, end = 2 * past;
  if (dead_load_ != nullptr)
    for (int i = begin; i < end; ++i) to[i - begin] += scale * dead_load_[i];
  const auto before = [](const NodalLoad& load, int unknown) { return load.unknown < unknown; };
  for (auto load = std::lower_bound(loads_->begin(), loads_->end(), begin, before);
       load != loads_->end() && load->unknown < end; ++load)
    to[load->unknown - begin] += scale * load->force;
  for (auto held = std::lower_bound(held_.begin(), held_.end(), begin); held != held_.end() && *held < end; ++held)
    to[*held - begin] = 0.0;
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
  terms.add(v, 1.0, 0.0);
  terms.add(w, rule.w_in_v, 1.0);
  for (int j = 0; j < rule.known; ++j) terms.add(accelerations_[j].data(), rule.a_in_v[j], rule.a_in_w[j]);
  replace(terms, 0, n_, v_still, w_still);
}

void BeamMotion::finish(const StepRule& rule, double* v, double* w) {
  std::array<const double*, most_accelerations> a{};
  for (int j = 0; j < rule.known; ++j) a[j] = acceleration(j);
  const int begin = fused() ? 2 * first_ : 0, end = fused() ? 2 * past_ : n_;
  end_step(rule, a, begin, end, v, w);
  const double a_first = rule.a_next[0], a_last = rule.a_next[rule.known - 1];
  double* const first = acceleration(0);
  const double* const last = acceleration(rule.known - 1);
  for (int i = begin; i < end; ++i) first[i] = a_first * first[i] + a_last * last[i];
}

void BeamMotion::set_range(int first, int past) {
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
