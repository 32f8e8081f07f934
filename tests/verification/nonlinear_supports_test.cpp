// One-sided, gapped and cubic foundations under trains: energy, linear limits, extremes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/beam_model.hpp"
#include "support/curve.hpp"
#include "support/quarter_car.hpp"
#include "support/record.hpp"

namespace traverse::test {
namespace {

const std::string train =
    "beam: {spans: [15.0, 30.0, 15.0], elements_per_span: 6, EI: 8.33e9, mass: 5000.0, rayleigh: [0.2, 1.0e-4], "
    "self_weight: true}\n"
    "support: {types: [free, roller, roller, free]}\n" +
    quarter_car_with(4e4, 3e3, 2e6, 4e4, "law: hertz, stiffness: 3.6e10") +
    "train: {vehicles: [car, car], positions: [14.0, 8.0], speed: 40.0}\n"
    "ts: {max_time: 0.9, dt: 2.5e-4}\n"
    "output: {interval: 0.01, probes: [0.0, 7.5, 30.0, 45.0, 60.0]}\n";

const Values bearings = {{"foundation_vertical_x", "0,60"}, {"foundation_vertical_k", "1e8"}};

// The end bearings open and close under the train, which is on the bridge from start to end.
TEST(OneSidedPoints, TrainAndItsEnergy) {
  for (const char* c : {"0", "1e5"}) {
    Results run =
        run_yaml(train, bearings + Values{{"foundation_vertical_one_sided", "true"}, {"foundation_vertical_c", c}});
    for (std::size_t end : {0u, 4u}) {
      const std::vector<double> v = run.column("/probes/deflection", end);
      EXPECT_GT(*std::max_element(v.begin(), v.end()), 5e-4);  // has opened
      EXPECT_LT(*std::min_element(v.begin(), v.end()), -1e-3);
    }
    double scale = 0.0;
    for (const char* term : {"/energy/strain", "/energy/potential", "/energy/work"}) {
      const std::vector<double> values = run(term);
      scale = std::max(
          scale, *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end()));
    }
    const double missing = std::abs(peak(run("/energy/residual")).first) / scale;
    record("train_energy_missing", missing);
    EXPECT_LT(missing, 1e-6);
  }
}

// Pressed all the time, a one-sided support is a linear one; the damper too.
TEST(OneSidedPoints, PreloadedAreLinear) {
  const Values heavy = {{"beam_mass", "30000"}, {"foundation_vertical_c", "1e5"}, {"ts_max_time", "0.4"}};
  Results linear = run_yaml(train, bearings + heavy);
  Results one_sided = run_yaml(train, bearings + heavy + Values{{"foundation_vertical_one_sided", "true,true"}});
  for (const char* name :
       {"/probes/deflection", "/probes/velocity", "/probes/moment", "/probes/shear", "/vehicles/0/body/position",
        "/vehicles/1/wheel/normal_force", "/supports/reaction", "/energy/strain", "/energy/dissipated"})
    EXPECT_LT(relative_difference(one_sided(name), linear(name)), 1e-9) << name;
  for (double v : linear.column("/probes/deflection", 0)) EXPECT_LT(v, 0.0);
}

// A preloaded bed's points of integration reproduce its matrix: deflections to rounding, and at the nodes moments too.
TEST(OneSidedBed, PreloadedIsLinear) {
  const char* scene = R"(
beam: {spans: 20.0, elements_per_span: 10, EI: 5.0e7, mass: 5.0e3, self_weight: true}
support: {types: [free, free]}
foundation: {vertical_bed: {k: 2.0e7, c: 3.0e4}}
load: {forces: 2.0e4, positions: 4.0, speed: 25.0}
ts: {max_time: 0.4, dt: 1.0e-3}
output: {probes: [2.0, 10.0, 16.0]}
)";
  Results linear = run_yaml(scene), one_sided = run_yaml(scene, {{"foundation_vertical_bed_one_sided", "true"}});
  for (const char* name : {"/probes/deflection", "/probes/velocity", "/probes/moment", "/energy/dissipated"})
    EXPECT_LT(relative_difference(one_sided(name), linear(name)), 1e-9) << name;
}

TEST(OneSidedPoints, GapOfZeroIsNone) {
  Results plain = run_yaml(train, bearings),
          zero = run_yaml(train, bearings + Values{{"foundation_vertical_gap", "0"}});
  EXPECT_EQ(plain("/probes/deflection"), zero("/probes/deflection"));
}

// Very stiff, very strongly damped, with and without a gap: the run ends, nothing is gained, nothing pulls.
TEST(OneSidedPoints, Extremes) {
  for (const char* k : {"1e6", "1e12"})
    for (const char* c : {"0", "1e5", "1e9"})
      for (const char* gap : {"0", "1e-4"}) {
        SCOPED_TRACE(std::string(k) + " " + c + " " + gap);
        Results run = run_yaml(train, bearings + Values{{"foundation_vertical_one_sided", "true"},
                                                        {"foundation_vertical_k", k},
                                                        {"foundation_vertical_c", c},
                                                        {"foundation_vertical_gap", gap},
                                                        {"ts_max_time", "0.7"},
                                                        {"ts_dt", "1e-3"}});
        const std::vector<double> lost = run("/energy/dissipated");
        const std::vector<double> right = run.column("/probes/deflection", 4);
        EXPECT_GT(*std::max_element(right.begin(), right.end()), 1e-3);  // has opened
        EXPECT_TRUE(std::is_sorted(lost.begin(), lost.end()));
        const double scale = std::abs(peak(run("/energy/strain")).first);
        record("residual_over_strain", std::abs(peak(run("/energy/residual")).first) / scale);
        EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 0.02 * scale);
      }
}

}  // namespace
}  // namespace traverse::test
