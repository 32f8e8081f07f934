#include "structure/beam_motion.hpp"

#include <algorithm>
#include <tuple>

namespace traverse::structure {
namespace {

constexpr int tile = beam::ElementRows::tile;
constexpr int most_terms = most_accelerations + 2;  // with v and w

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

// `outputs` sums of N vectors' entries [from, from + size) at once.
template <int N, int outputs>
void add_up(const std::array<const double*, most_terms>& vectors,
            const std::array<std::array<double, outputs>, most_terms>& weight, std::ptrdiff_t from, int size,
            const std::array<double*, outputs>& to) {
  std::array<const double*, N> x;
  for (int j = 0; j < N; ++j) x[j] = vectors[j] + from;
#pragma GCC ivdep
  for (int i = 0; i < size; ++i) {
    std::array<double, outputs> sum{};
    for (int j = 0; j < N; ++j)
      for (int k = 0; k < outputs; ++k) sum[k] += weight[j][k] * x[j][i];
    for (int k = 0; k < outputs; ++k) to[k][i] = sum[k];
  }
}

}  // namespace

/// Vectors and their weights in so many sums.
template <int outputs>
struct BeamMotion::Terms {
  std::array<const double*, most_terms> x{};
  std::array<std::array<double, outputs>, most_terms> weight{};
  int count = 0;

  void add(const double* vector, const std::array<double, outputs>& weights) {
    if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; })) return;
    x[count] = vector;
    weight[count++] = weights;
  }
  void evaluate(std::ptrdiff_t from, int size, const std::array<double*, outputs>& to) const {
    with_count(count, [&](auto N) { add_up<N, outputs>(x, weight, from, size, to); });
  }
};

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

void BeamMotion::Sum::add(double by, const Sum& other) {
  v += by * other.v;
  w += by * other.w;
  for (std::size_t j = 0; j < kept.size(); ++j) kept[j] += by * other.kept[j];
}

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

void BeamMotion::begin(const Method& method) {
  const auto [a, b] = fused() ? beam_.rayleigh() : beam::Rayleigh{};
  std::array<Sum, most_accelerations> accelerations{};  // A_j
  accelerations[0].kept[0] = 1.0;
  const auto v_and_w = [&](double w_in_v, const Weights& a_in_v, const Weights& a_in_w, Sum& v, Sum& w) {
    v = {1.0, w_in_v, {}};
    w = {0.0, 1.0, {}};
    for (std::size_t j = 0; j < accelerations.size(); ++j) {
      v.add(a_in_v[j], accelerations[j]);
      w.add(a_in_w[j], accelerations[j]);
    }
  };
  stages_.clear();
  for (const StageRule& rule : method.stages) {
    Stage stage;
    stage.rate = rule.rate;
    stage.displacement = rule.displacement;
    v_and_w(rule.w_in_v, rule.a_in_v, rule.a_in_w, stage.v_still, stage.w_still);
    const double c = a / (1.0 + a * rule.rate);
    stage.a.kept[stages_.size() + 1] = 1.0;
    stage.a.add(-c, stage.w_still);
    stage.e = stage.v_still;
    stage.e.add(b - c * (b * rule.rate + rule.displacement), stage.w_still);
    stages_.push_back(stage);
    accelerations[stages_.size()] = stage.a;
  }
  v_and_w(method.step.w_in_v, method.step.a_in_v, method.step.a_in_w, v_end_, w_end_);
  a_end_ = v_error_ = w_error_ = {};
  for (std::size_t j = 0; j < accelerations.size(); ++j) {
    a_end_.add(method.step.a_next[j], accelerations[j]);
    v_error_.add(method.step.error_in_v[j], accelerations[j]);
    w_error_.add(method.step.error_in_w[j], accelerations[j]);
  }
  for (std::size_t j = 0; j <= stages_.size(); ++j) kept_[j].resize(static_cast<std::size_t>(n_), 0.0);
}

template <int outputs>
BeamMotion::Terms<outputs> BeamMotion::terms_of(const std::array<const Sum*, outputs>& sums, const View& view) const {
  Terms<outputs> terms;
  const auto add = [&](const double* vector, auto weight_of) {
    std::array<double, outputs> weights;
    for (int k = 0; k < outputs; ++k) weights[k] = weight_of(*sums[k]);
    terms.add(vector, weights);
  };
  add(view.v, [](const Sum& s) { return s.v; });
  add(view.w, [](const Sum& s) { return s.w; });
  for (std::size_t j = 0; j <= stages_.size(); ++j) add(view.kept[j], [j](const Sum& s) { return s.kept[j]; });
  return terms;
}

