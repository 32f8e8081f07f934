// -describe: every scene of options/, what it shows, what it finds unusual and what not, and what it leaves alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

std::vector<std::string> scenes() {
  std::vector<std::string> files;
  for (const char* folder : {"scenes", "studies"})
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/options/" + folder))
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
  const Outcome outcome = workplace.run({"-options_file", GetParam(), "-describe"});
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

// SuspensionInKilonewtons: the frame hangs on springs of 1 m that 88.3 kN each extend by 44.1 m, instead of standing 1
// m above their lower ends: 46.1 m.
class Unusual : public testing::TestWithParam<Case> {};
TEST_P(Unusual, IsFoundWhereItIs) {
  const Workplace workplace(usual);
  std::vector<std::string> words = GetParam().words;
  words.emplace_back("-describe");
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
        Case{"SpeedInKilometresAnHour", {"-train_speed", "144"}, "518.4 km/h"},
        Case{"SoftContact", {"-vehicle_cart_a_stiffness", "1e6"}, "a: its contact is softer, 1e+06 N/m"},
        Case{"SuspensionInKilonewtons",
             {"-vehicle_cart_one_stiffness", "2e3", "-vehicle_cart_two_stiffness", "2e3"},
             "the body frame is 46.1 m below its position"},
        Case{"RadiusInMillimetres",
             {"-vehicle_cart_a_radius", "500", "-vehicle_cart_b_radius", "500"},
             "m above its position in the input"},
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
    [](const testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

/// A bridge under a force, without damping.
constexpr const char* under_a_force = R"(
beam: {spans: 30.0, EI: 1.6e11, mass: 2.0e4, elements_per_span: 8}
load: {forces: 1.7e5, speed: 40.0}
ts: {dt: 2.0e-3}
)";

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What the program prints under "unusual input" of a scene.
std::string unusual_of(const Workplace& workplace, const std::vector<std::string>& words) {
  const Outcome outcome = workplace.run(words);
  expect_success(outcome);
  return section(outcome.out, "unusual input");
}

// The first frequency is pi/2/L^2 sqrt(EI/m) = 4.94 Hz: a/(2 omega) = 0.161 for a = 10 1/s, b omega/2 = 0.155 for b =
// 0.01 s.
TEST(UnusualInput, DampingHoweverItIsWritten) {
  const Workplace workplace(under_a_force);
  const std::vector<std::pair<std::vector<std::string>, const char*>> cases = {
      {{"-beam_damping_ratios", "0.2,0.2"}, "20 % of critical damping"},
      {{"-beam_rayleigh", "10,0"}, "16.1 % of critical damping"},
      {{"-beam_rayleigh", "0,0.01"}, "15.5 % of critical damping"},
      {{"-model_modes", "3", "-model_damping_ratios", "0.3"}, "30 % of critical damping"}};
  for (const auto& [words, found] : cases) {
    SCOPED_TRACE(words[0] + " " + words[1]);
    EXPECT_TRUE(contains(unusual_of(workplace, words), found)) << unusual_of(workplace, words);
  }
  EXPECT_EQ(unusual_of(workplace, {"-beam_rayleigh", "0.6,3e-4"}), "");
}

// Axles of 170 kN, given as 170 N: before the computation, once, and in the results file.
TEST(UnusualInput, IsSaidByEveryVerb) {
  const Workplace workplace(under_a_force);
  workplace.write("record.csv", "0 0\n0.3 -1e-6\n0.6 0\n");
  const std::string found = "the largest load of a wheel or force is 170 N; forces are possibly given in kN";
  const std::vector<std::vector<std::string>> verbs = {
      {},
      {"-scene_analysis", "static", "-load_positions", "15"},
      {"-sweep_speed", "30,50,10"},
      {"-study_vary_load_speed", "30,40", "-study_vary_beam_mass", "2e4,2.2e4"},
      {"-study_vary_beam_mass_normal", "2e4,1e3", "-study_sensitivity", "local"},
      {"-find_option", "load_speed", "-find_between", "30,50", "-find_quantity", "peak_deflection", "-find_equals",
       "1"},
      {"-fit_vary_beam_EI", "1e11,2e11", "-fit_to_middle_series", "record.csv", "-fit_to_middle_quantity", "deflection",
       "-fit_to_middle_x", "15"}};
  for (const std::vector<std::string>& verb : verbs) {
    SCOPED_TRACE(verb.empty() ? "" : verb.front());
    std::vector<std::string> words = {"-load_forces", "170",          "-beam_damping_ratios",
                                      "0.01,0.01",    "-output_file", "a.h5"};
    words.insert(words.end(), verb.begin(), verb.end());
    const Outcome outcome = workplace.run(words);
    const std::size_t first = outcome.out.find(found), heading = outcome.out.find("unusual input");
    EXPECT_LT(heading, first) << outcome.out << outcome.err;
    EXPECT_LT(first, std::min(outcome.out.find("modelled"), outcome.out.find("summary"))) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out.find(found, first + 1), std::string::npos) << outcome.out;
    EXPECT_TRUE(contains(bytes_of(workplace.path("a.h5")), found));  // among the texts of /model/notes
  }
}

// A run that fails says before what is unusual.
TEST(UnusualInput, IsSaidBeforeARunFails) {
  const Workplace workplace(usual);
  std::string heights;
  for (int i = 0; i < 200; ++i)
    heights += std::to_string(0.25 * i - 10.0) + "," + std::to_string(3.0 * std::sin(i)) + "\n";
  workplace.write("profile.csv", heights);
  const Outcome outcome = workplace.run({"-track_profile", "profile.csv"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_TRUE(contains(section(outcome.out, "unusual input"), "heights are possibly given in mm")) << outcome.out;
}

TEST(UnusualInput, ProfilesThatAreElsewhere) {
  const Workplace workplace(usual);
  const auto profile = [&](double from, double to, double end) {
    std::string text;
    for (double x = from; x < to; x += 1.0) text += std::to_string(x) + "," + std::to_string(1e-3 * std::sin(x)) + "\n";
    workplace.write("profile.csv", text + std::to_string(to) + "," + std::to_string(end) + "\n");
    return unusual_of(workplace, {"-track_profile", "profile.csv", "-describe"});
  };
  EXPECT_TRUE(contains(profile(12340.0, 12540.0, 0.0), "goes from x = 12340 to 12540 m, but the wheels"));
  EXPECT_TRUE(contains(profile(-500.0, -100.0, 0.0), "but the wheels and the bridge are between"));
  EXPECT_TRUE(contains(profile(-20.0, 15.0, 1e-3), "goes from x = -20 to 15 m, the bridge from 0 to 30 m"));
  EXPECT_FALSE(contains(profile(-20.0, 15.0, 0.0), "track_profile"));  // a local unevenness
  EXPECT_FALSE(contains(profile(-20.0, 40.0, 1e-3), "track_profile"));
}

// Positions in km and speeds in km/h: d(v^2)/dx/2 = 45^2/(2 0.1) m/s2 in the first interval.
TEST(UnusualInput, SpeedsOfARunningTimeProgram) {
  const Workplace workplace(
      "beam: {spans: 20.0, EI: 4.0e10, mass: 1.2e4, damping_ratios: 0.02}\n"
      "load: {forces: 1.0e5, speed_file: speeds.csv, speed_over: position}\n");
  workplace.write("speeds.csv", "0,0\n0.1,45\n0.5,80\n");
  EXPECT_TRUE(
      contains(unusual_of(workplace, {"-describe"}), "load_speed_file: the speed changes by up to 1.012e+04 m/s2"));
  workplace.write("speeds.csv", "0,0\n100,12.5\n500,22\n");
  EXPECT_FALSE(contains(unusual_of(workplace, {"-describe"}), "load_speed_file"));
}

TEST(Check, FindsNothingUnusualInWhatIsUsual) {
  const Workplace workplace(usual);
  const Outcome outcome = workplace.run({"-describe"});
  expect_success(outcome);
  EXPECT_EQ(section(outcome.out, "unusual input"), "  nothing               \n") << outcome.out;
  const Outcome quiet = workplace.run({"-describe", "-output_quiet"});
  expect_success(quiet);
  EXPECT_EQ(quiet.out, "");
}

// Axles of 10 t each, 98.1 kN; a support of a single span bears at most both axles, when one stands over it and the
// other 4 m away: 98.1 (1 + 26/30) kN, and half of the bridge's 600 t.
TEST(Check, ShowsLoadsAndReactionsAtRest) {
  const Workplace workplace(usual);
  const std::string out = workplace.run({"-describe"}).out;
  EXPECT_TRUE(contains(out, "a 98.1, b 98.1")) << out;
  const std::string supports = section(out, "support reactions");
  EXPECT_TRUE(contains(supports, "support at 0 m              2943             0       183.1")) << supports;
  EXPECT_TRUE(contains(supports, "support at 30 m             2943             0       183.1")) << supports;
  // F a (3 L^2 - 4 a^2)/(48 EI) of each axle, both a = 13 m from the nearer support.
  EXPECT_TRUE(contains(supports, "0.6722 mm")) << supports;
}

TEST(Check, OnTwoRanksIsTheSame) {
  const Workplace workplace(usual);
  const Outcome outcome = workplace.run({"-describe"}, 2);
  expect_success(outcome);
  EXPECT_EQ(lines_of(outcome.out), lines_of(workplace.run({"-describe"}).out));
}

TEST(Check, LeavesResultsThatAreThereAlone) {
  const Workplace workplace(usual);
  workplace.write("mine.h5", "not a results file");
  const Outcome outcome = workplace.run({"-describe", "-output_file", "mine.h5"});
  expect_success(outcome);
  EXPECT_TRUE(contains(outcome.out, "the file exists")) << outcome.out;
  EXPECT_EQ(std::filesystem::file_size(workplace.path("mine.h5")), 18u);
}

TEST(Check, RefusesWhatARunRefuses) {
  const Workplace workplace(usual);
  expect_refusal(workplace, workplace.run({"-describe", "-beam_EI", "-5"}), {"beam_EI"});
  expect_refusal(workplace, workplace.run({"-describe", "-ts_tpye", "esdirk4"}), {"ts_tpye"});
  expect_refusal(workplace, workplace.run({"-describe", "-support_types", "free"}), {"support_types"});
  expect_refusal(workplace, workplace.run({"-describe", "-ts_dt", "0.5"}), {"ts_dt"});
}

// --- the estimate counts what the run does
// ----------------------------------------------------------------------------

/// The steps that -describe counts, and those of the run.
void expect_counted_steps(const Workplace& workplace, double tolerance) {
  const Outcome check = workplace.run({"-describe"});
  expect_success(check);
  const std::string cost = section(check.out, "cost, estimated");
  const std::size_t at = cost.find("  steps ");
  ASSERT_NE(at, std::string::npos) << check.out;
  const double counted = std::stod(cost.substr(at + 8));
  expect_success(workplace.run({"-output_file", "r.h5"}));
  const double taken = Results(workplace.path("r.h5")).attribute("/summary", "steps");
  EXPECT_NEAR(counted, taken, tolerance * taken);
}

// Steps end at the rows of a table, of which there are four times as many as steps would be needed.
TEST(CheckedSteps, EndAtTheRowsOfATable) {
  const Workplace workplace(
      "beam: {spans: [20.0], EI: 8.0e9, mass: 9.0e3, elements_per_span: 4, damping_ratios: 0.02}\n"
      "support: {motion: motion.csv}\nload: {forces: 1.0e5, speed: 20.0}\nts: {dt: 0.02}\noutput: {interval: 0.1}\n");
  std::string rows;
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.005 * i, s = std::sin(3.14159265358979 * t);
    rows += std::to_string(t) + ", " + std::to_string(1e-3 * s * s) + "\n";
  }
  workplace.write("motion.csv", rows);
  expect_counted_steps(workplace, 0.02);
}

}  // namespace
}  // namespace traverse::test
