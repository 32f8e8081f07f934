// A run that goes on from a checkpoint: which results it takes up, and that it takes none of another run.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "results/checkpoint_file.hpp"
#include "support/folders.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A run that has stopped after three steps, with its results in r.h5 and its checkpoint in r.h5.checkpoint.
class Stopped {
 public:
  explicit Stopped(const std::vector<std::string>& words = {}) {
    std::vector<std::string> all = {"-ts_max_steps", "3"};
    all.insert(all.end(), words.begin(), words.end());
    expect_success(workplace.run(all));
  }
  /// The checkpoint with other contents, as of somebody who knows its form.
  template <class Change>
  void craft(Change&& change) const {
    const std::string file = workplace.path("r.h5.checkpoint");
    results::Checkpoint checkpoint = results::read_checkpoint(MPI_COMM_SELF, file);
    change(checkpoint.results);
    const std::string own = checkpoint.of_ranks.front();
    results::write_checkpoint(MPI_COMM_SELF, file, checkpoint, own);
  }
  Outcome go_on(const std::vector<std::string>& words = {}) const {
    std::vector<std::string> all = {"-restart", "r.h5.checkpoint"};
    all.insert(all.end(), words.begin(), words.end());
    return workplace.run(all);
  }
  /// The run is refused in one line that holds these parts.
  void expect_refused(const std::vector<std::string>& parts, const std::vector<std::string>& words = {}) const {
    const Outcome outcome = go_on(words);
    EXPECT_GT(outcome.status, 0);
    ASSERT_EQ(complaints(outcome).size(), 1U) << outcome.err;
    for (const std::string& part : parts) EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  }
  void move(const std::string& from, const std::string& to) const {
    std::filesystem::rename(workplace.path(from), workplace.path(to));
  }
  double reached(const std::string& file) const { return Results(workplace.path(file)).time().back(); }

  const Workplace workplace{small_scene() + "ts_max_time: 0.1\noutput: {file: r.h5}\n"};  // s
};

// --- what a checkpoint says of results
// --------------------------------------------------------------------------------

