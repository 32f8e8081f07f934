// Files that a scene names and the file that a run writes: which one is read, and what is never overwritten.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <memory>

#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// --- which file is read ----------------------------------------------------------------------------------------------

/// The quarter car with a table for every kind that a vehicle has; the file of a vehicle.
std::string vehicle_with_tables() {
  return "bodies: [body, axle]\njoints: [guide]\nsprings: [suspension]\nwheels: [wheel]\ndrivers: [level]\n"
         "actuators: [push]\n"
         "body: {mass: 5000.0, inertia: 100.0, position: [0.0, 2.0]}\n"
         "axle: {mass: 1000.0, inertia: 10.0, position: [0.0, 0.5]}\n"
         "guide: {type: prismatic, bodies: [body, axle], point: [0.0, 0.5], axis: [0.0, 1.0]}\n"
         "suspension: {bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.5], table: spring.csv, damping: 1.0e4}\n"
         "wheel: {body: axle, radius: 0.5, law: hertz, stiffness: 1.0e10}\n"
         "level: {body: body, coordinate: phi, table: level.csv}\n"
         "push: {body: body, table: push.csv}\n";
}

/// Every file in `folder`; with `text` in place of numbers and options where it is given.
void write_scene(const Workplace& workplace, const std::string& folder, const std::string& text = "") {
  const auto write = [&](const std::string& name, const std::string& good) {
    workplace.write(folder + name, text.empty() ? good : text);
  };
  write("bridge.yml",
        "beam: {spans: [20.0, 20.0], elements_per_span: 4, EI: EI.csv, mass: mass.csv}\n"
        "support: {types: [pinned, roller, roller]}\nfoundation: {vertical_bed: {k: bed.csv}}\n");
  write("bridge.opt", "-track_profile ./profile.csv\n");
  write("car.yml", vehicle_with_tables());
  write("EI.csv", "0 1.0e10\n40 1.0e10\n");
  write("mass.csv", "0 2000\n40 2000\n");
  write("bed.csv", "0 1e3\n40 1e3\n");
  write("profile.csv", "0 0\n20 1e-4\n40 0\n");
  write("spring.csv", "-1 -1.6e6\n1 1.6e6\n");
  write("level.csv", "0 0\n1 0\n");
  write("push.csv", "0 0\n1 100\n");
}

TEST(NamedFiles, BesideTheFileThatNamesThemComeFirst) {
  const Workplace workplace("");
  write_scene(workplace, "sub/");
  write_scene(workplace, "", "wrong: [one\n");  // each of the same name in the working directory
  workplace.write("sub/scene.yml",
                  "options_file: [bridge.yml, bridge.opt]\nvehicle: {car: {file: car.yml}}\n"
                  "train: {vehicles: car, speed: 40.0}\nts: {dt: 0.01}\noutput: {file: none}\n");
  expect_success(workplace.run({"-options_file", "sub/scene.yml", "-ts_max_time", "0.1"}));
}

TEST(NamedFiles, OfTheCommandLineStandInTheWorkingDirectory) {
  const Workplace workplace("");
  write_scene(workplace, "");
  write_scene(workplace, "sub/", "wrong\n");
  workplace.write("sub/scene.yml", std::string(two_spans) + "load: {forces: 1.0e5, speed: 40.0}\nts: {dt: 0.01}\n");
  const std::vector<std::string> words = {"-options_file", "sub/scene.yml", "-output_file",
                                          "none",          "-ts_max_time",  "0.1"};
  std::vector<std::string> more = words;
  more.insert(more.end(), {"-beam_EI", "EI.csv"});
  expect_success(workplace.run(more));
  more = words;
  workplace.write("sub/other.csv", "0 1.0e10\n40 1.0e10\n");
  more.insert(more.end(), {"-beam_EI", "other.csv"});
  expect_refusal(workplace, workplace.run(more), {"beam_EI = other.csv"});
}

TEST(NamedFiles, OfTheWorkingDirectoryDoWhereThereIsNoneBeside) {
  const Workplace workplace("");
  write_scene(workplace, "");
  workplace.write("sub/scene.yml", "options_file: bridge.yml\nload: {forces: 1.0e5, speed: 40.0}\nts: {dt: 0.01}\n");
  expect_success(workplace.run({"-options_file", "sub/scene.yml", "-output_file", "none", "-ts_max_time", "0.1"}));
}

