// The verdict of EN 1991-2, 6.4.6.5, of runs and sweeps, against statics by hand and what the runs themselves found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/record.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double L = 20.0, EI = 2e10, mass = 1.5e4, F = 2e5, pi = 3.14159265358979323846;
constexpr const char* bridge = R"(
beam: {spans: 20.0, EI: 2.0e10, mass: 1.5e4}
support: {types: [pinned, roller]}
model: {modes: 6, damping_ratios: 0.02}
load: {forces: 2.0e5, speed: 50.0}
output: {probes: [5.0, 10.0]}
norm: {load_models: lm71, alpha: 1.1, track: careful}
)";

/// phi''/2 of annex C, at the speed of 22 m/s or more.
double half_of_track() {
  const double n0 = pi / 2.0 * std::sqrt(EI / mass) / (L * L);
  return 0.005 * (56.0 * std::exp(-L * L / 100.0) + 50.0 * (L * n0 / 80.0 - 1.0) * std::exp(-L * L / 400.0));
}

// One force on a simple span: everything but the dynamic peak is known by hand.
TEST(NormVerdict, OfOneForce) {
  Results sweep = run_yaml(bridge, {{"sweep_speed", "30,80,5"}});
  const std::vector<double>& peaks = sweep("/sweep/peak_deflection");  // [1, 11, 2]
  const double at_rest = F * L * L * L / (48.0 * EI), moment = F * L / 4.0, shear = F;
  const double a = L / 4.0, b = std::sqrt((L * L - a * a) / 3.0);  // L/4 deflects most with the force b before the end
  const double at_quarter = F * a * b * (L * L - a * a - b * b) / (6.0 * EI * L);
  double phi = 0.0;
  for (std::size_t v = 0; v < 11; ++v)
    phi = std::max({phi, peaks[2 * v] / at_quarter - 1.0, peaks[2 * v + 1] / at_rest - 1.0});
  ASSERT_EQ(sweep("/norm/phi_dyn").size(), 5U);
  EXPECT_GT(phi, 0.05);
  EXPECT_NEAR(sweep("/norm/phi_dyn")[0], phi, 1e-6);
  double worst = 0.0;
  const std::vector<double> by_hand = {at_rest, moment, shear, F};
  for (std::size_t e = 0; e < 4; ++e) {
    const double at = sweep("/norm/train_static")[e];
    EXPECT_NEAR(at, by_hand[e], 2e-6 * by_hand[e]) << e;
    worst = std::max(worst, std::abs(at / by_hand[e] - 1.0));
    EXPECT_NEAR(sweep("/norm/train_dynamic")[e], (1.0 + sweep("/norm/phi_dyn")[e] + half_of_track()) * at, 1e-5 * at);
  }
  record("static_error", worst);
  // F (L^2 - b^2) b/(6 EI L), greatest at b = L/sqrt(3)
  EXPECT_NEAR(sweep("/norm/train_static")[4], F * L * L / (9.0 * std::sqrt(3.0) * EI), 1e-9 * F * L * L / EI);
  // LM71 on 20 m is 121.5 kN/m; Phi2 = 1.157; the greatest moment stands near midspan, not in it.
  const double lm71 = 121.5e3 * L * L / 8.0, phi2 = 1.44 / (std::sqrt(L) - 0.2) + 0.82;
  EXPECT_NEAR(sweep("/norm/model_static")[1], lm71, 1e-3 * lm71);
  EXPECT_NEAR(sweep("/norm/model_with_phi")[1], 1.1 * phi2 * sweep("/norm/model_static")[1], 1e-9 * lm71);
  EXPECT_NEAR(sweep("/norm/train_over_model")[1], sweep("/norm/train_dynamic")[1] / sweep("/norm/model_with_phi")[1],
              1e-12);
  // The sweep's own static deflection is the same at each probe.
  const std::vector<double> x = sweep("/static/x"), deflection = sweep("/static/deflection");
  for (std::size_t p = 0; p < 2; ++p) {
    const auto place = std::find(x.begin(), x.end(), p == 0 ? 5.0 : 10.0) - x.begin();
    EXPECT_NEAR(-deflection[2 * static_cast<std::size_t>(place)], sweep("/sweep/static_deflection")[p], 1e-6 * at_rest);
  }
}

