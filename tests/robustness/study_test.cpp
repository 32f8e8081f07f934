// Studies that do not get to their end, and are gone on with; studies that cannot be meant.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

const std::string forces = std::string(two_spans) + "load: {forces: 1.0e5, speed: 40}\nts_dt: 2.0e-3\n";

std::size_t finished(const std::string& file) {
  const std::vector<double> values = Results(file)("/study/finished");
  return static_cast<std::size_t>(std::count(values.begin(), values.end(), 1.0));
}

/// A file that a run holds open and has locked.
std::size_t finished_so_far(const Workplace& workplace, const std::string& name) {
  std::error_code failed;
  const std::string copy = workplace.path("copy.h5");
  std::filesystem::copy_file(workplace.path(name), copy, std::filesystem::copy_options::overwrite_existing, failed);
  if (failed || std::filesystem::file_size(copy) == 0) return 0;
  std::size_t found = 0;
  H5E_BEGIN_TRY {  // HDF5 is silent about what is not there yet
    try {
      found = finished(copy);
    } catch (const std::runtime_error&) {
      found = 0;
    }
  }
  H5E_END_TRY
  return found;
}

std::string study(const char* what) { return forces + "study: {vary: {" + what + "}}\n"; }

TEST(StudyInput, IsRefusedInOneLine) {
  const struct {
    const char* vary;
    std::vector<std::string> parts;
  } cases[] = {
      {"trak_seed: 1:5", {"study_vary_trak_seed", "there is no option trak_seed", "did you mean track_seed?"}},
      {"beam_mass: []", {"study_vary_beam_mass", "empty list"}},
      {"beam_mass: {from: 2.0e3, to: 1.0e3, step: 10}", {"study_vary_beam_mass", "empty range"}},
      {"load_speed: 10:5", {"study_vary_load_speed", "empty range"}},
      {"beam_mass: [1.0e3, heavy]", {"study_vary_beam_mass", "'heavy' is not a finite number", "beam_mass"}},
      {"beam_mass: [1.0e3, -1]", {"study_vary_beam_mass", "-1 is not a value of beam_mass", "above"}},
      {"beam_mass: {normal: [1.0, 5.0]}", {"study_draws is missing"}},
      {"support_types: [pinned]", {"support_types cannot be varied", "not a number"}},
      {"ts_dt: [1.0e-3, 2.0e-3]", {"ts_dt cannot be varied", "given for all runs too"}},
      {"accuracy: [1.0e-3, 1.0e-2]", {"accuracy cannot be varied"}},
      {"track_seed: 1:5", {"track_seed has no effect", "track_profile is none"}},
      {"beam_mass: {from: 1, to: 2}", {"study_vary_beam_mass_from", "either step or count"}},
      {"load_speed: 0:10", {"study_vary_load_speed", "0 m/s", "above 0"}},
      {"load_speed: {from: 10, to: 60, count: 100000}, beam_mass: {from: 1, to: 2, count: 10000}",
       {"1e+09 runs (100000 of load_speed times 10000 of beam_mass)", "allowed: at most 1e+06",
        "They would take 1388 h"}},
  };
  for (const auto& one : cases) {
    SCOPED_TRACE(one.vary);
    const Workplace workplace(study(one.vary));
    expect_refusal(workplace, workplace.run(), one.parts);
  }
}

TEST(StudyInput, DrawsAreCheckedToo) {
  const Workplace workplace(forces + "study: {vary: {beam_mass: {normal: [1.0, 5.0]}}, draws: 100}\n");
  expect_refusal(workplace, workplace.run(), {"study_vary_beam_mass_normal", "draw ", "use lognormal"});
  const Workplace unequal(forces + "study: {vary: {beam_mass: [1, 2], load_speed: [10, 20, 30]}, combine: together}\n");
  expect_refusal(unequal, unequal.run(), {"study_combine", "beam_mass (2) and load_speed (3) differ"});
  const Workplace unvaried(study("beam_mass: [1000, 2000]"));
  expect_refusal(unvaried, unvaried.run({"-study_statistics_over", "beam_EI"}), {"study_statistics_over", "beam_EI"});
}

