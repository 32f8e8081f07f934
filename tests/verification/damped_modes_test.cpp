// Damped natural modes against exact ones: lambda of Bernoulli-Euler beams and bars with a damper, as roots of their
// complex frequency equations. v = phi(x) exp(lambda t), phi'''' = beta^4 phi with lambda = i beta^2 sqrt(EI/m). The
// argument principle says how many roots there are, so that none is missed.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "modes/modes.hpp"
#include "support/one_span.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using std::numbers::pi;
using Complex = std::complex<double>;

using namespace test::one_span;

modes::DampedModes damped(const BeamModel& model, int count, beam::Rayleigh ab = {}) {
  beam::Beam beam(PETSC_COMM_WORLD, model);
  beam.set_rayleigh(ab);
  return modes::damped_modes(beam, count, true);
}

// --- exact eigenvalues

using Equation = std::function<Complex(Complex lambda)>;  // entire, real for real lambda

Complex beta_of(Complex lambda) { return std::sqrt(lambda / (Complex(0, 1) * std::sqrt(EI / m))); }

/// The root next to a guess: Newton's method with a derivative by complex differences.
Complex root_near(const Equation& f, Complex lambda) {
  for (int i = 0; i < 50; ++i) {
    const double h = 1e-4 * std::abs(lambda);
    const Complex slope = (f(lambda + h) - f(lambda - h)) / (2.0 * h), step = f(lambda) / slope;
    lambda -= step;
    if (std::abs(step) < 1e-14 * std::abs(lambda)) break;
  }
  return lambda;
}

/// How many roots lie in |lambda| < radius: how often the value turns about zero while lambda goes round.
int roots_within(const Equation& f, double radius) {
  const int steps = 20000;
  double turned = 0.0;
  Complex last = f(radius);
  for (int i = 1; i <= steps; ++i) {
    const Complex next = f(std::polar(radius, 2.0 * pi * i / steps));
    turned += std::arg(next / last);
    last = next;
  }
  return static_cast<int>(std::lround(turned / (2.0 * pi)));
}

/// Receptances times their denominators: the displacement under a unit force, or the rotation under a unit moment.
/// Simply supported, a spring k and a damper c at x = x1, Rayleigh damping of the beam: 1 + (k + lambda c) G = 0,
///
///   2 B beta^3 G = sin(beta x1) sin(beta x2)/sin(beta L) - sinh(beta x1) sinh(beta x2)/sinh(beta L), x1 + x2 = L,
///
/// with B = (1 + b lambda) EI and beta^4 = -m (lambda^2 + a lambda)/B.
Equation point_in_span(double k, double c, double x1, beam::Rayleigh ab = {}) {
  return [=](Complex lambda) {
    const Complex B = EI * (1.0 + ab.b * lambda), x2 = L - x1;
    const Complex q = pow(-m * lambda * (lambda + ab.a) / B, 0.25);
    return 2.0 * B * sin(q * L) * sinh(q * L) / (q * q) +
           (k + lambda * c) * (sin(q * x1) * sin(q * x2) * sinh(q * L) - sinh(q * x1) * sinh(q * x2) * sin(q * L)) /
               pow(q, 5);
  };
}

/// Cantilever, a damper at its tip: EI phi''' = c lambda phi there.
Equation damper_at_tip(double c) {
  return [=](Complex lambda) {
    const Complex q = beta_of(lambda), z = q * L;
    return EI * (1.0 + cos(z) * cosh(z)) + lambda * c * (sin(z) * cosh(z) - cos(z) * sinh(z)) / pow(q, 3);
  };
}

/// Simply supported, a rotational damper at its end: 1 + lambda c (coth(beta L) - cot(beta L))/(2 EI beta) = 0.
Equation rotational_damper(double c) {
  return [=](Complex lambda) {
    const Complex q = beta_of(lambda), z = q * L;
    return 2.0 * EI * sin(z) * sinh(z) / (q * q) + lambda * c * (cosh(z) * sin(z) - cos(z) * sinh(z)) / pow(q, 3);
  };
}

