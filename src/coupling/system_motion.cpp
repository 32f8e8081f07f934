// The system stepped in second-order form (motion.hpp): one beam solve a stage, made while its right-hand side is
// written, and Newton on vehicles and contacts.
#include <algorithm>
#include <cmath>

#include "traverse/beam/shape.hpp"
#include "traverse/coupling/system.hpp"

namespace traverse::coupling {
namespace {

constexpr double same_position = 1e-9;  // m or rad: a step's last stage is its end
constexpr double measured_steps = 2.0;  // of one stage, from one look at the beam's dissipation to the next

/// Free response of a fused stage, whose vectors v and w are never formed.
struct FusedResponse final : FreeResponse {
  const BeamMotion& beam;
  std::size_t stage;
  const double *v, *w;
  FusedResponse(const BeamMotion& b, std::size_t s, const double* v_n, const double* w_n)
      : beam(b), stage(s), v(v_n), w(w_n) {}
  std::pair<double, double> at(int unknown) const override { return beam.state(stage, v, w, unknown); }
};

struct NoBeam final : FreeResponse {
  std::pair<double, double> at(int) const override { return {}; }
};

}  // namespace

void System::leave_out_rest(double tolerance, const std::vector<double>& probes) {
  if (beam_ == nullptr) return;
  rest_tolerance_ = tolerance;
  watched_.clear();
  for (double x : probes)
    watched_.push_back(beam_->bridge().first_column + beam_->mesh().element(beam_->mesh().locate(x).element).left);
}

void System::begin_motion(const Method& method) {
  Motion& m = motion_.emplace();
  m.unit = method;
  const std::size_t f = static_cast<std::size_t>(fleet_.freedom());
  for (int j = 0; j < method.step.known; ++j) m.pdd[j].assign(f, 0.0);
  for (std::vector<double>* x : {&m.p, &m.pd}) x->assign(f, 0.0);
  share_.deal(comm_, fleet_);
  if (beam_ == nullptr) return;
  m.beam.emplace(*beam_, *operator_, input_.self_weight ? dead_load_.data() : nullptr);
  m.beam->begin(method);
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
  if (low >= high) return {0, 0};
  if (operator_->parts() != nullptr) {
    const std::vector<int>& parts = beam_->parts();
    const auto part_of = [&](int column) { return std::upper_bound(parts.begin(), parts.end(), column) - 1; };
    low = *part_of(low);
    high = part_of(high - 1)[1];
  }
  return {low, high};
}

// What the stages of the coming step are solved for, and what moves freely during it.
void System::set_ranges(double t, double h) {
  Motion& m = *motion_;
  const auto [low, high] = loaded_columns(t, h);
  const auto local = [&](int column) { return std::clamp(column - beam_->first_column(), 0, beam_->local_columns()); };
  const bool parts = operator_->parts() != nullptr;
  int first = 0, past = beam_->columns();
  if (m.window) {
    const StageRule& rule = m.method.stages.front();
    m.window->open(low, high, compliance_->reach(rule.rate / rule.displacement, 1.0 / rule.displacement));
    first = m.window->first();
    past = m.window->past();
  }
  m.free = {};
  if (parts && m.measures_errors) {  // a step is judged by all that moves
    m.beam->set_range(local(first), local(past));
  } else if (parts) {
    m.free = {{{local(first), local(low < high ? low : past)}, {local(low < high ? high : past), local(past)}}};
    m.beam->set_range(local(low), local(high));
  } else if (m.window) {
    m.beam->set_range(local(first), local(past));
  }
}

void System::complete_step(double* y) {
  Motion& m = *motion_;
  if (!m.incomplete) return;
  m.incomplete = false;
  if (!m.beam || !m.beam->fused()) return;
  BeamMotion::Dissipation dissipation = m.beam->dissipation();
  for (const auto& [first, past] : m.free) m.beam->step_free(first, past, y, y + n_, dissipation);
  if (m.measuring) {
    add_dissipation(dissipation);
    m.measuring = m.to_measure = false;
  }
  m.unmeasured += m.length;
  if (m.window) m.window->close(*m.beam, y, y + n_);
}

// D until a state whose dissipation is known: the trapezoidal rule with its correction by the rates, of order 4.
double System::dissipated_until(const BeamMotion::Dissipation& now) const {
  const Motion& m = *motion_;
  return m.dissipated + 0.5 * m.unmeasured * (m.measured.power + now.power) +
         m.unmeasured * m.unmeasured / 12.0 * (m.measured.rate - now.rate);
}

void System::add_dissipation(const BeamMotion::Dissipation& now) {
  motion_->dissipated = dissipated_until(now);
  motion_->measured = now;
  motion_->unmeasured = 0.0;
}

BeamMotion::Dissipation System::measure_dissipation(const double* w) {
  BeamMotion::Dissipation d;
  if (!operator_->damped()) return d;
  operator_->multiply(1.0, nullptr, w, nullptr, work_.data());
  const double* a = motion_->beam->start_acceleration();
  for (int i = 0; i < n_; ++i) {
    d.power += w[i] * work_[i];
    d.rate += 2.0 * a[i] * work_[i];
  }
  return d;
}

void System::restart_motion(double t, double* y) {
  Motion& m = *motion_;
  const bool fused = m.beam && m.beam->fused();
  if (fused && m.stepped) add_dissipation(measure_dissipation(y + n_));
  m.rate.resize(static_cast<std::size_t>(local_size()));
  rate(t, y, m.rate.data(), Part::all);
  if (beam_ != nullptr) std::copy_n(m.rate.data() + n_, n_, m.beam->start_acceleration());
  const int f = fleet_.freedom();
  m.p.assign(p_.begin(), p_.begin() + f);
  m.pd.assign(p_.begin() + f, p_.end());
  m.pdd[0] = pdd_;
  m.powers[0] = {};
  if (beam_ != nullptr && !m.beam->fused()) m.powers[0].beam = beam_dissipation(y + n_);
  fleet_powers(m.powers[0]);
  if (fused && m.unmeasured > 0.0) add_dissipation(measure_dissipation(y + n_));
  m.to_measure = true;
  m.stepped = false;
  if (m.window) {
    const auto [low, high] = loaded_columns(t, 0.0);
    m.window->begin(*m.beam, y, y + n_, low, high);
  }
}

void System::rate_of_motion(const double* y, double* ydot) const {
  const Motion& m = *motion_;
  std::fill_n(ydot, local_size(), 0.0);
  if (m.beam) {
    std::copy_n(y + n_, n_, ydot);
    std::copy_n(m.beam->start_acceleration(), n_, ydot + n_);
  }
  if (rank_ != 0) return;
  double* pdd = std::copy(m.pd.begin(), m.pd.end(), ydot + 2 * n_);
  std::copy(m.pdd[0].begin(), m.pdd[0].end(), pdd);
}

void System::take_back_step(double* y) {
  Motion& m = *motion_;
  m.dissipated = m.before.dissipated;
  m.worked = m.before.worked;
  m.stepped = m.incomplete = false;
  std::copy(m.before.v.begin(), m.before.v.end(), y + m.before.first);
  std::copy(m.before.w.begin(), m.before.w.end(), y + n_ + m.before.first);
  std::copy(m.before.p.begin(), m.before.p.end(), y + 2 * n_);
}

bool System::step_motion(double t, double h, double* y, const std::function<bool()>& good_enough) {
  Motion& m = *motion_;
  if (h != m.length) {
    m.method = m.unit;
    m.method.scale_to(h);
    m.length = h;
    if (m.beam) m.beam->begin(m.method);
  }
  if (m.beam && m.beam->fused()) {
    set_ranges(t, h);
    const double interval = m.method.stages.size() == 1 ? measured_steps * h : 0.0;
    m.measuring = operator_->damped() && (m.to_measure || m.unmeasured > 0.999 * interval);
    m.beam->measure(m.measuring);
  }
  m.before.dissipated = m.dissipated;
  m.before.worked = m.worked;
  if (keep_steps_) {
    const bool range = m.beam && m.beam->fused();
    m.before.first = range ? 2 * m.beam->first() : 0;
    m.before.past = range ? 2 * m.beam->past() : n_;
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
  if (good_enough && !good_enough()) return false;
  finish_step(y);
  return true;
}

bool System::stage_of_motion(double t, const StageRule& rule, const double* v, const double* w) {
  Motion& m = *motion_;
  const double shift = rule.rate / rule.displacement, shift2 = 1.0 / rule.displacement;
  for (std::vector<double>* x : {&p_still_, &pd_still_, &x_}) x->resize(m.p.size());
  const auto [first, past] = fleet_.own_coordinates();
  for (int i = first; i < past; ++i) {
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
  const std::size_t stage = static_cast<std::size_t>(rule.known) - 1;
  if (beam_ == nullptr) {
    loads_.clear();
    nodal_loads_.clear();
    if (!stage_of_fleet({t, shift, shift2}, NoBeam(), nullptr)) return false;
  } else if (m.beam->fused()) {
    moving_loads(t);
    list_nodal_loads();
    m.beam->solve(stage, v, w, nodal_loads_);
    if (!stage_of_fleet({t, shift, shift2}, FusedResponse(*m.beam, stage, v, w), nullptr)) return false;
    add_contact_response(shift2, m.beam->kept(stage));
  } else {
    m.beam->still(stage, v, w, v_still_.data(), w_still_.data());
    if (nonlinear_) nonlinear_->begin(shift, v_still_.data(), w_still_.data(), w);
    load_of_stills(t);
    if (solve_coupled({t, shift, shift2}, Part::all, true) != Solution::found) return false;
    double* a = m.beam->kept(stage);
    for (int i = 0; i < n_; ++i) a[i] = shift2 * nodal_[i];
    for (int i = 0; i < n_; ++i) w_still_[i] += rule.rate * a[i];
    powers.beam = beam_dissipation(w_still_.data());
    list_nodal_loads();
  }
  for (const NodalLoad& load : nodal_loads_)
    powers.loads += load.force * m.beam->state(stage, v, w, load.unknown).second;
  for (int i = first; i < past; ++i) m.pdd[rule.known][i] = shift2 * x_[i];
  fleet_powers(powers);
  return true;
}

void System::finish_step(double* y) {
  Motion& m = *motion_;
  const StepRule& rule = m.method.step;
  const auto [first, past] = fleet_.own_coordinates();
  signs_ = fleet_.worn() ? VehicleShare::worn : 0U;
  for (int i = first; i < past; ++i) {
    m.p[i] += rule.w_in_v * m.pd[i];
    for (int j = 0; j < rule.known; ++j) {
      m.p[i] += rule.a_in_v[j] * m.pdd[j][i];
      m.pd[i] += rule.a_in_w[j] * m.pdd[j][i];
    }
    double next = 0.0;
    for (int j = 0; j < rule.known; ++j) next += rule.a_next[j] * m.pdd[j][i];
    m.pdd[0][i] = next;
    if (std::abs(m.p[i] - p_[i]) > same_position) signs_ |= VehicleShare::moved;
  }
  const bool counts = share_.dealt() || rank_ == 0;  // of vehicles and contacts
  for (int j = 0; j < rule.known; ++j) {
    const Motion::Powers& powers = m.powers[j];
    m.dissipated += rule.power[j] * (powers.beam + (counts ? powers.dissipation : 0.0));
    m.worked += rule.power[j] * (powers.loads + (counts ? powers.work : 0.0));
  }
  m.powers[0] = m.powers[rule.known - 1];
  m.stepped = m.incomplete = true;
  if (beam_ != nullptr) m.beam->finish(y, y + n_);
  share_step();
  if (rank_ != 0) return;
  double* p = y + 2 * n_;
  std::copy(m.p.begin(), m.p.end(), p);
  std::copy(m.pd.begin(), m.pd.end(), p + m.p.size());
}

// p, p' and p'' at the end of the step, of all vehicles.
void System::share_step() {
  Motion& m = *motion_;
  const auto freedom = [this](int k) { return fleet_.vehicles[k].mechanism.freedom(); };
  const std::array<std::vector<double>*, 3> all = {&m.p, &m.pd, &m.pdd[0]};
  signs_ = share_.exchange(
      signs_, [&](int k) { return 3 * freedom(k); },
      [&](int k, double* to) {
        for (const std::vector<double>* x : all)
          to = std::copy_n(x->begin() + fleet_.vehicles[k].offset, freedom(k), to);
      },
      [&](int k, const double* from) {
        for (std::vector<double>* x : all) {
          std::copy_n(from, freedom(k), x->begin() + fleet_.vehicles[k].offset);
          from += freedom(k);
        }
      });
}

}  // namespace traverse::coupling
