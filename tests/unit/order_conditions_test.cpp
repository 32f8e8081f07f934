// The methods of one_step_methods.hpp by their tables alone: the algebraic conditions of their orders, of what they
// damp and of the quadrature of powers. Every row of methods() is walked; one equation is integrated to see its order.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <set>
#include <string>

#include "base/one_step_methods.hpp"

namespace traverse::base {
namespace {

constexpr double rounding = 4e-15;

// ------------------------------------------------------------------------------------------------- Runge-Kutta's kind

/// Butcher's table of a Runge-Kutta method whose first stage is the start of the step: w's of the stages and of the
/// end.
struct Butcher {
  Eigen::MatrixXd A;
  Eigen::VectorXd b, c, embedded;
};

Butcher butcher_of(const Method& method) {
  const int s = method.step.known;
  Butcher t{Eigen::MatrixXd::Zero(s, s), Eigen::VectorXd(s), Eigen::VectorXd::Zero(s), Eigen::VectorXd(s)};
  for (int i = 1; i < s; ++i) {
    const StageRule& stage = method.stages[static_cast<std::size_t>(i) - 1];
    EXPECT_EQ(stage.known, i);
    for (int j = 0; j < i; ++j) t.A(i, j) = stage.a_in_w[j];
    t.A(i, i) = stage.rate;
    t.c[i] = stage.time;
  }
  for (int j = 0; j < s; ++j) {
    t.b[j] = method.step.a_in_w[j];
    t.embedded[j] = t.b[j] - method.step.error_in_w[j];
  }
  return t;
}

/// The conditions of an order: what a sum of the weights and its exact value differ by, the largest of all trees.
double violation(const Butcher& t, const Eigen::VectorXd& b, int order) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(b.size()), Ac = t.A * t.c;
  const Eigen::VectorXd c2 = t.c.cwiseProduct(t.c), c3 = c2.cwiseProduct(t.c);
  switch (order) {
    case 1:
      return std::abs(b.dot(one) - 1.0);
    case 2:
      return std::abs(b.dot(t.c) - 1.0 / 2.0);
    case 3:
      return std::max(std::abs(b.dot(c2) - 1.0 / 3.0), std::abs(b.dot(Ac) - 1.0 / 6.0));
    default:
      return std::max({std::abs(b.dot(c3) - 1.0 / 4.0), std::abs(b.dot(t.c.cwiseProduct(Ac)) - 1.0 / 8.0),
                       std::abs(b.dot(t.A * c2) - 1.0 / 12.0), std::abs(b.dot(t.A * Ac) - 1.0 / 24.0)});
  }
}

/// By what a step multiplies x of x' = z/h x.
std::complex<double> growth(const Butcher& t, std::complex<double> z) {
  const Eigen::Index s = t.b.size();
  const Eigen::MatrixXcd stages = Eigen::MatrixXcd::Identity(s, s) - z * t.A;
  const Eigen::VectorXcd one = Eigen::VectorXcd::Ones(s), x = stages.partialPivLu().solve(one);
  return 1.0 + z * (t.b.cast<std::complex<double>>().transpose() * x)(0);
}

/// Whether the next step begins with the last acceleration, as Runge-Kutta methods do.
bool of_runge_kutta(const Method& method) {
  Weights last{};
  last[static_cast<std::size_t>(method.step.known) - 1] = 1.0;
  return method.step.a_next == last;
}

TEST(OrderConditions, OfEveryRungeKuttaMethod) {
  int seen = 0;
  for (const MethodRow& row : methods()) {
    const Method method = row.make(row.parameter.value);
    if (!of_runge_kutta(method)) continue;
    SCOPED_TRACE(row.name);
    const Butcher t = butcher_of(method);
    EXPECT_LT((t.A.rowwise().sum() - t.c).cwiseAbs().maxCoeff(), rounding);
    for (int order = 1; order <= std::min(row.order, 4); ++order)
      EXPECT_LT(violation(t, t.b, order), rounding) << order;
    for (double y = 1e-2; y < 1e4; y *= 1.1) EXPECT_LE(std::abs(growth(t, {0.0, y})), 1.0 + rounding) << y;
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

TEST(OrderConditions, EmbeddedMethodOfOrderThreeAndNoMore) {
  const Butcher t = butcher_of(esdirk4());
  for (int order = 1; order <= 3; ++order) EXPECT_LT(violation(t, t.embedded, order), rounding) << order;
  EXPECT_GT(violation(t, t.embedded, 4), 1e-4);
  EXPECT_GT((t.b - t.embedded).cwiseAbs().maxCoeff(), 1e-3);
}

// Second-order form: v is what two applications of the same table to v' = w, w' = a give.
TEST(OrderConditions, DisplacementsOfEsdirkFollowFromItsRates) {
  const Method method = esdirk4();
  const Butcher t = butcher_of(method);
  const int s = method.step.known;
  const Eigen::MatrixXd A2 = t.A * t.A;
  for (int i = 1; i < s; ++i) {
    const StageRule& stage = method.stages[static_cast<std::size_t>(i) - 1];
    EXPECT_NEAR(stage.w_in_v, t.c[i], rounding);
    EXPECT_NEAR(stage.displacement, A2(i, i), rounding);
    for (int j = 0; j < i; ++j) EXPECT_NEAR(stage.a_in_v[j], A2(i, j), rounding) << i << ' ' << j;
  }
  const Eigen::VectorXd in_v = t.A.transpose() * t.b, error_in_v = t.A.transpose() * (t.b - t.embedded);
  EXPECT_NEAR(method.step.w_in_v, 1.0, rounding);
  for (int j = 0; j < s; ++j) {
    EXPECT_NEAR(method.step.a_in_v[j], in_v[j], rounding) << j;
    EXPECT_NEAR(method.step.error_in_v[j], error_in_v[j], rounding) << j;
    EXPECT_EQ(method.step.error_in_a[j], method.step.error_in_w[j]) << j;
    EXPECT_EQ(method.step.a_next[j], j == s - 1 ? 1.0 : 0.0) << j;
  }
}

TEST(OrderConditions, EsdirkIsLStable) {
  const Butcher t = butcher_of(esdirk4());
  for (int i = 1; i < t.b.size(); ++i) EXPECT_EQ(t.A(i, i), t.A(1, 1));  // one factorisation serves all stages
  EXPECT_LT((t.A.row(t.A.rows() - 1).transpose() - t.b).cwiseAbs().maxCoeff(), rounding);  // the last stage is the end
  for (double y = 1e-2; y < 1e4; y *= 1.1) EXPECT_LE(std::abs(growth(t, {0.0, y})), 1.0 + rounding) << y;
  EXPECT_LT(std::abs(growth(t, {-1e8, 0.0})), 1e-6);
  EXPECT_LT(std::abs(growth(t, {0.0, 1e8})), 1e-6);
}

// ----------------------------------------------------------------------------------------------- generalised alpha

constexpr double radii[] = {0.0, 0.3, 0.7, 0.9, 1.0};

/// v, w and A_0 at the end of a step of 1 of v'' = -omega2 v, from those at its start.
Eigen::Matrix3d amplification(const Method& method, double omega2) {
  const StageRule& stage = method.stages.front();
  const StepRule& step = method.step;
  Eigen::Matrix3d to;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d from = Eigen::Vector3d::Unit(k);
    const double predicted = from[0] + stage.w_in_v * from[1] + stage.a_in_v[0] * from[2];
    const double a = -omega2 * predicted / (1.0 + omega2 * stage.displacement);
    to.col(k) << from[0] + step.w_in_v * from[1] + step.a_in_v[0] * from[2] + step.a_in_v[1] * a,
        from[1] + step.a_in_w[0] * from[2] + step.a_in_w[1] * a, step.a_next[0] * from[2] + step.a_next[1] * a;
  }
  return to;
}

double spectral_radius(const Eigen::Matrix3d& A) { return A.eigenvalues().cwiseAbs().maxCoeff(); }

TEST(OrderConditions, GeneralisedAlphaOfOrderTwo) {
  for (double radius : radii) {
    SCOPED_TRACE(radius);
    const Method method = generalised_alpha(radius);
    ASSERT_EQ(method.stages.size(), 1U);
    const StageRule& stage = method.stages[0];
    const StepRule& step = method.step;
    EXPECT_EQ(stage.time, 1.0);
    EXPECT_EQ(stage.known, 1);
    EXPECT_EQ(step.known, 2);
    // A_0 of a smooth motion is the acceleration a part of the step behind its start, and a_next keeps it so.
    EXPECT_NEAR(step.a_next[0] + step.a_next[1], 1.0, rounding);
    const double behind = (step.a_next[1] - 1.0) / (1.0 - step.a_next[0]);
    // w = w_n + h (b_0 A_0 + b_1 A_1) and v = v_n + h w_n + h2 (d_0 A_0 + d_1 A_1)
    EXPECT_NEAR(step.a_in_w[0] + step.a_in_w[1], 1.0, rounding);
    EXPECT_NEAR(step.a_in_w[0] * behind + step.a_in_w[1] * stage.time, 0.5, rounding);
    EXPECT_EQ(step.w_in_v, 1.0);
    EXPECT_NEAR(step.a_in_v[0] + step.a_in_v[1], 0.5, rounding);
    // The stage is the end of the step.
    EXPECT_EQ(stage.w_in_v, step.w_in_v);
    EXPECT_EQ(stage.a_in_v[0], step.a_in_v[0]);
    EXPECT_EQ(stage.a_in_w[0], step.a_in_w[0]);
    EXPECT_EQ(stage.displacement, step.a_in_v[1]);
    EXPECT_EQ(stage.rate, step.a_in_w[1]);
    for (double error : step.error_in_w) EXPECT_EQ(error, 0.0);
  }
}

TEST(OrderConditions, GeneralisedAlphaShrinksTheFastestByItsRadius) {
  for (double radius : radii) {
    SCOPED_TRACE(radius);
    const Method method = generalised_alpha(radius);
    // A double or triple eigenvalue keeps the root of rounding.
    EXPECT_NEAR(spectral_radius(amplification(method, 1e16)), radius, 3e-5);
    for (double omega = 1e-2; omega < 1e4; omega *= 1.1)
      EXPECT_LE(spectral_radius(amplification(method, omega * omega)), 1.0 + 1e-7) << omega;
  }
}

TEST(OrderConditions, RadiusOneIsTheTrapezoidalRule) {
  const Method method = generalised_alpha(1.0);
  const StageRule& stage = method.stages[0];
  EXPECT_EQ(stage.a_in_w[0], 0.5);
  EXPECT_EQ(stage.rate, 0.5);
  EXPECT_EQ(stage.a_in_v[0], 0.25);
  EXPECT_EQ(stage.displacement, 0.25);
  EXPECT_EQ(method.step.a_next[0], 0.0);
  EXPECT_EQ(method.step.a_next[1], 1.0);
}

// -------------------------------------------------------------------------------------------------- of every method

// A hardening spring with a damper under a force that changes.
double acceleration(double t, double v, double w) { return std::cos(t) - v - 0.3 * v * v * v - 0.2 * w; }

struct Swing {
  double v = 0.4, w = -0.3, a = acceleration(0.0, 0.4, -0.3);
};

/// One step of a method that is scaled to its length. Returns the errors that it estimates, of v and w together.
double take_step(const Method& method, double t, Swing& s) {
  Weights A{s.a};
  const auto sum = [&A](const Weights& weights, int count) {
    double total = 0.0;
    for (int j = 0; j < count; ++j) total += weights[static_cast<std::size_t>(j)] * A[static_cast<std::size_t>(j)];
    return total;
  };
  for (const StageRule& stage : method.stages) {
    const double v = s.v + stage.w_in_v * s.w + sum(stage.a_in_v, stage.known),
                 w = s.w + sum(stage.a_in_w, stage.known);
    double a = A[static_cast<std::size_t>(stage.known) - 1];
    for (int i = 0; i < 60; ++i) a = acceleration(t + stage.time, v + stage.displacement * a, w + stage.rate * a);
    A[static_cast<std::size_t>(stage.known)] = a;
  }
  const StepRule& step = method.step;
  s.v += step.w_in_v * s.w + sum(step.a_in_v, step.known);
  s.w += sum(step.a_in_w, step.known);
  s.a = sum(step.a_next, step.known);
  return std::hypot(sum(step.error_in_v, step.known), sum(step.error_in_w, step.known));
}

Swing after_two_seconds(const Method& unit, int steps) {
  Method method = unit;
  const double h = 2.0 / steps;
  method.scale_to(h);
  Swing swing;
  for (int i = 0; i < steps; ++i) take_step(method, i * h, swing);
  return swing;
}

TEST(Methods, HaveTheirNamesOnce) {
  std::set<std::string> names;
  for (const MethodRow& row : methods()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(find_method(row.name), &row);
    const MethodParameter& p = row.parameter;
    if (p.option != nullptr) {
      EXPECT_EQ(p.option[0], '-') << row.name;
    }
    EXPECT_GE(p.value, p.least);
    EXPECT_LE(p.value, p.most);
  }
  EXPECT_EQ(find_method("rosw"), nullptr);
  EXPECT_TRUE(find_method("esdirk4")->estimates_errors());
  EXPECT_FALSE(find_method("genalpha")->estimates_errors());
}

// What the steps of System and Structure take for granted.
TEST(Methods, EndWithTheirLastStage) {
  for (const MethodRow& row : methods()) {
    SCOPED_TRACE(row.name);
    const Method method = row.make(row.parameter.value);
    ASSERT_FALSE(method.stages.empty());
    for (std::size_t i = 0; i < method.stages.size(); ++i) EXPECT_EQ(method.stages[i].known, static_cast<int>(i) + 1);
    const StageRule& last = method.stages.back();
    const StepRule& step = method.step;
    ASSERT_EQ(step.known, last.known + 1);
    ASSERT_LE(step.known, most_accelerations);
    EXPECT_NEAR(last.time, 1.0, rounding);
    EXPECT_EQ(step.w_in_v, last.w_in_v);
    for (std::size_t j = 0; j < static_cast<std::size_t>(last.known); ++j) {
      EXPECT_EQ(step.a_in_v[j], last.a_in_v[j]) << j;
      EXPECT_EQ(step.a_in_w[j], last.a_in_w[j]) << j;
    }
    EXPECT_EQ(step.a_in_v[static_cast<std::size_t>(last.known)], last.displacement);
    EXPECT_EQ(step.a_in_w[static_cast<std::size_t>(last.known)], last.rate);
  }
}

TEST(Methods, ConvergeWithTheirOrder) {
  const Swing exact = after_two_seconds(esdirk4(), 2000);  // 1e-14 off
  for (const MethodRow& row : methods()) {
    SCOPED_TRACE(row.name);
    const Method method = row.make(row.parameter.value);
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      const Swing end = after_two_seconds(method, 40 << i);
      errors[i] = std::hypot(end.v - exact.v, end.w - exact.w);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), row.order, 0.2) << errors[1];
  }
}