/// Free beam, a damper at one end: EI beta^3 (1 - cos cosh) = c lambda (sin cosh - cos sinh), divided by its one
/// root lambda = 0.
Equation damper_at_free_end(double c) {
  return [=](Complex lambda) {
    const Complex q = beta_of(lambda), z = q * L;
    return EI * (1.0 - cos(z) * cosh(z)) / lambda - c * (sin(z) * cosh(z) - cos(z) * sinh(z)) / pow(q, 3);
  };
}

// --- beams with a damper

constexpr int coarse = 24, fine = 48;  // elements, even: x = L/2 and L/4 are nodes
constexpr int looked_at = 5;           // modes, apart from the rigid ones

struct Case {
  const char* name;
  BeamModel model;
  Equation exact;
  int rigid;
  int overdamped;  // among those looked at
  beam::Rayleigh rayleigh = {};
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Case in_span(const char* name, double c, double x, int overdamped, double k = 0.0, beam::Rayleigh ab = {}) {
  BeamModel model = span(Support::pinned, Support::roller, 1);
  model.foundation.vertical = {{x, k, c}};
  return {name, model, point_in_span(k, c, x, ab), 0, overdamped, ab};
}

Case at_end(const char* name, double c, Support left, const Equation& exact, int rigid, int overdamped) {
  BeamModel model = span(left, Support::free, 1);
  model.foundation.vertical = {{L, 0.0, c}};
  return {name, model, exact, rigid, overdamped};
}

Case turning(const char* name, double c, int overdamped) {
  BeamModel model = span(Support::pinned, Support::roller, 1);
  model.foundation.rotational = {{0.0, 0.0, c}};
  return {name, model, rotational_damper(c), 0, overdamped};
}

class DampedBending : public testing::TestWithParam<Case> {
 protected:
  std::vector<Complex> found(int elements, int count) const {
    BeamModel model = GetParam().model;
    model.elements = {elements};
    return damped(model, count, GetParam().rayleigh).lambda;
  }
};

// c = omega_1 m L, 7e5 N s/m, in the middle of a simply supported beam would be critical for its first mode alone.
INSTANTIATE_TEST_SUITE_P(
    DampedModes, DampedBending,
    testing::Values(in_span("weak_at_midspan", 1e5, L / 2, 0), in_span("strong_at_midspan", 2e6, L / 2, 2),
                    in_span("weak_off_the_middle", 1e5, L / 4, 0),
                    // The spring's stiffness has no part in b K: no analytic answer although nothing else damps.
                    in_span("rayleigh_and_a_spring", 0.0, L / 2, 0, 5e7, {0.5, 2e-4}),
                    in_span("rayleigh_spring_and_damper", 1e5, L / 4, 0, 5e7, {0.5, 2e-4}),
                    at_end("weak_at_tip", 3e4, Support::clamped, damper_at_tip(3e4), 0, 0),
                    at_end("strong_at_tip", 1e6, Support::clamped, damper_at_tip(1e6), 0, 1),
                    // Two rigid motions; the damper resists one of them.
                    at_end("free_beam", 5e4, Support::free, damper_at_free_end(5e4), 2, 1),
                    turning("weak_rotational", 1e7, 1), turning("strong_rotational", 2e8, 1)),
    [](const auto& which) { return which.param.name; });

TEST_P(DampedBending, FourthOrder) {
  const Case& c = GetParam();
  const int last = c.rigid + looked_at;
  const auto rough = found(coarse, last), lambda = found(fine, last);
  ASSERT_EQ(lambda.size(), static_cast<std::size_t>(last));
  for (int i = 0; i < c.rigid; ++i) EXPECT_EQ(lambda[i], 0.0) << "rigid mode " << i;
  int overdamped = 0;
  for (int i = c.rigid; i < last; ++i) {
    const Complex exact = root_near(c.exact, lambda[i]);
    const double e1 = std::abs(rough[i] / exact - 1.0), e2 = std::abs(lambda[i] / exact - 1.0);
    // (beta h)^4/1440 of an undamped mode, 8e-6 in the fifth one; a mode that a damper holds moves like the next.
    EXPECT_LT(e2, 1e-5) << "mode " << i;
    // Below 1e-8 there is rounding, of 0.02 eps n^4 = 2e-11, in what is left.
    if (e1 > 1e-8) {
      EXPECT_NEAR(std::log2(e1 / e2), 4.0, 0.1) << "mode " << i;
    }
    if (lambda[i].imag() == 0.0) ++overdamped;
  }
  EXPECT_EQ(overdamped, c.overdamped);
}

TEST_P(DampedBending, NoneIsMissed) {
  const Case& c = GetParam();
  const auto lambda = found(fine, c.rigid + looked_at + 1);
  int eigenvalues = 0;
  for (int i = c.rigid; i < c.rigid + looked_at; ++i) eigenvalues += lambda[i].imag() == 0.0 ? 1 : 2;
  const double between = std::sqrt(std::abs(lambda[lambda.size() - 2]) * std::abs(lambda.back()));
  EXPECT_EQ(roots_within(c.exact, between), eigenvalues);
}

// A force within an element bends it as no cubic does: h^3 xi^3 (1 - xi)^3/(3 EI) of its displacement is missing, so
// the order is three. An overdamped mode shows it: lambda = -1/(c G), nearly.
TEST(DampedModes, DamperWithinAnElementThirdOrder) {
  const auto first = [](int elements) {
    BeamModel model = span(Support::pinned, Support::roller, elements);
    model.foundation.vertical = {{L / 2, 0.0, 2e6}};
    return damped(model, 1).lambda.at(0);
  };
  const Complex rough = first(25), better = first(75), exact = root_near(point_in_span(0.0, 2e6, L / 2), better);
  const double e1 = std::abs(rough / exact - 1.0), e2 = std::abs(better / exact - 1.0);
  EXPECT_NEAR(std::log(e1 / e2) / std::log(3.0), 3.0, 0.05);
  EXPECT_LT(e2, 1e-5);
  const double missing = std::pow(L / 25, 3) / 64 / (3 * EI), whole = std::pow(L, 3) / (48 * EI);
  EXPECT_NEAR(e1, missing / whole, 0.1 * e1);
}

// --- bars with a damper

/// A bar held at x = 0 with a damper at x = L: Z cosh s + c sinh s = 0, s = lambda L/speed, Z = sqrt(EA m). From
/// there exp(2 s) = (c - Z)/(c + Z).
Complex bar(double c, int mode) {
  const double Z = std::sqrt(EA * m), size = 0.5 * std::log(std::abs(c - Z) / (c + Z));
  return std::sqrt(EA / m) / L * Complex(size, pi * (c > Z ? mode : mode + 0.5));
}

std::vector<Complex> axial_modes(double c, int elements) {
  BeamModel model = span(Support::pinned, Support::roller, elements);
  model.axial = true;
  model.foundation.longitudinal = {{L, 0.0, c}};
  const auto found = damped(model, 8);
  std::vector<Complex> lambda;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found.motion[i] == modes::Motion::along) lambda.push_back(found.lambda[i]);
  }
  return lambda;
}

