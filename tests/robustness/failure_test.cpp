// Failures while the program runs: one message, a status other than 0, and results that stay readable.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>

#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

std::string endless_scene() { return small_scene() + "ts_max_time: 1.0e4\noutput: {file: r.h5, interval: 0.01}\n"; }

/// A results file holds what its length says: no rows of zeros, every series at least as long as /time.
void expect_readable(const std::string& file) {
  Results results(file);
  const std::vector<double> time = results.time();
  ASSERT_GT(time.size(), 1U);
  for (std::size_t i = 1; i < time.size(); ++i) ASSERT_GT(time[i], time[i - 1]) << "row " << i;
  EXPECT_GE(results("/probes/deflection").size(), 2 * time.size());
  EXPECT_GE(results("/vehicles/0/body/position").size(), 3 * time.size());
  for (const double force : results("/vehicles/0/wheel/normal_force")) ASSERT_TRUE(std::isfinite(force));
}

void expect_one_complaint(const Outcome& outcome, const std::vector<std::string>& parts) {
  ASSERT_FALSE(outcome.timed_out) << outcome.out;
  EXPECT_EQ(outcome.signal, 0);
  EXPECT_GT(outcome.status, 0);
  const std::vector<std::string> lines = complaints(outcome);
  ASSERT_EQ(lines.size(), 1U) << outcome.err;
  EXPECT_TRUE(lines.front().starts_with("traverse: ")) << lines.front();
  for (const std::string& part : parts)
    EXPECT_NE(lines.front().find(part), std::string::npos) << "no '" << part << "' in: " << lines.front();
}

TEST(ResultsFile, CannotBeMade) {
  const Workplace workplace(small_scene());
  std::filesystem::create_directory(workplace.path("folder"));
  for (const int ranks : {1, 2}) {
    SCOPED_TRACE(ranks);
    for (const std::string file : {"folder", "scene.yml/r.h5", "/dev/null/r.h5", "/dev/full"}) {
      SCOPED_TRACE(file);
      if (ranks == 2 && file != "folder") continue;
      expect_refusal(workplace, workplace.run({"-output_file", file}, ranks), {"results file", file});
    }
  }
}

TEST(ResultsFile, IsNotWritable) {
  const Workplace workplace(small_scene());
  workplace.write("closed/r.h5", "");
  std::filesystem::permissions(workplace.path("closed"),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  std::filesystem::permissions(workplace.path("closed/r.h5"), std::filesystem::perms::owner_read);
  if (std::ofstream(workplace.path("closed/r.h5"), std::ios::app)) GTEST_SKIP() << "this user may write anywhere";
  expect_refusal(workplace, workplace.run({"-output_file", "closed/r.h5"}), {"results file", "closed/r.h5"});
}

TEST(ResultsFile, OfAnEarlierRunIsReplaced) {
  const Workplace workplace(small_scene());
  expect_success(workplace.run({"-output_file", "r.h5", "-ts_max_time", "0.5"}));
  expect_success(workplace.run({"-output_file", "r.h5", "-ts_max_time", "0.2"}));
  EXPECT_NEAR(Results(workplace.path("r.h5")).time().back(), 0.2, 1e-12);
}

/// The scene's command behind a shell line that ends in exec "$0" "$@".
std::vector<std::string> behind(const std::string& line, std::vector<std::string> command) {
  const std::vector<std::string> shell = {"/bin/sh", "-c", line};
  command.insert(std::find(command.begin(), command.end(), program_path()), shell.begin(), shell.end());
  return command;
}

const std::vector<std::string> ten_megabytes = {"-ts_max_time", "300", "-output_quiet", "-output_probes", "10*200"};

// As batch systems limit files; 8 MB, of which MPI takes no more than 4 for the memory that ranks share.
TEST(ResultsFile, OutgrowsItsLimit) {
  const Workplace workplace(endless_scene());
  const std::string line =
      "export OMPI_MCA_btl_vader_segment_size=4194304; ulimit -f 16000; trap '' XFSZ; exec \"$0\" \"$@\"";
  for (const int ranks : {1, 2}) {
    SCOPED_TRACE(ranks);
    Child child(behind(line, workplace.command(ten_megabytes, ranks)), workplace.folder());
    expect_one_complaint(child.wait(), {"r.h5"});
    expect_readable(workplace.path("r.h5"));
  }
}

// A disk of 4 MB of this process alone; its file is copied out before the disk goes with the process.
TEST(ResultsFile, OutgrowsTheDisk) {
  const Workplace workplace(endless_scene());
  std::filesystem::create_directory(workplace.path("disk"));
  const std::string mount = "mount -t tmpfs -o size=4m none disk";
  if (Child({"unshare", "-rm", "/bin/sh", "-c", mount}, workplace.folder()).wait().status != 0)
    GTEST_SKIP() << "no disk can be mounted here";
  const std::string line = mount + "; \"$0\" \"$@\"; status=$?; cp disk/r.h5 r.h5; exit $status";
  std::vector<std::string> command = workplace.command(ten_megabytes);
  command.insert(command.end(), {"-output_file", "disk/r.h5"});
  command = behind(line, command);
  command.insert(command.begin(), {"unshare", "-rm"});
  expect_one_complaint(Child(command, workplace.folder()).wait(), {"disk/r.h5", "space"});
  expect_readable(workplace.path("r.h5"));
}

/// Waits until the run has written instants to r.h5; their number.
std::size_t wait_for_instants(Child& child, const Workplace& workplace) {
  std::size_t instants = 0;
  EXPECT_TRUE(child.wait_until([&] { return (instants = stored_instants(workplace.path("r.h5"))) > 1; }));
  return instants;
}

/// What was written before the signal is still there.
void expect_kept(const Workplace& workplace, std::size_t instants) {
  expect_readable(workplace.path("r.h5"));
  EXPECT_GE(Results(workplace.path("r.h5")).time().size(), instants);
}

TEST(Signals, EndTheRunInOrder) {
  const Workplace workplace(endless_scene());
  for (const int signal : {SIGTERM, SIGINT}) {
    SCOPED_TRACE(signal);
    std::filesystem::remove(workplace.path("r.h5"));
    Child child(workplace.command({"-ts_dt", "1e-3"}), workplace.folder());
    const std::size_t instants = wait_for_instants(child, workplace);
    child.kill(signal);
    const Outcome outcome = child.wait();
    ASSERT_FALSE(outcome.timed_out);
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_NE(outcome.out.find("ended by signal " + std::to_string(signal)), std::string::npos) << outcome.out;
    expect_kept(workplace, instants);
  }
}

// mpirun passes the signal on, and kills a second later the ranks that have not ended.
TEST(Signals, EndTheRunOnTwoRanks) {
  const Workplace workplace(endless_scene());
  Child child(workplace.command({"-ts_dt", "1e-3", "-step_ranks", "all"}, 2), workplace.folder());
  const std::size_t instants = wait_for_instants(child, workplace);
  child.kill(SIGTERM);
  const Outcome outcome = child.wait();
  ASSERT_FALSE(outcome.timed_out);
  EXPECT_NE(outcome.status, 0);
  expect_kept(workplace, instants);
}

TEST(Signals, ToOneRankEndTheRunOnBothInOrder) {
  const Workplace workplace(endless_scene());
  const std::string line = "echo $$ > rank_$OMPI_COMM_WORLD_RANK; exec \"$0\" \"$@\"";
  Child child(behind(line, workplace.command({"-ts_dt", "1e-3", "-step_ranks", "all"}, 2)), workplace.folder());
  const std::size_t instants = wait_for_instants(child, workplace);
  pid_t rank = 0;
  std::ifstream(workplace.path("rank_1")) >> rank;
  ASSERT_GT(rank, 0);
  kill(rank, SIGTERM);
  const Outcome outcome = child.wait();
  ASSERT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.status, 128 + SIGTERM);
  EXPECT_NE(outcome.out.find("ended by signal 15"), std::string::npos) << outcome.out;
  expect_kept(workplace, instants);
}