TEST(StudyInput, SensitivityAnalysesNeedDistributionsAndSamples) {
  const auto refused = [](const char* vary, const std::vector<std::string>& words,
                          const std::vector<std::string>& parts) {
    SCOPED_TRACE(vary);
    const Workplace workplace(study(vary));
    expect_refusal(workplace, workplace.run(words), parts);
  };
  refused("beam_mass: [1000, 2000]", {"-study_sensitivity", "sobol"},
          {"study_sensitivity", "no option has a distribution"});
  refused("beam_mass: {normal: [1.0e3, 5.0]}", {"-study_sensitivity", "sobol"}, {"study_draws is missing"});
  for (const char* method : {"sobol", "morris"})
    refused("beam_mass: {normal: [1.0e3, 5.0]}", {"-study_sensitivity", method, "-study_draws", "1"},
            {"study_draws", "no scatter", "from 2"});
  refused("beam_mass: {normal: [1.0e3, 5.0]}", {"-study_sensitivity", "all"}, {"study_sensitivity", "morris"});
  refused("beam_mass: {normal: [1.0, 5.0]}", {"-study_sensitivity", "morris", "-study_draws", "9"},
          {"study_vary_beam_mass_normal", "value of the design"});
  refused("beam_mass: {normal: [1.0e3, 5.0]}", {"-study_sensitivity", "local", "-study_combine", "random"},
          {"study_combine", "grid"});
  refused("beam_mass: {normal: [1.0e3, 5.0]}", {"-study_sensitivity", "sobol", "-study_draws", "400000"},
          {"study_draws", "1.2e+06 points of the design"});
  refused("beam_mass: {normal: [1.0e3, 5.0]}", {"-study_sensitivity", "local", "-study_resume"},
          {"study_resume", "study_sensitivity"});
}

TEST(StudyInput, SpeedsToRefineAreAListOfTheirOwn) {
  const struct {
    const char* vary;
    std::vector<std::string> parts;
  } cases[] = {
      {"beam_mass: [1000, 2000, 3000]", {"study_refine", "no list of speeds is varied"}},
      {"load_speed: [30, 40]", {"study_refine", "load_speed has 2 values", "at least 3"}},
      {"load_speed: [30, 40, 30]", {"study_refine", "each once"}},
  };
  for (const auto& one : cases) {
    SCOPED_TRACE(one.vary);
    const Workplace workplace(study(one.vary));
    expect_refusal(workplace, workplace.run({"-study_refine", "1e-2"}), one.parts);
  }
  const Workplace together(forces + "study: {vary: {beam_mass: [1, 2, 3], load_speed: [10, 20, 30]}}\n");
  expect_refusal(together, together.run({"-study_refine", "1e-2", "-study_combine", "together"}),
                 {"study_refine", "load_speed varies together"});
  const Workplace swept(forces);
  expect_refusal(swept, swept.run({"-sweep_speed", "30,40,10", "-sweep_refine", "1e-2"}),
                 {"sweep_refine", "2 speeds", "at least 3"});
  expect_refusal(swept, swept.run({"-sweep_speed", "30,40,1", "-sweep_refine", "-1"}), {"sweep_refine", "allowed"});
  EXPECT_NE(swept.run({"-sweep_refine", "1e-2"}).out.find("sweep_refine has no effect"), std::string::npos);
}

// An explicit method with a step far too long fails by its own.
TEST(StudyFails, ByOneRunThatIsNamed) {
  const Workplace workplace(std::string(two_spans) +
                            "load: {forces: 1.0e5, speed: 40}\nts_type: rk\nts_dt: 0.03\n"
                            "study: {vary: {beam_mass: [1000, 2000]}}\n");
  const Outcome outcome = workplace.run({"-output_file", "r.h5"});
  EXPECT_NE(outcome.status, 0);
  const std::vector<std::string> lines = complaints(outcome);
  ASSERT_EQ(lines.size(), 1u) << outcome.err;
  EXPECT_NE(lines[0].find("the run at beam_mass 1000 failed: "), std::string::npos) << lines[0];
  EXPECT_EQ(Results(workplace.path("r.h5"))("/study/peak_deflection").size(), 4u) << "readable";
}

// Killed without warning: what is in the file stays, and the study goes on from there, on one rank and on two.
TEST(StudyResumes, AfterAKill) {
  const Workplace workplace(study("beam_mass: {from: 1.0e3, to: 2.0e3, count: 400}, load_speed: [30, 40]"));
  Results whole = [&] {
    expect_success(workplace.run({"-output_file", "whole.h5"}));
    return Results(workplace.path("whole.h5"));
  }();
  for (const int ranks : {1, 2}) {
    const std::string name = "r" + std::to_string(ranks) + ".h5", file = workplace.path(name);
    Child child(workplace.command({"-output_file", name}), workplace.folder());
    ASSERT_TRUE(child.wait_until([&] { return finished_so_far(workplace, name) > 0; }, 300.0)) << child.written("out");
    child.kill(SIGKILL);
    (void)child.wait();
    const std::size_t before = finished(file);
    EXPECT_GT(before, 0u);
    EXPECT_LT(before, 800u);
    const Outcome outcome = workplace.run({"-output_file", name, "-study_resume"}, ranks);
    expect_success(outcome);
    EXPECT_NE(outcome.out.find(std::to_string(before) + " of them are read from the existing results file"),
              std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find(std::to_string(800 - before) + " of " + std::to_string(800 - before) + " runs"),
              std::string::npos)
        << outcome.out;
    Results resumed(file);
    for (const char* set : {"/study/peak_deflection", "/study/peak_acceleration_time", "/study/finished"})
      EXPECT_EQ(resumed(set), whole(set)) << set;
  }
}

