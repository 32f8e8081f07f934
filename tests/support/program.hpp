// Runs the real program, TRAVERSE_BINARY, as a child process: what a user types and sees.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace traverse::test {

/// How a process ended and what it wrote.
struct Outcome {
  int status = -1;         ///< exit status; -1 when it did not exit by itself
  int signal = 0;          ///< the signal that ended it, or 0
  bool timed_out = false;  ///< it did not end by itself in time
  std::string out, err;
};

/// Longest wait by the clock, s. It is long because a machine that is busy with other things may be a hundred times
/// slower; a program that computes without end is stopped earlier, by the processor time that it has used.
constexpr double patience = 3600.0;

/// A process in a group of its own, without the variables that Open MPI sets in this one. Killed with the object, or by
/// the system once it has used five minutes of processor time.
class Child {
 public:
  Child(std::vector<std::string> command, const std::string& folder);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();
  void kill(int signal) const;
  /// Waits until the process has brought about a state; false when it ends or `seconds` pass before.
  bool wait_until(const std::function<bool()>& state, double seconds = patience);
  /// What the process has written so far: "out" or "err".
  std::string written(const std::string& ending) const;
  /// Waits until the process has written `text`.
  bool wait_for(const std::string& text, double seconds = patience);
  /// Waits until the process ends.
  Outcome wait(double seconds = patience);

 private:
  bool ended();

  TemporaryFolder streams_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int state_ = 0;
};

/// A folder with a scene, in which the program runs: paths are relative to it.
class Workplace {
 public:
  /// Writes `scene` as scene.yml.
  explicit Workplace(const std::string& scene) { folder_.write("scene.yml", scene); }

  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  std::string path(const std::string& name) const { return folder_.path(name); }
  bool has(const std::string& name) const { return std::filesystem::exists(folder_.path(name)); }
  /// `traverse -options_file scene.yml words...`, through mpirun for more than one rank.
  std::vector<std::string> command(const std::vector<std::string>& words, int ranks = 1) const;
  Outcome run(const std::vector<std::string>& words = {}, int ranks = 1, double seconds = patience) const;
  std::string folder() const { return folder_.path(""); }

 private:
  TemporaryFolder folder_;
};

/// Lines of a text.
std::vector<std::string> lines_of(const std::string& text);
/// The lines on stderr that the program wrote: mpirun adds its own.
std::vector<std::string> complaints(const Outcome& outcome);

/// The run has ended with status 0 and without a word on stderr.
void expect_success(const Outcome& outcome);
/// Refused before anything was computed: one line that begins `traverse: ` and holds every one of `parts`, a status
/// other than 0, no summary, no results file.
void expect_refusal(const Workplace& workplace, const Outcome& outcome, const std::vector<std::string>& parts);

/// Two spans of 20 m (4 elements each) and a body on a sprung axle: 6,000 kg, at 40 m/s.
extern const char* const two_spans;
extern const char* const quarter_car;
constexpr double quarter_car_weight = 6000.0 * 9.81;  // N
std::string small_scene();

}  // namespace traverse::test