// A run by itself finds what the sweep of its speed alone finds.
TEST(NormVerdict, OfARunAndOfASweep) {
  Results one = run_yaml(bridge, {{"output_interval", "1e-4"}});
  Results sweep = run_yaml(bridge, {{"sweep_speed", "50,50,1"}});
  for (std::size_t e = 0; e < 5; ++e)
    EXPECT_NEAR(one("/norm/train_over_model")[e], sweep("/norm/train_over_model")[e],
                1e-4 * sweep("/norm/train_over_model")[e]);
}

// A car on two sprung axles weighs on the bridge as its two wheels do.
TEST(NormVerdict, OfAVehicle) {
  Results run = run_yaml(std::string(two_spans) + quarter_car, {{"norm_load_models", "lm71"}, {"accuracy", "1e-2"}});
  EXPECT_NEAR(run("/norm/train_static")[3], quarter_car_weight, 1e-6 * quarter_car_weight);
  EXPECT_GT(run("/norm/phi_dyn")[0], 0.0);
}

// On continuous spans SW/0 stands beside LM71: over the inner support it is the worse one.
TEST(NormVerdict, OfContinuousSpans) {
  Results run = run_yaml(bridge, {{"beam_spans", "20,20"},
                                  {"support_types", "pinned,roller,roller"},
                                  {"norm_load_models", "lm71"},
                                  {"scene_analysis", "envelope"}});
  EXPECT_EQ(run("/static/moment").size(), 3 * 2 * run("/static/x").size());  // train, LM71, SW/0
  EXPECT_NEAR(run("/norm/determinant_length")[0], 24.0, 1e-12);
  // Both spans fully under q: the moment over the support is q L^2/8; SW/0 leaves 5.3 m of 40 m free.
  const std::vector<double>& moment = run("/static/moment");
  const std::size_t sections = run("/static/x").size();
  double least = 0.0;
  for (std::size_t i = 0; i < sections; ++i) least = std::min(least, moment[2 * (2 * sections + i)]);
  EXPECT_LT(least, -0.8 * 133e3 * L * L / 8.0);
  EXPECT_GT(least, -1.0 * 133e3 * L * L / 8.0);
}

/// Least and greatest moment of the train in an envelope at x.
std::pair<double, double> moments_at(double x, const std::string& spans, const Values& load) {
  Results run = run_yaml("beam: {spans: [" + spans + "], EI: 1.0e10, mass: 1.0e4, elements_per_span: 8}\n" +
                             "scene: {analysis: envelope}\n",
                         load);
  const std::vector<double>&sections = run("/static/x"), &moment = run("/static/moment");
  for (std::size_t i = 0; i < sections.size(); ++i)
    if (std::abs(sections[i] - x) < 1e-3) return {moment[2 * i], moment[2 * i + 1]};
  return {};
}

// A lane load acts wherever it is unfavourable, and behind a locomotive only where its gap ends.
TEST(NormVerdict, LaneLoadBesideTheTruck) {
  const std::string truck = source_folder() + "/options/loads/hl93_truck.yml";
  const double w = 9.3e3, midspan = 145e3 * 7.5 + (145e3 + 35e3) * (7.5 - 2.15);
  EXPECT_NEAR(moments_at(15.0, "30", {{"options_file", truck}}).second, midspan + w * 30.0 * 30.0 / 8.0,
              1e-6 * midspan);
  const double with = moments_at(20.0, "20, 20", {{"options_file", truck}}).first,
               without = moments_at(20.0, "20, 20", {{"options_file", truck}, {"norm_lane_load", "0"}}).first;
  EXPECT_NEAR(with - without, -w * 20.0 * 20.0 / 8.0, 1e-4 * w * 50.0);
  const Values behind = {{"load_forces", "1.0"}, {"load_speed", "10"}, {"norm_lane_load", "1e5"}};
  const double full = moments_at(5.0, "10", behind).second;
  EXPECT_NEAR(full, 1e5 * 100.0 / 8.0, 10.0);
  EXPECT_NEAR(moments_at(5.0, "10", behind + Values{{"norm_lane_gap", "-3,1000"}}).second, full, 10.0);
  // 40 m of gap on either side of the force leave nothing beside it on the span.
  EXPECT_NEAR(moments_at(5.0, "10", behind + Values{{"load_forces", "1e7"}, {"norm_lane_gap", "-40,40"}}).second,
              1e7 * 2.5, 1.0);
}

