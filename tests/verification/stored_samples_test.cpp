// Stored samples lie at the multiples of the interval, and nowhere else; the end of a run that is none stands apart.
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

const char* const bridge = R"(
beam: {spans: [20.0, 25.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}
support: {types: [pinned, roller, roller]}
load: {forces: [1.0e5, 1.0e5], positions: [0.0, -7.0], speed: 41.3}
)";
constexpr double leaving = 52.0 / 41.3;  // s

struct Case {
  const char* name;
  Values options;
};

class StoredSamples : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Samples, StoredSamples,
    testing::Values(
        Case{"interval_given", {{"ts_dt", "2e-3"}, {"output_interval", "7e-3"}}},
        Case{"interval_open", {{"ts_dt", "2e-3"}}},
        Case{"longer_than_the_run", {{"ts_dt", "2e-3"}, {"output_interval", "100"}}},
        Case{"shorter_than_the_step", {{"ts_dt", "7e-3"}, {"output_interval", "3e-5"}}},
        Case{"steps_at_probes", {{"ts_dt", "2e-3"}, {"output_interval", "1.1e-2"}, {"step_probes", "true"}}},
        Case{"from_the_accuracy", {{"accuracy", "1e-2"}}},
        Case{"control_of_steps", {{"ts_dt", "7e-3"}, {"output_interval", "7e-3"}, {"ts_adapt_type", "ladder"}}},
        Case{"of_petsc", {{"ts_dt", "2e-3"}, {"ts_type", "bdf"}, {"output_interval", "7e-3"}}},
        Case{"by_modes", {{"model_modes", "4"}, {"output_interval", "7e-3"}}}),
    [](const auto& set) { return set.param.name; });

TEST_P(StoredSamples, LieAtMultiplesOfTheInterval) {
  Results run = run_yaml(bridge, GetParam().options);
  const double interval = run.attribute("/time", "interval");
  ASSERT_GT(interval, 0.0);
  const std::vector<double> time = run.time();
  EXPECT_EQ(time.size(), static_cast<std::size_t>(leaving / interval * (1.0 + 1e-9)) + 1);
  for (std::size_t i = 0; i < time.size(); ++i)
    EXPECT_NEAR(time[i], static_cast<double>(i) * interval, 1e-13 * leaving) << i;
  EXPECT_NEAR(run.attribute("/summary", "end_time"), leaving, 1e-9);
  ASSERT_EQ(run("/end/time").size(), 1u);
  EXPECT_NEAR(run("/end/time")[0], leaving, 1e-9);
  EXPECT_EQ(run("/end/probes/deflection").size(), run("/probes/x").size());
  EXPECT_EQ(run("/end/supports/reaction").size(), 9u);
}

// What the end holds is what a sample there would hold.
TEST(StoredEnd, IsTheStateAtTheEnd) {
  for (const Values& kind : {Values{{"ts_dt", "1e-3"}}, Values{{"model_modes", "4"}}}) {
    const Values options = kind + Values{{"ts_max_time", "0.75"}};
    Results apart = run_yaml(bridge, options + Values{{"output_interval", "0.02"}});
    Results sampled = run_yaml(bridge, options + Values{{"output_interval", "0.01"}});
    EXPECT_EQ(apart.time().size(), 38u);
    ASSERT_EQ(sampled.time().size(), 76u);
    EXPECT_THROW(sampled("/end/time"), std::runtime_error) << "the end is a sample";
    EXPECT_EQ(sampled.attribute("/summary", "end_time"), 0.75);
    for (std::size_t p = 0; p < 2; ++p)
      for (const char* name : {"deflection", "velocity", "moment"}) {
        const std::vector<double> series = sampled.column(std::string("/probes/") + name, p);
        EXPECT_NEAR(apart(std::string("/end/probes/") + name)[p], series.back(), 1e-6 * std::abs(peak(series).first))
            << name;
      }
    const double work = sampled("/energy/work").back();
    EXPECT_NEAR(apart("/end/energy/work")[0], work, 1e-6 * std::abs(peak(sampled("/energy/work")).first));
  }
}

}  // namespace
}  // namespace traverse::test