// The user's files beside the results, of whatever name.
TEST(StudyResumes, WithNoOtherFile) {
  const Workplace workplace(study("beam_mass: [1.0e3, 2.0e3]"));
  expect_success(workplace.run({"-output_file", "r.h5"}));
  workplace.write("users", "mine");
  std::filesystem::create_symlink("users", workplace.path("r.h5.before"));
  std::filesystem::create_directory(workplace.path("r.h5.part"));
  expect_success(workplace.run({"-output_file", "r.h5", "-study_resume", "-study_vary_beam_mass", "2e3,3e3"}));
  EXPECT_TRUE(std::filesystem::is_symlink(workplace.path("r.h5.before")));
  EXPECT_EQ(std::filesystem::file_size(workplace.path("users")), 4u);
  EXPECT_TRUE(std::filesystem::is_directory(workplace.path("r.h5.part")));
}

// More values of the same quantities: only those are run that are new.
TEST(StudyResumes, WithMoreRuns) {
  const Workplace workplace(study("beam_mass: [1.0e3, 2.0e3]"));
  expect_success(workplace.run({"-output_file", "r.h5"}));
  const Outcome more = workplace.run({"-output_file", "r.h5", "-study_resume", "-study_vary_beam_mass", "2e3,3e3"});
  expect_success(more);
  EXPECT_NE(more.out.find("1 of 1 runs"), std::string::npos) << more.out;
  EXPECT_EQ(finished(workplace.path("r.h5")), 2u);
  // Of another scene nothing may be taken, and the file stays.
  const Outcome other = workplace.run({"-output_file", "r.h5", "-study_resume", "-load_speed", "50"});
  EXPECT_NE(other.status, 0);
  ASSERT_EQ(complaints(other).size(), 1u) << other.err;
  EXPECT_NE(other.err.find("it was computed with load_speed = 40, not 50"), std::string::npos) << other.err;
  EXPECT_EQ(finished(workplace.path("r.h5")), 2u);
}

TEST(StudyEnds, ByASignalWithWhatItHas) {
  const Workplace workplace(study("beam_mass: {from: 1.0e3, to: 2.0e3, count: 4000}"));
  Child child(workplace.command({"-output_file", "r.h5", "-ts_dt", "1e-4"}), workplace.folder());
  ASSERT_TRUE(child.wait_for(" of 4000 runs   ", 300.0));
  child.kill(SIGTERM);
  const Outcome outcome = child.wait();
  EXPECT_EQ(outcome.status, 128 + SIGTERM) << outcome.err;
  EXPECT_NE(outcome.out.find("ended by signal 15"), std::string::npos) << outcome.out;
  EXPECT_LT(finished(workplace.path("r.h5")), 4000u);
}

// The speeds that were added are in the file, and are not computed again.
TEST(StudyResumes, WithTheSpeedsThatWereAdded) {
  const Workplace workplace(study("beam_mass: [1000, 1500], load_speed: [30, 40, 50, 60]"));
  const std::vector<std::string> words = {"-output_file", "r.h5", "-study_refine", "1e-3"};
  expect_success(workplace.run(words));
  const std::vector<double> speeds = Results(workplace.path("r.h5"))("/study/load_speed");
  const std::vector<double> peaks = Results(workplace.path("r.h5"))("/study/peak_moment");
  EXPECT_GT(speeds.size(), 8u);
  std::vector<std::string> again = words;
  again.emplace_back("-study_resume");
  const Outcome outcome = workplace.run(again);
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("0 of 0 runs"), std::string::npos) << outcome.out;
  Results resumed(workplace.path("r.h5"));
  EXPECT_EQ(resumed("/study/load_speed"), speeds);
  EXPECT_EQ(resumed("/study/peak_moment"), peaks);
}

}  // namespace
}  // namespace traverse::test