TEST(Restart, TakesUpNoResultsWithoutTheirRows) {
  using Earlier = results::Recorder::Earlier;
  const std::vector<void (*)(Earlier&)> changes = {
      [](Earlier& r) { r.rows = 0; },        [](Earlier& r) { r.rows = 0, r.digests.clear(); },
      [](Earlier& r) { r.digests.clear(); }, [](Earlier& r) { r.objects.clear(); },
      [](Earlier& r) { r.file.clear(); },    [](Earlier& r) { r.file.insert(1, 1, '\0'); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SCOPED_TRACE(i);
    const Stopped run;
    run.craft(changes[i]);
    const std::string before = text_of(run.workplace.path("r.h5"));
    run.expect_refused({"r.h5.checkpoint: the checkpoint is damaged"});
    EXPECT_EQ(text_of(run.workplace.path("r.h5")), before);
  }
}

TEST(Restart, TakesUpNoResultsThatCannotBeRead) {
  const Stopped run;
  run.craft([](results::Recorder::Earlier& r) { r.rows += 1000; });
  run.expect_refused({"r.h5: its datasets do not hold the rows"});
  run.craft([](results::Recorder::Earlier& r) { r.rows -= 1000, r.digests.pop_back(); });
  run.expect_refused({"r.h5: its datasets do not hold the rows"});
}

// The digests of the rows are those of the other run: only the scene tells them apart.
TEST(Restart, TakesUpNoResultsOfAnotherScene) {
  const Stopped run, other({"-gravity", "9.7"});
  results::Recorder::Earlier theirs =
      results::read_checkpoint(MPI_COMM_SELF, other.workplace.path("r.h5.checkpoint")).results;
  theirs.file = other.workplace.path("r.h5");
  run.craft([&](results::Recorder::Earlier& r) { r = theirs; });
  const std::string before = text_of(theirs.file);
  std::filesystem::remove(run.workplace.path("r.h5"));
  run.expect_refused({theirs.file + ": its datasets do not hold the rows"});
  EXPECT_EQ(text_of(theirs.file), before);
}

TEST(Restart, TakesNoUnusualNameFromACheckpoint) {
  const Stopped run;
  run.craft([](results::Recorder::Earlier& r) { r.file = "profile"; });
  run.expect_refused({"profile", "does not end in .h5", "-output_file"});
  EXPECT_FALSE(run.workplace.has("profile"));
}

// --- where the results are
// --------------------------------------------------------------------------------------------

TEST(Restart, OfARunWithoutResultsHasNone) {
  const Stopped run({"-output_file", "none", "-checkpoint_file", "r.h5.checkpoint"});
  run.expect_refused({"had no results file", "-output_file none"}, {"-output_file", "new.h5"});
  EXPECT_FALSE(run.workplace.has("new.h5"));
  expect_success(run.go_on());
  EXPECT_FALSE(run.workplace.has("r.h5"));
}

// The scene names r.h5, the run was told to write s.h5.
TEST(Restart, GoesOnInItsOwnResults) {
  const Stopped run({"-output_file", "s.h5", "-checkpoint_file", "r.h5.checkpoint"});
  const Outcome another = run.workplace.run({"-ts_max_time", "0.05"});
  expect_success(another);
  const std::string before = text_of(run.workplace.path("r.h5"));
  expect_success(run.go_on());
  EXPECT_EQ(text_of(run.workplace.path("r.h5")), before);
  EXPECT_NEAR(run.reached("s.h5"), 0.1, 1e-12);
}

TEST(Restart, FindsResultsThatWereMoved) {
  const Stopped run;
  std::filesystem::create_directory(run.workplace.path("moved"));
  run.move("r.h5", "moved/r.h5");
  run.move("r.h5.checkpoint", "moved/c");
  run.workplace.write("r.h5", "");
  const Stopped other({"-gravity", "9.7"});
  std::filesystem::copy(other.workplace.path("r.h5"), run.workplace.path("r.h5"),
                        std::filesystem::copy_options::overwrite_existing);
  expect_success(run.workplace.run({"-restart", "moved/c", "-output_file", "new.h5"}));
  EXPECT_NEAR(run.reached("new.h5"), 0.1, 1e-12);
  std::filesystem::remove(run.workplace.path("moved/r.h5"));
  expect_success(run.workplace.run({"-ts_max_steps", "3", "-output_file", "new.h5"}));
  run.move("new.h5.checkpoint", "r.h5.checkpoint");
  run.move("new.h5", "newer.h5");
  run.expect_refused({"new.h5 is not there", "other.h5 is not there"}, {"-output_file", "other.h5"});
  expect_success(run.go_on({"-output_file", "newer.h5"}));
}

// --- the copy that is taken up
// ----------------------------------------------------------------------------------------

// The copy has a free name, whatever is there.
TEST(Restart, LeavesAFileBesideTheResults) {
  const Stopped run;
  expect_success(run.workplace.run({"-output_file", "r.h5.part", "-ts_max_time", "0.05"}));
  const std::string before = text_of(run.workplace.path("r.h5.part"));
  expect_success(run.go_on());
  EXPECT_EQ(text_of(run.workplace.path("r.h5.part")), before);
}

// --- how far it goes
// --------------------------------------------------------------------------------------------------

TEST(Restart, TakesNoStepBeyondItsLimit) {
  const Stopped run;
  run.expect_refused({"has taken 3 steps already", "ts_max_steps"}, {"-ts_max_steps", "3"});
  expect_success(run.go_on({"-ts_max_steps", "4"}));
}

TEST(Restart, OfAScenesOwnResultsHasNoLimitOfSteps) {
  const Stopped run;
  const Outcome outcome = Child({program_path(), "r.h5", "-restart", "r.h5.checkpoint"}, run.workplace.folder()).wait();
  expect_success(outcome);
  EXPECT_NEAR(run.reached("r.h5"), 0.1, 1e-12);
}

TEST(Restart, LeavesTheCheckpointOfAnotherRun) {
  const Stopped run;
  const std::string before = text_of(run.workplace.path("r.h5.checkpoint"));
  expect_success(run.workplace.run());
  EXPECT_EQ(text_of(run.workplace.path("r.h5.checkpoint")), before);
}

}  // namespace
}  // namespace traverse::test
