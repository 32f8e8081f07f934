// Natural frequencies of continuous and of isolated spans, and of bars, against the exact dynamic stiffness
// (support/exact_beam.hpp) and frequency equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "support/convergence.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using std::numbers::pi;
using test::expect_exact;
using test::exact::chain_of;
using test::exact::Motion;

constexpr double EI = 1.96e9, EA = 1.0e10, m = 1000.0;

BeamModel bridge(const std::vector<double>& spans, int elements, bool axial = false) {
  BeamModel model;
  model.spans = spans;
  model.elements.assign(spans.size(), elements);
  model.supports.assign(spans.size() + 1, Support::roller);
  model.supports.front() = Support::pinned;
  model.EI = EI;
  model.EA = EA;
  model.mass = m;
  model.axial = axial;
  return model;
}

// --- continuous spans ------------------------------------------------------------------------------------------------

class ContinuousSpans : public testing::TestWithParam<std::vector<double>> {};
INSTANTIATE_TEST_SUITE_P(Frequencies, ContinuousSpans,
                         testing::Values(std::vector<double>{20, 20}, std::vector<double>{20, 27},
                                         std::vector<double>{20, 32, 24}, std::vector<double>{20, 20, 20, 20},
                                         std::vector<double>{18, 25, 25, 18}, std::vector<double>{15, 25, 30, 22, 18},
                                         std::vector<double>{20, 20, 20, 20, 20}),
                         [](const auto& which) {
                           std::string name;
                           for (double span : which.param) name += "_" + std::to_string(static_cast<int>(span));
                           return name.substr(1);
                         });

TEST_P(ContinuousSpans, FourthOrder) {
  const auto& spans = GetParam();
  // 16 elements in spans of 30 m: beta h is less than 0.6 up to the last mode.
  expect_exact([&](int n) { return bridge(spans, n); }, 0, static_cast<int>(spans.size()) + 2);
}

TEST_P(ContinuousSpans, ClampedAndFreeEnds) {
  const auto& spans = GetParam();
  expect_exact(
      [&](int n) {
        BeamModel model = bridge(spans, n);
        model.supports.front() = Support::clamped;
        model.supports.back() = Support::free;  // an overhang
        return model;
      },
      0, 4);
}

// The reference's own check: the three-moment equation of free vibration,
//   psi_i M_(i-1) + (phi_i + phi_(i+1)) M_i + psi_(i+1) M_(i+1) = 0,
//   phi = coth(b) - cot(b), psi = 1/sin(b) - 1/sinh(b), b = beta L_i
// (from the end rotations of a span under end moments; Rogers 1959, Dynamics of Framed Structures). Its determinant
// changes sign at each exact frequency.
TEST_P(ContinuousSpans, ThreeMomentEquation) {
  const auto& spans = GetParam();
  const auto exact = test::exact::frequencies(chain_of(bridge(spans, 1)).chain, static_cast<int>(spans.size()) + 2);
  const auto determinant = [&](double omega) {
    const double beta = std::pow(m * omega * omega / EI, 0.25);
    const auto phi = [&](double L) { return 1.0 / std::tanh(beta * L) - 1.0 / std::tan(beta * L); };
    const auto psi = [&](double L) { return 1.0 / std::sin(beta * L) - 1.0 / std::sinh(beta * L); };
    double before = 1.0, now = phi(spans[0]) + phi(spans[1]);  // of the leading minors
    for (std::size_t i = 1; i + 1 < spans.size(); ++i) {
      const double next = (phi(spans[i]) + phi(spans[i + 1])) * now - psi(spans[i]) * psi(spans[i]) * before;
      before = now;
      now = next;
    }
    return now;
  };
  for (std::size_t i = 0; i < exact.size(); ++i) {
    // Where a span alone has this frequency too, psi is infinite and says nothing: modes of equal spans.
    const double beta = std::pow(m * exact[i] * exact[i] / EI, 0.25);
    const bool pole =
        std::any_of(spans.begin(), spans.end(), [&](double L) { return std::abs(std::sin(beta * L)) < 1e-6; });
    if (pole) continue;
    EXPECT_LT(determinant(exact[i] * (1 - 1e-9)) * determinant(exact[i] * (1 + 1e-9)), 0.0) << "mode " << i + 1;
  }
}

// --- isolated spans --------------------------------------------------------------------------------------------------

// Spans of 20 m (three), 25 m (two) and 31 m: each frequency (n pi/L)^2 sqrt(EI/m) as often as its span.
TEST(Frequencies, IsolatedSpansRepeatThem) {
  const std::vector<double> spans{20, 25, 20, 31, 25, 20};
  const int count = 24;
  std::vector<double> exact;
  for (double span : spans) {
    for (int n = 1; n <= 12; ++n) exact.push_back(std::pow(n * pi / span, 2) * std::sqrt(EI / m));
  }
  std::sort(exact.begin(), exact.end());
  exact.resize(count);
  const auto model = [&](int n) {
    BeamModel isolated = bridge(spans, n);
    isolated.joints = {beam::Joint::separate};
    return isolated;
  };
  test::expect_convergence(exact, model, 20, 0, {4.0, 0.1, 3e-6, 1e-6});  // (6 pi/80)^4/1440 = 2e-6
  // Copies are equal to the last bit, and each moves a span of its own.
  const beam::Beam beam(PETSC_COMM_SELF, model(20));
  const auto found = modes::natural_modes(beam, count, true);
  std::map<double, std::vector<int>> moved;
  for (int i = 0; i < count; ++i) {
    int nodes_moved = 0, span = -1;
    for (int node = 0; node < beam.mesh().nodes(); ++node) {
      if (found.shape[i][static_cast<std::size_t>(node)] == 0.0) continue;
      span = node / 21;
      ++nodes_moved;
    }
    EXPECT_LE(nodes_moved, 19) << "one span only";
    moved[found.omega[i]].push_back(span);
  }
  for (auto& [omega, which] : moved) {
    std::sort(which.begin(), which.end());
    EXPECT_EQ(std::unique(which.begin(), which.end()), which.end()) << omega;
  }
  EXPECT_EQ(moved[found.omega[0]], (std::vector<int>{3}));        // 31 m
  EXPECT_EQ(moved[found.omega[1]], (std::vector<int>{1, 4}));     // 25 m
  EXPECT_EQ(moved[found.omega[3]], (std::vector<int>{0, 2, 5}));  // 20 m
}

