// The finite element equations of the beam (equation 51 of the paper): loads on nodes, free response and compliance in
// an implicit stage, energies and dissipated power.
#include "structure/element_structure.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "base/numbers.hpp"
#include "beam/shape.hpp"

namespace traverse::structure {

ElementStructure::ElementStructure(const beam::Beam& beam, double gravity, std::shared_ptr<BeamOperator> op)
    : MovingStructure(beam, std::move(op), gravity),
      compliance_(beam, *statics_),
      response_(beam, *statics_),
      longest_span_(*std::max_element(beam.model().spans.begin(), beam.model().spans.end())) {
  all_ = {{0, beam.local_columns()}};
  for (std::vector<double>* x : {&z_, &v_predicted_, &w_predicted_, &work_}) x->resize(static_cast<std::size_t>(n_));
}

void ElementStructure::set_reference_loads(double sum, double greatest) {
  if (!beam_.model().nonlinear()) return;
  nonlinear_.emplace(beam_, *statics_, sum, greatest);
  stage_load_.resize(static_cast<std::size_t>(n_));
}

// --- loads ---------------------------------------------------------------------------------------------------------

void ElementStructure::load(const std::vector<recovery::ElementLoad>& forces) {
  nodal_forces_.clear();
  for (const recovery::ElementLoad& force : forces) {
    const auto parts = on_unknowns(line_, force);
    line_.for_unknowns(force.element, [&](int k, int unknown, double factor) {
      const double part = factor * parts[static_cast<std::size_t>(k)];
      if (const int local = beam_.local(unknown); local >= 0 && part != 0.0) nodal_forces_.push_back({local, part});
    });
  }
  const auto sort = [](std::vector<NodalLoad>& loads) {
    std::sort(loads.begin(), loads.end(), [](const NodalLoad& a, const NodalLoad& b) { return a.unknown < b.unknown; });
  };
  sort(nodal_forces_);
  if (!support_motion_) return;
  with_inertia_ = nodal_forces_;
  for (int i = 0; i < n_; ++i)
    if (const double force = support_motion_->load()[i]; force != 0.0) with_inertia_.push_back({i, force});
  sort(with_inertia_);
}

void ElementStructure::add_support_inertia(double* nodal) const {
  for (int i = 0; support_motion_ && i < n_; ++i) nodal[i] += support_motion_->load()[i];
}

// All loads but the contact forces: dead load and moving forces.
void ElementStructure::external_load(double* nodal) const {
  std::copy(dead_load_.begin(), dead_load_.end(), nodal);
  for (const NodalLoad& force : nodal_forces_) nodal[force.unknown] += force.force;
}

// --- at a state ----------------------------------------------------------------------------------------------------

Powers ElementStructure::accelerations(const double* v, const double* w, const ElementLoads& contacts, double* a) {
  statics_->multiply(-1.0, nullptr, w, v, a);
  external_load(work_.data());
  add_support_inertia(work_.data());
  for (int i = 0; i < n_; ++i) a[i] += work_[i];
  if (nonlinear_) {
    nonlinear_->evaluate(v, w);
    nonlinear_->add_forces(a);
  }
  add_contacts(contacts, a);
  release_held(a);
  statics_->solve_mass(a);
  return powers(w);
}

double ElementStructure::power_of_forces(const double* w) const {
  double power = 0.0;
  for (const NodalLoad& force : driving_forces()) power += force.force * w[force.unknown];
  return power;
}

// Power lost in the damping of the beam and its foundation, this rank's share.
double ElementStructure::dissipation(const double* w) {
  double sum = 0.0;
  if (statics_->damped()) {
    statics_->multiply(1.0, nullptr, w, nullptr, work_.data());
    sum = base::dot(work_, w);
  }
  return nonlinear_ ? sum + nonlinear_->dissipation() : sum;
}

void ElementStructure::add_values(const std::vector<int>& elements, const double* v, const double* w,
                                  double* v_elements, double* w_elements) const {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node());
  const auto value_at = [&](int i) -> std::pair<double, double> {
    if (v != nullptr) return {v[i], w[i]};
    if (stage_.kind == Kind::fused) return motion_->state(stage_.number, stage_.v, stage_.w, i);
    return {v_predicted_[i] + z_[i], w_predicted_[i] + stage_.shift * z_[i]};
  };
  for (std::size_t a = 0; a < elements.size(); ++a) {
    line_.for_unknowns(elements[a], [&](int k, int unknown, double factor) {
      const int local = beam_.local(unknown);
      if (local < 0) return;
      const auto [value, rate] = value_at(local);
      v_elements[a * m + static_cast<std::size_t>(k)] += factor * value;
      w_elements[a * m + static_cast<std::size_t>(k)] += factor * rate;
    });
  }
}

