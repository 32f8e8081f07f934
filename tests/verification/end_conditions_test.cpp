// Natural frequencies of one span with every pair of end conditions, springs at its ends and inside, and beds, against
// the exact dynamic stiffness (support/exact_beam.hpp), which is itself checked against published roots first.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "support/convergence.hpp"
#include "support/one_span.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using std::numbers::pi;
using test::expect_exact;
using test::frequencies;
using test::exact::chain_of;

using namespace test::one_span;

// Blevins 1979, Formulas for Natural Frequency and Mode Shape, table 8-1, to all digits of a double.
TEST(ExactStiffness, RootsOfTheFrequencyEquations) {
  const struct {
    Support left, right;
    std::vector<double> beta_L;
  } cases[] = {
      {Support::pinned, Support::roller, {pi, 2 * pi, 3 * pi}},
      {Support::clamped, Support::free, {1.875104068711961, 4.694091132974174, 7.854757438237613}},
      {Support::clamped, Support::clamped, {4.730040744862704, 7.853204624095838, 10.99560783800167}},
      {Support::clamped, Support::pinned, {3.926602312047919, 7.068582745628732, 10.21017612281303}},
      {Support::clamped, Support::guided, {2.365020372431352, 5.497803919000836, 8.639379828699740}},
      {Support::guided, Support::pinned, {pi / 2, 3 * pi / 2, 5 * pi / 2}},
  };
  for (const auto& c : cases) {
    const auto found = test::exact::frequencies(chain_of(span(c.left, c.right, 1)).chain, 3);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i] / unit / (c.beta_L[i] * c.beta_L[i]), 1.0, 1e-14) << i;
  }
}

// --- every pair of supports ------------------------------------------------------------------------------------------

class EndConditions : public testing::TestWithParam<std::pair<Support, Support>> {};
constexpr std::pair<Support, const char*> types[] = {{Support::free, "free"},
                                                     {Support::roller, "roller"},
                                                     {Support::pinned, "pinned"},
                                                     {Support::clamped, "clamped"},
                                                     {Support::guided, "guided"}};
std::vector<std::pair<Support, Support>> all_pairs() {
  std::vector<std::pair<Support, Support>> pairs;
  for (const auto& left : types) {
    for (const auto& right : types) pairs.emplace_back(left.first, right.first);
  }
  return pairs;
}
std::string name_of(Support s) {
  return std::find_if(std::begin(types), std::end(types), [s](const auto& t) { return t.first == s; })->second;
}
INSTANTIATE_TEST_SUITE_P(Frequencies, EndConditions, testing::ValuesIn(all_pairs()), [](const auto& which) {
  return name_of(which.param.first) + "_" + name_of(which.param.second);
});

TEST_P(EndConditions, Bending) {
  const auto [left, right] = GetParam();
  const int deflections = fixes_vertical(left) + fixes_vertical(right);
  const bool turns = !fixes_rotation(left) && !fixes_rotation(right) && deflections < 2;
  const int rigid = (deflections == 0 ? 1 : 0) + (turns ? 1 : 0);
  expect_exact([&](int n) { return span(left, right, n); }, rigid, 3);
}

// --- springs and beds ------------------------------------------------------------------------------------------------

/// A span with springs added; EI/L^3 = 2.45e5 N/m and EI/L = 9.8e7 N m/rad are those of the beam itself.
std::function<BeamModel(int)> with(Support left, Support right, const beam::Foundation& foundation) {
  return [=](int n) {
    BeamModel model = span(left, right, n);
    model.foundation = foundation;
    return model;
  };
}
using Points = std::vector<beam::PointFoundation>;
beam::Foundation springs(const Points& vertical, const Points& rotational = {}) {
  beam::Foundation f;
  f.vertical = vertical;
  f.rotational = rotational;
  return f;
}
beam::Foundation bed(const beam::Distribution& k, double c = 0.0) {
  beam::Foundation f;
  f.vertical_bed = beam::Bed{k, c};
  return f;
}

TEST(Frequencies, SpringsAtEnds) {
  const auto free = Support::free;
  expect_exact(with(free, free, springs({{0.0, 1e6, 0.0}, {L, 3e6, 0.0}})), 0, 4);
  expect_exact(with(free, free, springs({{0.0, 1e7, 0.0}, {L, 1e6, 0.0}}, {{L, 2e8, 0.0}})), 0, 4);
  expect_exact(with(free, free, springs({{L, 1e6, 0.0}})), 1, 3);
  expect_exact(with(free, free, springs({}, {{0.0, 1e8, 0.0}})), 1, 3);
  expect_exact(with(Support::pinned, Support::roller, springs({}, {{0.0, 1e8, 0.0}, {L, 3e8, 0.0}})), 0, 3);
  expect_exact(with(Support::clamped, free, springs({{L, 2e6, 0.0}}, {{L, 1e8, 0.0}})), 0, 3);
  expect_exact(with(Support::guided, free, springs({{0.0, 2e6, 0.0}}, {{L, 1e8, 0.0}})), 0, 3);
}