TEST(DampedModes, BarWithEndDamperSecondOrder) {
  for (double c : {1e6, 1e7}) {  // below and above Z = 3.16e6: with c above it the first mode is overdamped
    const auto rough = axial_modes(c, 200), better = axial_modes(c, 400);
    ASSERT_GE(better.size(), 2u);
    for (int i = 0; i < 2; ++i) {
      const Complex exact = bar(c, i);
      const double e1 = std::abs(rough[i] / exact - 1.0), e2 = std::abs(better[i] / exact - 1.0);
      EXPECT_LT(e2, 1e-5) << c << " mode " << i;  // |s|^2/(24 n^2) of an undamped mode, 6e-6 in the second
      EXPECT_NEAR(std::log2(e1 / e2), 2.0, 0.02) << c << " mode " << i;
    }
    EXPECT_EQ(better[0].imag() == 0.0, c > 3.2e6);
  }
}

// --- analytic answers

constexpr double free_beta_L[] = {0.0, 0.0, 4.730040744862704, 7.853204624095838};  // Blevins 1979

/// Both roots of lambda^2 + 2 half lambda + square = 0.
std::pair<Complex, Complex> quadratic(double half, double square) {
  const Complex root = std::sqrt(Complex(half * half - square));
  return {-half + root, -half - root};
}

