// What a user sees of `accuracy`: what was chosen, what is promised, what is not, and the check.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string limits_of_en1990 = source_folder() + "/options/limits/en1990.yml";

const std::string damped_span =
    "beam: {spans: 30.0, EI: 1.2e10, mass: 9000.0, damping_ratios: 0.03}\n"
    "support: {types: [pinned, roller]}\n"
    "load: {forces: 2.0e5, speed: 40.0}\n";

bool says(const Outcome& outcome, const std::string& text) { return outcome.out.find(text) != std::string::npos; }

TEST(AccuracyOption, ReportShowsThePromiseKept) {
  const Workplace workplace(damped_span);
  const Outcome outcome = workplace.run({"-accuracy", "1e-3", "-accuracy_report"});
  expect_success(outcome);
  for (const char* text :
       {"accuracy 0.001: ", "trial runs", "estimated errors of the peaks: deflection", "wanted", "within"})
    EXPECT_TRUE(says(outcome, text)) << text << "\n" << outcome.out;
  EXPECT_FALSE(says(outcome, "exceeded")) << outcome.out;
}

TEST(AccuracyOption, NamesWhatItCannotPromise) {
  const Workplace workplace(damped_span);
  const Outcome undamped = workplace.run({"-beam_damping_ratios", "0"});
  expect_success(undamped);
  EXPECT_TRUE(says(undamped, "error not estimated: acceleration: without damping")) << undamped.out;
  const Outcome coarse = workplace.run({"-beam_elements_per_span", "2"});
  expect_success(coarse);
  EXPECT_TRUE(says(coarse, "the error with the given 2 elements a span is")) << coarse.out;
}

// The track before the bridge moves the bridge a little; peaks that small cannot be as accurate as the wheel force.
TEST(AccuracyOption, OfABridgeThatNoWheelHasReached) {
  const Workplace workplace("");
  const Outcome outcome = workplace.run(
      {"-options_file", source_folder() + "/options/scenes/four_coaches_ballasted_bridge.yml", "-ts_max_time", "0.1"});
  expect_success(outcome);
  EXPECT_TRUE(says(outcome, "estimated errors of the peaks: wheel force")) << outcome.out;
  for (const char* quantity : {"deflection", "acceleration", "moment"})
    EXPECT_TRUE(says(outcome, std::string("error not estimated: ") + quantity + ": in this run the bridge moves by"))
        << outcome.out;
}

// Fewer peaks that are asked for: longer steps, and no promise of the others.
TEST(AccuracyOption, OfSomePeaks) {
  const Workplace workplace(damped_span);
  const Values by_elements = {{"model_modes", "0"}, {"accuracy", "1e-4"}};
  Results all = run_yaml(damped_span, by_elements);
  Results deflection = run_yaml(damped_span, by_elements + Values{{"accuracy_of", "deflection"}});
  EXPECT_LT(deflection.attribute("/", "steps"), 0.7 * all.attribute("/", "steps"));
  const Outcome outcome = workplace.run({"-accuracy_of", "deflection,moment", "-accuracy_report"});
  expect_success(outcome);
  EXPECT_TRUE(says(outcome, "error not estimated: acceleration: accuracy_of does not include it")) << outcome.out;
  const Workplace fresh(damped_span);
  expect_refusal(fresh, fresh.run({"-accuracy_of", "speed"}), {"accuracy_of", "'speed' is not allowed"});
  expect_refusal(fresh, fresh.run({"-accuracy_of", "deflection,acceleration_lowpass", "-output_lowpass", "none"}),
                 {"accuracy_of", "needs a filter, but output_lowpass is none"});
}

