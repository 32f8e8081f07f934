// One-step methods for second-order equations of motion, written for accelerations: what a stage and a step combine.
//
//   stage:  w = w~ + rate*a,  v = v~ + displacement*a,   w~ = w_n + sum_j a_in_w[j] A_j
//                                                        v~ = v_n + w_in_v w_n + sum_j a_in_v[j] A_j
//   with a, the new A, from the equations of motion at `time`; beam and vehicles alike.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace traverse::structure {

inline constexpr int most_accelerations = 6;
using Weights = std::array<double, most_accelerations>;

struct StageRule {
  double time = 0.0;  // s, from the start of the step
  int known = 0;      // accelerations A_0 ... A_{known-1}; the stage's own becomes A_known
  double w_in_v = 0.0;
  Weights a_in_v{}, a_in_w{};
  double rate = 0.0, displacement = 0.0;  // s, s2
};

/// The end of the step from all its accelerations; the last one belongs to the equations of motion there.
struct StepRule {
  int known = 0;
  double w_in_v = 0.0;
  Weights a_in_v{}, a_in_w{};
  Weights a_next{};  // the next step's A_0
  Weights power{};   // s: integral over the step of a power known at the accelerations' states
  /// By how much the end of an embedded method of one order less is elsewhere: the estimate of the step's error; all 0
  /// where there is no such method. error_in_a is that of w over the length of the step.
  Weights error_in_v{}, error_in_w{}, error_in_a{};
};

/// Stage i has the i + 1 accelerations before it; the last stage is the end of the step.
struct Method {
  std::vector<StageRule> stages;
  StepRule step;
  /// From steps of 1 to steps of h, s.
  void scale_to(double h);
};

/// Additive Runge-Kutta ARK4(3)6L[2]SA's implicit part (Kennedy and Carpenter 2003): order 4, L-stable, five implicit
/// stages. The same numbers as PETSc's ARKIMEX 4, fully implicit.
Method esdirk4();
/// Generalised-alpha with all forces at the end of the step (Wood, Bossak and Zienkiewicz 1980): order 2, one stage;
/// what oscillates fast within a step shrinks by `radius` (0..1) each step. 1: the trapezoidal rule.
Method generalised_alpha(double radius);

/// A number that a method takes from an option.
struct MethodParameter {
  const char* option = nullptr;  // with its dash; null: there is none
  const char* words = "";
  double value = 0.0;  // where the option is not given
  double least = 0.0, most = 0.0;
};

/// A method as `-ts_type NAME` chooses it. Its tests walk the rows (order_conditions_test.cpp).
struct MethodRow {
  const char* name;
  int order;
  const char* words;
  Method (*make)(double parameter);
  MethodParameter parameter{};

  /// Of the beam in a step.
  double solves() const { return static_cast<double>(make(parameter.value).stages.size()); }
  /// Whether there is an embedded method, whose difference is the estimate of a step's error.
  bool estimates_errors() const;
};

/// All of them, the default first.
std::span<const MethodRow> methods();
/// Null: none has this name.
const MethodRow* find_method(std::string_view name);

}  // namespace traverse::structure
