// Damped natural modes against exact ones: lambda of Bernoulli-Euler beams and bars with a damper, as roots of their
// complex frequency equations. v = phi(x) exp(lambda t), phi'''' = beta^4 phi with lambda = i beta^2 sqrt(EI/m). The
// argument principle says how many roots there are, so that none is missed.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "traverse/modes/modes.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double EI = 1.96e9, EA = 1.0e10, m = 1000.0, L = 20.0;

BeamModel model_of(Support left, Support right, int elements) {
  BeamModel model;
  model.spans = {L};
  model.elements = {elements};
  model.supports = {left, right};
  model.EI = EI;
  model.EA = EA;
  model.mass = m;
  model.axial = false;
  return model;
}

modes::DampedModes damped(const BeamModel& model, int count, beam::Rayleigh ab = {}) {
  beam::Beam beam(PETSC_COMM_WORLD, model);
  beam.set_rayleigh(ab);
  return modes::damped_modes(beam, count, true);
}

std::vector<Complex> eigenvalues(const BeamModel& model, int count) { return damped(model, count).lambda; }

// ------------------------------------------------------------------------------------------- exact eigenvalues

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
/// Simply supported, a damper c at x = a: 1 + lambda c G(a, a) = 0,
/// 2 EI beta^3 G = sin(beta a) sin(beta b)/sin(beta L) - sinh(beta a) sinh(beta b)/sinh(beta L), a + b = L.
Equation damper_in_span(double c, double a) {
  return [=](Complex lambda) {
    const Complex q = beta_of(lambda), b = L - a;
    return 2.0 * EI * sin(q * L) * sinh(q * L) / (q * q) +
           lambda * c * (sin(q * a) * sin(q * b) * sinh(q * L) - sinh(q * a) * sinh(q * b) * sin(q * L)) / pow(q, 5);
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

/// A bar held at one end, a damper at the other: u = sinh(lambda x/speed), EA u' = -c lambda u at x = L.
Equation damper_on_bar(double c) {
  return [=](Complex lambda) {
    const Complex s = lambda * L / std::sqrt(EA / m);
    return std::sqrt(EA * m) * cosh(s) + c * sinh(s);
  };
}

// ------------------------------------------------------------------------------------------------------- cases

struct Case {
  const char* name;
  std::function<BeamModel(int elements)> model;
  Equation exact;
  int coarse, fine;  // elements
  int rigid;
  int real;      // overdamped modes among the first
  double order;  // of the error with the length of an element
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

constexpr int looked_at = 5;  // modes that are not rigid

Case in_span(const char* name, double c, double a, int coarse, int fine, int real, double order) {
  return {name,
          [=](int elements) {
            BeamModel model = model_of(Support::pinned, Support::roller, elements);
            model.foundation.vertical = {{a, 0.0, c}};
            return model;
          },
          damper_in_span(c, a),
          coarse,
          fine,
          0,
          real,
          order};
}

Case at_end(const char* name, double c, Support left, Equation exact, int rigid, int real) {
  return {name,
          [=](int elements) {
            BeamModel model = model_of(left, Support::free, elements);
            model.foundation.vertical = {{L, 0.0, c}};
            return model;
          },
          std::move(exact),
          24,
          48,
          rigid,
          real,
          4.0};
}

Case turning(const char* name, double c, int real) {
  return {name,
          [=](int elements) {
            BeamModel model = model_of(Support::pinned, Support::roller, elements);
            model.foundation.rotational = {{0.0, 0.0, c}};
            return model;
          },
          rotational_damper(c),
          24,
          48,
          0,
          real,
          4.0};
}

class DampedBending : public testing::TestWithParam<Case> {};
// A damper of c = omega_1 m L is critical in the first mode of a simply supported beam, 7e5 N s/m.
INSTANTIATE_TEST_SUITE_P(
    DampedModes, DampedBending,
    testing::Values(in_span("weak_at_midspan", 1e5, L / 2, 24, 48, 0, 4.0),
                    in_span("strong_at_midspan", 2e6, L / 2, 24, 48, 2, 4.0),
                    in_span("weak_off_the_middle", 1e5, L / 4, 24, 48, 0, 4.0),
                    // Within an element the damper's force bends what a cubic cannot follow: third order.
                    in_span("weak_inside_an_element", 1e5, L / 2, 25, 51, 0, 3.0),
                    at_end("weak_at_tip", 3e4, Support::clamped, damper_at_tip(3e4), 0, 0),
                    at_end("strong_at_tip", 1e6, Support::clamped, damper_at_tip(1e6), 0, 1),
                    at_end("free_beam", 5e4, Support::free, damper_at_free_end(5e4), 2, 1),
                    turning("weak_rotational", 1e7, 1), turning("strong_rotational", 2e8, 1)),
    [](const auto& which) { return which.param.name; });

TEST_P(DampedBending, ExactAndOfItsOrder) {
  const Case& c = GetParam();
  const int count = c.rigid + looked_at + 1;
  const auto coarse = eigenvalues(c.model(c.coarse), count), fine = eigenvalues(c.model(c.fine), count);
  ASSERT_EQ(fine.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < c.rigid; ++i) EXPECT_EQ(fine[i], 0.0) << "rigid mode " << i;
  int real = 0, roots = 0;
  for (int i = c.rigid; i + 1 < count; ++i) {
    const Complex exact = root_near(c.exact, fine[i]);
    const double e1 = std::abs(coarse[i] / exact - 1.0), e2 = std::abs(fine[i] / exact - 1.0);
    std::printf("%s %d: %.10g %+.10g i  exact %.10g %+.10g  e1 %.3g e2 %.3g order %.3f\n", c.name, i, fine[i].real(), fine[i].imag(), exact.real(), exact.imag(), e1, e2, std::log(e1 / e2) / std::log(double(c.fine) / c.coarse));
    if (fine[i].imag() == 0.0) ++real;
    roots += fine[i].imag() == 0.0 ? 1 : 2;
  }
  EXPECT_EQ(real, c.real);
  const double radius = std::sqrt(std::abs(fine[count - 2]) * std::abs(fine[count - 1]));
  EXPECT_EQ(roots_within(c.exact, radius), roots) << "modes missed";
}

}  // namespace
}  // namespace traverse
