// Beams whose EI and mass vary along x: tapered ones against Ritz' method (support/ritz.hpp), stepped ones against the
// exact dynamic stiffness of their pieces (support/exact_beam.hpp). What a table does at a node costs nothing, and
// nodes come to where it steps. Inside an element the bending moment is smooth, so v'' = M/EI has what EI has and a
// cubic has not: a kink (h^3 of that one element, which does not show beside the h^4 of all on usual meshes).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/convergence.hpp"
#include "support/one_span.hpp"
#include "support/ritz.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Distribution;
using beam::Support;
using test::expect_exact;

using namespace test::one_span;

/// From 1 at x = 0 to `end` at x = L.
double wedge(double x, double end) { return 1.0 + (end - 1.0) * x / L; }

int held(Support s) { return s == Support::clamped ? 2 : s == Support::free ? 0 : 1; }

TEST(Ritz, UniformBeam) {
  // Blevins 1979, table 8-1.
  const double unit = std::sqrt(EI / m) / (L * L);
  const auto uniform = [](double value) { return [value](double) { return value; }; };
  const auto cantilever = test::ritz_frequencies({L, uniform(EI), uniform(m), 2, 0}, 3);
  const auto free = test::ritz_frequencies({L, uniform(EI), uniform(m), 0, 0}, 4);
  const double exact[] = {1.875104068711961, 4.694091132974174, 7.854757438237613};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(cantilever[i] / (unit * exact[i] * exact[i]), 1.0, 1e-12) << i;
  EXPECT_NEAR(free[2] / (unit * 4.730040744862704 * 4.730040744862704), 1.0, 1e-12);
  EXPECT_NEAR(free[3] / (unit * 7.853204624095838 * 7.853204624095838), 1.0, 1e-12);
}

// --- tapered ---------------------------------------------------------------------------------------------------------

struct Taper {
  const char* name;
  Support left, right;
  int rigid;
  double EI_end, mass_end;
};
void PrintTo(const Taper& t, std::ostream* out) { *out << t.name; }
class Tapered : public testing::TestWithParam<Taper> {};
INSTANTIATE_TEST_SUITE_P(Frequencies, Tapered,
                         testing::Values(Taper{"cantilever", Support::clamped, Support::free, 0, 0.2, 0.4},
                                         Taper{"cantilever_thicker_at_its_tip", Support::clamped, Support::free, 0, 3.0,
                                               2.0},
                                         Taper{"simply_supported", Support::pinned, Support::roller, 0, 0.3, 0.6},
                                         Taper{"clamped_clamped", Support::clamped, Support::clamped, 0, 4.0, 1.5},
                                         Taper{"clamped_pinned", Support::clamped, Support::pinned, 0, 0.5, 1.0},
                                         Taper{"free_free", Support::free, Support::free, 2, 0.4, 0.7},
                                         Taper{"pinned_free", Support::pinned, Support::free, 1, 1.0, 0.3}),
                         [](const auto& which) { return which.param.name; });

TEST_P(Tapered, FourthOrder) {
  const Taper& t = GetParam();
  const test::RitzBeam beam{L, [&](double x) { return EI * wedge(x, t.EI_end); },
                            [&](double x) { return m * wedge(x, t.mass_end); }, held(t.left), held(t.right)};
  const auto exact = test::ritz_frequencies(beam, t.rigid + 3);
  const auto fewer = test::ritz_frequencies(beam, t.rigid + 3, 20);
  for (int i = t.rigid; i < t.rigid + 3; ++i) ASSERT_NEAR(fewer[i] / exact[i], 1.0, 1e-11) << "converged";
  test::expect_convergence(
      exact,
      [&](int n) {
        BeamModel model = span(t.left, t.right, n);
        model.EI = Distribution({0, L}, {EI, EI * t.EI_end}, "EI");
        model.mass = Distribution({0, L}, {m, m * t.mass_end}, "mass");
        return model;
      },
      16, t.rigid);
}