double BeamMotion::at(const Sum& sum, const View& view, int i) const {
  double x = sum.v * view.v[i] + sum.w * view.w[i];
  for (std::size_t j = 0; j <= stages_.size(); ++j)
    if (sum.kept[j] != 0.0) x += sum.kept[j] * view.kept[j][i];
  return x;
}

BeamMotion::View BeamMotion::view_of(const double* v, const double* w) const {
  View view{v, w, {}, 0, nodes_};
  for (std::size_t j = 0; j <= stages_.size(); ++j) view.kept[j] = kept_[j].data();
  return view;
}

void BeamMotion::solve(std::size_t stage, const double* v, const double* w, const std::vector<NodalLoad>& loads) {
  view_ = view_of(v, w);
  stage_ = &stages_[stage];
  loads_ = &loads;
  measuring_ = stage == 0 && measure_;
  if (stage == 0) dissipation_ = {};
  exchange_borders(stage_->e, {0.0, 1.0, {}});
  target_ = kept(stage);
  const BeamFactor& factor = operator_.factored(stage_->rate / stage_->displacement, 1.0 / stage_->displacement);
  if (ranged_)
    factor.solve_window(target_, first_, past_, *this);
  else
    factor.solve(target_, *this);
  ++operator_.solves;
}

void BeamMotion::step_free(int first, int past, double* v, double* w, Dissipation& dissipation) {
  if (first >= past) return;
  static const std::vector<NodalLoad> none;
  loads_ = &none;
  ghosts_ = {};
  dissipation_ = {};
  const Stage& any = stages_.front();
  const BeamFactor& factor = operator_.factored(any.rate / any.displacement, 1.0 / any.displacement);
  const solve::Parts& layout = *operator_.parts();
  const solve::Parts::Part* part = &layout.at(first);
  const solve::Parts::Part* const end = layout.parts.data() + layout.parts.size();
  while (part != end && part->first < past) {
    const solve::Parts::Part* const next = layout.together(part, past);
    const int from = static_cast<int>(part->first), to = static_cast<int>(next[-1].past), size = 2 * (to - from);
    const std::ptrdiff_t offset = 2 * static_cast<std::ptrdiff_t>(from);
    view_ = {v + offset, w + offset, {start_acceleration() + offset}, from, to};
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
      std::vector<double>& z = scratch_[stage];
      if (z.size() < static_cast<std::size_t>(size)) z.resize(static_cast<std::size_t>(size));
      view_.kept[stage + 1] = target_ = z.data();
      stage_ = &stages_[stage];
      measuring_ = stage == 0 && measure_;
      fill(from, to);
      factor.parts().solve_together(*part, target_, static_cast<int>(next - part));
    }
    end_step(view_, 0, size, v + offset, w + offset, start_acceleration() + offset);
    part = next;
  }
  dissipation.power += dissipation_.power;
  dissipation.rate += dissipation_.rate;
}

// Two sums at the columns next to this rank's.
void BeamMotion::exchange_borders(const Sum& first_sum, const Sum& second_sum) {
  if (nodes_ == 0 || !operator_.shared()) return;
  constexpr int size = 4;
  std::array<double, size> first, last, left{}, right{};
  for (int i = 0; i < 2; ++i) {
    const int end = 2 * (nodes_ - 1) + i;
    first[i] = at(first_sum, view_, i);
    last[i] = at(first_sum, view_, end);
    first[2 + i] = at(second_sum, view_, i);
    last[2 + i] = at(second_sum, view_, end);
  }
  operator_.exchange(first.data(), last.data(), size, left.data(), right.data());
  for (int c = 0; c < 2; ++c) ghosts_[c] = {left[2 * c], left[2 * c + 1], right[2 * c], right[2 * c + 1]};
}

// A sum on a tile and its neighbours, with its values beyond the view's nodes.
void BeamMotion::combine(const Sum& sum, int first, int past, const Ghosts& ghosts, Tile& to) const {
  const int from = std::max(first - 1, view_.first), count = std::min(past + 1, view_.past) - from;
  terms_of<1>({&sum}, view_)
      .evaluate(2 * static_cast<std::ptrdiff_t>(from - view_.first), 2 * count, {to.together.data()});
  to.separate(from - (first - 1), count);
  if (first == view_.first) to.set(0, ghosts[0], ghosts[1]);
  if (past == view_.past) to.set(past - first + 1, ghosts[2], ghosts[3]);
}