// A crab between 3 m and 8 m of a beam of 20 m: its first wheel leads the second one by 2 m.
TEST(NormVerdict, OfATrolleyThatReachesAPartOfTheBeam) {
  const Values crab = {{"load_forces", "1e5,1e5"}, {"load_positions", "0,-2"}, {"load_speed", "1"}};
  const auto range = [&](const char* ends) { return crab + Values{{"norm_range", ends}}; };
  EXPECT_NEAR(moments_at(10.0, "20", range("3,8")).second, 1e5 * (8.0 + 6.0) * 0.5, 1e-3);
  EXPECT_NEAR(moments_at(10.0, "20", range("3,3")).second, 1e5 * (3.0 + 1.0) * 0.5, 1e-3);
  EXPECT_NEAR(moments_at(2.0, "20", range("5,8")).second, 2e5 * 2.0 * (20.0 - 4.0) / 20.0, 1e-3);
  EXPECT_NEAR(moments_at(10.0, "20", range("-50,50")).second, moments_at(10.0, "20", crab).second, 1e-6);
}

TEST(NormVerdict, LimitsAreJudged) {
  const TemporaryFolder folder;
  const std::string limits = folder.write("limits.yml",
                                          "- {clause: a, quantity: deck_acceleration, value: 3.5}\n"
                                          "- {clause: b, quantity: lm71_deflection_over_span, value: 1/600}\n"
                                          "- {clause: c, quantity: lm71_end_rotation, value: 6.5e-3}\n"
                                          "- {clause: d, quantity: end_rotation, value: 6.5e-3}\n"
                                          "- {clause: e, quantity: train_over_lm71, value: 1}\n");
  Results run = run_yaml(bridge, {{"limits", limits}, {"sweep_speed", "50,60,5"}});
  const std::vector<double>& found = run("/verdicts/value");
  const double largest = *std::max_element(run("/norm/train_over_model").begin(), run("/norm/train_over_model").end());
  EXPECT_EQ(found[4], largest);
  EXPECT_NEAR(found[1], run("/norm/model_with_phi")[0] / L, 1e-12);
  EXPECT_NEAR(found[2], run("/norm/model_with_phi")[4], 1e-12);
}

// A study has no static effects: what it would be judged by is unknown, whatever its runs are made of.
TEST(NormVerdict, OfAStudyIsUnknown) {
  const TemporaryFolder folder;
  const std::string limits =
      folder.write("limits.yml", "- {clause: b, quantity: lm71_deflection_over_span, value: 1/600}\n");
  const std::string by_elements =
      "beam: {spans: 20.0, EI: 2.0e10, mass: 1.5e4, elements_per_span: 4}\nload: {forces: 2.0e5, speed: 50.0}\n";
  for (const std::string& scene : {std::string(bridge), by_elements + "model: {modes: 0}\nts_dt: 0.01\n"}) {
    Results study = run_yaml(scene, {{"limits", limits}, {"study_vary_load_speed", "40,50"}});
    EXPECT_TRUE(std::isnan(study("/verdicts/value")[0]));
    EXPECT_EQ(study("/verdicts/runs")[0], 0.0);
    for (const double found : study("/study/judged")) EXPECT_TRUE(std::isnan(found));
  }
}