// One of an embedded method of one order less: it falls with the power `order` of the step.
TEST(Methods, EstimateTheErrorOfAStep) {
  for (const MethodRow& row : methods()) {
    SCOPED_TRACE(row.name);
    const auto estimate = [&](double h) {
      Method method = row.make(row.parameter.value);
      method.scale_to(h);
      Swing swing;
      return take_step(method, 0.0, swing);
    };
    if (row.estimates_errors()) {
      EXPECT_NEAR(std::log2(estimate(0.04) / estimate(0.02)), row.order, 0.2);
    } else {
      EXPECT_EQ(estimate(0.04), 0.0);
    }
  }
}

// The integral of a power of time is exact below the order of the method.
TEST(OrderConditions, IntegralsOfPowers) {
  const auto greatest_error = [](const Method& method, int order) {
    double greatest = 0.0;
    for (int k = 0; k < order; ++k) {
      double sum = k == 0 ? method.step.power[0] : 0.0;
      for (const StageRule& stage : method.stages) sum += method.step.power[stage.known] * std::pow(stage.time, k);
      greatest = std::max(greatest, std::abs(sum - 1.0 / (k + 1.0)));
    }
    return greatest;
  };
  for (const MethodRow& row : methods())
    EXPECT_LT(greatest_error(row.make(row.parameter.value), row.order), rounding) << row.name;
  for (double radius : radii) EXPECT_LT(greatest_error(generalised_alpha(radius), 2), rounding) << radius;
}

