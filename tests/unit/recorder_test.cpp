// The results file: what is written comes back, whatever happens to the run that wrote it.
#include "results/recorder.hpp"

#include <gtest/gtest.h>
#include <sys/file.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "recorder_helpers.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/base/error.hpp"
#include "traverse/base/version.hpp"

namespace traverse::results {
namespace {

using namespace traverse::results::testing;  // NOLINT: the helpers of this file

namespace fs = std::filesystem;

// Samples that the recorder writes at a time; fewer when they come slowly, as on a busy machine.
constexpr long kBlock = 1024;

class RecorderTest : public ::testing::Test {
 protected:
  std::unique_ptr<Recorder> open(const Layout& layout) const { return open(layout, file_); }
  static std::unique_ptr<Recorder> open(const Layout& layout, const std::string& file) {
    return std::make_unique<Recorder>(MPI_COMM_SELF, file, layout,
                                      std::vector<std::pair<std::string, std::string>>{{"scene", "three_span"}},
                                      std::vector<std::pair<std::string, std::string>>{{"-train_speed", "40"}});
  }

  /// The message of the FileError, which must name the file.
  static std::string refusal(const std::string& file) {
    try {
      open(small_layout(), file);
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
      return error.what();
    }
    return "(accepted)";
  }

  /// The first rows of a dataset of numbers are i + offset.
  static void expect_ramp(const Reader& reader, const std::string& name, hsize_t rows, double offset) {
    const auto values = reader.values(name, rows);
    ASSERT_GE(values.size(), rows) << name;
    for (hsize_t i = 0; i < rows; ++i) ASSERT_EQ(values[i], static_cast<double>(i) + offset) << name << " " << i;
  }

