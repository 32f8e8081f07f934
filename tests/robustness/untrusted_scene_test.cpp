// A scene of a stranger's, or a .petscrc that lies beside it: nothing in them starts a program or writes to another
// file than the run's own; and what .petscrc and PETSC_OPTIONS change is said.
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace traverse::test {
namespace {

std::string forces(const std::string& more) {
  return std::string(two_spans) + "load: {forces: 1.0e5, speed: 40.0}\nts: {dt: 0.01, max_time: 0.05}\n" + more;
}

TEST(UntrustedScene, RunsNoCommandAndWritesNoOtherFile) {
  for (const char* line :
       {"python: 'touch victim #'\n", "info: victim\n", "history: victim\n", "citations: victim\n",
        "malloc_view: victim\n", "log_view: ':victim'\n", "Log_View: ':victim'\n", "options_view: ':victim'\n",
        "ts_monitor: 'ascii:victim'\n", "ts_view: ':victim'\n", "ts_monitor_solution: 'binary:victim'\n",
        "viewer_binary_filename: victim\n", "start_in_debugger: 'touch,victim'\n"}) {
    SCOPED_TRACE(line);
    const Workplace workplace(forces(line));
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{{}, {"-describe"}}) {
      const Outcome outcome = workplace.run(words);
      EXPECT_EQ(outcome.status, 2);
      ASSERT_EQ(complaints(outcome).size(), 1U) << outcome.err;
      EXPECT_FALSE(workplace.has("victim"));
    }
  }
}

TEST(UntrustedScene, GivesItsOutputsHarmlessNames) {
  const Workplace workplace(forces("output_file: .profile\n"));
  expect_refusal(workplace, workplace.run(), {"output_file = .profile (scene.yml:", "ends in .h5"});
  expect_refusal(
      workplace,
      workplace.run({"-output_file", "none", "-options_file", workplace.write("c.yml", "checkpoint_file: .bashrc\n")}),
      {"checkpoint_file = .bashrc", "ends in .checkpoint"});
  EXPECT_FALSE(workplace.has(".profile"));
  expect_success(workplace.run({"-output_file", "anything"}));
}

TEST(Petscrc, InTheFolderIsSaidOnStandardOutput) {
  const Workplace workplace(forces("output: {file: none}\n"));
  workplace.write(".petscrc", "-beam_damping_ratios 0.5\n-load_speed 41\n-python touch\n");
  std::vector<std::string> command = workplace.command({});
  command.insert(command.begin(), {"env", "PETSC_OPTIONS=-gravity 1 -info victim", "HOME=/nonexistent"});
  for (const char* word : {"-output_quiet", "-describe"}) {
    std::vector<std::string> words = command;
    words.emplace_back(word);
    const Outcome outcome = Child(words, workplace.folder()).wait();
    expect_success(outcome);
    for (const char* line :
         {"beam_damping_ratios = 0.5 (.petscrc:1) is in force", "load_speed = 41 (.petscrc:2) has no",
          "load_speed = 40.0 (scene.yml:", "python = touch (.petscrc:3) is ignored",
          "gravity = 1 (PETSC_OPTIONS) is in force", "info = victim (PETSC_OPTIONS) is ignored"})
      EXPECT_NE(outcome.out.find(line), std::string::npos) << line << " in\n" << outcome.out;
    EXPECT_FALSE(workplace.has("victim"));
  }
}

}  // namespace
}  // namespace traverse::test
