// Steps in second-order form (one_step_methods.hpp): stages of the structure, and Newton's method for vehicles and
// contacts.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "coupling/system.hpp"
#include "engine/linear_trains.hpp"

namespace traverse::coupling {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double same_position = 1e-9;  // m or rad: the last stage is at the end of the step
constexpr double same_length = 1e-10;   // relative difference of lengths of steps whose ends are rounded

}  // namespace

void System::begin_motion(const base::Method& method) {
  motion_ = std::make_unique<Motion>();
  Motion& m = *motion_;
  m.unit = method;
  const std::size_t f = static_cast<std::size_t>(fleet_.freedom());
  for (int j = 0; j < method.step.known; ++j) m.pdd[j].assign(f, 0.0);
  for (std::vector<double>* x : {&m.p, &m.pd}) x->assign(f, 0.0);
  make_linear_train();
  if (!trains_) share_.distribute(comm_, fleet_);
}

// If vehicles are linear with plain contacts, every rank computes all of them: messages would cost more time.
void System::make_linear_train() {
  trains_.reset();
  if (structure_ && structure_->support_motion() != nullptr) return;
  const int own = static_cast<int>(engine::best_target());
  int bounds[2] = {own, -own};  // all ranks must compute the same to the last bit
  MPI_Allreduce(MPI_IN_PLACE, bounds, 2, MPI_INT, MPI_MAX, comm_);
  if (bounds[0] != -bounds[1] || !engine::LinearTrain::obstacle(fleet_).empty()) return;
  std::vector<std::size_t> first{0};
  const bool apart = sharing_ || (input_.only_on_bridge && line_ != nullptr);
  for (const train::Course& course : input_.train.courses)
    if (apart && course.first > 0) first.push_back(static_cast<std::size_t>(fleet_.members[course.first].unit));
  trains_ = std::make_unique<engine::LinearTrains>(fleet_, first, line_ != nullptr ? &line_->mesh : nullptr, per_node(),
                                                   surface_height());
  if (!input_.only_on_bridge || line_ == nullptr || trains_->count() != first.size()) return;
  trains_->presence() = presence_on_bridge();
  for (const train::WheelContact& c : fleet_.wheels) wheels_at_start_.push_back(fleet_.coordinates(c).x());
}

// Places the wheels of trains that are computed from t on, before `end`: they have not been moved since the start.
void System::place_entering(double t, double end) {
  if (wheels_at_start_.empty() || !trains_->enters(t, end)) return;
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    if (!trains_->is_present(c.vehicle) && trains_->presence()[trains_->train_of(c.vehicle)].overlaps({t, end}))
      fleet_.x(c) = wheels_at_start_[i] + law_of_wheel(static_cast<int>(i)).distance(t);
  }
}

// From when to when each train's wheels may touch the line, at t = 0. Trains on a rough track, and those whose speed
// changes, move beside the bridge too.
std::vector<base::Interval> System::presence_on_bridge() const {
  std::vector<base::Interval> presence(trains_->count(), {infinite, -infinite});
  for (std::size_t i = 0; i < fleet_.wheels.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    base::Interval& of_train = presence[trains_->train_of(c.vehicle)];
    const base::SpeedLaw law = law_of_wheel(static_cast<int>(i));
    const double x = fleet_.coordinates(c).x(), reach = fleet_.reach(c);
    const std::array times = {law.time_of(line_->mesh.start() - reach - x), law.time_of(line_->mesh.end() + reach - x)};
    const auto [enters, leaves] = std::minmax(times[0], times[1]);
    const bool steady =
        fleet_.profile(c).level() && is_driven(static_cast<int>(i)) && law.constant() && law.direction() != 0.0;
    of_train.from = steady ? std::min(of_train.from, enters) : -infinite;
    of_train.to = steady ? std::max(of_train.to, leaves) : infinite;
  }
  return presence;
}

