// Beams with dampers from none to overdamped: damped modes against roots of the exact dynamic stiffness with complex
// exponents (support/exact_beam.hpp), and what dampers do not hold.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

#include "beam/beam.hpp"
#include "support/exact_model.hpp"
#include "support/message.hpp"
#include "support/one_span.hpp"
#include "support/rows.hpp"
#include "support/scene_run.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using std::numbers::pi;
using test::exact::chain_of;

using namespace test::one_span;

/// A root s of det(s^2 M + s C + K) next to `start`, by the secant method.
std::complex<double> damped_root(const BeamModel& model, std::complex<double> start) {
  using Complex = std::complex<long double>;
  using Matrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic>;
  beam::Beam beam(PETSC_COMM_SELF, model);
  beam.set_rayleigh({});
  const auto M = test::local_rows(beam.mass()), C = test::local_rows(beam.damping()),
             K = test::local_rows(beam.stiffness());
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < M.size(); ++i) {
    if (beam.fixed()[i] == 0) free.push_back(i);
  }
  const auto n = static_cast<Eigen::Index>(free.size());
  const auto determinant = [&](Complex s, long double& scale) {
    Matrix A(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const std::size_t row = free[static_cast<std::size_t>(i)], column = free[static_cast<std::size_t>(j)];
        A(i, j) = s * s * Complex(M[row][column]) + s * Complex(C[row][column]) + Complex(K[row][column]);
      }
    }
    const Eigen::PartialPivLU<Matrix> lu(A);
    if (scale == 0.0L) {
      for (Eigen::Index i = 0; i < n; ++i)
        scale += std::log(std::abs(lu.matrixLU()(i, i))) / static_cast<long double>(n);
      scale = std::exp(scale);
    }
    Complex product = static_cast<long double>(lu.permutationP().determinant());
    for (Eigen::Index i = 0; i < n; ++i) product *= lu.matrixLU()(i, i) / scale;
    return product;
  };
  long double scale = 0.0L;
  Complex a(start.real(), start.imag()), b = a * (1.0L + 1e-5L), at_a = determinant(a * (1.0L + 1e-4L), scale);
  at_a = determinant(a, scale);
  Complex at_b = determinant(b, scale);
  for (int i = 0; i < 60 && std::abs(b - a) > 1e-14L * std::abs(b) && at_a != at_b; ++i) {
    const Complex next = b - at_b * (b - a) / (at_b - at_a);
    a = b;
    at_a = at_b;
    b = next;
    at_b = determinant(b, scale);
  }
  return {static_cast<double>(b.real()), static_cast<double>(b.imag())};
}

// A cantilever with a damper at its tip, at each half decade. From below: the free one's first mode, until it hardly
// swings. From above: the propped one's first mode, which without damper is the free one's second.
TEST(Dampers, TipDamperFromNoneToRigid) {
  const auto at = [](double beta_L) { return std::complex<double>(0.0, unit * beta_L * beta_L); };
  const std::complex<double> first = at(1.875104068711961), second = at(4.694091132974174),
                             propped = at(3.926602312047919);
  BeamModel model = span(Support::clamped, Support::free, 16);
  model.foundation.vertical = {{L, 0.0, 0.0}};
  double most = 0.0;
  const auto follow = [&](std::complex<double>& exact, double c) {
    model.foundation.vertical[0].c = c;
    exact = test::exact::damped_root(chain_of(model).chain, exact);
    // (4.7/16)^4/1440 = 5e-6
    EXPECT_LT(std::abs(damped_root(model, exact) - exact), 6e-6 * std::abs(exact)) << "c = " << c;
    EXPECT_LE(exact.real(), 0.0) << "a damper takes energy, c = " << c;
    most = std::max(most, -exact.real() / std::abs(exact));
  };
  std::complex<double> s = first;
  for (int half = 0; half <= 10; ++half) follow(s, std::pow(10.0, 0.5 * half));
  EXPECT_GT(most, 0.3) << "of critical, at 1e5 N s/m";
  follow(s = first, 0.0);
  EXPECT_LT(std::abs(s - first), 1e-12 * std::abs(first));
  s = propped;
  follow(s, 1e15);
  EXPECT_LT(std::abs(s - propped), 1e-9 * std::abs(propped));
  for (int half = 29; half >= 0; --half) follow(s, std::pow(10.0, 0.5 * half));
  EXPECT_LT(std::abs(s - second), 1e-3 * std::abs(second));
}

// The beam moves up and down as one on its damped bed: m s^2 + c s + k = 0, also when overdamped; and bending mode n
// with k + (n pi/L)^4 EI in place of k.
TEST(Dampers, BedFromNoneToOverdamped) {
  const double k = 1e6, critical = 2 * std::sqrt(k * m);
  for (double ratio : {0.0, 1e-6, 0.1, 0.9, 1.1, 10.0, 1e3}) {
    BeamModel model = span(Support::free, Support::free, 8);
    model.foundation.vertical_bed = beam::Bed{k, ratio * critical};
    BeamModel simple = model;
    simple.elements = {16};
    simple.supports = {Support::pinned, Support::roller};
    const auto root = [&](double stiffness) {
      const double c = ratio * critical;
      const auto swing = std::sqrt(std::complex<double>(c * c - 4 * m * stiffness));
      // The slow one of two real roots; of a complex pair either.
      return -2.0 * stiffness / (c + swing);
    };
    const auto rigid = root(k), bending = root(k + std::pow(pi / L, 4) * EI);
    // The rigid root is a double one (up and down, and turning): the secant method gets half of the digits.
    EXPECT_LT(std::abs(damped_root(model, rigid) - rigid), 1e-5 * std::abs(rigid)) << ratio;
    EXPECT_LT(std::abs(damped_root(simple, bending) - bending), 5e-6 * std::abs(bending)) << ratio;
  }
}

std::string scene(const std::string& supports, const std::string& foundation) {
  return "beam: {spans: 20.0, EI: 1.96e9, mass: 1000.0, elements_per_span: 8}\nsupport: {types: [" + supports + "]}\n" +
         (foundation.empty() ? "" : "foundation: {" + foundation + "}\n") +
         "load: {forces: 1.0e5, speed: 40.0}\nts: {dt: 2.0e-3, max_time: 0.5}\noutput: {interval: 0.01, probes: [5, "
         "10, 20]}\n";
}

// Dampers alone hold nothing at rest.
TEST(Dampers, HoldNothingAtRest) {
  for (const char* damper : {"vertical: {x: [0.0, 20.0], c: 1.0e9}", "vertical_bed: {c: 1.0e9}"}) {
    const auto message = test::message_of([&] { test::run_yaml(scene("free, free", damper)); });
    EXPECT_TRUE(test::contains(message, "can move vertically and rotate")) << message;
  }
  const auto turning = test::message_of([] {
    test::run_yaml(scene("pinned, free", "rotational: {x: 0.0, c: 1.0e9}"), {{"scene_analysis", "static"}});
  });
  EXPECT_TRUE(test::contains(turning, "can rotate about x = 0 m")) << turning;
}

}  // namespace
}  // namespace traverse
