// Static deflections, moments and reactions against textbook formulas. Cubic elements with consistent loads are exact
// at the nodes of a uniform beam, and the recovery is exact everywhere: 1e-8 stands for rounding.
#include <gtest/gtest.h>

#include <cmath>

#include "support/static_case.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using test::Case;

constexpr double EI = 2.5e9, EA = 1.0e10, tolerance = 1e-8;

BeamModel model_of(std::vector<double> spans, std::vector<Support> supports, int elements) {
  BeamModel m;
  m.elements.assign(spans.size(), elements);
  m.spans = std::move(spans);
  m.supports = std::move(supports);
  m.EI = EI;
  m.EA = EA;
  m.mass = 1000.0;
  return m;
}

void expect_close(double value, double exact, double scale, const std::string& what) {
  EXPECT_NEAR(value, exact, tolerance * std::abs(scale)) << what;
}

class Meshes : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Statics, Meshes, testing::Values(1, 2, 7));

TEST_P(Meshes, SimplySupportedUnderPointLoad) {
  const double L = 20.0, F = -1e5;
  for (double a : {3.7, 10.0, 19.2}) {
    Case c(model_of({L}, {Support::pinned, Support::roller}, GetParam()));
    c.load(a, F).solve();
    const double b = L - a;
    for (double x : {0.0, 1.0, 3.7, 5.0, 10.0, 15.5, 20.0}) {
      const double y = x <= a ? x : L - x, far = x <= a ? b : a;  // from the support on this side
      const double v = F * far * y * (L * L - far * far - y * y) / (6 * L * EI);
      const std::string where = "load at " + std::to_string(a) + ", x = " + std::to_string(x);
      const auto r = c.at(x);
      expect_close(r.deflection, v, F * L * L * L / (48 * EI), where);
      expect_close(r.moment, -F * far * y / L, F * L / 4, where);
      const bool left_of_load = x < a || (x == L && a == L);
      expect_close(r.shear, left_of_load ? -F * b / L : F * a / L, F, where);
    }
    const auto R = c.reactions();
    expect_close(R[0][1], -F * b / L, F, "left reaction");
    expect_close(R[1][1], -F * a / L, F, "right reaction");
    expect_close(R[0][2], 0.0, F * L, "no moment");
  }
}

TEST_P(Meshes, CantileverUnderForceMomentAndPull) {
  const double L = 12.0, F = 3e4, M = -7e4, N = 5e5;
  Case c(model_of({L}, {Support::clamped, Support::free}, GetParam()));
  c.load(L, F, M, N).solve();
  const auto tip = c.at(L), middle = c.at(L / 2);
  expect_close(tip.deflection, F * L * L * L / (3 * EI) + M * L * L / (2 * EI), tip.deflection, "tip");
  expect_close(tip.moment, M, M, "moment just left of the tip");
  expect_close(middle.moment, F * L / 2 + M, F * L, "moment halfway");
  expect_close(middle.shear, -F, F, "shear");
  expect_close(middle.axial_force, N, N, "axial force");
  expect_close(tip.axial_displacement, N * L / EA, N * L / EA, "pull");
  const auto R = c.reactions();
  expect_close(R[0][0], -N, N, "held axially");
  expect_close(R[0][1], -F, F, "held vertically");
  expect_close(R[0][2], -F * L - M, F * L, "clamped");
  expect_close(R[1][1], 0.0, F, "free end");
}

TEST_P(Meshes, OwnWeight) {
  const double L = 15.0, q = 9.81 * 1000.0;
  Case simple(model_of({L}, {Support::pinned, Support::roller}, GetParam()));
  simple.weight(9.81).solve();
  for (double x : {0.0, 4.0, 7.5, 11.1, 15.0}) {
    const auto r = simple.at(x);
    const double v = -q * x * (L * L * L - 2 * L * x * x + x * x * x) / (24 * EI);
    expect_close(r.deflection, v, 5 * q * std::pow(L, 4) / (384 * EI), "deflection");
    expect_close(r.moment, q * x * (L - x) / 2, q * L * L / 8, "moment");
    expect_close(r.shear, q * (L / 2 - x), q * L, "shear");
  }
  Case clamped(model_of({L}, {Support::clamped, Support::clamped}, GetParam()));
  clamped.weight(9.81).solve();
  expect_close(clamped.at(0.0).moment, -q * L * L / 12, q * L * L, "end moment");
  expect_close(clamped.at(L / 2).moment, q * L * L / 24, q * L * L, "midspan moment");
  expect_close(clamped.at(L / 2).deflection, -q * std::pow(L, 4) / (384 * EI), q * std::pow(L, 4) / (384 * EI), "v");
  expect_close(clamped.reactions()[0][2], q * L * L / 12, q * L * L, "moment of the support on the beam");
  expect_close(clamped.reactions()[1][2], -q * L * L / 12, q * L * L, "the other one");
}