// A link to a folder: .. from it leads to where the folder really is.
TEST(NamedFiles, BehindALinkedFolder) {
  const Workplace workplace("");
  write_scene(workplace, "there/");
  write_scene(workplace, "", "wrong: [one\n");
  workplace.write("there/scenes/scene.yml",
                  "options_file: ../bridge.yml\nload: {forces: 1.0e5, speed: 40.0}\nts: {dt: 0.01}\n");
  std::filesystem::create_directory_symlink(workplace.path("there/scenes"), workplace.path("link"));
  expect_success(workplace.run({"-options_file", "link/scene.yml", "-output_file", "none", "-ts_max_time", "0.1"}));
}

TEST(NamedFiles, WithUnusualNames) {
  const Workplace workplace("");
  for (const std::string name : {"a$b", "${HOME}", "a\nb", "f\xfcr", "a b", "a#b", "#a"}) {
    SCOPED_TRACE(name);
    workplace.write(name + ".yml",
                    "options_file: \"bridge-$.yml\"\nload: {forces: 1.0e5, speed: 40.0}\nts: {dt: 0.01}\n");
    workplace.write("bridge-$.yml", two_spans);
    std::vector<std::string> command = workplace.command({"-ts_max_time", "0.1"});
    *std::find(command.begin(), command.end(), "scene.yml") = name + ".yml";
    const Outcome outcome = Child(command, workplace.folder()).wait(300.0);
    expect_success(outcome);
    EXPECT_EQ(lines_of(outcome.out).back().substr(0, 7), "results") << outcome.out;
  }
  EXPECT_TRUE(workplace.has("results/a_b.h5"));
  workplace.write("-dash.yml", two_spans);
  workplace.write("-car.yml", vehicle_with_tables());
  workplace.write("-scene.yml", "options_file: -dash.yml\nload: {forces: 1.0e5, speed: 40.0}\nts: {dt: 0.01}\n");
  expect_success(workplace.run({"-options_file", "./-scene.yml", "-output_file", "./-r.h5", "-ts_max_time", "0.1"}));
  EXPECT_TRUE(workplace.has("-r.h5"));
}

TEST(NamedFiles, WithADashInFrontOnTheCommandLine) {
  const Workplace workplace(small_scene());
  workplace.write("-dash.yml", small_scene());
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"-options_file", "-dash.yml"}, {"-output_file", "-r.h5"}, {"-vehicle_car_file", "-car.yml"}}) {
    SCOPED_TRACE(words.back());
    expect_refusal(workplace, workplace.run(words), {"'" + words.back() + "'", "write ./" + words.back()});
  }
}

// --- the file that a run writes --------------------------------------------------------------------------------------

TEST(ResultsPlace, IsNeverAnotherFile) {
  const Workplace workplace(small_scene());
  const std::string scene = text_of(workplace.path("scene.yml"));
  std::filesystem::create_symlink("scene.yml", workplace.path("symbolic.h5"));
  std::filesystem::create_hard_link(workplace.path("scene.yml"), workplace.path("hard.h5"));
  workplace.write("table.csv", "0 1\n");
  for (const std::string file : {"scene.yml", "./scene.yml", "symbolic.h5", "hard.h5", "table.csv"}) {
    SCOPED_TRACE(file);
    for (const char* analysis : {"transient", "static", "modes"}) {
      const Outcome outcome = workplace.run({"-output_file", file, "-scene_analysis", analysis});
      expect_refusal(workplace, outcome, {"results file " + file, "no results file of Traverse", "-output_file"});
      EXPECT_EQ(outcome.out, "") << "refused before anything is computed";
    }
  }
  EXPECT_EQ(text_of(workplace.path("scene.yml")), scene);
  EXPECT_EQ(text_of(workplace.path("table.csv")), "0 1\n");
}

