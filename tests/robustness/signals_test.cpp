// What ends the program from outside, at any time: a quiet end with a status that tells it, and readable results.
#include <gtest/gtest.h>

#include <csignal>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr double long_enough = 300.0;  // s, on a machine that has much else to do

const std::string endless =
    std::string(two_spans) + quarter_car + "ts_max_time: 1.0e5\nts_dt: 1.0e-3\noutput: {file: r.h5, interval: 0.01}\n";

// Progress is shown after some seconds of steps, so that by then there are samples.
const char* const progress = "t = ";

/// The program behind a shell's line that has "$0" "$@" in it.
Outcome in_shell(const Workplace& workplace, const std::string& line, const std::vector<std::string>& words) {
  std::vector<std::string> command = workplace.command(words);
  command.insert(command.begin(), {"/bin/sh", "-c", line});
  return Child(command, workplace.folder()).wait(long_enough);
}

void expect_end_by(int signal, const Outcome& outcome, const Workplace& workplace) {
  ASSERT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.status, 128 + signal);
  EXPECT_EQ(outcome.err, "");
  EXPECT_GT(Results(workplace.path("r.h5")).time().size(), 1U);
}

TEST(SignalsInARun, EndItInOrder) {
  const Workplace workplace(endless);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGQUIT}) {
    SCOPED_TRACE(signal);
    Child child(workplace.command({}), workplace.folder());
    ASSERT_TRUE(child.wait_for(progress, long_enough));
    child.kill(signal);
    const Outcome outcome = child.wait(long_enough);
    expect_end_by(signal, outcome, workplace);
    EXPECT_NE(outcome.out.find("ended by signal " + std::to_string(signal)), std::string::npos) << outcome.out;
  }
}

// nohup and shells' background jobs ignore signals for the programs they start.
TEST(SignalsInARun, StayIgnoredWhereTheyWere) {
  const Workplace workplace(endless);
  std::vector<std::string> command = workplace.command({});
  command.insert(command.begin(), {"/bin/sh", "-c", "trap '' HUP; exec \"$0\" \"$@\""});
  Child child(command, workplace.folder());
  ASSERT_TRUE(child.wait_for(progress, long_enough));
  child.kill(SIGHUP);
  child.kill(SIGTERM);
  expect_end_by(SIGTERM, child.wait(long_enough), workplace);
}

TEST(SignalsBeforeARun, EndTheProgramAtOnce) {
  struct Case {
    std::string scene;
    std::vector<std::string> words;
    std::string stage;
  };
  const std::string many_modes =
      "beam: {spans: 25.0*60, elements_per_span: 400, EI: 1.2e10, mass: 9000.0}\nscene: {analysis: modes}\n"
      "modes: {count: 10000}\n";
  const std::string many_probes = std::string(two_spans) + quarter_car + "ts_max_time: 1.0\n";
  for (const Case& c : {Case{many_modes, {}, "computation of the natural modes"},
                        Case{many_probes, {"-output_probes", "12.5*100000", "-accuracy", "1e-5"}, "trial runs"}}) {
    SCOPED_TRACE(c.stage);
    const Workplace workplace(c.scene);
    Child child(workplace.command(c.words), workplace.folder());
    ASSERT_TRUE(child.wait_for(c.stage + ",", long_enough) || child.wait_for(c.stage + ":", 1.0));
    child.kill(SIGTERM);
    const Outcome outcome = child.wait(long_enough);
    ASSERT_FALSE(outcome.timed_out);
    EXPECT_EQ(outcome.status, 128 + SIGTERM);
    EXPECT_EQ(outcome.err, "traverse: ended by signal 15 during " + c.stage + "\n");
    EXPECT_FALSE(workplace.has("results"));
  }
}

TEST(Output, ToAReaderThatGoes) {
  const Workplace workplace(endless);
  const Outcome outcome = in_shell(workplace, "{ \"$0\" \"$@\"; echo status $? >&2; } | head -1", {});
  ASSERT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.err, "status 141\n");
  EXPECT_EQ(outcome.out, "unusual input\n");  // there is no damping
  EXPECT_GT(Results(workplace.path("r.h5")).time().size(), 1U);
}

// All output fits into the buffer, so that the end of the program writes it.
TEST(Output, OfAShortRunToAReaderThatHasGone) {
  const Workplace workplace(small_scene());
  const Outcome outcome = in_shell(workplace, "{ sleep 1; \"$0\" \"$@\"; echo status $? >&2; } | true", {});
  EXPECT_EQ(outcome.err, "status 141\n");
}

TEST(Output, ToAFullDevice) {
  const Workplace workplace(small_scene());
  for (const std::string words : {"-output_file r.h5", "-help", "-version"}) {
    SCOPED_TRACE(words);
    const Outcome outcome = in_shell(workplace, "exec \"$0\" \"$@\" " + words + " > /dev/full", {});
    EXPECT_EQ(outcome.status, 4);
    const std::vector<std::string> lines = complaints(outcome);
    ASSERT_EQ(lines.size(), 1U) << outcome.err;
    EXPECT_NE(lines.front().find("traverse: standard output could not be written: No space left"), std::string::npos);
  }
  EXPECT_NEAR(Results(workplace.path("r.h5")).time().back(), 1.0, 1e-9);
}

// Otherwise the results file would get the number of the stream, and the words.
TEST(Output, ToStreamsThatAreClosed) {
  const Workplace workplace(small_scene());
  const Outcome outcome = in_shell(workplace, "exec \"$0\" \"$@\" <&- >&- 2>&-", {"-output_file", "r.h5"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NEAR(Results(workplace.path("r.h5")).time().back(), 1.0, 1e-9);
}

}  // namespace
}  // namespace traverse::test
