// The system stepped in second-order form (motion.hpp): one beam solve a stage, made while its right-hand side is
// written, and Newton on vehicles and contacts.
#include <algorithm>

#include "traverse/beam/shape.hpp"
#include "traverse/coupling/system.hpp"

namespace traverse::coupling {
namespace {

/// Free response of a fused stage, whose vectors v and w are never formed.
struct FusedResponse final : FreeResponse {
  const BeamMotion& beam;
  const StageRule& rule;
  const double *v, *w;
  FusedResponse(const BeamMotion& b, const StageRule& r, const double* v_n, const double* w_n)
      : beam(b), rule(r), v(v_n), w(w_n) {}
  std::pair<double, double> at(int unknown) const override { return beam.state(rule, v, w, unknown); }
};

struct NoBeam final : FreeResponse {
  std::pair<double, double> at(int) const override { return {}; }
};

double last(const Weights& values, int count) { return values[static_cast<std::size_t>(count) - 1]; }

}  // namespace

void System::leave_out_rest(double tolerance, const std::vector<double>& probes) {
  if (beam_ == nullptr) return;
  rest_tolerance_ = tolerance;
  watched_.clear();
  for (double x : probes) watched_.push_back(beam_->bridge().first_column + beam_->mesh().element(beam_->mesh().locate(x).element).left);
}

void System::begin_motion(const Method& method) {
  Motion& m = motion_.emplace();
  m.unit = method;
  const std::size_t f = static_cast<std::size_t>(fleet_.freedom());
  for (int j = 0; j < method.step.known; ++j) m.pdd[j].assign(f, 0.0);
  for (std::vector<double>* x : {&m.p, &m.pd}) x->assign(f, 0.0);
  if (beam_ == nullptr) return;
  m.beam.emplace(*beam_, *operator_, input_.self_weight ? dead_load_.data() : nullptr);
  m.beam->prepare(method.step.known);
  if (rest_tolerance_ == 0.0 || !m.beam->fused()) return;
  if (input_.self_weight) {
    rest_ = dead_load_;
    release_held(rest_.data());
    operator_->solve_static(rest_.data());
  }
  m.window.emplace(*beam_, *operator_, rest_tolerance_, watched_, rest_.empty() ? nullptr : rest_.data());
}

// The columns of the elements under wheels and forces during a step: [first, past); equal: none.
std::pair<int, int> System::loaded_columns(double t, double h) const {
  const beam::Mesh& mesh = line_->mesh;
  int low = beam_->columns(), high = 0;
  const auto add = [&](double from, double to) {
    if (std::max(from, to) < mesh.start() || std::min(from, to) > mesh.end()) return;
    const int first = mesh.element(mesh.locate(std::min(from, to), true).element).left;
    const int last = mesh.element(mesh.locate(std::max(from, to)).element).left;
    low = std::min(low, line_->first_column + std::max(0, first - 1));
    high = std::max(high, line_->first_column + std::min(mesh.nodes(), last + 3));
  };
  for (const WheelContact& c : fleet_.wheels) {
    if (c.is_further) continue;
    const double x = fleet_.coordinates(c).x(), reach = fleet_.velocities(c).x() * h;
    const double width = 0.1 * fleet_.wheel(c).radius;  // a wheel touches beside its centre
    add(std::min(x, x + 2.0 * reach) - width, std::max(x, x + 2.0 * reach) + width);
  }
  for (double x : input_.load.positions) add(x + input_.load.speed * t, x + input_.load.speed * (t + h));
  return {low, std::max(low, high)};
}

void System::restart_motion(double t, double* y) {
  Motion& m = *motion_;
  if (m.stepped) settle_dissipation(y + n_);
  m.rate.resize(static_cast<std::size_t>(local_size()));
  rate(t, y, m.rate.data(), Part::all);
  if (beam_ != nullptr) std::copy_n(m.rate.data() + n_, n_, m.beam->acceleration(0));
  const int f = fleet_.freedom();
  m.p.assign(p_.begin(), p_.begin() + f);
  m.pd.assign(p_.begin() + f, p_.end());
  m.pdd[0] = pdd_;
  m.powers[0] = {};
  if (beam_ != nullptr && !m.beam->fused()) m.powers[0].beam = beam_dissipation(y + n_);
  fleet_powers(m.powers[0]);
  if (!m.stepped) settle_dissipation(y + n_);
  m.stepped = false;
  if (m.window) {
    const auto [low, high] = loaded_columns(t, 0.0);
    m.window->begin(*m.beam, y, y + n_, low, high);
  }
}

// The last step's share of D that waits for the state at its end.
void System::settle_dissipation(const double* w) {
  motion_->dissipated += pending_dissipation(w);
  motion_->pending = {};
}

double System::pending_dissipation(const double* w) {
  const Motion& m = *motion_;
  if (m.pending.power == 0.0 || !operator_->damped()) return 0.0;
  const double* a = end_acceleration();
  operator_->multiply(1.0, nullptr, w, nullptr, work_.data());
  double sum = 0.0;
  for (int i = 0; i < n_; ++i) sum += (m.pending.power * w[i] + 2.0 * m.pending.rate * a[i]) * work_[i];
  return sum;
}

// Of the beam, where the last step led to or a restart began.
const double* System::end_acceleration() const {
  const Motion& m = *motion_;
  const int known = m.unit.step.known;
  return m.beam->acceleration(m.stepped && last(m.unit.step.a_next, known) != 1.0 ? known - 1 : 0);
}

void System::rate_of_motion(const double* y, double* ydot) const {
  const Motion& m = *motion_;
  const int f = fleet_.freedom();
  std::fill_n(ydot, local_size(), 0.0);
  const int j = m.stepped ? m.unit.step.known - 1 : 0;
  if (m.beam) {
    std::copy_n(y + n_, n_, ydot);
    std::copy_n(end_acceleration(), n_, ydot + n_);
  }
  if (rank_ != 0) return;
  std::copy(m.pd.begin(), m.pd.end(), ydot + 2 * n_);
  std::copy(m.pdd[j].begin(), m.pdd[j].end(), ydot + 2 * n_ + f);
}

void System::take_back_step(double* y) {
  Motion& m = *motion_;
  m.dissipated = m.before.dissipated;
  m.worked = m.before.worked;
  m.pending = m.before.pending;
  m.stepped = false;
  std::copy(m.before.v.begin(), m.before.v.end(), y + m.before.first);
  std::copy(m.before.w.begin(), m.before.w.end(), y + n_ + m.before.first);
  std::copy(m.before.p.begin(), m.before.p.end(), y + 2 * n_);
}

bool System::step_motion(double t, double h, double* y) {
  Motion& m = *motion_;
  if (h != m.length) {
    m.method = m.unit;
    m.method.scale_to(h);
    m.length = h;
  }
  if (m.window) {
    const StageRule& rule = m.method.stages.front();
    const auto [low, high] = loaded_columns(t, h);
    m.window->open(*m.beam, low, high, compliance_->reach(rule.rate / rule.displacement, 1.0 / rule.displacement));
  }
  m.before.dissipated = m.dissipated;
  m.before.worked = m.worked;
  m.before.pending = m.pending;
  if (keep_steps_) {
    m.before.first = m.window ? operator_->block() * m.beam->first() : 0;
    m.before.past = m.window ? operator_->block() * m.beam->past() : n_;
    m.before.v.assign(y + m.before.first, y + m.before.past);
    m.before.w.assign(y + n_ + m.before.first, y + n_ + m.before.past);
    m.before.p.assign(y + 2 * n_, y + local_size());
  }
  double* v = y;
  double* w = y + n_;
  moving_loads(t);
  list_nodal_loads();
  m.powers[0].loads = 0.0;
  for (const NodalLoad& load : nodal_loads_) m.powers[0].loads += load.force * w[load.unknown];
  for (const StageRule& rule : m.method.stages)
    if (!stage_of_motion(t + rule.time, rule, v, w)) return false;
  finish_step(y);
  return true;
}

bool System::stage_of_motion(double t, const StageRule& rule, const double* v, const double* w) {
  Motion& m = *motion_;
  const int f = fleet_.freedom();
  const double shift = rule.rate / rule.displacement, shift2 = 1.0 / rule.displacement;
  p_still_.resize(f);
  pd_still_.resize(f);
  x_.resize(f);
  for (int i = 0; i < f; ++i) {
    p_still_[i] = m.p[i] + rule.w_in_v * m.pd[i];
    pd_still_[i] = m.pd[i];
    for (int j = 0; j < rule.known; ++j) {
      p_still_[i] += rule.a_in_v[j] * m.pdd[j][i];
      pd_still_[i] += rule.a_in_w[j] * m.pdd[j][i];
    }
    x_[i] = rule.displacement * m.pdd[rule.known - 1][i];
  }
  Motion::Powers& powers = m.powers[rule.known];
  powers = {};
  if (beam_ == nullptr) {
    loads_.clear();
    nodal_loads_.clear();
    if (!stage_of_fleet({t, shift, shift2}, NoBeam(), nullptr)) return false;
  } else if (m.beam->fused()) {
    moving_loads(t);
    list_nodal_loads();
    m.beam->solve(rule, v, w, nodal_loads_);
    if (rule.known == 1) m.beam_dissipation = m.beam->dissipation();
    if (!stage_of_fleet({t, shift, shift2}, FusedResponse(*m.beam, rule, v, w), nullptr)) return false;
    add_contact_response(shift2, m.beam->acceleration(rule.known));
  } else {
    m.beam->still(rule, v, w, v_still_.data(), w_still_.data());
    if (nonlinear_) nonlinear_->begin(shift, v_still_.data(), w_still_.data(), w);
    load_of_stills(t);
    if (solve_coupled({t, shift, shift2}, Part::all, true) != Solution::found) return false;
    double* a = m.beam->acceleration(rule.known);
    for (int i = 0; i < n_; ++i) a[i] = shift2 * nodal_[i];
    for (int i = 0; i < n_; ++i) w_still_[i] += rule.rate * a[i];
    powers.beam = beam_dissipation(w_still_.data());
    list_nodal_loads();
  }
  for (const NodalLoad& load : nodal_loads_)
    powers.loads += load.force * m.beam->state(rule, v, w, load.unknown).second;
  for (int i = 0; i < f; ++i) m.pdd[rule.known][i] = shift2 * x_[i];
  fleet_powers(powers);
  return true;
}

void System::finish_step(double* y) {
  Motion& m = *motion_;
  const StepRule& rule = m.method.step;
  const int f = fleet_.freedom();
  for (int i = 0; i < f; ++i) {
    m.p[i] += rule.w_in_v * m.pd[i];
    for (int j = 0; j < rule.known; ++j) {
      m.p[i] += rule.a_in_v[j] * m.pdd[j][i];
      m.pd[i] += rule.a_in_w[j] * m.pdd[j][i];
    }
    double next = 0.0;
    for (int j = 0; j < rule.known; ++j) next += rule.a_next[j] * m.pdd[j][i];
    m.pdd[0][i] = next;
  }
  double dissipation = 0.0, work = 0.0;
  if (m.beam && m.beam->fused()) {  // the trapezoidal rule with its correction by the rates: order 4
    const double half = 0.5 * m.length, twelfth = m.length * m.length / 12.0;
    m.dissipated += (m.pending.power + half) * m.beam_dissipation.power;
    m.dissipated += (m.pending.rate + twelfth) * m.beam_dissipation.rate;
    m.pending = {half, -twelfth};
  }
  for (int j = 0; j < rule.known; ++j) {
    const Motion::Powers& powers = m.powers[j];
    m.dissipated += rule.power[j] * powers.beam;
    m.worked += rule.power[j] * powers.loads;
    dissipation += rule.power[j] * powers.dissipation;
    work += rule.power[j] * powers.work;
  }
  m.powers[0] = m.powers[rule.known - 1];
  m.stepped = true;
  if (beam_ != nullptr) m.beam->finish(rule, y, y + n_);
  if (m.window) m.window->close(*m.beam, y, y + n_);
  if (rank_ != 0) return;
  double* p = y + 2 * n_;
  std::copy(m.p.begin(), m.p.end(), p);
  std::copy(m.pd.begin(), m.pd.end(), p + f);
  p[2 * f] += dissipation;
  p[2 * f + 1] += work;
}

}  // namespace traverse::coupling
