// -check: every scene of options/, what it shows, what it finds unusual and what not, and what it leaves alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/paths.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

std::vector<std::string> scenes() {
  std::vector<std::string> files;
  for (const char* folder : {"scenes", "studies"})
    for (const auto& entry : std::filesystem::directory_iterator(std::string(TRAVERSE_SOURCE_DIR "/options/") + folder))
      if (entry.path().extension() == ".yml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

std::string stem(const testing::TestParamInfo<std::string>& info) {
  return std::filesystem::path(info.param).stem().string();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The lines under a heading, as far as they are indented.
std::string section(const std::string& text, const std::string& heading) {
  std::string found;
  bool inside = false;
  for (const std::string& line : lines_of(text)) {
    if (inside && !line.starts_with("  ")) break;
    if (inside) found += line + "\n";
    inside = inside || line.starts_with(heading);
  }
  return found;
}

class CheckedFile : public testing::TestWithParam<std::string> {};
TEST_P(CheckedFile, IsShownAndNotRun) {
  const Workplace workplace("");
  const Outcome outcome = workplace.run({"-options_file", GetParam(), "-check"});
  expect_success(outcome);
  EXPECT_FALSE(workplace.has("results"));
  EXPECT_EQ(std::count_if(outcome.out.begin(), outcome.out.end(), [](char c) { return c < 32 && c != '\n'; }), 0)
      << outcome.out;  // nor anything beyond ASCII, which is negative
  for (const char* heading : {"analysis", "cost, estimated", "unusual input"})
    EXPECT_FALSE(section(outcome.out, heading).empty()) << heading << "\n" << outcome.out;
  EXPECT_TRUE(contains(section(outcome.out, "cost, estimated"), "memory")) << outcome.out;
  if (contains(outcome.out, "bridges under")) return;  // a screen has no drawing
  EXPECT_TRUE(contains(outcome.out, "to scale")) << outcome.out;
  if (contains(outcome.out, "\nbridge\n")) {
    EXPECT_TRUE(contains(section(outcome.out, "bridge"), "first frequencies"));
    EXPECT_TRUE(contains(section(outcome.out, "bridge"), " Hz"));
  }
}
INSTANTIATE_TEST_SUITE_P(Options, CheckedFile, testing::ValuesIn(scenes()), stem);

/// A bridge of 30 m and 600 t with one vehicle of two axles of 10 t, of which nothing is unusual.
constexpr const char* usual = R"(
beam: {spans: 30.0, EI: 1.6e11, mass: 2.0e4, elements_per_span: 8, damping_ratios: [0.01, 0.01]}
vehicle:
  cart:
    bodies: [front, rear, frame]
    springs: [one, two]
    wheels: [a, b]
    front: {mass: 1.0e3, inertia: 50.0, position: [2.0, 0.5]}
    rear: {mass: 1.0e3, inertia: 50.0, position: [-2.0, 0.5]}
    frame: {mass: 1.8e4, inertia: 5.0e4, position: [0.0, 1.5]}
    joints: [guide_a, guide_b]
    guide_a: {type: prismatic, bodies: [frame, front], point: [2.0, 1.0], axis: [0.0, 1.0]}
    guide_b: {type: prismatic, bodies: [frame, rear], point: [-2.0, 1.0], axis: [0.0, 1.0]}
    one: {bodies: [frame, front], from: [2.0, 1.5], to: [2.0, 0.5], stiffness: 2.0e6, damping: 3.0e4}
    two: {bodies: [frame, rear], from: [-2.0, 1.5], to: [-2.0, 0.5], stiffness: 2.0e6, damping: 3.0e4}
    a: {body: front, radius: 0.5, law: linear, stiffness: 1.0e9}
    b: {body: rear, radius: 0.5, law: linear, stiffness: 1.0e9}
train: {vehicles: cart, positions: -5.0, speed: 40.0}
ts: {dt: 1.0e-3}
)";

struct Case {
  const char* name;
  std::vector<std::string> words;
  const char* found;
};

class Unusual : public testing::TestWithParam<Case> {};
TEST_P(Unusual, IsFoundWhereItIs) {
  const Workplace workplace(usual);
  std::vector<std::string> words = GetParam().words;
  words.emplace_back("-check");
  const Outcome outcome = workplace.run(words);
  expect_success(outcome);
  EXPECT_TRUE(contains(section(outcome.out, "unusual input"), GetParam().found)) << outcome.out;
  // And on two ranks, quietly, it is all that is said.
  words.insert(words.end(), {"-output_quiet"});
  const Outcome quiet = workplace.run(words, 2);
  expect_success(quiet);
  EXPECT_TRUE(contains(quiet.out, GetParam().found)) << quiet.out;
  EXPECT_FALSE(contains(quiet.out, "cost, estimated")) << quiet.out;
}
INSTANTIATE_TEST_SUITE_P(
    Scenes, Unusual,
    testing::Values(
        Case{"LowFrequency", {"-beam_EI", "2.0e10"}, "below the range of railway bridges of 30 m"},
        Case{"HighFrequency", {"-beam_EI", "1.6e12"}, "above the range of railway bridges of 30 m"},
        Case{"StiffnessInKilonewtons", {"-beam_EI", "1.6e8"}, "possibly given in kN m2"},
        Case{"MassInTonnes", {"-beam_mass", "20"}, "possibly given in t/m"},
        Case{"BothInThousands", {"-beam_mass", "20", "-beam_EI", "1.6e8"}, "beam_mass: 20 kg/m is small"},
        Case{"DampingInPerCent", {"-beam_damping_ratios", "0.5,0.5"}, "50 % of critical damping"},
        Case{"FastTrain", {"-train_speed", "155"}, "558 km/h"},
        Case{"FasterThanAny", {"-train_speed", "300"}, "1080 km/h"},
        Case{"FastSweep", {"-sweep_speed", "100,155,5"}, "558 km/h"},
        Case{"HeavyAxle", {"-vehicle_cart_frame_mass", "9e4"}, "46 t, on one axle"},
        Case{"MassesInTonnes",
             {"-vehicle_cart_frame_mass", "18", "-vehicle_cart_front_mass", "1", "-vehicle_cart_rear_mass", "1"},
             "masses are possibly given in t"},
        Case{"ForcesInKilonewtons",
             {"-train_vehicles", "[]", "-load_forces", "170", "-load_speed", "40"},
             "forces are possibly given in kN"},
        Case{"WheelInTheAir", {"-vehicle_cart_frame_position", "2.2,1.5"}, "the static wheel load is"},
        Case{"LargeDeflection", {"-beam_EI", "5e8"}, "of its span"},
        Case{"StandsBefore", {"-train_speed", "0", "-ts_max_time", "1"}, "the train does not reach the bridge"},
        Case{"EndsBeforeItComes", {"-ts_max_time", "0.05"}, "before the first wheel reaches the bridge"},
        Case{"EndsBeforeItLeaves", {"-ts_max_time", "0.5"}, "before the last wheel has left the bridge"},
        Case{"SettledEnd", {"-support_settlement", "0,-0.005"}, "a step of up to 5 mm at x = 30 m"},
        Case{"YieldingEnd", {"-support_stiffness", "0,1.0e8"}, "a step of up to 1.8"},
        Case{"OnTheMoon", {"-gravity", "1.62"}, "on earth it is 9.81"},
        Case{"WithoutEffect", {"-load_speed", "30"}, "load_speed has no effect"}),
    [](const testing::TestParamInfo<Case>& info) { return std::string(info.param.name); });

TEST(Check, FindsNothingUnusualInWhatIsUsual) {
  const Workplace workplace(usual);
  const Outcome outcome = workplace.run({"-check"});
  expect_success(outcome);
  EXPECT_EQ(section(outcome.out, "unusual input"), "  nothing               \n") << outcome.out;
  const Outcome quiet = workplace.run({"-check", "-output_quiet"});
  expect_success(quiet);
  EXPECT_EQ(quiet.out, "");
}

// Axles of 10 t each, 98.1 kN; a support of a single span bears at most both axles, when one stands over it and the
// other 4 m away: 98.1 (1 + 26/30) kN, and half of the bridge's 600 t.
TEST(Check, ShowsLoadsAndReactionsAtRest) {
  const Workplace workplace(usual);
  const std::string out = workplace.run({"-check"}).out;
  EXPECT_TRUE(contains(out, "a 98.1, b 98.1")) << out;
  const std::string supports = section(out, "support reactions");
  EXPECT_TRUE(contains(supports, "support at 0 m              2943             0       183.1")) << supports;
  EXPECT_TRUE(contains(supports, "support at 30 m             2943             0       183.1")) << supports;
  // F a (3 L^2 - 4 a^2)/(48 EI) of each axle, both a = 13 m from the nearer support.
  EXPECT_TRUE(contains(supports, "0.6722 mm")) << supports;
}

TEST(Check, OnTwoRanksIsTheSame) {
  const Workplace workplace(usual);
  const Outcome outcome = workplace.run({"-check"}, 2);
  expect_success(outcome);
  EXPECT_EQ(lines_of(outcome.out), lines_of(workplace.run({"-check"}).out));
}

TEST(Check, LeavesResultsThatAreThereAlone) {
  const Workplace workplace(usual);
  workplace.write("mine.h5", "not a results file");
  const Outcome outcome = workplace.run({"-check", "-output_file", "mine.h5"});
  expect_success(outcome);
  EXPECT_TRUE(contains(outcome.out, "the file exists")) << outcome.out;
  EXPECT_EQ(std::filesystem::file_size(workplace.path("mine.h5")), 18u);
}

TEST(Check, RefusesWhatARunRefuses) {
  const Workplace workplace(usual);
  expect_refusal(workplace, workplace.run({"-check", "-beam_EI", "-5"}), {"beam_EI"});
  expect_refusal(workplace, workplace.run({"-check", "-ts_tpye", "esdirk4"}), {"ts_tpye"});
  expect_refusal(workplace, workplace.run({"-check", "-support_types", "free"}), {"support_types"});
  expect_refusal(workplace, workplace.run({"-check", "-ts_dt", "0.5"}), {"ts_dt"});
}

}  // namespace
}  // namespace traverse::test