// Low-passed accelerations by name, in the report too; sweeps have them for limits alone.
TEST(AccuracyOption, OfLowPassedAccelerations) {
  const Workplace workplace(damped_span);
  const std::vector<std::string> named = {"-accuracy_of", "deflection,acceleration_lowpass"};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), named.begin(), named.end());
    Outcome outcome = workplace.run(words);
    expect_success(outcome);
    return outcome;
  };
  const Outcome reported = run({"-accuracy_report", "-scene_tail", "0.5"});
  EXPECT_TRUE(says(reported, "estimated errors of the peaks: deflection")) << reported.out;
  EXPECT_TRUE(says(reported, ", low-passed acceleration ")) << reported.out;
  EXPECT_TRUE(says(reported, "\n  low-passed acceleration")) << reported.out;
  EXPECT_FALSE(says(reported, "exceeded")) << reported.out;
  EXPECT_TRUE(says(run({"-scene_tail", "0.5", "-accuracy_report"}), "stored choice for the same scene"))
      << reported.out;
  const Outcome sweep = run({"-sweep_speed", "20,60,10"});
  EXPECT_TRUE(says(sweep, "accuracy_of acceleration_lowpass: its error is not estimated: the runs of sweeps"))
      << sweep.out;
}

// Sweeps promise low-passed accelerations where the bridge is damped and the filter settles behind the train; with a
// number of modes given nothing is tried, and that is the reason.
TEST(AccuracyOption, OfLowPassedAccelerationsInSweeps) {
  const Workplace workplace(damped_span);
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(),
                 {"-limits", limits_of_en1990, "-sweep_speed", "30,50,10", "-scene_tail", "0.2", "-accuracy", "1e-2"});
    return workplace.run(words);
  };
  const std::string refused = "error not estimated: low-passed acceleration", given = "model_modes = 6 is given";
  const Outcome chosen = run({}), modes = run({"-model_modes", "6"}), undamped = run({"-beam_damping_ratios", "0"});
  EXPECT_TRUE(says(chosen, "low-passed acceleration 0.0") || says(chosen, "acceleration lowpass ")) << chosen.out;
  EXPECT_FALSE(says(chosen, refused)) << chosen.out;
  EXPECT_FALSE(says(modes, refused)) << modes.out;
  EXPECT_TRUE(says(modes, given)) << modes.out;
  EXPECT_TRUE(says(undamped, refused)) << undamped.out;
}

// A first period of a 50,000th of the crossing is not followed where nothing vibrates: the response is the static one.
TEST(AccuracyOption, SlowForcesTakeFewSteps) {
  Results run = run_yaml(
      "beam: {spans: 25.0, EI: 8.0e9, mass: 1.0e-6}\nsupport: {types: [pinned, roller]}\n"
      "load: {forces: 1.0e5, speed: 120.0}\n",
      {{"accuracy", "1e-3"}});
  EXPECT_NEAR(run.attribute("/summary", "deflection") / (-1.0e5 * 25.0 * 25.0 * 25.0 / (48.0 * 8.0e9)), 1.0, 1e-4);
  EXPECT_LT(run.attribute("/", "steps"), 1e4);
}

// Limits judge the low-passed acceleration: the whole one, which takes far more modes, is not promised unasked.
TEST(AccuracyOption, WholeAccelerationsWhereTheyAreJudged) {
  const Workplace workplace(damped_span);
  const Outcome judged =
      workplace.run({"-limits", limits_of_en1990, "-scene_tail", "0.2", "-accuracy", "1e-2", "-model_modes", "0"});
  EXPECT_TRUE(says(judged, "error not estimated: acceleration: the limits apply to the low-passed acceleration"))
      << judged.out;
  EXPECT_TRUE(says(judged, ", low-passed acceleration ")) << judged.out;
}