// The reaches of wheels and forces during a step.
const std::vector<structure::Reach>& System::loaded(double t, double h) {
  reaches_.clear();
  const auto add = [&](double from, double to, double width) {
    reaches_.push_back({std::min(from, to) - width, std::max(from, to) + width});
  };
  for (const train::WheelContact& c : fleet_.wheels) {
    if (c.is_further || (trains_ && !trains_->moves(c.vehicle))) continue;
    const double x = fleet_.coordinates(c).x(), travel = fleet_.velocities(c).x() * h;
    add(x, x + 2.0 * travel, fleet_.reach(c));  // a wheel may touch beside its centre
  }
  for (std::size_t i = 0; i < input_.load.positions.size(); ++i)
    add(train::place_of(input_.load, i, t), train::place_of(input_.load, i, t + h),
        0.5 * train::length_of(input_.load, i));
  for (const auto& [x, force] : applied_) add(x, x, 0.0);
  if (structure_ && structure_->support_motion() != nullptr) add(line_->mesh.start(), line_->mesh.end(), 0.0);
  return reaches_;
}

void System::restart_motion(double t, double h, double* y) {
  Motion& m = *motion_;
  if (is_shared()) recall(y);
  if (!is_length(h)) set_step(h);
  m.rate.resize(static_cast<std::size_t>(local_size()));
  rate(t, y, m.rate.data());
  const int f = fleet_.freedom();
  m.p.assign(p_.begin(), p_.begin() + f);
  m.pd.assign(p_.begin() + f, p_.end());
  m.pdd[0] = pdd_;
  m.powers.at[0] = fleet_powers();
  if (trains_) trains_->restart(fleet_, m.p.data(), m.pd.data(), m.pdd[0].data());
  if (structure_) structure_->restart(loaded(t, 0.0), y, y + n_, m.rate.data() + n_);
}

bool System::is_length(double h) const { return std::abs(h - motion_->length) <= same_length * motion_->length; }

void System::reject_step(double* y) {
  Motion& m = *motion_;
  if (is_shared()) recall(y, true);
  m.powers.sum = m.powers.before;
  if (structure_) structure_->reject_step(y, y + n_);
  std::copy(m.before.begin(), m.before.end(), y + 2 * n_);
}

void System::set_step(double h) {
  Motion& m = *motion_;
  m.method = m.unit;
  m.method.scale_to(h);
  m.length = h;
  if (trains_) trains_->set_method(m.method, h);
  if (structure_) structure_->set_method(m.method, h);
}

bool System::step_motion(double t, double h, double* y, const std::function<bool()>& good_enough) {
  Motion& m = *motion_;
  if (sharing_) begin_shared_step(t, h, y);
  if (trains_) {
    place_entering(t, t + h);
    trains_->set_present(t, t + h);
  }
  if (!is_length(h)) set_step(h);
  m.powers.before = m.powers.sum;
  if (store_steps_) m.before.assign(y + 2 * n_, y + local_size());
  bool solved = trains_ && solve_by_passes(t, y);
  if (is_shared() && !receive_trains(solved)) {
    recall(y, true);
    restart_motion(t, h, y);
    return step_motion(t, h, y, good_enough);  // all trains on this rank
  }
  if (trains_ && !solved) evaluate_fleet(t, y);
  if (!solved && !solve_stages(t, y, y + n_)) return false;
  if (good_enough && !good_enough()) return false;
  finish_step(y);
  if (by_passes_) {  // the state that the fleet's contacts have
    evaluated_time_ = t + h;
    is_evaluated_ = false;
  }
  return true;
}

// Solves all stages of a step from t by passes over the contacts of linear vehicles.
bool System::solve_by_passes(double t, const double* y) {
  by_passes_ = true;
  trains_->begin_step();
  motion_->powers.at[0] = trains_->powers_at_start();
  by_passes_ = solve_stages(t, y, y + n_);
  return by_passes_;
}

// Solves all stages of a step from t.
bool System::solve_stages(double t, const double* v, const double* w) {
  Motion& m = *motion_;
  if (structure_) {
    load_structure(t);
    structure_->begin_step(loaded(t, m.length), v, w, store_steps_);
  }
  for (std::size_t i = 0; i < m.method.stages.size(); ++i)
    if (!stage_of_motion(t + m.method.stages[i].time, i, v, w)) return false;
  return true;
}