TEST_P(Meshes, MomentInsideAnElement) {
  const double L = 10.0, M = 4e5, a = 3.3;
  Case c(model_of({L}, {Support::pinned, Support::roller}, GetParam()));
  c.load(a, 0.0, M).solve();
  // Ends push with M/L, up on the left: moment M x/L, and a jump by -M at a (M counter-clockwise).
  for (double x : {1.0, 3.0, 3.6, 8.0}) {
    expect_close(c.at(x).moment, M * x / L - (x < a ? 0.0 : M), M, "moment");
    const double b = L - a;
    const double slope0 = M * (L * L - 3 * b * b) / (6 * EI * L) * -1.0;
    const double v = slope0 * x + M * x * x * x / (6 * EI * L) - (x < a ? 0.0 : M * (x - a) * (x - a) / (2 * EI));
    expect_close(c.at(x).deflection, v, M * L * L / EI, "deflection");
  }
  expect_close(c.reactions()[0][1], M / L, M / L, "reaction");
}

TEST_P(Meshes, ContinuousBeamsUnderOwnWeight) {
  // Reactions in qL: two spans 3/8, 10/8, 3/8; three spans 0.4, 1.1, 1.1, 0.4 (any table of continuous beams).
  const double L = 20.0, q = 9.81 * 1000.0;
  const auto roller = Support::roller;
  Case two(model_of({L, L}, {Support::pinned, roller, roller}, GetParam()));
  const auto R2 = two.weight(9.81).solve().reactions();
  const double exact2[] = {0.375, 1.25, 0.375};
  for (int i = 0; i < 3; ++i) expect_close(R2[i][1], exact2[i] * q * L, q * L, "two spans");
  expect_close(two.at(L).moment, -q * L * L / 8, q * L * L / 8, "moment over the support");
  expect_close(two.at(0.375 * L).moment, 9.0 / 128 * q * L * L, q * L * L / 8, "largest moment in a span");

  Case three(model_of({L, L, L}, {Support::pinned, roller, roller, roller}, GetParam()));
  const auto R3 = three.weight(9.81).solve().reactions();
  const double exact3[] = {0.4, 1.1, 1.1, 0.4};
  for (int i = 0; i < 4; ++i) expect_close(R3[i][1], exact3[i] * q * L, q * L, "three spans");
  expect_close(three.at(L).moment, -0.1 * q * L * L, q * L * L, "moment over the support");
  expect_close(three.at(1.5 * L).moment, 0.025 * q * L * L, q * L * L, "middle of the middle span");
}

TEST_P(Meshes, ContinuousTwoSpansUnderPointLoad) {
  // F in the middle of the first of two spans: reactions 13/32, 22/32, -3/32 of F.
  const double L = 20.0, F = -2e5;
  Case c(model_of({L, L}, {Support::pinned, Support::roller, Support::roller}, GetParam()));
  const auto R = c.load(L / 2, F).solve().reactions();
  const double exact[] = {13.0 / 32, 22.0 / 32, -3.0 / 32};
  for (int i = 0; i < 3; ++i) expect_close(R[i][1], -exact[i] * F, F, "reaction");
  expect_close(c.at(L).moment, 3.0 / 32 * F * L, F * L, "moment over the support");
}

TEST_P(Meshes, IsolatedSpansDoNotTalk) {
  const double L = 20.0, F = -2e5;
  auto m = model_of({L, L}, {Support::pinned, Support::roller, Support::roller}, GetParam());
  m.joints = {beam::Joint::separate};
  Case c(m);
  c.load(5.0, F, 0.0, 1e4).solve();
  expect_close(c.at(5.0).moment, -F * 5 * 15 / L, F * L, "loaded span");
  EXPECT_EQ(c.at(30.0).deflection, 0.0);
  EXPECT_EQ(c.at(30.0).moment, 0.0);
  const auto R = c.reactions();
  expect_close(R[0][1], -0.75 * F, F, "left");
  expect_close(R[1][1], -0.25 * F, F, "inner end");
  expect_close(R[2][1], 0.0, F, "right");
  expect_close(R[0][0], -1e4, 1e4, "fixed bearing of span 1");
  // The second span rolls on both ends: its left end is the fixed bearing.
  Case d(m);
  d.load(25.0, 0.0, 0.0, 1e4).solve();
  expect_close(d.reactions()[1][0], -1e4, 1e4, "fixed bearing of span 2");
  expect_close(d.reactions()[0][0], 0.0, 1e4, "nothing crosses");
}

}  // namespace
}  // namespace traverse
