// Converts the implicit tableau of ARK4(3)6L[2]SA (Kennedy and Carpenter 2003) and the generalised-alpha method with
// all forces at the end of the step (Wood, Bossak and Zienkiewicz) to coefficients of accelerations.
#include "base/one_step_methods.hpp"

#include <algorithm>

namespace traverse::base {
namespace {

constexpr MethodRow rows[] = {
    {"esdirk4", 4, "five solves a step, the best all-round choice", [](double) { return esdirk4(); }},
    {"genalpha",
     2,
     "one solve a step, for deflections to 1e-2 or 1e-3",
     generalised_alpha,
     {"-ts_genalpha_radius", "what is left after a step of a fast oscillation, 0 to 1", 0.9, 0.0, 1.0}},
};

void scale(Weights& weights, double by) {
  for (double& w : weights) w *= by;
}

/// A Runge-Kutta method from its Butcher table, whose first row is the start of the step and whose last row is its
/// end: v_i = v_n + h sum_k a_ik w_k with w_k = w_n + h sum_j a_kj A_j.
template <int s>
Method runge_kutta(const double (&a)[s][s]) {
  static_assert(s <= most_accelerations);
  Method m;
  for (int i = 1; i < s; ++i) {
    StageRule rule;
    rule.known = i;
    for (int k = 0; k <= i; ++k) {
      rule.w_in_v += a[i][k];
      if (k < i) rule.a_in_w[k] = a[i][k];
      for (int j = 0; j <= k && j < i; ++j) rule.a_in_v[j] += a[i][k] * a[k][j];
    }
    rule.time = rule.w_in_v;
    rule.rate = a[i][i];
    rule.displacement = a[i][i] * a[i][i];
    m.stages.push_back(rule);
  }
  const StageRule& last = m.stages.back();
  m.step = {s, last.w_in_v, last.a_in_v, last.a_in_w, {}, last.a_in_w};
  m.step.a_in_v[s - 1] = last.displacement;
  m.step.a_in_w[s - 1] = m.step.power[s - 1] = last.rate;
  m.step.a_next[s - 1] = 1.0;
  return m;
}

/// Adds the error estimate, from the weights of an embedded method of one order less.
template <int s>
void embed(const double (&weights)[s], const double (&a)[s][s], Method& m) {
  for (int k = 0; k < s; ++k) {
    const double difference = a[s - 1][k] - weights[k];
    m.step.error_in_a[k] = m.step.error_in_w[k] = difference;
    for (int j = 0; j <= k; ++j) m.step.error_in_v[j] += difference * a[k][j];
  }
}

}  // namespace

std::span<const MethodRow> methods() { return rows; }

const MethodRow* find_method(std::string_view name) {
  const auto* row = std::find_if(std::begin(rows), std::end(rows), [&](const MethodRow& r) { return name == r.name; });
  return row == std::end(rows) ? nullptr : row;
}

bool MethodRow::estimates_errors() const { return make(parameter.value).step.error_in_w != Weights{}; }

void Method::scale_to(double h) {
  for (StageRule& s : stages) {
    s.time *= h;
    s.w_in_v *= h;
    scale(s.a_in_v, h * h);
    scale(s.a_in_w, h);
    s.rate *= h;
    s.displacement *= h * h;
  }
  step.w_in_v *= h;
  scale(step.a_in_v, h * h);
  scale(step.a_in_w, h);
  scale(step.power, h);
  scale(step.error_in_v, h * h);
  scale(step.error_in_w, h);
}

Method esdirk4() {
  constexpr int s = 6;
  constexpr double gamma = 0.25;
  constexpr double a[s][s] = {
      {},
      {0.25, gamma},
      {8611.0 / 62500.0, -1743.0 / 31250.0, gamma},
      {5012029.0 / 34652500.0, -654441.0 / 2922500.0, 174375.0 / 388108.0, gamma},
      {15267082809.0 / 155376265600.0, -71443401.0 / 120774400.0, 730878875.0 / 902184768.0, 2285395.0 / 8070912.0,
       gamma},
      {82889.0 / 524892.0, 0.0, 15625.0 / 83664.0, 69875.0 / 102672.0, -2260.0 / 8211.0, gamma}};
  constexpr double embedded[s] = {4586570599.0 / 29645900160.0, 0.0,
                                  178811875.0 / 945068544.0,    814220225.0 / 1159782912.0,
                                  -3700637.0 / 11593932.0,      61727.0 / 225920.0};
  Method m = runge_kutta(a);
  embed(embedded, a, m);
  return m;
}

Method generalised_alpha(double radius) {
  const double alpha =
      (radius - 1.0) / (radius + 1.0);  // inertia forces of the step: M ((1 - alpha) a_{n+1} + alpha a_n)
  const double gamma = 0.5 - alpha, beta = 0.25 * (1.0 - alpha) * (1.0 - alpha);
  // a_{n+1} = (A_1 - alpha A_0)/(1 - alpha)
  const double next0 = -alpha / (1.0 - alpha), next1 = 1.0 / (1.0 - alpha);
  StageRule rule;
  rule.time = 1.0;
  rule.known = 1;
  rule.w_in_v = 1.0;
  rule.a_in_v[0] = 0.5 - beta + beta * next0;
  rule.a_in_w[0] = 1.0 - gamma + gamma * next0;
  rule.displacement = beta * next1;
  rule.rate = gamma * next1;
  Method m;
  m.stages.push_back(rule);
  m.step = {2, 1.0, rule.a_in_v, rule.a_in_w, {}, {}};
  m.step.a_in_v[1] = rule.displacement;
  m.step.a_in_w[1] = rule.rate;
  m.step.a_next = {next0, next1};
  m.step.power = {0.5, 0.5};
  return m;
}

}  // namespace traverse::base
