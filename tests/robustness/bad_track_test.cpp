// What a layered track may not be: one line that names the option, its value and what is allowed.
#include <gtest/gtest.h>

#include "support/extremes.hpp"
#include "support/scene_run.hpp"
#include "support/small_track.hpp"

namespace traverse::test {
namespace {

const std::string track = track_of(zhai_layers, R"(
  elements_per_bay: 2
  approach: 6.0
  stretches: [weak]
  weak: {from: 3.0, to: 4.2}
beam: {spans: 9.0, EI: 4.0e9, mass: 5000.0}
load: {forces: 1.0e5, positions: 5.0, speed: 0.0}
scene: {analysis: static}
)");

struct BadTrack {
  const char *option, *value;
  std::vector<std::string> parts;
};

TEST(BadTracks, AreRefusedByName) {
  for (const BadTrack& bad : std::vector<BadTrack>{
           {"track_weak_pad_kk", "1", {"unknown option track_weak_pad_kk", "did you mean track_weak_pad_k?"}},
           {"track_soft_pad_k", "1", {"unknown option track_soft_pad_k"}},
           {"track_weak_pad_k", "-1", {"track_weak_pad_k = -1", "not below 0"}},
           {"track_weak_gap", "nan", {"track_weak_gap = nan"}},
           {"track_weak_sleepers", "few", {"track_weak_sleepers = few", "standard, none"}},
           {"track_weak_to", "2.0", {"track_weak_to = 2.0", "not below track_weak_from, 3 m"}},
           {"track_weak_subballast_k", "0", {"track_weak_subballast_k is 0", "it must be positive"}},
           {"track_stretches", "weak,weak", {"track_stretches", "track_weak_from", "rename"}},
           {"track_pad_k", "0", {"too few sleepers"}},
           {"track_gap", "1e-3", {"too few sleepers"}},
           {"track_rail_hinges", "3.1", {"track_rail_hinges is 3.1", "0.3 m apart"}},
           {"track_dips_length", "1", {"track_dips_length = 1", "need track_dips_x"}},
           {"output_sleepers", "5,40", {"output_sleepers = 5,40", "no track at x = 40 m", "from -6 to 15 m"}},
           {"output_sleepers", "3,3.1", {"the sleeper at x = 3 m twice", "each sleeper once"}},
       }) {
    SCOPED_TRACE(bad.option);
    const bool ground = std::string(bad.option) == "track_weak_subballast_k";
    Values values = {{bad.option, bad.value}};
    if (ground) values = values + Values{{"track_weak_from", "-3"}};
    expect_refused([&] { run_yaml(track, values); }, bad.parts);
  }
}

TEST(BadTracks, NothingLeftToStandOn) {
  expect_refused(
      [&] {
        run_yaml(track, {{"track_weak_pad_k", "0"}, {"track_weak_ballast_k", "0"}});
      },
      {"the sleeper at x = 3 m", "neither pad nor ballast"});
  expect_refused(
      [&] {
        run_yaml(track, {{"track_weak_pad_k", "0"}, {"track_weak_gap", "1e-3"}});
      },
      {"track_weak_pad_k is 0 at the sleeper at x = 3 m"});
  expect_refused(
      [&] {
        run_yaml(track, {{"track_weak_from", "3.1"}, {"track_weak_to", "3.5"}});
      },
      {"track_weak_from", "no sleeper of the track stands from 3.1 to 3.5 m"});
  expect_refused(
      [&] {
        run_yaml(track, {{"track_rail_hinges", "2.7,3.0,3.3"}, {"track_weak_sleepers", "none"}});
      },
      {"float away"});
}

TEST(BadTracks, OfTheSleepersThatAreThere) {
  expect_refused(
      [&] {
        run_yaml(track, {{"track_weak_sleepers", "none"}, {"output_sleepers", "3.6"}});
      },
      {"output_sleepers = 3.6", "the sleeper at x = 3.6 m is missing"});
  expect_refused(
      [&] {
        run_scene("r2_sprung_mass", {{"output_sleepers", "3"}});
      },
      {"output_sleepers = 3", "needs a layered track"});
}

TEST(BadTracks, BridgesMoveByTheirElements) {
  expect_refused(
      [&] {
        run_yaml(track, {{"scene_analysis", "transient"}, {"model_modes", "3"}});
      },
      {"model_modes = 3", "under a layered track", "allowed: auto or 0"});
}

TEST(BadTracks, ShearNeedsBallastThatMoves) {
  constexpr const char* on_pads = R"(
beam: {spans: 9.0, EI: 4.0e9, mass: 5000.0}
track: {rail: {EI: 1.3e7, mass: 121.0}, spacing: 0.6, pad: {k: 1.3e8}, sleeper: {mass: 251.0}, approach: 6.0}
load: {forces: 1.0e5, positions: 5.0, speed: 0.0}
scene: {analysis: static}
)";
  for (const char* name : {"track_shear_k", "track_shear_c", "track_ballast_own_mass"})
    expect_refused([&] { run_yaml(on_pads, {{name, "1"}}); }, {name, "needs ballast masses that move separately"});
  expect_refused([&] { run_yaml(on_pads, {{"track_gap", "1e-3"}}); }, {"track_gap needs track_ballast_k"});
}

}  // namespace
}  // namespace traverse::test