// --- stages --------------------------------------------------------------------------------------------------------

void ElementStructure::begin_statics(bool loaded) {
  stage_ = {};
  stage_.loaded = loaded;
  for (std::vector<double>* predicted : {&v_predicted_, &w_predicted_})
    std::fill(predicted->begin(), predicted->end(), 0.0);
  const bool has_settlements = !beam_.imposed().empty();
  if (has_settlements) v_predicted_ = beam_.imposed();
  if (nonlinear_) nonlinear_->begin(0.0, has_settlements ? v_predicted_.data() : nullptr, nullptr, nullptr);
  if (has_settlements) return load_at_zero_acceleration();
  external_load(z_.data());
  release_held(z_.data());
  if (nonlinear_) stage_load_ = z_;
}

void ElementStructure::begin_stage(double shift, const double* c_v, const double* c_w, const double* w_guess) {
  stage_ = {};
  stage_.kind = Kind::state;
  stage_.shift = shift;
  stage_.shift2 = shift * shift;
  for (int i = 0; i < n_; ++i) w_predicted_[i] = -c_w[i] / shift;
  for (int i = 0; i < n_; ++i) v_predicted_[i] = (w_predicted_[i] - c_v[i]) / shift;
  if (nonlinear_) nonlinear_->begin(shift, v_predicted_.data(), w_predicted_.data(), w_guess);
  load_at_zero_acceleration();
}

void ElementStructure::begin_stage(std::size_t i, const double* v, const double* w) {
  const base::StageRule& rule = method_.stages[i];
  stage_ = {};
  stage_.kind = fused() ? Kind::fused : Kind::step;
  stage_.shift = rule.rate / rule.displacement;
  stage_.shift2 = 1.0 / rule.displacement;
  stage_.number = i;
  stage_.v = v;
  stage_.w = w;
  if (fused()) return;
  motion_->predicted(i, v, w, v_predicted_.data(), w_predicted_.data());
  if (nonlinear_) nonlinear_->begin(stage_.shift, v_predicted_.data(), w_predicted_.data(), w);
  load_at_zero_acceleration();
}

// Stores the load at zero acceleration in z_.
void ElementStructure::load_at_zero_acceleration() {
  stage_.loaded = true;
  statics_->multiply(-1.0, nullptr, w_predicted_.data(), v_predicted_.data(), z_.data());
  external_load(work_.data());
  if (stage_.kind != Kind::statics) add_support_inertia(work_.data());
  for (int i = 0; i < n_; ++i) z_[i] += work_[i];
  release_held(z_.data());
  if (nonlinear_) stage_load_ = z_;
}

void ElementStructure::solve_free() {
  if (stage_.kind == Kind::fused) return motion_->solve(stage_.number, stage_.v, stage_.w, driving_forces());
  if (nonlinear_) {
    stage_.added = &nonlinear_->linearise();
    z_ = stage_load_;
    nonlinear_->add_linearised(z_.data());
    release_held(z_.data());
  }
  if (!stage_.loaded && !nonlinear_) return;
  if (stage_.shift == 0.0) return statics_->solve_static(z_.data(), stage_.added);
  statics_->factored(stage_.shift, stage_.shift2, stage_.added).solve(z_.data());
  ++statics_->solves;
}

const ElementCompliance& ElementStructure::compliance(const std::vector<int>& elements) {
  if (!elements.empty()) compliance_.prepare(stage_.shift, stage_.shift2, stage_.added, elements);
  return compliance_;
}

LoadedStructure::Verdict ElementStructure::apply_contact_loads(const std::vector<double>& loads) {
  const bool fused = stage_.kind == Kind::fused;
  double* const to = fused ? motion_->stored(stage_.number) : z_.data();
  const double factor = fused ? stage_.shift2 : 1.0;
  if (stage_.by_response) {
    response_.add(factor, to);
  } else if (!loads.empty()) {
    element_work_ = loads;
    for (double& load : element_work_) load *= factor;
    compliance_.add_response(element_work_, to);
  }
  return check_stage();
}

