// Steps of the structure by elements, in second-order form (one_step_methods.hpp).
#include <algorithm>
#include <cmath>

#include "structure/element_structure.hpp"

namespace traverse::structure {
namespace {

constexpr double measured_steps = 2.0;  // time between computations of the dissipation, in steps of one stage

}  // namespace

void ElementStructure::begin_motion() {
  const bool has_dead_load = std::any_of(dead_load_.begin(), dead_load_.end(), [](double load) { return load != 0.0; });
  motion_.emplace(beam_, *statics_, has_dead_load ? dead_load_.data() : nullptr);
  if (window_tolerance_.elsewhere == 0.0 || !motion_->fused()) return;
  if (deformed_without_traffic()) static_displacements_ = displacements_without_traffic();
  std::vector<int> probe_columns;
  for (double x : window_probes_)
    probe_columns.push_back(beam_.bridge().first_column + beam_.mesh().element(beam_.mesh().locate(x).element).left);
  window_.emplace(beam_, *statics_, window_tolerance_, probe_columns,
                  static_displacements_.empty() ? nullptr : static_displacements_.data());
}

void ElementStructure::set_method(const base::Method& method, double h) {
  if (!motion_) begin_motion();
  method_ = method;
  length_ = h;
  motion_->begin(method);
}

// The columns of the elements in a reach, or of whole parts with them.
Range ElementStructure::columns_of(const Reach& reach) const {
  const beam::Mesh& mesh = line_.mesh;
  if (reach.to < mesh.start() || reach.from > mesh.end()) return {};
  const int left = mesh.element(mesh.locate(reach.from, true).element).left;
  const int right = mesh.element(mesh.locate(reach.to).element).left;
  const Range range{line_.first_column + std::max(0, left - 1), line_.first_column + std::min(mesh.nodes(), right + 3)};
  if (statics_->parts() == nullptr) return range;
  const std::vector<int>& parts = beam_.parts();
  const auto part_of = [&](int column) { return std::upper_bound(parts.begin(), parts.end(), column) - 1; };
  return {*part_of(range.first), part_of(range.past - 1)[1]};
}

void ElementStructure::set_to_rest(const std::vector<Range>& columns, double* v, double* w) {
  for (const Range& r : columns)
    motion_->set_to_rest(r.first, r.past, static_displacements_.empty() ? nullptr : static_displacements_.data(), v, w);
}

// The columns of the elements under wheels and forces. Loads less than a span apart share one range.
const std::vector<Range>& ElementStructure::find_loaded(const std::vector<Reach>& loaded) {
  const beam::Mesh& mesh = line_.mesh;
  reaches_.clear();
  for (const Reach& reach : loaded)
    if (reach.to >= mesh.start() && reach.from <= mesh.end()) reaches_.push_back(reach);
  std::sort(reaches_.begin(), reaches_.end(), [](const Reach& a, const Reach& b) { return a.from < b.from; });
  loaded_.clear();
  for (std::size_t i = 0; i < reaches_.size();) {
    Reach all = reaches_[i];
    for (++i; i < reaches_.size() && reaches_[i].from <= all.to + longest_span_; ++i)
      all.to = std::max(all.to, reaches_[i].to);
    loaded_.push_back(columns_of(all));
  }
  merge(loaded_);
  return loaded_;
}

int ElementStructure::local_node(int column) const {
  return std::clamp(column - beam_.first_column(), 0, beam_.local_columns());
}

/// Converts columns to nodes of this rank.
void ElementStructure::make_local(std::vector<Range>& columns) const {
  for (Range& r : columns) r = {local_node(r.first), local_node(r.past)};
}

// The active nodes of this rank.
const std::vector<Range>& ElementStructure::active_nodes() {
  if (window_) {
    active_ = window_->moving();
    make_local(active_);
  } else {
    active_.assign(1, {0, beam_.local_columns()});
  }
  return active_;
}

// Sets the ranges of the next step's stages, and the ranges that move freely during the step.
void ElementStructure::set_ranges(const std::vector<Reach>& loaded) {
  const bool by_parts = statics_->parts() != nullptr && motion_->proportional();
  if (!window_ && !by_parts) return;
  find_loaded(loaded);
  if (window_) {
    const base::StageRule& rule = method_.stages.front();
    window_->open(loaded_, compliance_.reach(rule.rate / rule.displacement, 1.0 / rule.displacement));
  }
  free_.clear();
  if (!by_parts || measures_errors_) {  // the error of a step includes all moving nodes
    motion_->set_ranges(active_nodes());
    return;
  }
  if (window_)
    active_ = window_->moving();
  else
    active_.assign(1, {0, beam_.columns()});
  subtract(active_, loaded_, free_);
  make_local(free_);
  make_local(loaded_);
  motion_->set_ranges(loaded_);
}

void ElementStructure::begin_step(const std::vector<Reach>& loaded, const double* v, const double* w, bool store) {
  if (fused()) {
    set_ranges(loaded);
    const double interval = method_.stages.size() == 1 && motion_->proportional() ? measured_steps * length_ : 0.0;
    measuring_ = measured_between_steps() && statics_->damped() && (to_measure_ || unmeasured_ > 0.999 * interval);
    motion_->measure(measuring_);
  }
  if (nonlinear_) update_loaded_range(loaded);
  powers_.before = powers_.sum;
  if (store) {
    before_.numbers.clear();
    before_.powers = powers_.at[0];
    before_.stepped = stepped_;
    const auto block = static_cast<std::ptrdiff_t>(statics_->block());
    for (const double* x : {v, w, const_cast<const double*>(motion_->start_acceleration())})
      for (const Range& r : motion_->ranges())
        before_.numbers.insert(before_.numbers.end(), x + block * r.first, x + block * r.past);
  }
  powers_.at[0].work = power_of_forces(w);
}

void ElementStructure::end_stage(std::size_t i, const double* v, const double* w) {
  Powers& powers = powers_.at[i + 1];
  powers = {};
  if (!fused()) {
    double* a = motion_->stored(i);
    for (int k = 0; k < n_; ++k) a[k] = stage_.shift2 * z_[k];
    for (int k = 0; k < n_; ++k) w_predicted_[k] += method_.stages[i].rate * a[k];
    powers.dissipation = dissipation(w_predicted_.data());
  } else if (!measured_between_steps() && statics_->damped()) {
    powers.dissipation = motion_->power(i, v, w);
  }
  for (const NodalLoad& force : driving_forces())
    powers.work += force.force * motion_->state(i, v, w, force.unknown).second;
}

void ElementStructure::finish_step(double* v, double* w) {
  const base::StepRule& rule = method_.step;
  powers_.add(rule);
  powers_.at[0] = powers_.at[rule.known - 1];
  stepped_ = incomplete_ = true;
  motion_->finish(v, w);
}

void ElementStructure::accept(double* v, double* w, const std::vector<Reach>& loaded) {
  if (!motion_ && nonlinear_) {
    nonlinear_->update_slip(v);
    update_loaded_range(loaded);
  }
  if (!incomplete_) return;
  incomplete_ = false;
  if (fused()) {
    BeamMotion::Dissipation dissipation = motion_->dissipation();
    for (const Range& r : free_) motion_->step_free(r.first, r.past, v, w, dissipation);
    if (measuring_) {
      add_dissipation(dissipation);
      measuring_ = to_measure_ = false;
    }
    unmeasured_ += length_;
  }
  if (nonlinear_) nonlinear_->update_slip(v);
  if (!window_) return;
  window_->close(*motion_, v, w);
  energy_left_ = window_->energy_left();
}

void ElementStructure::reject_step(double* v, double* w) {
  step_back(v, w);
  stepped_ = false;
}

void ElementStructure::step_back(double* v, double* w) {
  powers_.sum = powers_.before;
  powers_.at[0] = before_.powers;
  stepped_ = before_.stepped;
  incomplete_ = false;
  const auto block = static_cast<std::ptrdiff_t>(statics_->block());
  const double* from = before_.numbers.data();
  for (double* x : {v, w, motion_->start_acceleration()})
    for (const Range& r : motion_->ranges()) {
      const std::ptrdiff_t size = block * (r.past - r.first);
      std::copy_n(from, size, x + block * r.first);
      from += size;
    }
}

void ElementStructure::restart(const std::vector<Reach>& loaded, double* v, double* w, const double* a) {
  if (stepped_) measure_dissipation(v, w);
  start_with(a);
  powers_.at[0] = {};
  if (!measured_between_steps()) powers_.at[0].dissipation = dissipation(w);
  if (unmeasured_ > 0.0) measure_dissipation(v, w);
  to_measure_ = true;
  stepped_ = false;
  if (!window_) return;
  window_->begin(*motion_, v, w, find_loaded(loaded));
}

// Sets the accelerations at the start of the next step to a. A method of one stage answers a jump of the accelerations
// of modes that are faster than its steps by oscillations far beyond it, because it does not damp them. It receives the
// jump as an implicit stage of the step would cause it, which leaves the slow modes unchanged to the order of the
// method.
void ElementStructure::start_with(const double* a) {
  double* const start = motion_->start_acceleration();
  if (method_.stages.size() > 1) {
    std::copy_n(a, n_, start);
    return;
  }
  const base::StageRule& rule = method_.stages.front();
  const double shift = rule.rate / rule.displacement, shift2 = 1.0 / rule.displacement;
  for (int i = 0; i < n_; ++i) work_[i] = a[i] - start[i];
  statics_->multiply(1.0, work_.data(), nullptr, nullptr, z_.data());
  release_held(z_.data());
  statics_->factored(shift, shift2).solve(z_.data());
  for (int i = 0; i < n_; ++i) start[i] += shift2 * z_[i];
}

// Adds the dissipation until now: the trapezoidal rule, with Rayleigh damping only corrected by the rates to order 4.
// Strong dampers have rates that long steps do not resolve, and so do fast modes after a jump of the load. There the
// correction would exceed what it corrects.
void ElementStructure::add_dissipation(const BeamMotion::Dissipation& now) {
  const double trapezoid = 0.5 * unmeasured_ * (measured_.power + now.power);
  const double correction = unmeasured_ * unmeasured_ / 12.0 * (measured_.rate - now.rate);
  powers_.sum.dissipation += trapezoid;
  if (motion_->proportional()) {
    double whole[2] = {trapezoid, correction};  // of all ranks, which decide alike
    MPI_Allreduce(MPI_IN_PLACE, whole, 2, MPI_DOUBLE, MPI_SUM, beam().comm());
    if (std::abs(whole[1]) < std::abs(whole[0])) powers_.sum.dissipation += correction;
  }
  measured_ = now;
  unmeasured_ = 0.0;
}

// Whether the dissipation is measured between steps. Otherwise it is integrated by the method's stages, which is much
// more accurate for strong dampers and long steps of several stages.
bool ElementStructure::measured_between_steps() const {
  return fused() && (motion_->proportional() || method_.stages.size() == 1);
}

// Measures the dissipation of all moving nodes between two steps.
void ElementStructure::measure_dissipation(const double* v, const double* w) {
  if (!measured_between_steps() || !statics_->damped()) return;
  add_dissipation(motion_->dissipation(active_nodes(), v, w));
}

void ElementStructure::keep(base::Archive& archive) {
  if (motion_) archive.cut(motion_->start());
  archive.sum(powers_.at[0].dissipation, powers_.at[0].work, powers_.sum.dissipation, powers_.sum.work, measured_.power,
              measured_.rate);
  archive.same(unmeasured_, measuring_, to_measure_, stepped_, incomplete_);
  if (window_) {
    window_->keep(archive);
    energy_left_ = window_->energy_left();
  }
  if (nonlinear_) archive.cache(*nonlinear_);
  statics_->keep(archive, [this](long version) { return nonlinear_ ? nonlinear_->tangents(version) : nullptr; });
  archive.cache(compliance_);
}

double ElementStructure::error_energy(const double* v, const double* w) {
  if (fused()) return motion_->error_energy();
  double* const error_of_v = v_predicted_.data();
  double* const error_of_w = w_predicted_.data();
  motion_->error(v, w, error_of_v, error_of_w);
  double energy = 0.0;
  statics_->multiply(1.0, nullptr, nullptr, error_of_v, work_.data());
  for (int i = 0; i < n_; ++i) energy += 0.5 * error_of_v[i] * work_[i];
  statics_->multiply(1.0, error_of_w, nullptr, nullptr, work_.data());
  for (int i = 0; i < n_; ++i) energy += 0.5 * error_of_w[i] * work_[i];
  return energy;
}

}  // namespace traverse::structure
