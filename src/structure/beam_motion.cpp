// Expresses every stage and the end of a step as linear combinations of v, w and the stages' accelerations, and
// evaluates right-hand sides tile by tile as the solver's forward elimination reaches them.
#include "structure/beam_motion.hpp"

#include <algorithm>
#include <tuple>

#include "beam_motion_tile.hpp"

namespace traverse::structure {

void BeamMotion::Sum::add(double by, const Sum& other) {
  v += by * other.v;
  w += by * other.w;
  for (std::size_t j = 0; j < stored.size(); ++j) stored[j] += by * other.stored[j];
}

BeamMotion::BeamMotion(const beam::Beam& beam, BeamOperator& op, const double* dead_load)
    : beam_(beam),
      operator_(op),
      dead_load_(dead_load),
      block_(beam.block()),
      n_(beam.local_unknowns()),
      nodes_(beam.local_columns()),
      ranges_{{0, nodes_}} {
  proportional_ = op.mass_damping().has_value();
  if (beam::ElementRows::fit(beam) && !beam.model().nonlinear()) elements_.emplace(beam);
  for (int i = 0; i < n_; ++i)
    if (beam.fixed()[i] != 0) held_.push_back(i);
}

void BeamMotion::begin(const base::Method& method) {
  const auto [a, b] = fused() && proportional_ ? beam_.rayleigh() : beam::Rayleigh{};
  std::array<Sum, base::most_accelerations> accelerations{};  // A_j
  accelerations[0].stored[0] = 1.0;
  const auto v_and_w = [&](double w_in_v, const base::Weights& a_in_v, const base::Weights& a_in_w, Sum& v, Sum& w) {
    v = {1.0, w_in_v, {}};
    w = {0.0, 1.0, {}};
    for (std::size_t j = 0; j < accelerations.size(); ++j) {
      v.add(a_in_v[j], accelerations[j]);
      w.add(a_in_w[j], accelerations[j]);
    }
  };
  stages_.clear();
  for (const base::StageRule& rule : method.stages) {
    Stage stage;
    stage.rate = rule.rate;
    stage.displacement = rule.displacement;
    v_and_w(rule.w_in_v, rule.a_in_v, rule.a_in_w, stage.v_predicted, stage.w_predicted);
    const double c = a / (1.0 + a * rule.rate);
    stage.a.stored[stages_.size() + 1] = 1.0;
    stage.a.add(-c, stage.w_predicted);
    stage.v = stage.v_predicted;
    stage.v.add(rule.displacement, stage.a);
    stage.w = stage.w_predicted;
    stage.w.add(rule.rate, stage.a);
    stage.e = stage.v_predicted;
    stage.e.add(b - c * (b * rule.rate + rule.displacement), stage.w_predicted);
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
  for (std::size_t j = 0; j <= stages_.size(); ++j) stored_[j].resize(static_cast<std::size_t>(n_), 0.0);
}

double BeamMotion::at(const Sum& sum, const View& view, int i) const {
  double x = sum.v * view.v[i] + sum.w * view.w[i];
  for (std::size_t j = 0; j <= stages_.size(); ++j)
    if (sum.stored[j] != 0.0) x += sum.stored[j] * view.stored[j][i];
  return x;
}

BeamMotion::View BeamMotion::view_of(const double* v, const double* w) const {
  View view{v, w, {}, 0, nodes_};
  for (std::size_t j = 0; j <= stages_.size(); ++j) view.stored[j] = stored_[j].data();
  return view;
}

void BeamMotion::solve(std::size_t stage, const double* v, const double* w, const std::vector<NodalLoad>& loads) {
  view_ = view_of(v, w);
  stage_ = &stages_[stage];
  loads_ = &loads;
  measuring_ = stage == 0 && measure_;
  if (stage == 0) dissipation_ = {};
  const Sum rate{0.0, 1.0, {}};
  exchange_borders({&stage_->e, &rate, &stage_->w_predicted});
  target_ = stored(stage);
  const BeamFactor& factor = operator_.factored(stage_->rate / stage_->displacement, 1.0 / stage_->displacement);
  if (!has_ranges_) factor.solve(target_, *this);
  for (const Range& r : ranges_)
    if (has_ranges_) factor.solve_window(target_, r.first, r.past, *this);
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
    const solve::Parts::Part* const next = layout.group_end(part, past);
    const int from = static_cast<int>(part->first), to = static_cast<int>(next[-1].past), size = block_ * (to - from);
    const std::ptrdiff_t offset = block_ * static_cast<std::ptrdiff_t>(from);
    view_ = {v + offset, w + offset, {start_acceleration() + offset}, from, to};
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) {
      std::vector<double>& z = scratch_[stage];
      if (z.size() < static_cast<std::size_t>(size)) z.resize(static_cast<std::size_t>(size));
      view_.stored[stage + 1] = target_ = z.data();
      stage_ = &stages_[stage];
      measuring_ = stage == 0 && measure_;
      fill(from, to);
      factor.parts().solve_group(*part, target_, static_cast<int>(next - part));
    }
    end_step(view_, 0, size, v + offset, w + offset, start_acceleration() + offset);
    part = next;
  }
  dissipation.power += dissipation_.power;
  dissipation.rate += dissipation_.rate;
}