TEST(Signals, KilledAtOnceLeavesWhatWasFlushed) {
  const Workplace workplace(endless_scene());
  Child child(workplace.command({}), workplace.folder());
  const std::size_t instants = wait_for_instants(child, workplace);
  child.kill(SIGKILL);
  EXPECT_EQ(child.wait().signal, SIGKILL);
  expect_kept(workplace, instants);
}

TEST(Steps, ExplicitBeyondItsLimit) {
  const Workplace workplace(small_scene());
  for (const std::string step : {"0.01", "0.05"}) {
    SCOPED_TRACE(step);
    expect_one_complaint(workplace.run({"-ts_type", "rk", "-ts_dt", step, "-output_file", "r.h5"}), {"-ts_dt"});
    EXPECT_FALSE(Results(workplace.path("r.h5")).time().empty());
  }
}

TEST(Steps, ExplicitBeyondItsLimitWithForcesOnly) {
  const Workplace workplace(std::string(two_spans) + "load: {forces: 1.0e5, speed: 40.0}\nts_dt: 0.05\n");
  expect_one_complaint(workplace.run({"-ts_type", "rk", "-output_file", "r.h5"}), {"-ts_dt"});
  EXPECT_FALSE(Results(workplace.path("r.h5")).time().empty());
}

// The default integrator with steps far too long: right within 5 %, or refused.
TEST(Steps, FarTooLongAreNotSilentlyWrong) {
  const Workplace workplace(small_scene());
  const auto peak_of = [&](const std::string& step, Outcome& outcome) {
    outcome = workplace.run({"-ts_dt", step, "-output_file", "r.h5"});
    return outcome.status == 0 ? peak(Results(workplace.path("r.h5"))("/probes/deflection")).first : 0.0;
  };
  Outcome outcome;
  const double fine = peak_of("0.002", outcome);
  expect_success(outcome);
  ASSERT_NE(fine, 0.0);
  for (const std::string step : {"0.02", "0.2", "1"}) {
    SCOPED_TRACE(step);
    const double coarse = peak_of(step, outcome);
    if (outcome.status == 0)
      EXPECT_NEAR(coarse, fine, 0.05 * std::abs(fine));
    else
      expect_one_complaint(outcome, {"ts_dt"});
  }
}

}  // namespace
}  // namespace traverse::test
