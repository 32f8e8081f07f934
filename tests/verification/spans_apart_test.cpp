// Linear vehicles over many spans that do not touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

const Values viaduct = {{"beam_spans", "32.0*12"},   {"train_vehicles", "coach*2"},
                        {"train_positions", "-2"},   {"output_probes", "48,176.3"},
                        {"output_interval", "0.02"}, {"ts_max_time", "3.5"},
                        {"ts_dt", "2e-3"},           {"model_vehicles", "linear"}};

const char* const of_train[] = {"/vehicles/0/wheel_3/normal_force", "/vehicles/1/rear_bogie/acceleration"};
double largest_difference(Results& a, Results& b) {
  double worst = 0.0;
  for (const char* name : of_train) worst = std::max(worst, relative_difference(a(name), b(name)));
  return worst;
}

// Spans far from the train rest and are left out of the steps.
TEST(SpansApart, AllSteppedOrOnlyThoseThatMove) {
  Results moving = run_scene("danyang_kunshan", viaduct + Values{{"ts_dt", "2e-2"}});
  Results all = run_scene("danyang_kunshan", viaduct + Values{{"ts_dt", "2e-2"}, {"model_window", "0"}});
  EXPECT_LT(largest_difference(moving, all), 1e-9);
  EXPECT_LT(relative_difference(moving("/probes/deflection"), all("/probes/deflection")), 1e-9);
}

TEST(SpansApart, ThatTwist) {
  const Values twisting =
      viaduct +
      Values{{"ts_dt", "2e-2"}, {"beam_GJ", "1e11"}, {"beam_polar_inertia", "3e5"}, {"track_eccentricity", "2.3"}};
  Results moving = run_scene("danyang_kunshan", twisting);
  Results all = run_scene("danyang_kunshan", twisting + Values{{"model_window", "0"}});
  EXPECT_LT(largest_difference(moving, all), 1e-9);
  for (const char* name : {"/probes/deflection", "/probes/twist", "/probes/torsional_moment"})
    EXPECT_LT(relative_difference(moving(name), all(name)), 1e-9) << name;
}

// Around each of two trains that meet and part again.
TEST(SpansApart, OfTrainsThatMeet) {
  const std::string scene =
      "beam: {spans: 32.0*60, elements_per_span: 6, EI: 3.795e11, mass: 3.0e4, damping_ratios: 0.2, "
      "continuity: simply_supported}\n"
      "vehicle: {coach: {file: " +
      source_folder() +
      "/options/vehicles/s300.yml}}\ntrains: [up, down]\n"
      "up: {vehicles: coach, positions: 200.0, speed: 83.333}\ndown: {vehicles: coach, positions: 1700.0, speed: "
      "-83.333}\n"
      "model: {vehicles: linear}\nts: {dt: 2e-2, max_time: 17}\noutput: {interval: 0.1, probes: [944.0, 1296.0]}\n";
  Results moving = run_yaml(scene), all = run_yaml(scene, {{"model_window", "0"}});
  EXPECT_LT(relative_difference(moving("/probes/deflection"), all("/probes/deflection")), 1e-9);
  EXPECT_LT(relative_difference(moving("/vehicles/1/wheel_1/normal_force"), all("/vehicles/1/wheel_1/normal_force")),
            1e-9);
}

// Samples a second apart do not show where a span that swings five times a second turns.
TEST(SpansApart, PeaksAreLookedForBetweenSamples) {
  Results rare = run_scene("danyang_kunshan", viaduct + Values{{"output_interval", "1"}});
  Results often = run_scene("danyang_kunshan", viaduct);
  for (const char* peak : {"deflection", "moment"}) {
    const double off = rare.attribute("/summary", peak) / often.attribute("/summary", peak) - 1.0;
    RecordProperty("of_" + std::string(peak), text(off));
    EXPECT_LT(std::abs(off), 1e-3) << peak;
  }
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

}  // namespace
}  // namespace traverse::test