  test::TemporaryFolder folder_;
  const std::string file_ = folder_.path("run.h5");
};

using Shape1 = std::vector<hsize_t>;

TEST_F(RecorderTest, WritesEveryDatasetOfTheLayout) {
  const long n = 2 * kBlock + 88;
  auto recorder = open(small_layout());
  for (long i = 0; i < n; ++i) recorder->add(sample_at(i));
  recorder->finish({});

  const Reader reader(file_);
  ASSERT_TRUE(reader.opened());
  const hsize_t rows = n;
  expect_ramp(reader, "/time", rows, 0.0);
  EXPECT_EQ(reader.text("/time", "unit"), "s");
  EXPECT_EQ(reader.values("/probes/x"), (std::vector{2.5, 5.0}));
  EXPECT_EQ(reader.values("/supports/x"), (std::vector{0.0, 5.0, 10.0}));

  EXPECT_EQ(reader.text("/supports/x", "unit"), "m");

  EXPECT_EQ(reader.shape("/probes/deflection"), (Shape1{rows, 2}));
  EXPECT_EQ(reader.text("/probes/deflection", "unit"), "m");
  EXPECT_DOUBLE_EQ(reader.values("/probes/deflection")[2 * 300], 300.01);
  EXPECT_DOUBLE_EQ(reader.values("/probes/deflection")[2 * 300 + 1], 300.11);
  EXPECT_EQ(reader.shape("/supports/reaction"), (Shape1{rows, 3, 3}));
  EXPECT_EQ(reader.text("/supports/reaction", "unit"), "N, N, N m");
  EXPECT_DOUBLE_EQ(reader.values("/supports/reaction")[9 * 599 + 5], 599.25);
  EXPECT_EQ(reader.shape("/vehicles/0/car/position"), (Shape1{rows, 3}));
  EXPECT_DOUBLE_EQ(reader.values("/vehicles/0/car/position")[3 * 255 + 2], 255.32);
  EXPECT_DOUBLE_EQ(reader.values("/vehicles/0/car/position")[3 * 256 + 1], 256.31);
  EXPECT_EQ(reader.shape("/vehicles/0/rear_wheel/penetration"), (Shape1{rows}));
  expect_ramp(reader, "/vehicles/0/rear_wheel/penetration", rows, 0.45);
  expect_ramp(reader, "/energy/residual", rows, 0.85);
}

TEST_F(RecorderTest, KeepsTheEndApartFromTheSamples) {
  auto recorder = open(small_layout());
  for (long i = 0; i < 3; ++i) recorder->add(sample_at(i));
  recorder->end(sample_at(7));
  recorder->finish({});
  const Reader reader(file_);
  EXPECT_EQ(reader.values("/time"), (std::vector{0.0, 1.0, 2.0}));
  EXPECT_EQ(reader.number("/time", "interval"), 1.0);
  EXPECT_EQ(reader.values("/end/time"), (std::vector{7.0}));
  EXPECT_EQ(reader.shape("/end/vehicles/0/car/position"), (Shape1{1, 3}));
  EXPECT_DOUBLE_EQ(reader.values("/end/vehicles/0/car/position")[2], 7.32);
  EXPECT_EQ(reader.text("/end/supports/reaction", "unit"), "N, N, N m");
}

TEST_F(RecorderTest, WritesAttributesOptionsAndSummary) {
  auto recorder = open(small_layout());
  recorder->add(sample_at(0));
  recorder->shape({1.5, {0.0, 5.0, 10.0}, {0.0, -0.002, 0.0}});
  Summary summary;
  summary.probes = true;
  summary.deflection = {-0.002, 1.5, 5.0};
  summary.least_wheel = "vehicle 0, rear_wheel";
  summary.contact_losses = 3;
  summary.steps = 1234;
  summary.wall_seconds = 0.75;
  summary.ended = "reached its end";
  recorder->finish(summary);

  const Reader reader(file_);
  EXPECT_EQ(reader.text("/", "program"), "traverse");
  EXPECT_EQ(reader.text("/", "version"), version());
  EXPECT_NE(reader.text("/", "petsc_version"), "(no attribute)");
  EXPECT_EQ(reader.text("/", "scene"), "three_span");
  EXPECT_EQ(reader.number("/", "ranks"), 1);
  EXPECT_EQ(reader.number("/", "steps"), 1234);
  EXPECT_EQ(reader.number("/", "wall_seconds"), 0.75);
  EXPECT_EQ(reader.options(), (std::vector<std::string>{"-train_speed", "40"}));
  EXPECT_EQ(reader.number("/summary", "deflection"), -0.002);
  EXPECT_EQ(reader.number("/summary", "deflection_time"), 1.5);
  EXPECT_EQ(reader.number("/summary", "deflection_place"), 5.0);
  EXPECT_EQ(reader.number("/summary", "contact_losses"), 3);
  EXPECT_EQ(reader.text("/summary", "least_wheel"), "vehicle 0, rear_wheel");
  EXPECT_EQ(reader.text("/summary", "ended"), "reached its end");
  EXPECT_EQ(reader.values("/shape/x"), (std::vector{0.0, 5.0, 10.0}));
  EXPECT_EQ(reader.values("/shape/deflection"), (std::vector{0.0, -0.002, 0.0}));
  EXPECT_EQ(reader.number("/shape/deflection", "time"), 1.5);
}

TEST_F(RecorderTest, WritesModes) {
  auto recorder = open(small_layout());
  const modes::Modes modes = {.omega = {2.0 * std::numbers::pi, 30.0},
                              .motion = {modes::Motion::bending, modes::Motion::along},
                              .shape = {{0.0, 1.0, 0.0}, {0.5, 0.0, -1.0}},
                              .x = {0.0, 5.0, 10.0}};
  recorder->modes(modes, 0.1, 0.002, 6.3, 30.0);
  recorder->finish({});
  const Reader reader(file_);
  EXPECT_DOUBLE_EQ(reader.values("/modes/frequency")[0], 1.0);
  EXPECT_EQ(reader.shape("/modes/shape"), (Shape1{2, 3}));
  EXPECT_EQ(reader.values("/modes/shape")[5], -1.0);
  EXPECT_EQ(reader.values("/modes/axial"), (std::vector{0.0, 1.0}));
  EXPECT_EQ(reader.values("/modes/x"), (std::vector{0.0, 5.0, 10.0}));
  EXPECT_EQ(reader.number("/modes", "rayleigh_b"), 0.002);
  EXPECT_EQ(reader.number("/modes", "omega2"), 30.0);
  EXPECT_FALSE(reader.has("/time"));
}

TEST_F(RecorderTest, WritesDampedModes) {
  auto recorder = open(small_layout());
  const double omega = 2.0 * std::numbers::pi;
  recorder->damped_modes({.lambda = {-2.0, {-0.6 * omega, 0.8 * omega}},
                          .motion = {modes::Motion::bending, modes::Motion::along},
                          .shape = {{0.0, 1.0, 0.0}, {{0.5, 0.25}, 0.0, 1.0}}});
  recorder->finish({});
  const Reader reader(file_);
  EXPECT_EQ(reader.values("/modes/damped_frequency")[0], 0.0);
  EXPECT_DOUBLE_EQ(reader.values("/modes/damped_frequency")[1], 0.8);
  EXPECT_EQ(reader.values("/modes/damping_ratio")[0], 1.0);
  EXPECT_DOUBLE_EQ(reader.values("/modes/damping_ratio")[1], 0.6);
  EXPECT_EQ(reader.values("/modes/decay_rate")[0], 2.0);
  EXPECT_EQ(reader.values("/modes/damped_axial"), (std::vector{0.0, 1.0}));
  EXPECT_EQ(reader.shape("/modes/damped_shape"), (Shape1{2, 3, 2}));
  EXPECT_EQ(reader.values("/modes/damped_shape")[7], 0.25);
  EXPECT_EQ(reader.text("/modes/decay_rate", "unit"), "1/s");
  EXPECT_EQ(reader.text("/modes/damped_frequency", "unit"), "Hz");
}

TEST_F(RecorderTest, KeepsEveryRowAtBlockBoundaries) {
  for (const long n : {1L, kBlock - 1, kBlock, kBlock + 1, 2 * kBlock}) {
    auto recorder = open(small_layout());
    for (long i = 0; i < n; ++i) recorder->add(sample_at(i));
    recorder->finish({});
    const Reader reader(file_);
    EXPECT_EQ(reader.shape("/time"), (Shape1{static_cast<hsize_t>(n)}));
    expect_ramp(reader, "/energy/residual", static_cast<hsize_t>(n), 0.85);
  }
}

// More than the file keeps open between two blocks.
TEST_F(RecorderTest, KeepsEveryRowOfThousandsOfDatasets) {
  constexpr long datasets = 2100;
  const auto name = [](long k) { return "/many/" + std::to_string(k); };
  Layout layout;
  Sample sample;
  for (long k = 0; k < datasets; ++k) layout.fields.push_back({name(k), {}, "m"});
  auto recorder = open(layout);
  const long n = kBlock + 8;
  for (long i = 0; i < n; ++i) {
    sample.time = static_cast<double>(i);
    sample.values.clear();
    for (long k = 0; k < datasets; ++k) sample.values.push_back(static_cast<double>(i + k));
    recorder->add(sample);
  }
  recorder->end(sample);
  recorder->finish({});

  const Reader reader(file_);
  ASSERT_TRUE(reader.opened());
  for (const long k : {0L, 1998L, 1999L, 2000L, datasets - 1}) {
    expect_ramp(reader, name(k), static_cast<hsize_t>(n), static_cast<double>(k));
    EXPECT_EQ(reader.values("/end" + name(k)), std::vector{static_cast<double>(n - 1 + k)});
    EXPECT_EQ(reader.text(name(k), "unit"), "m");
  }
}

TEST_F(RecorderTest, WritesTheTimeWhereThereIsNothingElse) {
  auto recorder = open({});
  Sample sample;
  recorder->add(sample);
  recorder->finish({});
  const Reader reader(file_);
  EXPECT_EQ(reader.shape("/time"), (Shape1{1}));
  EXPECT_FALSE(reader.has("/probes"));
  EXPECT_FALSE(reader.has("/supports"));
  EXPECT_FALSE(reader.has("/vehicles"));
}

TEST_F(RecorderTest, NoNameMeansNoFile) {
  auto recorder = open(small_layout(), "");
  recorder->add(sample_at(0));
  recorder->finish({});
}

TEST_F(RecorderTest, DestructorWritesWhatIsThere) {
  auto recorder = open(small_layout());
  for (long i = 0; i < 10; ++i) recorder->add(sample_at(i));
  recorder.reset();
  const Reader reader(file_);
  expect_ramp(reader, "/time", 10, 0.0);
  EXPECT_FALSE(reader.has("/summary"));
}

TEST_F(RecorderTest, KilledRunLeavesItsFullBlocks) {
  run_and_kill(
      [&](auto ready) {
        const auto recorder = open(small_layout());
        for (long i = 0; i < 2 * kBlock + 10; ++i) recorder->add(sample_at(i));
        ready();
        for (;;) pause();
      },
      0);
  const Reader reader(file_);
  ASSERT_TRUE(reader.opened());
  const hsize_t rows = reader.shape("/time")[0];
  EXPECT_GT(rows, kBlock + 10) << "less than a block is lost";
  expect_ramp(reader, "/time", rows, 0.0);
  expect_ramp(reader, "/vehicles/0/rear_wheel/penetration", rows, 0.45);
  EXPECT_EQ(reader.options().size(), 2U);
}

// Killed while it does nothing but write, which a real run hardly ever does.
TEST_F(RecorderTest, RunKilledAtAnyTimeLeavesTheRowsOfTime) {
  constexpr long samples = 60 * kBlock;
  Layout layout = small_layout();
  layout.rows = samples;
  for (useconds_t delay = 0; delay < 20000; delay += 997) {
    run_and_kill(
        [&](auto ready) {
          const auto recorder = open(layout);
          for (long i = 0; i < samples; ++i) {
            recorder->add(sample_at(i));
            if (i == 2 * kBlock) ready();
          }
        },
        delay);
    const Reader reader(file_);
    ASSERT_TRUE(reader.opened());
    const auto shape = reader.shape("/time");
    ASSERT_EQ(shape.size(), 1u);
    const hsize_t rows = shape[0];
    EXPECT_GT(rows, kBlock) << "less than a block of what was there is lost";
    // The very last block of /time itself may be caught between its length and its rows.
    const hsize_t sure = rows - kBlock;
    expect_ramp(reader, "/time", sure, 0.0);
    expect_ramp(reader, "/energy/residual", sure, 0.85);
    expect_ramp(reader, "/vehicles/0/rear_wheel/penetration", sure, 0.45);
  }
}

/// Places and sizes of the object headers of a file, which are of version 2 of HDF5's format.
std::vector<std::pair<std::size_t, std::size_t>> object_headers(const std::string& bytes) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at])); };
  for (std::size_t at = bytes.find("OHDR"); at != std::string::npos; at = bytes.find("OHDR", at + 1)) {
    const std::size_t flags = byte(at + 5), width = std::size_t{1} << (flags & 3U);
    std::size_t begin = at + 6 + ((flags & 0x20U) != 0 ? 16 : 0) + ((flags & 0x10U) != 0 ? 4 : 0), size = 0;
    for (std::size_t i = 0; i < width; ++i) size += byte(begin + i) << (8 * i);
    constexpr std::size_t checksum = 4;
    found.emplace_back(at, begin + width + size + checksum - at);
  }
  return found;
}