// Free beam, a uniform bed k, c: lambda^2 m + lambda c + k + EI beta^4 = 0, two rigid shapes among them. With
// Rayleigh damping of the beam, a m + b EI beta^4 joins c.
TEST(DampedModes, BedUnderAFreeBeam) {
  const double k = 1e6, c = 4e3;
  auto model = span(Support::free, Support::free, 40);
  model.foundation.vertical_bed = beam::Bed{k, c};
  for (const beam::Rayleigh ab : {beam::Rayleigh{}, beam::Rayleigh{0.3, 1e-4}}) {
    const auto found = damped(model, 4, ab);
    for (int i = 0; i < 4; ++i) {
      const double bending = EI * std::pow(free_beta_L[i] / L, 4);
      const Complex exact = quadratic(0.5 * (c / m + ab.a + ab.b * bending / m), (k + bending) / m).first;
      // Rigid shapes are exact in the mesh; the others (beta h)^4/700 off, 2e-6.
      EXPECT_LT(std::abs(found.lambda[i] / exact - 1.0), i < 2 ? 1e-9 : 5e-6) << "mode " << i;
    }
  }
}

// A bed of dampers only: both rigid motions stay where they are put, and each dies away with c/m.
TEST(DampedModes, DampingBedAlone) {
  auto model = span(Support::free, Support::free, 40);
  model.foundation.vertical_bed = beam::Bed{0.0, 4e3};
  const auto found = damped(model, 5);
  EXPECT_EQ(found.lambda[0], 0.0);
  EXPECT_EQ(found.lambda[1], 0.0);
  for (int i : {2, 3}) {
    EXPECT_NEAR(found.lambda[i].real(), -4.0, 1e-12);
    EXPECT_EQ(found.lambda[i].imag(), 0.0);
  }
  EXPECT_GT(found.damped_omega(4), 0.0);
}

TEST(DampedModes, RayleighAlone) {
  const beam::Rayleigh ab{100.0, 1e-3};  // zeta 1.46, 0.43, 0.32, 0.37, 0.49
  const auto model = span(Support::pinned, Support::roller, 24);
  const auto omega = modes::natural_modes(beam::Beam(PETSC_COMM_WORLD, model), 5, false).omega;
  const auto found = damped(model, 5, ab);
  ASSERT_EQ(found.size(), 5u);
  const double zeta = ab.a / (2 * omega[0]) + ab.b * omega[0] / 2;
  ASSERT_GT(zeta, 1.0);
  // An overdamped pair, then the others.
  EXPECT_NEAR(found.decay_rate(0) / omega[0], zeta - std::sqrt(zeta * zeta - 1), 1e-12);
  EXPECT_NEAR(found.decay_rate(1) / omega[0], zeta + std::sqrt(zeta * zeta - 1), 1e-12);
  EXPECT_EQ(found.ratio(0), 1.0);
  EXPECT_EQ(found.damped_omega(1), 0.0);
  for (int i = 2; i < 5; ++i) {
    const double w = omega[i - 1], ratio = ab.a / (2 * w) + ab.b * w / 2;
    EXPECT_NEAR(found.ratio(i), ratio, 1e-12);
    EXPECT_NEAR(found.damped_omega(i) / (w * std::sqrt(1 - ratio * ratio)), 1.0, 1e-12);
    EXPECT_NEAR(found.omega(i) / w, 1.0, 1e-12);
  }
}

// --- what must not matter