// Weights of v'' carry s2 in v and s in w; those of a carry none.
TEST(OrderConditions, ScaledToALength) {
  constexpr double h = 0.125;  // so that nothing is rounded
  for (const MethodRow& row : methods()) {
    SCOPED_TRACE(row.name);
    const Method unit = row.make(row.parameter.value);
    Method scaled = unit;
    scaled.scale_to(h);
    for (std::size_t i = 0; i < unit.stages.size(); ++i) {
      const StageRule &one = unit.stages[i], &its = scaled.stages[i];
      EXPECT_EQ(its.known, one.known);
      EXPECT_EQ(its.time, h * one.time);
      EXPECT_EQ(its.w_in_v, h * one.w_in_v);
      EXPECT_EQ(its.rate, h * one.rate);
      EXPECT_EQ(its.displacement, h * h * one.displacement);
      for (std::size_t j = 0; j < one.a_in_v.size(); ++j) {
        EXPECT_EQ(its.a_in_v[j], h * h * one.a_in_v[j]);
        EXPECT_EQ(its.a_in_w[j], h * one.a_in_w[j]);
      }
    }
    const StepRule &one = unit.step, &its = scaled.step;
    EXPECT_EQ(its.known, one.known);
    EXPECT_EQ(its.w_in_v, h * one.w_in_v);
    for (std::size_t j = 0; j < one.a_in_v.size(); ++j) {
      EXPECT_EQ(its.a_in_v[j], h * h * one.a_in_v[j]);
      EXPECT_EQ(its.a_in_w[j], h * one.a_in_w[j]);
      EXPECT_EQ(its.a_next[j], one.a_next[j]);
      EXPECT_EQ(its.power[j], h * one.power[j]);
      EXPECT_EQ(its.error_in_v[j], h * h * one.error_in_v[j]);
      EXPECT_EQ(its.error_in_w[j], h * one.error_in_w[j]);
      EXPECT_EQ(its.error_in_a[j], one.error_in_a[j]);
    }
  }
}

}  // namespace
}  // namespace traverse::base