// A kill may divide a write between two pages. A header on both would then have a wrong checksum.
TEST_F(RecorderTest, NoHeaderOfASeriesIsOnTwoPages) {
  constexpr std::size_t page = 4096, shortest = 256, longest = 512;
  const auto recorder = open(small_layout());
  for (int i = 0; i < 2 * kBlock; ++i) recorder->add(sample_at(i));
  recorder->finish({});
  std::ifstream file(file_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::size_t series = 0;
  for (const auto& [first, size] : object_headers(bytes)) {
    if (size < shortest || size > longest) continue;
    ++series;
    EXPECT_EQ(first / page, (first + size - 1) / page) << first << ", " << size;
  }
  EXPECT_GT(series, 5u);
}

TEST_F(RecorderTest, ReplacesOlderFileAndMakesFolders) {
  const std::string deep = folder_.path("a/b/run.h5");
  for (int n : {5, 3}) {
    auto recorder = open(small_layout(), deep);
    for (int i = 0; i < n; ++i) recorder->add(sample_at(i));
    recorder->finish({});
  }
  EXPECT_EQ(Reader(deep).shape("/time"), (Shape1{3}));
}

TEST_F(RecorderTest, RefusesPlacesThatCannotHoldTheFile) {
  const std::string plain = folder_.write("plain", "text");
  EXPECT_NE(refusal(plain + "/run.h5").find("Not a directory"), std::string::npos);
  EXPECT_NE(refusal(folder_.path(".")).find("no ordinary file"), std::string::npos);
  EXPECT_NE(refusal("/dev/full").find("no ordinary file"), std::string::npos);
  EXPECT_NE(refusal("/dev/null/run.h5"), "(accepted)");
  if (geteuid() != 0) {  // root may write anywhere
    fs::permissions(folder_.path("."), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_NE(refusal(file_).find("Permission denied"), std::string::npos);
    fs::permissions(folder_.path("."), fs::perms::owner_all);
  }
}

TEST_F(RecorderTest, LeavesFileThatAnotherRunIsWriting) {
  open(small_layout())->finish({});
  const int other = ::open(file_.c_str(), O_RDWR);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  EXPECT_NE(refusal(file_).find("-output_file"), std::string::npos);
  ::close(other);
  EXPECT_TRUE(Reader(file_).has("/summary"));
}

TEST_F(RecorderTest, FullDiskIsAnErrorAndKeepsWhatWasWritten) {
  auto recorder = open(small_layout());
  for (long i = 0; i < kBlock; ++i) recorder->add(sample_at(i));
  const hsize_t rows = test::stored_instants(file_);
  ASSERT_GT(rows, 0u);
  fill_disk_of(fs::canonical(file_));
  std::string message;
  try {
    for (long i = 0; i < kBlock; ++i) recorder->add(sample_at(i));
  } catch (const FileError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find(file_), std::string::npos) << message;
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  EXPECT_THROW(recorder->finish({}), std::logic_error);
  recorder.reset();
  const Reader reader(file_);
  ASSERT_TRUE(reader.opened());
  expect_ramp(reader, "/time", rows, 0.0);
  expect_ramp(reader, "/energy/residual", rows, 0.85);
}

TEST_F(RecorderTest, FullDiskAtTheEndIsAnError) {
  for (const bool finish : {true, false}) {
    auto recorder = open(small_layout());
    for (long i = 0; i < 10; ++i) recorder->add(sample_at(i));
    fill_disk_of(fs::canonical(file_));
    if (finish) {
      EXPECT_THROW(recorder->finish({}), FileError);
    }
    recorder.reset();  // never throws
  }
}

TEST_F(RecorderTest, SampleMustFitTheLayout) {
  auto recorder = open(small_layout());
  Sample sample = sample_at(0);
  sample.values.pop_back();
  EXPECT_THROW(recorder->add(sample), std::logic_error);
}

}  // namespace
}  // namespace traverse::results