TEST(ResultsPlace, IsNeverAForeignHdf5File) {
  const Workplace workplace(small_scene());
  const hid_t file = H5Fcreate(workplace.path("modes.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  H5Fclose(file);
  const std::string before = text_of(workplace.path("modes.h5"));
  expect_refusal(workplace, workplace.run({"-output_file", "modes.h5"}), {"modes.h5", "no results file of Traverse"});
  EXPECT_EQ(text_of(workplace.path("modes.h5")), before);
}

TEST(ResultsPlace, OfAnEmptyFileOrAnEarlierRunIsTaken) {
  const Workplace workplace(small_scene());
  workplace.write("r.h5", "");
  for (const char* analysis : {"transient", "modes", "static"})
    expect_success(workplace.run({"-output_file", "r.h5", "-ts_max_time", "0.1", "-scene_analysis", analysis}));
}

// Trial runs for the step would take long before the file is opened: the scene has no ts_dt.
TEST(ResultsPlace, IsTestedBeforeTrialRuns) {
  const Workplace workplace(std::string(two_spans) + quarter_car);
  std::filesystem::create_directory(workplace.path("folder"));
  workplace.write("locked.h5", "");
  const int locked = open(workplace.path("locked.h5").c_str(), O_RDWR);
  ASSERT_EQ(flock(locked, LOCK_EX | LOCK_NB), 0);
  struct Case {
    const char* file;
    const char* part;
  };
  for (const Case& c : {Case{"folder", "folder"},
                        {"folder/", "folder"},
                        {"scene.yml/r.h5", "folder cannot be made"},
                        {"/dev/full", "no ordinary file"},
                        {"locked.h5", "another run or program has it open"}}) {
    SCOPED_TRACE(c.file);
    for (const std::vector<std::string>& sweep :
         std::vector<std::vector<std::string>>{{}, {"-sweep_speed", "30,40,1"}}) {
      std::vector<std::string> words = {"-output_file", c.file};
      words.insert(words.end(), sweep.begin(), sweep.end());
      const Outcome outcome = workplace.run(words);
      expect_refusal(workplace, outcome, {"results file", c.file, c.part});
      EXPECT_EQ(outcome.out, "");
    }
  }
  close(locked);
}

TEST(ResultsPlace, OfARunThatIsRefusedIsLeftAsItWas) {
  const Workplace workplace(small_scene());
  expect_refusal(workplace, workplace.run({"-output_file", "new/deep/r.h5", "-support_types", "free"}), {"float away"});
  EXPECT_FALSE(workplace.has("new"));
  expect_success(workplace.run({"-output_file", "r.h5", "-ts_max_time", "0.1"}));
  expect_refusal(workplace, workplace.run({"-output_file", "r.h5", "-support_types", "free"}), {"float away"});
  EXPECT_NEAR(Results(workplace.path("r.h5")).time().back(), 0.1, 1e-12);
}

TEST(ResultsPlace, IsOneRunsAtATime) {
  const Workplace workplace(small_scene() +
                            "verbose: true\nts_max_time: 1.0e5\noutput: {file: r.h5, interval: 0.01}\n");
  std::vector<std::unique_ptr<Child>> runs;
  for (int i = 0; i < 3; ++i) runs.push_back(std::make_unique<Child>(workplace.command({}), workplace.folder()));
  int refused = 0;
  for (auto& run : runs) {
    if (run->wait_for("integrator", 300.0)) continue;  // the one that writes goes on
    const Outcome outcome = run->wait(300.0);
    EXPECT_EQ(outcome.status, 4);
    ASSERT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find("r.h5: another run or program has it open"), std::string::npos) << outcome.err;
    ++refused;
  }
  EXPECT_EQ(refused, 2);
}

TEST(ResultsPlace, OnTwoRanks) {
  const Workplace workplace(small_scene());
  expect_refusal(workplace, workplace.run({"-output_file", "scene.yml"}, 2), {"scene.yml", "no results file"});
}

TEST(ResultsPlace, StaysInItsFolder) {
  const Workplace workplace(small_scene());
  for (const std::string name : {"../../escape", "/tmp/escape", "a/b", "..", "a\nb", "a\tb"}) {
    SCOPED_TRACE(name);
    expect_refusal(workplace, workplace.run({"-scene_name", name}), {"scene_name", "without / and line breaks"});
  }
  expect_refusal(workplace, workplace.run({"-output_file", "a\nb.h5"}), {"output_file = a\\nb.h5", "line breaks"});
}

// Through a link a run would make or fill a file elsewhere, here one that is not there yet.
TEST(ResultsPlace, IsNoLink) {
  const Workplace workplace(small_scene());
  std::filesystem::create_symlink("elsewhere", workplace.path("dangling.h5"));
  expect_refusal(workplace, workplace.run({"-output_file", "dangling.h5"}), {"dangling.h5", "it is a link"});
  EXPECT_FALSE(workplace.has("elsewhere"));
}

// The new results are another file: a copy that is a hard link keeps the earlier ones. Its permissions remain.
TEST(ResultsPlace, OfAFileWithTwoNamesIsReplaced) {
  const Workplace workplace(small_scene() + "ts_max_time: 0.1\noutput: {file: r.h5}\n");
  expect_success(workplace.run());
  const std::string before = text_of(workplace.path("r.h5"));
  std::filesystem::create_hard_link(workplace.path("r.h5"), workplace.path("kept.h5"));
  std::filesystem::permissions(workplace.path("r.h5"),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  expect_success(workplace.run({"-ts_max_time", "0.2"}));
  EXPECT_EQ(text_of(workplace.path("kept.h5")), before);
  EXPECT_NEAR(Results(workplace.path("r.h5")).time().back(), 0.2, 1e-12);
  EXPECT_EQ(std::filesystem::status(workplace.path("r.h5")).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  for (const auto& file : std::filesystem::directory_iterator(workplace.folder()))
    EXPECT_EQ(file.path().filename().string().find(".part"), std::string::npos) << file.path();
}

TEST(ResultsPlace, OfAFileThatTheRunReads) {
  const Workplace workplace(small_scene());
  expect_success(workplace.run({"-output_file", "r.h5", "-ts_max_time", "0.1"}));
  const std::string before = text_of(workplace.path("r.h5"));
  const Outcome outcome =
      Child({program_path(), "r.h5", "-output_file", "./r.h5", "-ts_max_time", "0.1"}, workplace.folder()).wait();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("output_file = ./r.h5: the run reads this file"), std::string::npos) << outcome.err;
  EXPECT_EQ(text_of(workplace.path("r.h5")), before);
}

TEST(ResultsPlace, ThatVanishesDuringTheRunEndsIt) {
  for (const bool replaced : {false, true}) {
    const Workplace workplace(small_scene() +
                              "verbose: true\nts_max_time: 1.0e5\noutput: {file: r.h5, interval: 0.01}\n");
    Child child(workplace.command({}), workplace.folder());
    ASSERT_TRUE(child.wait_for("integrator"));
    ASSERT_TRUE(child.wait_until([&] { return std::filesystem::file_size(workplace.path("r.h5")) > 0; }));
    std::filesystem::remove(workplace.path("r.h5"));
    if (replaced) workplace.write("r.h5", "mine");
    child.kill(SIGTERM);
    const Outcome outcome = child.wait();
    EXPECT_EQ(outcome.status, 4);
    EXPECT_NE(outcome.err.find("r.h5 was removed, moved or replaced"), std::string::npos) << outcome.err;
    EXPECT_EQ(workplace.has("r.h5"), replaced);
    if (replaced) EXPECT_EQ(text_of(workplace.path("r.h5")), "mine");
  }
}

// --- checkpoints -----------------------------------------------------------------------------------------------------

TEST(CheckpointPlace, IsNeverAnotherFile) {
  const Workplace workplace(small_scene() + "ts_max_time: 0.1\n");
  workplace.write("text", "mine\n");
  workplace.write("empty", "");
  std::filesystem::create_directory(workplace.path("folder"));
  std::filesystem::create_symlink("elsewhere", workplace.path("link"));
  workplace.write("new.part", "mine\n");
  const std::string scene = text_of(workplace.path("scene.yml"));
  for (const std::string file : {"text", "empty", "folder", "link", "scene.yml", "new"}) {
    SCOPED_TRACE(file);
    const Outcome outcome = workplace.run({"-checkpoint_file", file, "-output_file", "r.h5"});
    expect_refusal(workplace, outcome, {"the checkpoint " + file, "no checkpoint of Traverse", "-checkpoint_file"});
    EXPECT_EQ(outcome.out, "") << "refused before anything is computed";
    EXPECT_FALSE(workplace.has("r.h5"));
  }
  EXPECT_EQ(text_of(workplace.path("text")) + text_of(workplace.path("new.part")), "mine\nmine\n");
  EXPECT_TRUE(workplace.has("empty") && workplace.has("folder"));
  EXPECT_EQ(text_of(workplace.path("scene.yml")), scene);
}

TEST(CheckpointPlace, IsNotThatOfTheResults) {
  const Workplace workplace(small_scene() + "ts_max_time: 0.1\n");
  for (const char* file : {"r.h5", "./r.h5"})
    expect_refusal(workplace, workplace.run({"-output_file", "r.h5", "-checkpoint_file", file}),
                   {"checkpoint_file = ", "results file r.h5"});
  expect_refusal(workplace, workplace.run({"-output_file", "r.part", "-checkpoint_file", "r"}),
                 {"checkpoint_file = r"});
}

TEST(CheckpointPlace, HasItsFolderBeforeTheRun) {
  const Workplace workplace(small_scene() + "ts_max_time: 0.1\n");
  const Outcome outcome = workplace.run({"-output_file", "r.h5", "-checkpoint_file", "missing/c"});
  expect_refusal(workplace, outcome, {"the checkpoint missing/c", "there is no folder missing"});
  EXPECT_EQ(outcome.out, "");
}

TEST(CheckpointPlace, OfARunBeforeIsTakenAndRemoved) {
  const Workplace workplace(small_scene() + "ts_max_time: 0.1\noutput: {file: r.h5}\n");
  expect_success(workplace.run({"-ts_max_steps", "3", "-checkpoint_file", "c"}));
  ASSERT_TRUE(workplace.has("c"));
  workplace.write("c.part", "");  // as by a kill before its first byte
  expect_success(workplace.run({"-ts_max_steps", "3", "-checkpoint_file", "c"}));
  EXPECT_FALSE(workplace.has("c.part"));
  expect_success(workplace.run({"-restart", "c", "-checkpoint_file", "c"}));
  EXPECT_FALSE(workplace.has("c"));
}

TEST(CheckpointPlace, ThatIsTakenDuringTheRunIsLeft) {
  const Workplace workplace(small_scene() +
                            "verbose: true\nts_max_time: 1.0e5\noutput: {file: r.h5, interval: 0.01}\n");
  Child child(workplace.command({"-checkpoint_file", "c"}), workplace.folder());
  ASSERT_TRUE(child.wait_for("integrator"));
  workplace.write("c", "mine");
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait().status, 4);
  EXPECT_EQ(text_of(workplace.path("c")), "mine");
}

// --- kept choices ----------------------------------------------------------------------------------------------------

TEST(KeptChoices, AreWrittenOverNoOtherFile) {
  const Workplace workplace(std::string(two_spans) + "load: {forces: 1.0e5, speed: 40.0}\nts_max_time: 0.1\n");
  const auto kept = [&] {
    std::vector<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(workplace.path(".traverse_choices")))
      names.push_back(file.path());
    return names;
  };
  expect_success(workplace.run({"-output_file", "r.h5"}));
  ASSERT_EQ(kept().size(), 1U);
  std::ofstream(kept().front()) << "mine";
  expect_success(workplace.run({"-output_file", "r.h5"}));
  ASSERT_EQ(kept().size(), 1U);
  EXPECT_EQ(text_of(kept().front()), "mine");
  std::filesystem::remove_all(workplace.path(".traverse_choices"));
  std::filesystem::create_directory(workplace.path("elsewhere"));
  std::filesystem::create_directory_symlink("elsewhere", workplace.path(".traverse_choices"));
  expect_success(workplace.run({"-output_file", "r.h5"}));
  EXPECT_TRUE(std::filesystem::is_empty(workplace.path("elsewhere")));
}

}  // namespace
}  // namespace traverse::test
