// What a file of given modes may lack, and what a bridge of such modes cannot be asked for: one line each.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/folders.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

const std::string head = "frequency, 4.0, 9.0\nmodal_mass, 1e5, 1e5\ndamping_ratio, 0.01\n";
const std::string shapes = "0, 0, 0\n5, 0.7, 1\n10, 1, 0\n15, 0.7, -1\n20, 0, 0\n";
const std::string forces = "load: {forces: 1e5, speed: 30}\n";

void expect_refused(const std::string& modes, const std::vector<std::string>& parts, const std::string& more = "",
                    const std::vector<std::string>& words = {}) {
  const Workplace workplace("bridge: {modes_file: modes.csv}\n" + forces + more);
  workplace.write("modes.csv", modes);
  expect_refusal(workplace, workplace.run(words), parts);
}

TEST(GivenModesFile, NamesTheLine) {
  expect_refused("frequency, 4, -9\n", {"modes.csv:1", "mode 2", "above 0"});
  expect_refused("frequency, 4, 9\nmodal_mass, 1e5\n", {"modes.csv:2", "modal_mass", "one per mode"});
  expect_refused("frequency, 4, 9\nmodal_mass, 1e5, -3\n", {"modes.csv:2", "modal mass of mode 2"});
  expect_refused("frequency, 4, 9\ndamping_ratio, 0.1, -1.5\n",
                 {"modes.csv:2", "damping ratio of mode 2", "not below 0"});
  expect_refused("frequency, 4, 9\ndamping_ratio, 2\n", {"modes.csv:2", "lowest mode is 2", "below 1"});
  expect_refused(head + "0, 0, 0\n5, 1, 1\n5, 1, 0\n", {"modes.csv:6", "increase strictly"});
  expect_refused(head + "0, 0, 0\n5, 1\n", {"modes.csv:5", "for 2 modes"});
  expect_refused(head + "1, 0, 0\n", {"modes.csv:4", "left end"});
  expect_refused(head + "0, 0, zero\n", {"modes.csv:4", "'zero'"});
  expect_refused(head + "pace, 3\n", {"modes.csv:4", "'pace'", "frequency"});
  expect_refused("frequency, 4\ndamping_ratio, 0\n" + std::string("0, 0\n5, 1\n"), {"modes.csv", "modal_mass"});
  expect_refused(head + "0, 0, 0\n", {"modes.csv", "1 stations"});
  expect_refused(head + "0, 0, 0\n5, 0, 0\n", {"modes.csv", "zero"});
  expect_refused("", {"modes.csv", "frequency"});
}

TEST(GivenModesFile, HasItsTracks) {
  expect_refused(head + shapes, {"bridge_track is 2", "1 track"}, "", {"-bridge_track", "2"});
  expect_refused(head + "track, 2\n" + shapes, {"modes.csv:4", "track, 1"});
}

TEST(GivenModesFile, OfAnotherKind) {
  const Workplace none("bridge: {modes_file: nowhere.csv}\n" + forces);
  expect_refusal(none, none.run(), {"nowhere.csv"});
  // A results file without modes.
  const Workplace workplace("beam: {spans: 20, EI: 1e10, mass: 1e4}\nts: {dt: 1e-2}\n" + forces);
  expect_success(workplace.run({"-output_file", "run.h5", "-model_modes", "0", "-accuracy_cache", "false"}));
  workplace.write("given.yml", "bridge: {modes_file: run.h5}\n" + forces);
  const Outcome outcome = workplace.run({"-options_file", "given.yml"});
  EXPECT_NE(outcome.status, 0);
}

TEST(GivenModes, HaveNoElements) {
  const std::string all = head + shapes;
  expect_refused(all, {"beam_EI", "bridge_modes_file"}, "", {"-beam_EI", "1e10"});
  expect_refused(all, {"foundation_vertical_x", "bridge_modes_file"}, "", {"-foundation_vertical_x", "5"});
  expect_refused(all, {"track_rail_EI", "bridge_modes_file"}, "", {"-track_rail_EI", "1e7"});
  expect_refused(all, {"scene_analysis", "transient or modes"}, "", {"-scene_analysis", "static"});
  expect_refused(all, {"scene_analysis", "transient or modes"}, "", {"-scene_analysis", "envelope"});
  expect_refused(all, {"model_modes", "up to 2"}, "", {"-model_modes", "0"});
  expect_refused(all, {"model_modes", "up to 2"}, "", {"-model_modes", "3"});
  expect_refused(all, {"norm_load_models"}, "", {"-norm_load_models", "lm71"});
  expect_refused(all, {"model_damping_ratios"}, "", {"-model_damping_ratios", "0.01"});
  const Workplace workplace("load: {forces: 1e5, speed: 30}\nbeam: {spans: 20, EI: 1e10, mass: 1e4}\n");
  expect_refusal(workplace, workplace.run({"-bridge_track", "1"}), {"bridge_track", "bridge_modes_file"});
}

// It runs again from its results when the file is gone, and says the same.
TEST(GivenModes, RunAgainFromResults) {
  const Workplace workplace("bridge: {modes_file: modes.csv}\n" + forces + "ts: {dt: 1e-3}\n");
  workplace.write("modes.csv", head + shapes);
  const Outcome first = workplace.run();
  expect_success(first);
  std::filesystem::remove(workplace.path("modes.csv"));
  expect_success(Child({program_path(), "results/scene.h5"}, workplace.folder()).wait());
}

TEST(GivenModes, OnTwoRanks) {
  const Workplace workplace("bridge: {modes_file: modes.csv}\n" + forces + "ts: {dt: 1e-3}\n");
  workplace.write("modes.csv", head + shapes);
  expect_success(workplace.run({"-step_ranks", "all"}, 2));
}

}  // namespace
}  // namespace traverse::test
