// Numbers that are too large: refused in one line, before memory is taken for them or work begun.
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string open_scene = std::string(two_spans) + quarter_car;

void expect_refused(const std::string& scene, const std::vector<std::string>& words,
                    const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& word : words) all += " " + word;
  SCOPED_TRACE(all);
  const Workplace workplace(scene);
  expect_refusal(workplace, workplace.run(words, 1, 300.0), parts);
}

TEST(TooMany, EntriesOfLists) {
  const std::string scene = small_scene();
  expect_refused(scene, {"-output_probes", "12.5*10000000"}, {"output_probes", "at most 100000"});
  expect_refused(scene, {"-train_vehicles", "car*1000000", "-train_spacing", "9"}, {"train_vehicles", "at most 2000"});
  expect_refused(scene, {"-train_vehicles", "car*99999999999999999999999"}, {"train_vehicles", "at most 2000"});
  expect_refused(scene, {"-load_forces", "1e3*1000000"}, {"load_forces", "at most 100000"});
  expect_refused(scene, {"-beam_spans", "20*10000000"}, {"beam_spans", "at most 1000000"});
}

TEST(TooMany, ElementsModesRunsAndStations) {
  const std::string scene = small_scene();
  const std::string spring = "foundation_vertical_";
  expect_refused(scene, {"-beam_spans", "20*10000", "-support_types", "pinned", "-beam_elements_per_span", "100000"},
                 {"beam_elements_per_span", "at most 2e+07"});
  expect_refused(scene, {"-" + spring + "x", "0,25", "-" + spring + "spacing", "1e-7", "-" + spring + "k", "1"},
                 {spring + "spacing", "2.5e+08 stations"});
  expect_refused(scene, {"-output_probes_spacing", "1e-6"},
                 {"output_probes_spacing", "4e+07 stations", "at most 100000"});
  expect_refused(scene, {"-sweep_speed", "1,10000,0.1", "-output_probes", "12.5*10000"},
                 {"sweep_speed", "at most 1e+08"});
  expect_refused(scene,
                 {"-scene_analysis", "modes", "-modes_count", "100000", "-beam_spans", "20*200", "-support_types",
                  "pinned", "-beam_elements_per_span", "50000"},
                 {"modes_count", "GB", "this machine has"});
}

TEST(TooMany, LinesAndLettersOfFiles) {
  expect_refused(small_scene(), {"-beam_EI", "/dev/zero"}, {"/dev/zero", "is a pipe or a device"});
  expect_refused(small_scene(), {"-options_file", "/dev/zero"}, {"/dev/zero", "is a pipe or a device"});
  std::string anchors = "$$a: &a {x: " + std::string(1000, '1') + "}\n";
  char last = 'a';
  for (char next = 'b'; next < 'k'; last = next++) {
    anchors += std::string("$$") + next + ": &" + next + " {";
    for (int i = 0; i < 10; ++i) anchors += (i > 0 ? ", k" : "k") + std::to_string(i) + ": *" + last;
    anchors += "}\n";
  }
  expect_refused(anchors + "beam: *j\n", {}, {"scene.yml", "anchors"});
}

// The interval over the step is more than a whole number of 32 bits can hold.
TEST(TooLong, AnIntervalBeyondTheRun) {
  const Workplace workplace(open_scene);
  const Outcome outcome =
      workplace.run({"-output_interval", "1e7", "-ts_max_time", "0.02", "-output_file", "r.h5"}, 1, 300.0);
  expect_success(outcome);
  Results results(workplace.path("r.h5"));
  EXPECT_EQ(results.time().size(), 1U);
  EXPECT_NEAR(results.attribute("/summary", "end_time"), 0.02, 1e-12);
}

// The same with a bridge by its modes, and with ratios of lengths.
TEST(TooLong, RatiosOfLengths) {
  const std::string span = "beam: {spans: 25.0, EI: 1.2e10, mass: 9000.0}\nload: {forces: 2.0e5, speed: 40.0}\n";
  const Workplace workplace(span);
  expect_success(workplace.run({"-output_interval", "1e12", "-model_modes", "3", "-output_file", "none"}, 1, 300.0));
  expect_refused(span, {"-foundation_vertical_bed_k", "1e50"}, {"foundation_vertical", "beam_elements_per_span"});
  expect_refused(small_scene(), {"-vehicle_car_wheel_flat_length", "1e-8", "-vehicle_car_wheel_radius", "1e-7"},
                 {"allowed"});
}

TEST(TrialRuns, ThatWouldTakeTooLongAreRefused) {
  expect_refused(open_scene, {"-beam_EI", "9e20"}, {"accuracy = 0.001", "trial runs", "first period", "ts_dt"});
}

TEST(TrialRuns, AreNotChangedByMonitorsAndLimits) {
  const Workplace workplace(open_scene);
  const auto choice = [](const Outcome& outcome) {
    for (const std::string& line : lines_of(outcome.out))
      if (line.find("accuracy 0.001: ") != std::string::npos) return line.substr(0, line.find(" took"));
    return "none in: " + outcome.out + outcome.err;
  };
  const std::vector<std::string> file = {"-output_file", "none"};
  const std::string alone = choice(workplace.run(file, 1, 300.0));
  EXPECT_NE(alone.find("trial runs"), std::string::npos) << alone;
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"-ts_monitor"}, {"-ts_max_steps", "3"}, {"-ts_adapt_type", "none"}, {"-ts_view"}, {"-ts_adapt_monitor"}}) {
    SCOPED_TRACE(words.front());
    std::vector<std::string> all = file;
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = workplace.run(all, 1, 300.0);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(choice(outcome), alone);
    if (words.front() == "-ts_max_steps") {
      EXPECT_NE(outcome.out.find("ended at the limit of -ts_max_steps"), std::string::npos) << outcome.out;
    }
    if (words.front() == "-ts_monitor") {
      EXPECT_NE(outcome.out.find("0 TS dt"), std::string::npos) << outcome.out;
      EXPECT_NE(outcome.out.find("100 TS dt"), std::string::npos) << outcome.out;
    }
  }
  const Outcome ladder = workplace.run({"-ts_adapt_type", "ladder", "-output_file", "none"}, 1, 300.0);
  EXPECT_NE(ladder.out.find(
                "has no effect: trial runs do not choose mesh and step, and errors are not estimated: ts_adapt_type"),
            std::string::npos)
      << ladder.out;
}

}  // namespace
}  // namespace traverse::test