// --- along x ---------------------------------------------------------------------------------------------------------

/// A bar of 20 m; linear elements: omega is off by (beta h)^2/24.
BeamModel bar(int elements, Support left, Support right) {
  BeamModel model = bridge({20.0}, elements, true);
  model.supports = {left, right};
  return model;
}
constexpr test::Bounds second_order{2.0, 0.05, 2e-3, 2e-5};

// Not even 1e-6 on thousands of elements by h^2 alone: the limit is what both meshes extrapolate to.
TEST(AxialFrequencies, EveryPairOfEnds) {
  for (const auto left : {Support::roller, Support::pinned}) {
    for (const auto right : {Support::roller, Support::pinned, Support::guided}) {
      const int rigid = left == Support::roller && right == Support::roller ? 1 : 0;
      expect_exact([&](int n) { return bar(n, left, right); }, rigid, 3, second_order, Motion::axial);
    }
  }
}

// EA/L = 5e8 N/m. The exact stiffness against tan(b) = -EA b/(k L), b = omega L sqrt(m/EA), too.
TEST(AxialFrequencies, EndSprings) {
  const double L = 20.0, k = 3e8;
  const auto one = [&](int n) {
    BeamModel model = bar(n, Support::pinned, Support::roller);
    model.foundation.longitudinal = {{L, k, 1e5}};
    return model;
  };
  for (double omega : test::exact::frequencies(chain_of(one(1), Motion::axial).chain, 3)) {
    const double b = omega * L * std::sqrt(m / EA);
    EXPECT_NEAR(std::tan(b) / (-EA * b / (k * L)), 1.0, 1e-12);
  }
  expect_exact(one, 0, 3, second_order, Motion::axial);
  const auto both = [&](int n) {
    BeamModel model = bar(n, Support::roller, Support::roller);
    model.foundation.longitudinal = {{0.0, 1e8, 0.0}, {L, 1e9, 0.0}};
    return model;
  };
  expect_exact(both, 0, 3, second_order, Motion::axial);
}

TEST(AxialFrequencies, InnerSpringAndBed) {
  const double L = 20.0;
  const auto on_bed = [&](int n) {
    BeamModel model = bar(n, Support::roller, Support::roller);
    model.foundation.longitudinal_bed = beam::Bed{5e7, 1e3};
    return model;
  };
  EXPECT_NEAR(test::axial_frequencies(on_bed(16), 1)[0] / std::sqrt(5e7 / m), 1.0, 1e-12) << "all of it together";
  expect_exact(
      [&](int n) {
        BeamModel model = on_bed(n);
        model.foundation.longitudinal = {{L / 4, 3e8, 0.0}};
        return model;
      },
      0, 3, second_order, Motion::axial);
  // Inside an element the strain jumps, and a linear element's cannot: of first order. At a third of the bar the
  // spring stands at a third of an element from the left or from the right on every mesh.
  expect_exact(
      [&](int n) {
        BeamModel model = bar(n, Support::pinned, Support::roller);
        model.foundation.longitudinal = {{L / 3, 1e9, 0.0}};
        return model;
      },
      0, 1, {1.0, 0.1, 1e-2, 1e-3}, Motion::axial);
}

// A step of EA and mass at a node, and of a bed inside an element (which does not cost the order).
TEST(AxialFrequencies, SteppedBar) {
  expect_exact(
      [](int n) {
        BeamModel model = bar(n, Support::pinned, Support::roller);
        model.EA = beam::Distribution({0, 5, 5, 20}, {2e10, 2e10, 0.5e10, 0.5e10}, "EA");
        model.mass = beam::Distribution({0, 10, 10, 20}, {1000, 1000, 700, 700}, "mass");
        model.foundation.longitudinal_bed =
            beam::Bed{beam::Distribution({0, 20.0 / 3, 20.0 / 3, 20}, {9e7, 9e7, 1e7, 1e7}, "k"), 0.0};
        return model;
      },
      0, 3, second_order, Motion::axial);
}

// Continuous spans are one bar, whatever their rollers.
TEST(AxialFrequencies, ContinuousSpansAreOneBar) {
  const auto found = test::axial_frequencies(bridge({20, 30, 25}, 40, true), 2);
  for (int i = 0; i < 2; ++i) {
    const double b = (2 * i + 1) * pi / 2;
    EXPECT_NEAR(found[i] / (b / 75.0 * std::sqrt(EA / m)), 1.0, std::pow(b / 100, 2) / 24 * 1.1) << "mode " << i + 1;
  }
}

}  // namespace
}  // namespace traverse