TEST(DampedModes, FewAtATimeAreThoseOfAllAtOnce) {
  BeamModel model = span(Support::free, Support::free, 50);  // 102 unknowns
  model.foundation.vertical = {{3.3, 1e6, 1e5}, {12.0, 0.0, 3e6}};
  model.foundation.rotational = {{L, 0.0, 1e7}};
  const auto few = damped(model, 12), all = damped(model, 80);  // by Krylov-Schur; more than half, by LAPACK
  ASSERT_EQ(few.size(), 12u);
  ASSERT_EQ(all.size(), 80u);
  for (int i = 0; i < 12; ++i) {
    EXPECT_LE(std::abs(few.lambda[i] - all.lambda[i]), 1e-9 * std::abs(all.lambda[i])) << "mode " << i;
  }
}

TEST(DampedModes, ShapeOfACantileverWithATipDamper) {
  BeamModel model = span(Support::clamped, Support::free, 48);
  model.foundation.vertical = {{L, 0.0, 1e5}};
  const auto found = damped(model, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Complex q = beta_of(found.lambda[i]), z = q * L;
    const Complex sigma = (cosh(z) + cos(z)) / (sinh(z) + sin(z));  // phi''(L) = 0
    const auto phi = [&](double x) { return cosh(q * x) - cos(q * x) - sigma * (sinh(q * x) - sin(q * x)); };
    const Complex ratio = found.shape[i][24] / found.shape[i][48], exact = phi(L / 2) / phi(L);
    EXPECT_LT(std::abs(ratio - exact), 1e-4 * std::abs(exact)) << "mode " << i;
    double largest = 0.0;
    for (const Complex& v : found.shape[i]) largest = std::max(largest, std::abs(v));
    EXPECT_DOUBLE_EQ(largest, 1.0);
  }
}

BeamModel isolated_spans(int elements, std::vector<double> dampers) {
  BeamModel model = span(Support::pinned, Support::pinned, elements);
  model.joints = {beam::Joint::separate};
  model.spans.assign(dampers.size(), L);
  model.elements.assign(dampers.size(), elements);
  model.supports.assign(dampers.size() + 1, Support::pinned);
  for (std::size_t i = 0; i < dampers.size(); ++i) {
    model.foundation.vertical.push_back({(static_cast<double>(i) + 0.5) * L, 0.0, dampers[i]});
  }
  return model;
}

TEST(DampedModes, EqualIsolatedSpansKeepTheirCopies) {
  const auto found = damped(isolated_spans(20, {1e5, 1e5, 1e5}), 6, {0.1, 1e-4});
  EXPECT_EQ(found.lambda[0], found.lambda[2]);
  EXPECT_EQ(found.lambda[3], found.lambda[5]);
  EXPECT_NE(found.lambda[2], found.lambda[3]);
}

// A damper so weak that b K drowns it in every entry still tells its span from the other: it adds c/(m L) to the
// decay of the first mode.
TEST(DampedModes, WeakDamperTellsSpansApart) {
  const auto found = damped(isolated_spans(100, {0.0, 1.0}), 2, {0.1, 1e-3});
  EXPECT_NEAR(std::abs(found.decay_rate(1) - found.decay_rate(0)) * (m * L), 1.0, 1e-2);
}

// Every high frequency of the mesh has a real mode near 1/b: none of them among the beam's own.
TEST(DampedModes, ListEndsWhereModesCrowd) {
  const beam::Rayleigh ab{0.5, 1e-3};
  BeamModel model = span(Support::pinned, Support::roller, 20);
  model.foundation.vertical = {{L / 2, 0.0, 1e5}};
  for (int elements : {20, 100}) {  // by LAPACK and by Krylov-Schur
    model.elements = {elements};
    const auto found = damped(model, 20, ab);
    EXPECT_EQ(found.size(), 5u);  // of 34.5 n^2 rad/s, those below 1000
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_GT(found.damped_omega(i), 0.0);
  }
}

}  // namespace
}  // namespace traverse
