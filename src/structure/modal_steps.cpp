// Stages and steps of a structure by modes, and its compliance in a stage.
#include <algorithm>
#include <tuple>

#include "structure/modal_structure.hpp"

namespace traverse::structure {

// --- stages --------------------------------------------------------------------------------------------------------

void ModalStructure::set_stage(double shift, double shift2) {
  if (shift == shift_ && shift2 == shift2_) return;
  shift_ = shift;
  shift2_ = shift2;
  factorise();
}

void ModalStructure::factorise() {
  for (std::size_t i = 0; i < modes_; ++i) {
    const double omega = bridge_.omega()[i];
    stiffness_[i] = shift2_ + 2.0 * bridge_.sigma()[i] * shift_ + omega * omega;
  }
  if (!bridge_.coupled()) return;
  inverse_ = shift_ * bridge_.cross_damping();
  inverse_.diagonal() += Eigen::Map<const Eigen::VectorXd>(stiffness_.data(), inverse_.rows());
  factor_.compute(inverse_);
  inverse_.setIdentity();
  factor_.solveInPlace(inverse_);
}

/// Computes S^-1 force.
void ModalStructure::divide(const double* force, double* displacement) const {
  if (!bridge_.coupled()) {
    for (std::size_t i = 0; i < modes_; ++i) displacement[i] = force[i] / stiffness_[i];
    return;
  }
  const Eigen::Index m = inverse_.rows();
  Eigen::Map<Eigen::VectorXd>(displacement, m).noalias() = inverse_ * Eigen::Map<const Eigen::VectorXd>(force, m);
}

void ModalStructure::begin_statics(bool /*loaded*/) {
  set_stage(0.0, 0.0);
  std::fill(v_predicted_.begin(), v_predicted_.end(), 0.0);
  std::fill(w_predicted_.begin(), w_predicted_.end(), 0.0);
}

void ModalStructure::begin_stage(double shift, const double* c_v, const double* c_w, const double* /*w_guess*/) {
  set_stage(shift, shift * shift);
  for (int i = 0; i < n_; ++i) {
    w_predicted_[i] = -c_w[i] / shift;
    v_predicted_[i] = (w_predicted_[i] - c_v[i]) / shift;
  }
}

void ModalStructure::begin_stage(std::size_t stage, const double* v, const double* w) {
  const base::StageRule& rule = method_.stages[stage];
  set_stage(rule.rate / rule.displacement, 1.0 / rule.displacement);
  for (int i = 0; i < n_; ++i)
    std::tie(v_predicted_[i], w_predicted_[i]) = base::advanced(rule, accelerations_, i, v[i], w[i]);
}

void ModalStructure::solve_free() {
  if (n_ == 0) return;
  for (int i = 0; i < n_; ++i) {
    const double omega = bridge_.omega()[i];
    q_[i] = modal_force_[i] - 2.0 * bridge_.sigma()[i] * w_predicted_[i] - omega * omega * v_predicted_[i];
  }
  subtract_cross_damping(w_predicted_.data(), q_.data());
  divide(q_.data(), z_.data());
}

const ElementCompliance& ModalStructure::compliance(const std::vector<int>& elements) {
  elements_ = elements;
  compliance_.prepare(elements);
  return compliance_;
}

void ModalStructure::ModalCompliance::prepare(const std::vector<int>& elements) {
  const bool same = shift_ == structure_.shift_ && shift2_ == structure_.shift2_;
  if (same && elements == elements_) return;
  std::swap(elements_, elements_before_);
  std::swap(blocks_, blocks_before_);
  elements_ = elements;
  shift_ = structure_.shift_;
  shift2_ = structure_.shift2_;
  const int count = static_cast<int>(elements_.size()), before = static_cast<int>(elements_before_.size());
  const std::size_t size = static_cast<std::size_t>(m_) * static_cast<std::size_t>(m_);
  previous_index_.assign(elements_.size(), -1);
  for (std::size_t a = 0; same && a < elements_.size(); ++a) {
    const auto at = std::find(elements_before_.begin(), elements_before_.end(), elements_[a]);
    if (at != elements_before_.end()) previous_index_[a] = static_cast<int>(at - elements_before_.begin());
  }
  blocks_.resize(elements_.size() * elements_.size() * size);
  responses_.resize(elements_.size());
  const auto block_at = [&](int a, int b, int of) {
    return static_cast<std::ptrdiff_t>(static_cast<std::size_t>(b * of + a) * size);
  };
  loaded_shapes_.resize(static_cast<std::size_t>(m_) * structure_.modes_);
  for (int b = 0; b < count; ++b) {
    responses_[b] = {0, count, static_cast<std::size_t>(b) * elements_.size() * size};
    const auto unknowns = structure_.line_.unknowns(elements_[b]);
    for (int k = 0; k < m_; ++k)
      structure_.divide(structure_.shapes(elements_[b], k, unknowns),
                        &loaded_shapes_[static_cast<std::size_t>(k) * structure_.modes_]);
    for (int a = 0; a < count; ++a) {
      double* to = blocks_.data() + block_at(a, b, count);
      if (previous_index_[a] >= 0 && previous_index_[b] >= 0)
        std::copy_n(blocks_before_.data() + block_at(previous_index_[a], previous_index_[b], before), size, to);
      else
        fill(a, to);
    }
  }
}

void ModalStructure::ModalCompliance::fill(int a, double* to) const {
  const auto unknowns = structure_.line_.unknowns(elements_[a]);
  for (int k = 0; k < m_; ++k) {
    const double* phi = structure_.shapes(elements_[a], k, unknowns);
    for (int j = 0; j < m_; ++j) {
      const double* loaded = &loaded_shapes_[static_cast<std::size_t>(j) * structure_.modes_];
      double sum = 0.0;
      for (std::size_t i = 0; i < structure_.modes_; ++i) sum += phi[i] * loaded[i];
      to[j * m_ + k] = sum;
    }
  }
}

LoadedStructure::Verdict ModalStructure::apply_contact_loads(const std::vector<double>& loads) {
  if (loads.empty()) return Verdict::converged;
  std::fill(q_.begin(), q_.end(), 0.0);
  add_modal_forces({elements_, loads}, q_.data());
  divide(q_.data(), displacements_.data());
  for (int i = 0; i < n_; ++i) z_[i] += displacements_[i];
  return Verdict::converged;
}

Powers ModalStructure::end_stage(double* v, double* w) {
  for (int i = 0; i < n_; ++i) {
    v[i] = v_predicted_[i] + z_[i];
    w[i] = w_predicted_[i] + shift_ * z_[i];
  }
  return powers(w);
}

void ModalStructure::end_stage(std::size_t stage, const double* /*v*/, const double* /*w*/) {
  for (int i = 0; i < n_; ++i) {
    accelerations_[stage + 1][i] = shift2_ * z_[i];
    w_predicted_[i] += shift_ * z_[i];
  }
  powers_.at[stage + 1] = powers(w_predicted_.data());
}

// --- steps ---------------------------------------------------------------------------------------------------------

void ModalStructure::set_method(const base::Method& method, double /*h*/) {
  method_ = method;
  for (int j = 0; j < method.step.known; ++j) accelerations_[j].resize(static_cast<std::size_t>(n_));
}

void ModalStructure::restart(const std::vector<Reach>& /*loaded*/, double* /*v*/, double* w, const double* a) {
  if (method_.stages.size() > 1) {
    std::copy_n(a, n_, accelerations_[0].begin());
  } else {  // as ElementStructure::start_with
    const base::StageRule& rule = method_.stages.front();
    set_stage(rule.rate / rule.displacement, 1.0 / rule.displacement);
    for (int i = 0; i < n_; ++i) q_[i] = a[i] - accelerations_[0][i];
    divide(q_.data(), z_.data());
    for (int i = 0; i < n_; ++i) accelerations_[0][i] += shift2_ * z_[i];
  }
  powers_.at[0].dissipation = damping(w);
}

void ModalStructure::begin_step(const std::vector<Reach>& /*loaded*/, const double* v, const double* w, bool store) {
  powers_.before = powers_.sum;
  if (store) {
    before_.v.assign(v, v + n_);
    before_.w.assign(w, w + n_);
  }
  powers_.at[0].work = work_rate(w);
}

void ModalStructure::finish_step(double* v, double* w) {
  const base::StepRule& rule = method_.step;
  for (int i = 0; i < n_; ++i) {
    std::tie(v[i], w[i]) = base::advanced(rule, accelerations_, i, v[i], w[i]);
    accelerations_[0][i] = base::combined(rule.a_next, rule.known, accelerations_, i);
  }
  powers_.add(rule);
  powers_.at[0] = powers_.at[rule.known - 1];
}

void ModalStructure::reject_step(double* v, double* w) {
  powers_.sum = powers_.before;
  std::copy(before_.v.begin(), before_.v.end(), v);
  std::copy(before_.w.begin(), before_.w.end(), w);
}

double ModalStructure::error_energy(const double* /*v*/, const double* /*w*/) {
  const base::StepRule& rule = method_.step;
  double energy = 0.0;
  for (int i = 0; i < n_; ++i) {
    const double error_of_v = base::combined(rule.error_in_v, rule.known, accelerations_, i);
    const double error_of_w = base::combined(rule.error_in_w, rule.known, accelerations_, i);
    const double omega = bridge_.omega()[i];
    energy += 0.5 * (omega * omega * error_of_v * error_of_v + error_of_w * error_of_w);
  }
  return energy;
}

}  // namespace traverse::structure
