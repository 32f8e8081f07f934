// Forces between rail and bridge: what is refused, by one line, and limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/extremes.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr const char* deck = R"(
scene: {analysis: rail}
beam: {spans: 12.0, EI: 2.0e9, EA: 4.0e9, mass: 3000.0, surface_height: 1.0}
support: {types: [roller, roller]}
foundation: {longitudinal: {x: 0.0, k: 2.0e8, depth: 0.5}}
track:
  rail: {EI: 1.28e7, EA: 3.2212e9, mass: 120.0, area: 0.0153, ends: held}
  spacing: 0.6
  pad: {k: 1.0e8}
  longitudinal: {k: 6.0e6, limit: 12000.0, loaded_k: 1.8e7, loaded_limit: 36000.0}
  approach: 60.0
uic774: {train_length: 30.0, fronts: [0.0, 12.0, 6.0]}
)";

TEST(BadRailForces, AreRefusedByName) {
  struct Bad {
    Values values;
    std::vector<std::string> parts;
  };
  for (const Bad& bad : std::vector<Bad>{
           {{{"track_longitudinal_limit", "0"}}, {"track_longitudinal_loaded_k", "needs track_longitudinal_limit"}},
           {{{"foundation_longitudinal_x", "6"}}, {"foundation_longitudinal_depth = 0.5", "at span ends"}},
           {{{"track_approach", "20"}}, {"track_approach = 20", "at least 30 m"}},
           {{{"uic774_fronts", "0,12,0"}}, {"uic774_fronts", "first, last, step"}},
           {{{"uic774_fronts", "0,12"}}, {"uic774_fronts"}},
           {{{"uic774_direction", "up"}}, {"uic774_direction = up", "right, left, both"}},
           {{{"model_axial", "false"}}, {"track_longitudinal_limit", "acts along x"}},
           {{{"track_rail_ends", "loose"}}, {"track_rail_ends = loose", "free, held"}},
           {{{"track_rail_expansion_devices", "12"}}, {"track_rail_expansion_devices is 12", "a sleeper stands there"}},
           {{{"track_rail_expansion_devices", "12.2"}}, {"track_rail_expansion_devices is 12.2", "0.3 m apart"}},
           {{{"track_rail_expansion_devices", "90.3"}}, {"track_rail_expansion_devices is 90.3", "within the track"}},
           {{{"track_rail_expansion_devices", "12.3,12.3"}}, {"track_rail_expansion_devices is 12.3", "of its own"}},
           {{{"track_rail_expansion_devices", "12.3"}, {"track_rail_hinges", "12.3"}},
            {"track_rail_expansion_devices is 12.3", "a joint of the rail stands there"}},
           {{{"track_rail_expansion_devices", "12.3"},
             {"track_stretches", "a"},
             {"track_a_from", "12.4"},
             {"track_a_to", "80"},
             {"track_a_longitudinal_k", "0"},
             {"track_rail_ends", "free"}},
            {"track_rail_expansion_devices is 12.3", "to its right"}},
           {{{"track_rail_expansion_devices", "12.3"},
             {"track_longitudinal_limit", "0"},
             {"track_longitudinal_loaded_k", "0"},
             {"track_longitudinal_loaded_limit", "0"},
             {"model_axial", "false"}},
            {"track_rail_expansion_devices", "acts along x"}},
           {{{"foundation_longitudinal_limit", "1e5"}, {"foundation_longitudinal_c", "1"}},
            {"foundation_longitudinal_limit", "without _c"}},
           {{{"foundation_longitudinal_limit", "-1"}}, {"foundation_longitudinal_limit"}},
       }) {
    SCOPED_TRACE(bad.parts.front());
    expect_refused([&] { run_yaml(deck, bad.values); }, bad.parts);
  }
}

TEST(BadRailForces, NeedATrackAndTheAreaOfItsRails) {
  const std::string bare = "beam: {spans: 12.0, EI: 2.0e9, mass: 3000.0}\n";
  expect_refused([&] { run_yaml("scene: {analysis: rail}\n" + bare); }, {"scene_analysis = rail", "layered track"});
  expect_refused(
      [&] {
        run_yaml(bare, {{"track_rail_expansion_devices", "3"}});
      },
      {"track_rail_expansion_devices", "belongs to a layered track"});
  std::string text(deck);
  const std::string area = "area: 0.0153, ";
  text.erase(text.find(area), area.size());
  expect_refused([&] { run_yaml(text); }, {"scene_analysis = rail", "track_rail_area"});
}

// Where no sleeper slides, and a train changes nothing of what holds it, the order of loads does not matter.
TEST(RailForcesOfALinearTrack, AddUp) {
  std::string text(deck);
  const std::string sliding = ", limit: 12000.0, loaded_k: 1.8e7, loaded_limit: 36000.0";
  text.erase(text.find(sliding), sliding.size());
  Results run = run_yaml(text, {{"beam_temperature_uniform", "30"}, {"uic774_traction", "0"}});
  for (const char* side : {"/least_stress", "/greatest_stress", "/greatest_slip"}) {
    const std::vector<double> sum = run("/rail_forces/separate" + std::string(side));
    for (const char* name : {"in_sequence", "at_once"})
      EXPECT_LT(relative_difference(run("/rail_forces/" + std::string(name) + side), sum), 1e-9) << name << side;
  }
}

// The same with an expansion device beyond either end of the deck.
TEST(RailForcesBothWays, OpenDevicesAlike) {
  Values there = {{"foundation_longitudinal_x", "0,12"},
                  {"foundation_longitudinal_side", "right"},
                  {"beam_temperature_uniform", "30"},
                  {"track_rail_temperature", "40"}};
  Values back = there;
  there.emplace_back("track_rail_expansion_devices", "12.3");
  back.emplace_back("track_rail_expansion_devices", "-0.3");
  back.emplace_back("uic774_direction", "left");
  Results right = run_yaml(deck, there), left = run_yaml(deck, back);
  for (const char* name : {"temperature", "bending", "braking", "traction", "in_sequence", "at_once"}) {
    const std::string its = "/rail_forces/" + std::string(name) + "/opening";
    EXPECT_NEAR(left(its)[0], right(its)[0], 1e-8 * std::abs(right(its)[0])) << name;
  }
}

// A train that runs the other way over a symmetric bridge does the mirror image.
TEST(RailForcesBothWays, AreMirrorImages) {
  const Values free_bearings = {{"foundation_longitudinal_x", "0,12"}, {"foundation_longitudinal_side", "right"}};
  Results right = run_yaml(deck, free_bearings);
  Values back = free_bearings;
  back.emplace_back("uic774_direction", "left");
  Results left = run_yaml(deck, back);
  for (const char* name : {"bending", "braking", "traction", "in_sequence"}) {
    const std::string its = "/rail_forces/" + std::string(name) + "/greatest_stress";
    std::vector<double> mirrored = left(its);
    std::reverse(mirrored.begin(), mirrored.end());
    EXPECT_LT(relative_difference(mirrored, right(its)), 1e-7) << name;
  }
}

}  // namespace
}  // namespace traverse::test