TEST(NormVerdict, LowerBoundsOfDamping) {
  const std::string scene = R"(
beam: {spans: 15.0, EI: 1.0e10, mass: 1.2e4}
model: {modes: 2, damping_bound: prestressed}
load: {forces: 2.0e5, speed: 50.0}
)";
  Results bound = run_yaml(scene), more = run_yaml(scene, {{"model_additional_damping", "true"}});
  const std::string plain = "beam: {spans: 15.0, EI: 1.0e10, mass: 1.2e4}\nload: {forces: 2.0e5, speed: 50.0}\n";
  Results given = run_yaml(plain, {{"model_modes", "2"}, {"model_damping_ratios", "0.0135"}});
  EXPECT_NEAR(bound.attribute("/summary", "acceleration") / given.attribute("/summary", "acceleration"), 1.0, 1e-9);
  EXPECT_LT(std::abs(more.attribute("/summary", "acceleration")),
            std::abs(bound.attribute("/summary", "acceleration")));
}

// Table 6.6 is a ratio of each mode. Elements give it to two modes only, so that modes represent the bridge by default.
TEST(NormVerdict, BoundOfDampingIsThatOfEachMode) {
  const std::string scene = R"(
beam: {spans: 15.0, EI: 1.0e10, mass: 1.2e4, elements_per_span: 16}
model: {damping_bound: prestressed}
load: {forces: [2.0e5, 2.0e5], positions: [0.0, -5.0], speed: 70.0}
ts_dt: 2.0e-4
output: {lowpass: 60.0}
)";
  Results chosen = run_yaml(scene), elements = run_yaml(scene, {{"model_modes", "0"}}),
          swept = run_yaml(scene, {{"sweep_speed", "60,70,10"}});
  const double bound = 0.01 + 0.0007 * (20.0 - 15.0), f1 = pi / 2.0 * std::sqrt(1e10 / 1.2e4) / (15.0 * 15.0);
  // all modes up to 1.5 times the third frequency, which is above 30 Hz and 1.5 f1: modes 1 to 3 (n^2 f1 <= 1.5 * 9 f1)
  ASSERT_GT(9.0 * f1, 30.0);
  ASSERT_EQ(chosen("/modes/ratio_by_beam").size(), 3u);
  for (const double ratio : chosen("/modes/ratio_by_beam")) EXPECT_NEAR(ratio, bound, 1e-12);
  EXPECT_EQ(swept.attribute("/sweep", "modes"), 3.0);
  // Rayleigh damping with the bound at f1 and 4 f1 has 1.9 times of it at 9 f1: (4/9 + 9)/5
  EXPECT_NEAR(elements("/modes/ratio_by_beam")[1], bound, 1e-12);
  EXPECT_NEAR(elements("/modes/ratio_by_beam")[2] / bound, (4.0 / 9.0 + 9.0) / 5.0, 1e-3);
  const std::string plain = scene.substr(0, scene.find("model:")) + scene.substr(scene.find("load:"));
  Results given = run_yaml(plain, {{"model_modes", "3"}, {"model_damping_ratios", std::to_string(bound)}});
  const auto peak = [](Results& run) { return run.attribute("/summary", "acceleration_lowpass"); };
  EXPECT_NEAR(peak(chosen) / peak(given), 1.0, 1e-9);
}

TEST(NormVerdict, BoundOfDampingOfNaturalModes) {
  Results run = run_yaml(R"(
beam: {spans: 20.0, EI: 9.0e9, mass: 1.5e4}
support: {types: [free, free]}
foundation: {vertical: {x: [0.0, 20.0], k: 5.0e7}}
model: {damping_bound: prestressed}
scene: {analysis: modes}
modes: {count: 4}
)");
  for (const double ratio : run("/modes/damping_ratio")) EXPECT_NEAR(ratio, 0.01, 1e-12);
}

// Nothing of a foundation that is not linear adds up.
TEST(NormVerdict, NoneWhereInfluenceLinesDoNotHold) {
  Results run = run_yaml(R"(
beam: {spans: [10.0, 10.0], EI: 1.0e10, mass: 1.2e4, damping_ratios: 0.02}
support: {types: [pinned, free, roller]}
foundation: {vertical: {x: 10.0, k: 1.0e8, c: 0.0, one_sided: true}}
load: {forces: 2.0e5, speed: 50.0}
norm: {load_models: lm71}
)",
                         {{"accuracy", "1e-2"}});
  EXPECT_ANY_THROW(run("/norm/phi_dyn"));
  EXPECT_ANY_THROW(run("/static/x"));
}

}  // namespace
}  // namespace traverse::test