// What was chosen is kept beside the results: the same scene is not tried again, another one is, and a file that is not
// whole counts for nothing.
TEST(AccuracyOption, IsKeptForTheSameScene) {
  const Workplace workplace(damped_span);
  const char* const kept = "stored choice for the same scene";
  for (const std::vector<std::string>& kind :
       {std::vector<std::string>{}, {"-sweep_speed", "20,60,10"}, {"-model_modes", "0"}}) {
    const auto run = [&](std::vector<std::string> words) {
      words.insert(words.end(), kind.begin(), kind.end());
      Outcome outcome = workplace.run(words);
      expect_success(outcome);
      return outcome;
    };
    EXPECT_FALSE(says(run({"-output_file", "first.h5"}), kept));
    const Outcome again = run({"-output_file", "second.h5", "-ts_monitor"});
    EXPECT_TRUE(says(again, kept)) << again.out;
    EXPECT_TRUE(says(again, "estimated errors of the peaks")) << again.out;
    EXPECT_FALSE(says(run({"-accuracy_cache", "false"}), kept));
    EXPECT_FALSE(says(run({"-accuracy", "2e-3"}), kept));
  }
  const Results first(workplace.path("first.h5")), second(workplace.path("second.h5"));
  for (const char* name : {"deflection", "acceleration", "expected_error_deflection", "steps"})
    EXPECT_EQ(first.attribute("/summary", name), second.attribute("/summary", name)) << name;
  for (const auto& file : std::filesystem::directory_iterator(workplace.path(".traverse_choices")))
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const Outcome damaged = workplace.run({"-model_modes", "0"});
  expect_success(damaged);
  EXPECT_FALSE(says(damaged, kept));
}

// A trial run that fails is no failure of the run: its step was too long.
TEST(AccuracyOption, ChoosesForExplicitMethodsToo) {
  const Workplace workplace(damped_span);
  const Outcome outcome = workplace.run({"-ts_type", "rk", "-accuracy", "1e-2", "-beam_elements_per_span", "4"});
  expect_success(outcome);
  EXPECT_TRUE(says(outcome, "reached its end")) << outcome.out;
}

// A step that was chosen and does not do is halved, and nothing is promised; one that was given is the user's. The 16th
// mode of the sprung mass of Yang and Yau is too fast for the first step of an explicit method.
TEST(AccuracyOption, RunsAgainWhereTheStepIsTooLong) {
  const Workplace workplace(R"(
beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0}
support: {types: [pinned, roller]}
vehicle:
  sprung_mass:
    bodies:  [body]
    wheels:  [spring]
    drivers: [level]
    body:    {mass: 5750.0, inertia: 1.0, position: [0.0, 0.1]}
    spring:  {body: body, radius: 0.1, law: linear, stiffness: 1.595e6}
    level:   {body: body, coordinate: phi}
train: {vehicles: sprung_mass, positions: 0.0, speed: 27.777777777777778}
accuracy: 1.0e-5
output: {file: r2.h5, interval: 1.0e-3}
)");
  const std::vector<std::string> explicit_steps = {"-ts_type", "rk", "-ts_rk_type", "4", "-model_modes", "16"};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), explicit_steps.begin(), explicit_steps.end());
    return workplace.run(words);
  };
  const Outcome again = run({});
  expect_success(again);
  EXPECT_TRUE(says(again, "the run is repeated with steps of 0.00025 s, without error estimates: ")) << again.out;
  const Results results(workplace.path("r2.h5"));
  EXPECT_NEAR(results.attribute("/summary", "deflection"), -2.40731635e-3, 1e-6);
  EXPECT_EQ(run({"-ts_dt", "5e-4"}).status, 3);
}

// The same choice on any number of ranks.
TEST(AccuracyOption, DoesNotDependOnRanks) {
  const Workplace workplace(damped_span);
  const auto choice = [](const Outcome& outcome) {
    for (const std::string& line : lines_of(outcome.out))
      if (line.find("accuracy 0.001: ") != std::string::npos) return line.substr(0, line.find(" took"));
    return std::string("none");
  };
  const std::string alone = choice(workplace.run());
  EXPECT_NE(alone, "none");
  EXPECT_EQ(choice(workplace.run({}, 2)), alone);
}

}  // namespace
}  // namespace traverse::test