// Exchanges the sums at the columns next to this rank's.
void BeamMotion::exchange_borders(std::initializer_list<const Sum*> sums) {
  if (nodes_ == 0 || !operator_.shared()) return;
  constexpr std::size_t most = 3 * static_cast<std::size_t>(beam::kinds);
  std::array<double, most> first, last, left{}, right{};
  int count = 0;
  for (const Sum* sum : sums) {
    for (int c = 0; c < block_; ++c, ++count) {
      first[count] = at(*sum, view_, c);
      last[count] = at(*sum, view_, block_ * (nodes_ - 1) + c);
    }
  }
  operator_.exchange(first.data(), last.data(), count, left.data(), right.data());
  for (int i = 0; i < count; ++i) {
    Ghosts& to = ghosts_[i / block_];
    to[i % block_] = left[i];
    to[beam::kinds + i % block_] = right[i];
  }
}

// Adds K_aa (v + b w), or with w null K_aa v. Changes v.
void BeamMotion::add_elastic(int first, int past, Tile& v, const Tile* w, Tile& force) const {
  for (int c = 0; c < block_ && w != nullptr; ++c) {
    const double b = operator_.stiffness_damping()[c];
    if (b == 0.0) continue;
    for (int i = 0; i < past - first + 2; ++i) v.plane[c][i] += b * w->plane[c][i];
  }
  elements_->add(first, past, v.planes(), force.planes());
}

void BeamMotion::add_mass_damping(int first, int past, const Tile& w, Tile& force) const {
  const double a = *operator_.mass_damping();
  Tile scaled;
  for (int c = 0; c < block_; ++c)
    for (int i = 0; i < past - first + 2; ++i) scaled.plane[c][i] = a * w.plane[c][i];
  operator_.mass().products.add(first, past, scaled.planes(), force.planes());
}

// Adds K* v + C* w, or with w null K* v. Changes v.
void BeamMotion::add_forces(int first, int past, Tile& v, Tile* w, Tile& force) const {
  const BeamOperator::Matrix *const springs = operator_.springs(), *const drag = operator_.drag();
  if (springs != nullptr) springs->products.add(first, past, v.planes(), force.planes());
  if (w != nullptr && drag != nullptr) drag->products.add(first, past, w->planes(), force.planes());
  if (w != nullptr && proportional_) add_mass_damping(first, past, *w, force);
  add_elastic(first, past, v, w, force);
}

void BeamMotion::fill(std::ptrdiff_t first, std::ptrdiff_t past) {
  for (std::ptrdiff_t node = first; node < past; node += tile)
    fill_tile(static_cast<int>(node), static_cast<int>(std::min<std::ptrdiff_t>(past, node + tile)));
}

void BeamMotion::fill_tile(int first, int past) {
  const int nodes = past - first;
  Tile elastic, rate, force;
  if (measuring_) measure_dissipation(first, past, ghosts_[1], rate, force);
  force.clear(block_, nodes);
  const Summand of_e{stage_->e, ghosts_[0], elastic}, of_w{stage_->w_predicted, ghosts_[2], rate};
  if (proportional_) {
    combine(std::array{of_e}, first, past);
    add_elastic(first, past, elastic, nullptr, force);
  } else {
    combine(std::array{of_e, of_w}, first, past);
    add_forces(first, past, elastic, &rate, force);
  }
  double* const to = target_ + block_ * static_cast<std::ptrdiff_t>(first - view_.first);
  const double scale = 1.0 / stage_->displacement;
  with_block(block_, [&](auto B) {
    const int b = B > 0 ? B : block_;
    for (int i = 0; i < nodes; ++i)
      for (int c = 0; c < b; ++c) to[b * i + c] = -scale * force.plane[c][i];
  });
  const int begin = block_ * first, end = block_ * past;
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
  double of_v = s.v.v * v[i] + s.v.w * w[i], of_w = s.w.v * v[i] + s.w.w * w[i];
  for (std::size_t j = 0; j < stage + 2; ++j) {
    of_v += s.v.stored[j] * stored_[j][i];
    of_w += s.w.stored[j] * stored_[j][i];
  }
  return {of_v, of_w};
}

void BeamMotion::states(std::size_t stage, const double* v, const double* w, std::ptrdiff_t from, int size,
                        double* v_stage, double* w_stage) const {
  terms_of<2>({&stages_[stage].v, &stages_[stage].w}, view_of(v, w)).evaluate(from, size, {v_stage, w_stage});
}

void BeamMotion::predicted(std::size_t stage, const double* v, const double* w, double* v_predicted,
                           double* w_predicted) const {
  const Stage& s = stages_[stage];
  terms_of<2>({&s.v_predicted, &s.w_predicted}, view_of(v, w)).evaluate(0, n_, {v_predicted, w_predicted});
}

void BeamMotion::error(const double* v, const double* w, double* error_of_v, double* error_of_w) const {
  terms_of<2>({&v_error_, &w_error_}, view_of(v, w)).evaluate(0, n_, {error_of_v, error_of_w});
}

// In place, by short ranges that fit into the cache.
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
  for (const Range& r : ranges_) end_step(view_of(v, w), block_ * r.first, block_ * r.past, v, w, start_acceleration());
}

void BeamMotion::set_ranges(const std::vector<Range>& ranges) {
  has_ranges_ = true;
  ranges_ = ranges;
}

}  // namespace traverse::structure