void BeamMotion::fill(std::ptrdiff_t first, std::ptrdiff_t past) {
  for (std::ptrdiff_t node = first; node < past; node += tile)
    fill_tile(static_cast<int>(node), static_cast<int>(std::min<std::ptrdiff_t>(past, node + tile)));
}

// w^T C w and 2 A_0^T C w.
void BeamMotion::measure_dissipation(int first, int past, Tile& rate, Tile& force) {
  const auto [a, b] = beam_.rayleigh();
  combine({0.0, 1.0, {}}, first, past, ghosts_[1], rate);
  Tile drag;
  for (int i = 0; i < past - first + 2; ++i) {
    drag.v[i] = a * rate.v[i];
    drag.theta[i] = a * rate.theta[i];
    rate.v[i] *= b;
    rate.theta[i] *= b;
  }
  rows_->multiply(first, past, rate.nodes(), drag.nodes(), force.nodes());
  const std::ptrdiff_t offset = 2 * static_cast<std::ptrdiff_t>(first - view_.first);
  const double* const w = view_.w + offset;
  const double* const a0 = view_.kept[0] + offset;
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
  Tile elastic, force;
  if (measuring_) measure_dissipation(first, past, elastic, force);
  combine(stage_->e, first, past, ghosts_[0], elastic);
  rows_->multiply(first, past, elastic.nodes(), {}, force.nodes());
  double* const to = target_ + 2 * static_cast<std::ptrdiff_t>(first - view_.first);
  const double scale = 1.0 / stage_->displacement;
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

std::pair<double, double> BeamMotion::state(std::size_t stage, const double* v, const double* w, int i) const {
  const Stage& s = stages_[stage];
  const View view = view_of(v, w);
  const double a = at(s.a, view, i);
  return {at(s.v_still, view, i) + s.displacement * a, at(s.w_still, view, i) + s.rate * a};
}

void BeamMotion::still(std::size_t stage, const double* v, const double* w, double* v_still, double* w_still) const {
  const Stage& s = stages_[stage];
  terms_of<2>({&s.v_still, &s.w_still}, view_of(v, w)).evaluate(0, n_, {v_still, w_still});
}

double BeamMotion::error_energy() {
  exchange_borders(v_error_, w_error_);
  Tile displacement, rate, force;
  Tile none;
  none.v = none.theta = {};
  double twice = 0.0;
  const auto add = [&](const Tile& x, int nodes) {
    for (int i = 0; i < nodes; ++i) twice += x.v[i + 1] * force.v[i] + x.theta[i + 1] * force.theta[i];
  };
  for (int first = first_; first < past_; first += tile) {
    const int past = std::min(past_, first + tile);
    combine(v_error_, first, past, ghosts_[0], displacement);
    combine(w_error_, first, past, ghosts_[1], rate);
    rows_->multiply(first, past, displacement.nodes(), {}, force.nodes());
    add(displacement, past - first);
    rows_->multiply(first, past, none.nodes(), rate.nodes(), force.nodes());
    add(rate, past - first);
  }
  return 0.5 * twice;
}

void BeamMotion::error(const double* v, const double* w, double* error_of_v, double* error_of_w) const {
  terms_of<2>({&v_error_, &w_error_}, view_of(v, w)).evaluate(0, n_, {error_of_v, error_of_w});
}

// In place, a stretch in the cache at a time.
void BeamMotion::end_step(const View& view, int begin, int end, double* v, double* w, double* a) const {
  const Terms<3> terms = terms_of<3>({&v_end_, &w_end_, &a_end_}, view);
  std::array<double, 4 * tile> new_v, new_w, new_a;
  for (int from = begin; from < end; from += 4 * tile) {
    const int size = std::min(end - from, 4 * tile);
    terms.evaluate(from, size, {new_v.data(), new_w.data(), new_a.data()});
    std::copy_n(new_v.data(), size, v + from);
    std::copy_n(new_w.data(), size, w + from);
    std::copy_n(new_a.data(), size, a + from);
  }
}

void BeamMotion::finish(double* v, double* w) {
  const int begin = fused() ? 2 * first_ : 0, end = fused() ? 2 * past_ : n_;
  end_step(view_of(v, w), begin, end, v, w, start_acceleration());
}

void BeamMotion::set_range(int first, int past) {
  ranged_ = true;
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
    for (std::vector<double>& a : kept_)
      if (!a.empty()) a[k] = 0.0;
  }
  return energy;
}

}  // namespace traverse::structure