LoadedStructure::Passes ElementStructure::begin_passes(const std::vector<int>& elements) {
  stage_.by_response = !support_motion_ && response_.worthwhile(elements.size());
  if (!stage_.by_response) return LoadedStructure::begin_passes(elements);
  const bool fused = stage_.kind == Kind::fused;
  response_.place(elements, fused ? motion_->ranges() : all_);
  compliance_.prepare_individual(stage_.shift, stage_.shift2, stage_.added, elements);
  if (fused) {
    response_.set_free([&](std::ptrdiff_t from, int size, double* v, double* w) {
      motion_->states(stage_.number, stage_.v, stage_.w, from, size, v, w);
    });
  } else {
    response_.set_free([&](std::ptrdiff_t from, int size, double* v, double* w) {
      for (int i = 0; i < size; ++i) {
        v[i] = v_predicted_[from + i] + z_[from + i];
        w[i] = w_predicted_[from + i] + stage_.shift * z_[from + i];
      }
    });
  }
  return {response_.field(), compliance_};
}

void ElementStructure::respond(const std::function<void()>& add_loads, double shift) {
  if (!stage_.by_response) return LoadedStructure::respond(add_loads, shift);
  response_.clear();
  add_loads();
  response_.solve(statics_->factored(stage_.shift, stage_.shift2, stage_.added));
  if (shift > 0.0) response_.find_rates(shift);
}

LoadedStructure::Verdict ElementStructure::check_stage() {
  if (!nonlinear_ || stage_.kind == Kind::fused) return Verdict::converged;
  const Verdict verdict = nonlinear_->check_stage(z_.data());
  if (verdict == Verdict::failed) failure_reason_ = nonlinear_->worst_point();
  return verdict;
}

Powers ElementStructure::end_stage(double* v, double* w) {
  const double shift = stage_.shift;  // a local copy lets the compiler vectorise the loop
  for (int i = 0; i < n_; ++i) {
    v[i] = v_predicted_[i] + z_[i];
    w[i] = w_predicted_[i] + shift * z_[i];
  }
  return powers(w);
}

// Sets the range from the first to the last wheel or force.
void ElementStructure::update_loaded_range(const std::vector<Reach>& loaded) {
  Reach train{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Reach& reach : loaded) train = {std::min(train.from, reach.from), std::max(train.to, reach.to)};
  nonlinear_->set_loaded_range(train.from, train.to);
}

// --- observation ---------------------------------------------------------------------------------------------------

StructureEnergy ElementStructure::energy(const double* v, const double* w) {
  StructureEnergy e;
  e.potential = -base::dot(dead_load_, v);
  if (motion_ && motion_->fused()) {
    // Nodes outside the active window contribute nothing, except if the dead load deforms the beam.
    const BeamMotion::Energy energy = motion_->energy(static_displacements_.empty() ? active_nodes() : all_, v, w);
    e.strain = energy.strain;
    e.kinetic = energy.kinetic;
  } else {
    statics_->multiply(1.0, w, nullptr, nullptr, work_.data());
    e.kinetic = 0.5 * base::dot(work_, w);
    statics_->multiply(1.0, nullptr, nullptr, v, work_.data());
    e.strain = 0.5 * base::dot(work_, v);
  }
  if (nonlinear_) e.strain += nonlinear_->energy();
  const double slip_loss = nonlinear_ ? nonlinear_->slip_loss() : 0.0;
  if (!motion_) return e;
  measure_dissipation(v, w);
  e.dissipated = integrals().dissipation + slip_loss;
  e.work = integrals().work;
  return e;
}

void ElementStructure::observe(const double* v, const double* w, const double* a, const ElementLoads& contacts,
                               bool with_loads, NodalMotion& out) {
  out.v = v;
  out.w = w;
  out.a = a != nullptr ? a : motion_->start_acceleration();
  if (with_loads) {
    out.P.resize(static_cast<std::size_t>(n_));
    external_load(out.P.data());
    add_contacts(contacts, out.P.data());
  }
  if (window_) out.moving = window_->moving();
  out.foundation_loads.clear();
  if (!nonlinear_) return;
  nonlinear_->evaluate(v, w);
  if (with_loads) nonlinear_->add_forces(out.P.data());
  nonlinear_->report(out.foundation, out.foundation_loads);
}

}  // namespace traverse::structure