// A cantilever with a spring at its tip: the roots b = beta L of
//   b^3 (1 + cos b cosh b) = kappa (cos b sinh b - sin b cosh b),  kappa = k L^3/EI,
// from shear = k v at the tip (the case in any table of beams with elastic ends), besides the dynamic stiffness.
TEST(Frequencies, SpringAtTheTipOfACantilever) {
  const double kappa = 10.0;
  const auto equation = [&](double b) {
    return b * b * b * (1 + std::cos(b) * std::cosh(b)) -
           kappa * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b));
  };
  double low = 1.875, high = 3.9266;  // free and pinned
  while (high - low > 1e-14) {
    const double middle = 0.5 * (low + high);
    ((equation(middle) > 0.0) == (equation(low) > 0.0) ? low : high) = middle;
  }
  const auto model = with(Support::clamped, Support::free, springs({{L, kappa * EI / (L * L * L), 0.0}}));
  EXPECT_NEAR(frequencies(model(64), 1)[0] / (unit * low * low), 1.0, 1e-8);
  expect_exact(model, 0, 3);
}

// At a node a spring's force goes with the jump of the shear there. Inside an element the cubic shape functions have no
// such jump: v'' is off by h on one element of length h, the energy by h^3. The spring stands at a third of the beam,
// so that it is at a third of some element, from the left or from the right, on every mesh.
TEST(Frequencies, SpringAtANodeAndInsideAnElement) {
  const auto pinned = Support::pinned, roller = Support::roller;
  expect_exact(with(pinned, roller, springs({{L / 2, 2e7, 0.0}})), 0, 3);
  expect_exact(with(pinned, roller, springs({}, {{L / 4, 2e8, 0.0}})), 0, 3);
  // The first mode: in the others the smooth part's h^4 is as large on these meshes, or the spring stands on their
  // node.
  expect_exact(with(pinned, roller, springs({{L / 3, 2e7, 0.0}})), 0, 1, {3.0, 0.1, 1e-6, 5e-7});
  // A moment makes v'' itself jump: h^0 on one element, the energy off by h.
  expect_exact(with(pinned, roller, springs({}, {{L / 3, 2e8, 0.0}})), 0, 1, {1.0, 0.1, 2e-4, 2e-5});
}

TEST(Frequencies, BedUnderEveryPairOfEnds) {
  for (const auto& [left, right] : all_pairs()) {
    SCOPED_TRACE(name_of(left) + " " + name_of(right));
    // The bed adds k/m to omega^2, whatever the ends.
    const auto found = frequencies(with(left, right, bed(2e6, 1e4))(24), 4);
    const auto without = frequencies(span(left, right, 24), 4);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[i] / std::hypot(without[i], std::sqrt(2e6 / m)), 1.0, 1e-9) << i;
  }
  expect_exact(with(Support::clamped, Support::free, bed(2e6)), 0, 3);
}

// A free beam on a bed moves as a rigid body at sqrt(k/m), up and down and turning.
TEST(Frequencies, FreeBeamOnABed) {
  const beam::Beam beam(PETSC_COMM_SELF, with(Support::free, Support::free, bed(2e6))(24));
  const auto found = modes::natural_modes(beam, 3, true);
  const double rigid = std::sqrt(2e6 / m);
  EXPECT_NEAR(found.omega[0] / rigid, 1.0, 1e-10);
  EXPECT_NEAR(found.omega[1] / rigid, 1.0, 1e-10);
  EXPECT_NEAR(found.omega[2] / std::hypot(rigid, 4.730040744862704 * 4.730040744862704 * unit), 1.0, 1e-6);
  for (int i = 0; i < 2; ++i) {  // any two motions of a rigid body: straight lines
    const auto& shape = found.shape[i];
    for (std::size_t node = 1; node + 1 < shape.size(); ++node) {
      EXPECT_NEAR(shape[node - 1] - 2 * shape[node] + shape[node + 1], 0.0, 1e-6) << "mode " << i + 1;
    }
  }
}

// The bed ends inside the beam, at a node and inside an element: k v jumps there, and the fourth derivative of v with
// it, which does not cost the order (that one element adds h^5 to the energy, which still shows in the first mode).
TEST(Frequencies, BedUnderAPartOfTheBeam) {
  for (const double end : {L / 4, L / 3}) {
    const beam::Distribution k({0, end, end, L}, {3e7, 3e7, 0, 0}, "k");
    expect_exact(with(Support::free, Support::roller, bed(k)), 0, 3, {4.0, 0.3});
  }
}

}  // namespace
}  // namespace traverse