// The same line from a table with stations inside elements: the integration is split there and nothing changes.
TEST(Tapered, MoreStationsOnTheSameLine) {
  BeamModel two = span(Support::clamped, Support::free, 10), many = two;
  two.EI = Distribution({0, L}, {EI, 0.2 * EI}, "EI");
  std::vector<double> x, values;
  for (int i = 0; i <= 7; ++i) {
    x.push_back(L * i / 7);
    values.push_back(EI * wedge(x.back(), 0.2));
  }
  many.EI = Distribution(x, values, "EI");
  const auto a = test::frequencies(two, 5), b = test::frequencies(many, 5);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(a[i] / b[i], 1.0, 1e-11) << i;
}

/// EI falls to a third over the first third of the beam and stays so.
BeamModel haunched(int elements) {
  BeamModel model = span(Support::clamped, Support::roller, elements);
  model.EI = Distribution({0, L / 3, L}, {EI, EI / 3, EI / 3}, "EI");
  return model;
}

// No reference sees a kink but a mesh that has a node there: 48 and 96 elements, extrapolated. (That this mesh is right
// is what the tapered beams above and the stepped ones below show.)
TEST(Haunched, KinkInsideAnElement) {
  const double coarse = test::frequencies(haunched(48), 1)[0], fine = test::frequencies(haunched(96), 1)[0];
  const double exact = fine + (fine - coarse) / 15;
  EXPECT_NEAR(std::log2((test::frequencies(haunched(12), 1)[0] / exact - 1) /
                        (test::frequencies(haunched(24), 1)[0] / exact - 1)),
              4.0, 0.1)
      << "at a node";
  const double e1 = test::frequencies(haunched(8), 1)[0] / exact - 1.0;
  const double e2 = test::frequencies(haunched(32), 1)[0] / exact - 1.0;
  RecordProperty("order", std::to_string(std::log2(e1 / e2) / 2));
  EXPECT_GT(std::log2(e1 / e2) / 2, 2.9) << "inside an element";
  EXPECT_LT(e2, 1e-6);
}

// --- stepped ---------------------------------------------------------------------------------------------------------

std::function<BeamModel(int)> stepped(Support left, Support right, double at, double EI_right, double mass_right) {
  return [=](int n) {
    BeamModel model = span(left, right, n);
    model.EI = Distribution({0, at, at, L}, {EI, EI, EI * EI_right, EI * EI_right}, "EI");
    model.mass = Distribution({0, at, at, L}, {m, m, m * mass_right, m * mass_right}, "mass");
    return model;
  };
}

TEST(Stepped, AtANode) {
  expect_exact(stepped(Support::clamped, Support::free, L / 2, 0.25, 0.5), 0, 3);
  expect_exact(stepped(Support::pinned, Support::roller, L / 4, 4.0, 2.0), 0, 3);
  expect_exact(stepped(Support::free, Support::free, L / 4, 2.0, 1.5), 2, 3);
  expect_exact(stepped(Support::clamped, Support::clamped, L / 2, 0.1, 1.0), 0, 3, {4.0, 0.1, 2e-6, 2e-6});
}

// A third of the span is no node of equal elements, but nodes come to it; the elements on either side differ in length,
// which do not halve exactly as their number doubles.
TEST(Stepped, NodesComeToIt) {
  expect_exact(stepped(Support::clamped, Support::free, L / 3, 0.25, 0.5), 0, 3, {4.0, 0.6, 1e-6, 1e-6});
  expect_exact(stepped(Support::pinned, Support::roller, L / 3, 4.0, 2.0), 0, 3, {4.0, 0.6, 1e-6, 1e-6});
  expect_exact(stepped(Support::pinned, Support::roller, L / 3, 1.0, 3.0), 0, 3, {4.0, 0.6, 1e-6, 1e-6});
}

}  // namespace
}  // namespace traverse
