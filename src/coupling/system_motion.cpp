// The system stepped in second-order form (one_step_methods.hpp): stages of the structure, and Newton on vehicles and
// contacts.
#include <algorithm>
#include <cmath>

#include "coupling/system.hpp"

namespace traverse::coupling {
namespace {

constexpr double same_position = 1e-9;  // m or rad: a step's last stage is its end
constexpr double same_length = 1e-10;   // relative, of steps whose ends are rounded

}  // namespace

void System::begin_motion(const structure::Method& method) {
  motion_ = std::make_unique<Motion>();
  Motion& m = *motion_;
  m.unit = method;
  const std::size_t f = static_cast<std::size_t>(fleet_.freedom());
  for (int j = 0; j < method.step.known; ++j) m.pdd[j].assign(f, 0.0);
  for (std::vector<double>* x : {&m.p, &m.pd}) x->assign(f, 0.0);
  if (!apart_) share_.deal(comm_, fleet_);
  if (structure_) structure_->begin_motion(method);
}

// Where wheels and forces are during a step.
const std::vector<structure::Reach>& System::loaded(double t, double h) {
  reaches_.clear();
  const auto add = [&](double from, double to, double width) {
    reaches_.push_back({std::min(from, to) - width, std::max(from, to) + width});
  };
  for (const train::WheelContact& c : fleet_.wheels) {
    if (c.is_further) continue;
    const double x = fleet_.coordinates(c).x(), way = fleet_.velocities(c).x() * h;
    add(x, x + 2.0 * way, fleet_.reach(c));  // a wheel touches beside its centre
  }
  for (std::size_t i = 0; i < input_.load.positions.size(); ++i)
    add(train::place_of(input_.load, i, t), train::place_of(input_.load, i, t + h), 0.0);
  for (const auto& [x, force] : applied_) add(x, x, 0.0);
  return reaches_;
}

void System::restart_motion(double t, double* y) {
  if (apart_) return;
  Motion& m = *motion_;
  m.rate.resize(static_cast<std::size_t>(local_size()));
  rate(t, y, m.rate.data(), Terms::all);
  const int f = fleet_.freedom();
  m.p.assign(p_.begin(), p_.begin() + f);
  m.pd.assign(p_.begin() + f, p_.end());
  m.pdd[0] = pdd_;
  m.powers[0] = fleet_powers();
  if (structure_) structure_->restart(loaded(t, 0.0), y, y + n_, m.rate.data() + n_);
}

void System::rate_of_motion(const double* y, double* ydot) const {
  const Motion& m = *motion_;
  std::fill_n(ydot, local_size(), 0.0);
  if (structure_) {
    std::copy_n(y + n_, n_, ydot);
    std::copy_n(structure_->acceleration(), n_, ydot + n_);
  }
  if (rank_ != 0) return;
  double* pdd = std::copy(m.pd.begin(), m.pd.end(), ydot + 2 * n_);
  std::copy(m.pdd[0].begin(), m.pdd[0].end(), pdd);
}

void System::take_back_step(double* y) {
  Motion& m = *motion_;
  m.dissipated = m.before.dissipated;
  m.worked = m.before.worked;
  if (structure_) structure_->take_back_step(y, y + n_);
  std::copy(m.before.p.begin(), m.before.p.end(), y + 2 * n_);
}

void System::set_step(double h) {
  Motion& m = *motion_;
  m.method = m.unit;
  m.method.scale_to(h);
  m.length = h;
  if (structure_) structure_->set_method(m.method, h);
}

bool System::step_motion(double t, double h, double* y, const std::function<bool()>& good_enough) {
  if (apart_) return true;  // try_apart has taken it
  Motion& m = *motion_;
  if (std::abs(h - m.length) > same_length * m.length) set_step(h);
  m.before.dissipated = m.dissipated;
  m.before.worked = m.worked;
  if (keep_steps_) m.before.p.assign(y + 2 * n_, y + local_size());
  if (structure_) {
    load_structure(t);
    structure_->begin_step(loaded(t, h), y, y + n_, keep_steps_);
  }
  for (std::size_t i = 0; i < m.method.stages.size(); ++i)
    if (!stage_of_motion(t + m.method.stages[i].time, i, y, y + n_)) return false;
  if (good_enough && !good_enough()) return false;
  finish_step(y);
  return true;
}

bool System::stage_of_motion(double t, std::size_t stage, const double* v, const double* w) {
  Motion& m = *motion_;
  const structure::StageRule& rule = m.method.stages[stage];
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
  if (structure_) {
    load_structure(t);
    structure_->begin_stage(stage, v, w);
  }
  if (solve_coupled({t, shift, shift2}, Terms::all) != Solution::found) return false;
  if (structure_) structure_->end_stage(stage, v, w);
  for (int i = first; i < past; ++i) m.pdd[rule.known][i] = shift2 * x_[i];
  m.powers[rule.known] = fleet_powers();
  return true;
}

void System::finish_step(double* y) {
  Motion& m = *motion_;
  const structure::StepRule& rule = m.method.step;
  const auto [first, past] = fleet_.own_coordinates();
  signs_ = fleet_.worn() ? train::VehicleShare::worn : 0U;
  for (int i = first; i < past; ++i) {
    m.p[i] += rule.w_in_v * m.pd[i];
    for (int j = 0; j < rule.known; ++j) {
      m.p[i] += rule.a_in_v[j] * m.pdd[j][i];
      m.pd[i] += rule.a_in_w[j] * m.pdd[j][i];
    }
    double next = 0.0;
    for (int j = 0; j < rule.known; ++j) next += rule.a_next[j] * m.pdd[j][i];
    m.pdd[0][i] = next;
    if (std::abs(m.p[i] - p_[i]) > same_position) signs_ |= train::VehicleShare::moved;
  }
  if (share_.dealt() || rank_ == 0) {  // else another rank counts the vehicles and contacts
    for (int j = 0; j < rule.known; ++j) {
      m.dissipated += rule.power[j] * m.powers[j].dissipation;
      m.worked += rule.power[j] * m.powers[j].work;
    }
  }
  m.powers[0] = m.powers[rule.known - 1];
  if (structure_) structure_->finish_step(y, y + n_);
  share_step();
  if (rank_ != 0) return;
  double* p = y + 2 * n_;
  std::copy(m.p.begin(), m.p.end(), p);
  std::copy(m.pd.begin(), m.pd.end(), p + m.p.size());
}

// p, p' and p'' at the end of the step, of all vehicles.
void System::share_step() {
  Motion& m = *motion_;
  const auto freedom = [this](int k) { return fleet_.vehicles[k].freedom(); };
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
