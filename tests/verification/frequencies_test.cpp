// Natural frequencies against exact ones, with the order of convergence: cubic elements with consistent mass give
// omega with an error that falls as h^4 ((beta h)^4/1440 at a simple support), linear bars as h^2.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "modes/modes.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using std::numbers::pi;

constexpr double EI = 1.96e9, EA = 1.0e10, m = 1000.0, L = 20.0;

BeamModel model_of(int spans, std::vector<Support> supports, int elements, bool axial) {
  BeamModel model;
  model.spans.assign(spans, L);
  model.elements.assign(spans, elements);
  model.supports = std::move(supports);
  model.EI = EI;
  model.EA = EA;
  model.mass = m;
  model.axial = axial;
  return model;
}

std::vector<double> frequencies(const BeamModel& model, int count) {
  return modes::natural_modes(beam::Beam(PETSC_COMM_WORLD, model), count, false).omega;
}

/// A single span and the exact beta L of its elastic modes, as roots of the frequency equations (Blevins 1979).
struct Bending {
  const char* name;
  Support left, right;
  int rigid;
  std::vector<double> beta_L;
};
void PrintTo(const Bending& b, std::ostream* out) { *out << b.name; }

class SingleSpan : public testing::TestWithParam<Bending> {};
INSTANTIATE_TEST_SUITE_P(
    Frequencies, SingleSpan,
    testing::Values(
        Bending{"simply_supported", Support::pinned, Support::roller, 0, {pi, 2 * pi, 3 * pi}},
        Bending{"cantilever",
                Support::clamped,
                Support::free,
                0,
                {1.875104068711961, 4.694091132974174, 7.854757438237613}},
        Bending{"clamped_clamped",
                Support::clamped,
                Support::clamped,
                0,
                {4.730040744862704, 7.853204624095838, 10.99560783800167}},
        Bending{"clamped_pinned",
                Support::clamped,
                Support::pinned,
                0,
                {3.926602312047919, 7.068582745628732, 10.21017612281303}},
        Bending{
            "free_free", Support::free, Support::free, 2, {4.730040744862704, 7.853204624095838, 10.99560783800167}},
        Bending{"pinned_free",
                Support::pinned,
                Support::free,
                1,
                {3.926602312047919, 7.068582745628732, 10.21017612281303}},
        Bending{"guided_pinned", Support::guided, Support::pinned, 0, {pi / 2, 3 * pi / 2, 5 * pi / 2}},
        Bending{"guided_guided", Support::guided, Support::guided, 1, {pi, 2 * pi, 3 * pi}},
        Bending{"clamped_guided",
                Support::clamped,
                Support::guided,
                0,
                {2.365020372431352, 5.497803919000836, 8.639379828699740}}),
    [](const auto& which) { return which.param.name; });

TEST_P(SingleSpan, FourthOrder) {
  const Bending& b = GetParam();
  const int count = b.rigid + static_cast<int>(b.beta_L.size());
  const auto coarse = frequencies(model_of(1, {b.left, b.right}, 16, false), count);
  const auto fine = frequencies(model_of(1, {b.left, b.right}, 32, false), count);
  ASSERT_EQ(fine.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < b.rigid; ++i) EXPECT_EQ(fine[i], 0.0) << "rigid mode " << i;
  for (std::size_t i = 0; i < b.beta_L.size(); ++i) {
    const double exact = std::pow(b.beta_L[i] / L, 2) * std::sqrt(EI / m);
    const double e1 = coarse[b.rigid + i] / exact - 1.0, e2 = fine[b.rigid + i] / exact - 1.0;
    EXPECT_NEAR(std::log2(e1 / e2), 4.0, 0.1) << "mode " << i + 1;
    EXPECT_GT(e2, 0.0) << "a conforming mesh is too stiff, mode " << i + 1;
    EXPECT_LT(e2, std::pow(b.beta_L[i] / 32, 4) / 700) << "mode " << i + 1;
  }
}

TEST(Frequencies, AxialBarSecondOrder) {
  const auto axial = [](int elements) {
    const beam::Beam bar(PETSC_COMM_WORLD, model_of(1, {Support::pinned, Support::roller}, elements, true));
    const auto found = modes::natural_modes(bar, 2 * elements, false);
    std::vector<double> omega;
    for (std::size_t i = 0; i < found.omega.size(); ++i) {
      if (found.motion[i] == modes::Motion::along) omega.push_back(found.omega[i]);
    }
    return omega;
  };
  const auto coarse = axial(16), fine = axial(32);
  for (int i = 0; i < 2; ++i) {
    const double exact = (2 * i + 1) * pi / (2 * L) * std::sqrt(EA / m);
    const double e1 = coarse[i] / exact - 1.0, e2 = fine[i] / exact - 1.0;
    EXPECT_NEAR(std::log2(e1 / e2), 2.0, 0.02) << "mode " << i + 1;
    EXPECT_NEAR(e2, std::pow((2 * i + 1) * pi / 2 / 32, 2) / 24, 1e-2 * e2);
  }
}

TEST(Frequencies, AxialFreeBarMovesAlong) {
  const auto found = modes::natural_modes(
      beam::Beam(PETSC_COMM_WORLD, model_of(1, {Support::roller, Support::roller}, 16, true)), 40, true);
  ASSERT_EQ(found.motion[0], modes::Motion::along);
  EXPECT_EQ(found.omega[0], 0.0);
  EXPECT_GT(found.omega[1], 0.0);
  for (double u : found.shape[0]) EXPECT_EQ(u, 1.0);
}

// R6: three continuous spans of 20 m, frequencies computed independently, converged to the digits printed.
TEST(Frequencies, ThreeContinuousSpans) {
  const double exact[] = {5.49779, 7.04549, 10.28788, 21.99116, 25.06237, 30.74769};
  const auto roller = Support::roller;
  const auto found = frequencies(model_of(3, {Support::pinned, roller, roller, roller}, 40, false), 6);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(found[i] / (2 * pi) / exact[i], 1.0, 1e-6) << "mode " << i + 1;
}

// A uniform vertical bed adds k/m to every squared frequency; a free beam then has k/m itself, twice.
TEST(Frequencies, VerticalBedShiftsSquares) {
  auto model = model_of(1, {Support::free, Support::free}, 20, false);
  model.foundation.vertical_bed = beam::Bed{1e6, 0.0};
  const auto found = frequencies(model, 3);
  EXPECT_NEAR(found[0] / std::sqrt(1e6 / m), 1.0, 1e-9);
  EXPECT_NEAR(found[1] / std::sqrt(1e6 / m), 1.0, 1e-9);
  const double bending = std::pow(4.730040744862704 / L, 4) * EI / m;
  EXPECT_NEAR(found[2] / std::sqrt(bending + 1e6 / m), 1.0, 1e-5);
}

}  // namespace
}  // namespace traverse