bool System::stage_of_motion(double t, std::size_t stage, const double* v, const double* w) {
  Motion& m = *motion_;
  const base::StageRule& rule = m.method.stages[stage];
  const double shift = rule.rate / rule.displacement, shift2 = 1.0 / rule.displacement;
  stage_ = stage;
  const auto [first, past] = fleet_.own_coordinates();
  if (!by_passes_) {
    for (std::vector<double>* x : {&p_predicted_, &pd_predicted_, &x_}) x->resize(m.p.size());
    for (int i = first; i < past; ++i) {
      std::tie(p_predicted_[i], pd_predicted_[i]) = base::advanced(rule, m.pdd, i, m.p[i], m.pd[i]);
      x_[i] = rule.displacement * m.pdd[rule.known - 1][i];
    }
  }
  if (structure_) {
    load_structure(t);
    structure_->begin_stage(stage, v, w);
  }
  if (solve_coupled({t, shift, shift2}) != Solution::found) return false;
  if (structure_) structure_->end_stage(stage, v, w);
  if (by_passes_) {
    trains_->accelerations(m.pdd[rule.known].data());
    m.powers.at[rule.known] = trains_->powers();
    return true;
  }
  for (int i = first; i < past; ++i) m.pdd[rule.known][i] = shift2 * x_[i];
  m.powers.at[rule.known] = fleet_powers();
  return true;
}

// The stage of solve_coupled by passes over all contacts, repeated until their forces no longer change.
bool System::stage_by_passes(const StageTime& at) {
  trains_->predict(fleet_, stage_, at.t);
  if (!trains_->place(fleet_)) return false;
  if (structure_) {
    const auto [field, own] = structure_->begin_passes(trains_->elements());
    trains_->set_contact_field(field, &own);
  }
  const auto respond = [&](double shift) {
    if (structure_) structure_->respond([this] { trains_->add_loads(); }, shift);
  };
  do {
    respond(0.0);
    if (!trains_->update_forces()) return false;
  } while (!trains_->converged());
  respond(stage_ + 1 == motion_->method.stages.size() ? at.shift : 0.0);  // the last stage also needs rates
  trains_->end_stage();
  return true;
}

void System::finish_step(double* y) {
  Motion& m = *motion_;
  const base::StepRule& rule = m.method.step;
  const auto [first, past] = fleet_.own_coordinates();
  flags_ = by_passes_ || !fleet_.badly_conditioned() ? 0U : train::VehicleShare::badly_conditioned;
  for (int i = first; !by_passes_ && i < past; ++i) {
    std::tie(m.p[i], m.pd[i]) = base::advanced(rule, m.pdd, i, m.p[i], m.pd[i]);
    m.pdd[0][i] = base::combined(rule.a_next, rule.known, m.pdd, i);
    if (std::abs(m.p[i] - p_[i]) > same_position) flags_ |= train::VehicleShare::moved;
  }
  if (share_.distributed() || rank_ == 0) m.powers.add(rule);  // otherwise another rank adds vehicles and contacts
  m.powers.at[0] = m.powers.at[rule.known - 1];
  if (structure_) structure_->finish_step(y, y + n_);
  if (by_passes_)
    finish_passes();
  else
    share_step();
  if (trains_ && !by_passes_) trains_->restart(fleet_, m.p.data(), m.pd.data(), m.pdd[0].data());
  if (rank_ != 0) return;
  double* p = y + 2 * n_;
  std::copy(m.p.begin(), m.p.end(), p);
  std::copy(m.pd.begin(), m.pd.end(), p + m.p.size());
}

// Copies the positions and contacts that contact events need to the fleet.
void System::finish_passes() {
  Motion& m = *motion_;
  trains_->finish_step();
  trains_->state(m.p.data(), m.pd.data(), m.pdd[0].data());
  trains_->copy_contacts_to(fleet_);
  std::copy(m.p.begin(), m.p.end(), p_.begin());
  if (!trains_->ends_with_stage()) flags_ |= train::VehicleShare::moved;
}

// Exchanges p, p' and p'' of all vehicles at the end of the step.
void System::share_step() {
  Motion& m = *motion_;
  const auto freedom = [this](int k) { return fleet_.vehicles[k].freedom(); };
  const std::array<std::vector<double>*, 3> all = {&m.p, &m.pd, &m.pdd[0]};
  flags_ = share_.exchange(
      flags_, [&](int k) { return 3 * freedom(k); },
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
