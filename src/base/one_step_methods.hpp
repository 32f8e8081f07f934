// One-step methods for second-order equations of motion in terms of accelerations: the coefficients of stages and
// steps.
//
//   stage:  w = w~ + rate*a,  v = v~ + displacement*a,   w~ = w_n + sum_j a_in_w[j] A_j
//                                                        v~ = v_n + w_in_v w_n + sum_j a_in_v[j] A_j
//   with a, the new A, from the equations of motion at `time`. Beam and vehicles use the same rules.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace traverse::base {

inline constexpr int most_accelerations = 6;
using Weights = std::array<double, most_accelerations>;

struct StageRule {
  double time = 0.0;  // s, from the start of the step
  int known = 0;      // number of accelerations A_0 ... A_{known-1}; the stage's acceleration becomes A_known
  double w_in_v = 0.0;
  Weights a_in_v{}, a_in_w{};
  double rate = 0.0, displacement = 0.0;  // s, s2
};

/// The end of the step from all its accelerations, the last of which satisfies the equations of motion at the end.
struct StepRule {
  int known = 0;
  double w_in_v = 0.0;
  Weights a_in_v{}, a_in_w{};
  Weights a_next{};  // the next step's A_0
  Weights power{};   // s: weights of the integral over the step of a power at the accelerations' states
  /// The result of the step minus the result of an embedded method of one order less, as an estimate of the step's
  /// error; all 0 without such a method. error_in_a is the error of w over the length of the step.
  Weights error_in_v{}, error_in_w{}, error_in_a{};
};

/// The combination of entry i of the accelerations A_0 ... with these weights.
template <class Accelerations>
double combined(const Weights& weights, int known, const Accelerations& A, int i) {
  double sum = 0.0;
  for (int j = 0; j < known; ++j) sum += weights[j] * A[j][i];
  return sum;
}

/// v~ and w~ of a stage, or v and w at the end of the step, of entry i with v and w at its start.
template <class Rule, class Accelerations>
std::pair<double, double> advanced(const Rule& rule, const Accelerations& A, int i, double v, double w) {
  v += rule.w_in_v * w;
  for (int j = 0; j < rule.known; ++j) {
    v += rule.a_in_v[j] * A[j][i];
    w += rule.a_in_w[j] * A[j][i];
  }
  return {v, w};
}

/// Power lost in damping, and power of loads: W, or their integrals, J.
struct Powers {
  double dissipation = 0.0, work = 0.0;
  Powers& operator+=(const Powers& more) {
    dissipation += more.dissipation;
    work += more.work;
    return *this;
  }
};

/// The powers at the accelerations of a step, and their integrals over all steps.
struct PowerIntegrals {
  std::array<Powers, most_accelerations> at;
  Powers sum, before;  // J; `before` at the start of a step, which may be rejected
  void add(const StepRule& rule) {
    for (int j = 0; j < rule.known; ++j) {
      sum.dissipation += rule.power[j] * at[j].dissipation;
      sum.work += rule.power[j] * at[j].work;
    }
  }
};

/// Stage i uses the i + 1 accelerations before it; the last stage is the end of the step.
struct Method {
  std::vector<StageRule> stages;
  StepRule step;
  /// Scales the coefficients from steps of 1 to steps of h, s.
  void scale_to(double h);
};

/// The implicit part of the additive Runge-Kutta method ARK4(3)6L[2]SA (Kennedy and Carpenter 2003): order 4, L-stable,
/// five implicit stages. Its coefficients are equal to PETSc's ARKIMEX 4, fully implicit.
Method esdirk4();
/// Generalised-alpha with all forces at the end of the step (Wood, Bossak and Zienkiewicz 1980): order 2, one stage.
/// Each step multiplies oscillations that are fast within a step by `radius` (0..1). 1: the trapezoidal rule.
Method generalised_alpha(double radius);

/// A parameter of a method, read from an option.
struct MethodParameter {
  const char* option = nullptr;  // option with its dash; null: no parameter
  const char* words = "";
  double value = 0.0;  // default
  double least = 0.0, most = 0.0;
};

/// A method with its name in `-ts_type NAME`. The tests in order_conditions_test.cpp check every row.
struct MethodRow {
  const char* name;
  int order;
  const char* words;
  Method (*make)(double parameter);
  MethodParameter parameter{};

  /// Number of solves of the beam per step.
  double solves() const { return static_cast<double>(make(parameter.value).stages.size()); }
  /// Whether the method has an embedded method, whose difference estimates the step's error.
  bool estimates_errors() const;
};

/// All methods, the default first.
std::span<const MethodRow> methods();
/// The method of this name, or null.
const MethodRow* find_method(std::string_view name);

}  // namespace traverse::base
