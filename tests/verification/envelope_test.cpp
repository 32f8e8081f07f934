// Envelopes along the bridge: stations everywhere, shear on both sides of a force, and the forces that belong together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

// A force that creeps over a simple span: V = F (1 - x/L) before it, -F x/L behind it, M = F x (L - x)/L under it.
// Samples are half a metre of its way apart, between the stations' passages and at them.
double off_statics(const char* interval) {
  constexpr double L = 20.0, F = 1e5;
  Results run = run_yaml(
      "beam: {spans: 20.0, EI: 1.0e12, mass: 100.0, elements_per_span: 8}\nsupport: {types: [pinned, roller]}\n",
      {{"load_forces", "1e5"},
       {"load_speed", "1.0"},
       {"scene_start", "equilibrium"},
       {"ts_dt", interval},
       {"output_interval", interval},
       {"output_probes_spacing", "1.7"}});
  const std::vector<double>& x = run("/probes/x");
  const auto at = [&](const char* name, std::size_t p, std::size_t side) {
    return run(std::string("/envelope/") + name)[2 * p + side];
  };
  EXPECT_EQ(x.size(), 13u);
  double worst = 0.0;
  for (std::size_t p = 1; p + 1 < x.size(); ++p) {
    EXPECT_NEAR(x[p], static_cast<double>(p) * L / 12.0, 1e-12);
    // Shear is d moment/dx: positive as long as the force is to the right.
    worst = std::max(worst, std::abs(at("shear", p, 1) / (F * (1.0 - x[p] / L)) - 1.0));
    worst = std::max(worst, std::abs(at("shear", p, 0) / (-F * x[p] / L) - 1.0));
    const double moment = F * x[p] * (L - x[p]) / L;
    worst = std::max(worst, std::abs(at("moment", p, 1) / moment - 1.0));
    worst = std::max(worst, std::abs(at("shear_moment", p, 1) / moment - 1.0));
    worst = std::max(worst, std::abs(at("shear_moment", p, 0) / moment - 1.0));
    const double shear = at("moment_shear", p, 1);
    EXPECT_LT(std::min(std::abs(shear - F * (1.0 - x[p] / L)), std::abs(shear + F * x[p] / L)), 1e-3 * F);
    EXPECT_NEAR(at("moment_time", p, 1), x[p], 1e-6);
    EXPECT_NEAR(at("shear_time", p, 0), x[p], 1e-6);
  }
  return worst;
}

TEST(Envelope, OfACreepingForce) {
  const double between = off_statics("0.47"), at_passages = off_statics("0.3333333333333333");
  EXPECT_LT(between, 1e-6);
  EXPECT_LT(at_passages, 1e-6);
  RecordProperty("between passages", text(between));
  RecordProperty("at every fifth passage", text(at_passages));
}

TEST(Envelope, StationsAreThoseNamedAndTheEvenOnes) {
  Results run =
      run_yaml("beam: {spans: [20.0, 11.0], EI: 1.0e10, mass: 1.0e4}\nsupport: {types: [pinned, roller, roller]}\n",
               {{"scene_analysis", "static"},
                {"load_forces", "1e5"},
                {"load_positions", "7"},
                {"output_probes", "7,20"},
                {"output_probes_spacing", "5"}});
  const std::vector<double> wanted = {0, 5, 7, 10, 15, 20, 20 + 11.0 / 3, 20 + 22.0 / 3, 31};
  ASSERT_EQ(run("/probes/x").size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(run("/probes/x")[i], wanted[i], 1e-12);
}

}  // namespace
}  // namespace traverse::test
