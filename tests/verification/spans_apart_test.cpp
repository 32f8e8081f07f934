// Linear vehicles over spans that do not touch, each stepped by the modes of its elements (lanes/span_crossing.hpp),
// against the same runs by the elements themselves. Under the train both are the same equations and the same method,
// but for the contacts' first power; behind it modes ring exactly, and elements with the method's error.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "support/curve.hpp"
#include "support/paths.hpp"

namespace traverse::test {
namespace {

const Values viaduct = {{"beam_spans", "32.0*12"},   {"train_vehicles", "coach*2"},
                        {"train_positions", "-2"},   {"output_probes", "48,176.3"},
                        {"output_interval", "0.02"}, {"ts_max_time", "3.5"},
                        {"ts_dt", "2e-3"},           {"model_vehicles", "linear"}};

const char* const of_train[] = {"/vehicles/0/wheel_3/normal_force", "/vehicles/1/rear_bogie/acceleration"};
const char* const of_bridge[] = {"/probes/deflection", "/probes/velocity", "/supports/reaction"};

double largest_difference(Results& a, Results& b, std::span<const char* const> series) {
  double worst = 0.0;
  for (const char* name : series) worst = std::max(worst, relative_difference(a(name), b(name)));
  return worst;
}

struct Runs {
  Results spans, elements;
};
Runs both(const Values& options) {
  return {run_scene("danyang_kunshan", viaduct + options),
          run_scene("danyang_kunshan", viaduct + options + Values{{"step_lanes", "false"}})};
}

TEST(SpansApart, AreWhatTheirElementsAre) {
  Runs runs = both({});
  const double train = largest_difference(runs.spans, runs.elements, of_train);
  const double bridge = largest_difference(runs.spans, runs.elements, of_bridge);
  RecordProperty("train", text(train));
  RecordProperty("bridge", text(bridge));
  EXPECT_LT(train, 1e-4);
  EXPECT_GT(train, 0.0) << "both are the same run";
  EXPECT_LT(bridge, 1e-4);
  EXPECT_LT(std::abs(peak(runs.spans("/balance/residual")).first),
            1e-9 * std::abs(peak(runs.spans("/balance/load")).first));
}

// What the elements' runs are off by behind the train falls with the fourth power of the step: the spans ring exactly.
TEST(SpansApart, RingExactly) {
  std::array<double, 2> off{};
  for (std::size_t i = 0; i < off.size(); ++i) {
    Runs runs = both({{"ts_dt", i == 0 ? "2e-2" : "1e-2"}});
    off[i] = relative_difference(runs.spans("/probes/deflection"), runs.elements("/probes/deflection"));
    RecordProperty(i == 0 ? "20 ms" : "10 ms", text(off[i]));
  }
  EXPECT_GT(off[0] / off[1], 8.0) << off[0] << " " << off[1];
}

TEST(SpansApart, SteppedOrLeftToRing) {
  Results ring = run_scene("danyang_kunshan", viaduct + Values{{"ts_dt", "2e-2"}});
  Results stepped = run_scene("danyang_kunshan", viaduct + Values{{"ts_dt", "2e-2"}, {"model_window", "0"}});
  EXPECT_LT(largest_difference(ring, stepped, of_train), 1e-9);
  EXPECT_LT(relative_difference(ring("/probes/deflection"), stepped("/probes/deflection")), 1e-9);
}

// Spans of several kinds, elements of several lengths.
TEST(SpansApart, OfSeveralLengths) {
  Runs runs = both({{"beam_spans", "32.0*3,20,24,32.0*4"}, {"beam_elements_per_span", "8"}});
  EXPECT_LT(largest_difference(runs.spans, runs.elements, of_train), 1e-4);
  EXPECT_LT(largest_difference(runs.spans, runs.elements, of_bridge), 1e-4);
}

TEST(SpansApart, EnergyBalances) {
  Results run = run_scene("danyang_kunshan", viaduct + Values{{"step_kinks", "true"}});
  EXPECT_LT(energy_error(run), 3e-4);
}

// Linear vehicles are taken where nothing is said, and keep to the accuracy against the mechanisms.
TEST(SpansApart, TakenWhereNothingIsSaid) {
  const Values open = viaduct + Values{{"model_vehicles", "auto"}, {"ts_dt", "2e-2"}};
  Results chosen = run_scene("danyang_kunshan", open);
  Results mechanisms = run_scene("danyang_kunshan", open + Values{{"model_vehicles", "full"}});
  EXPECT_GT(chosen.attribute("/summary", "linear_defect"), 0.0);
  EXPECT_LT(relative_difference(chosen("/probes/deflection"), mechanisms("/probes/deflection")), 1e-3);
}

// Where what a wheel missed until the step's end at a corner was not made up for, forces were 6e-5 off.
TEST(SpansApart, WheelsPassCornersWhereTheyHaveMovedTo) {
  const Values options = {{"model_vehicles", "linear"}, {"step_probes", "true"}, {"ts_dt", "1e-4"}};
  const std::string scene =
      "beam: {spans: 29.3*2, continuity: simply_supported, elements_per_span: 24, EI: 4.70444e+10, mass: 4283.07, "
      "damping_ratios: 0.0062}\n"
      "vehicle: {coach: {file: " TRAVERSE_SOURCE_DIR
      "/options/vehicles/velaro.yml}}\ntrain: {vehicles: coach*2, speed: 23.5}\nmodel: {modes: 0}\n";
  Results spans = run_yaml(scene, options), elements = run_yaml(scene, options + Values{{"step_lanes", "false"}});
  const double off = std::abs(spans.attribute("/summary", "greatest_wheel_force") /
                                  elements.attribute("/summary", "greatest_wheel_force") -
                              1.0);
  RecordProperty("force", text(off));
  EXPECT_LT(off, 1e-5);
  EXPECT_GT(off, 0.0) << "both are the same run";
}

}  // namespace
}  // namespace traverse::test
