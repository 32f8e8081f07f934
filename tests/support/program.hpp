// Runs the program TRAVERSE_BINARY as a child process, with the command line and the output of a user.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace traverse::test {

/// The end of a process and its output.
struct Outcome {
  int status = -1;         ///< exit status; -1 if it did not exit by itself
  int signal = 0;          ///< the signal that ended it, or 0
  bool timed_out = false;  ///< it did not end by itself in time
  std::string out, err;
};

/// Longest wait by the clock, s. It is long because a busy machine may be a hundred times slower. A program that does
/// not end is stopped earlier by its limit of processor time.
constexpr double patience = 3600.0;

/// A process in a separate process group, without the variables that Open MPI sets in this process. It is killed when
/// the object is destroyed, or by the system after five minutes of processor time.
class Child {
 public:
  Child(std::vector<std::string> command, const std::string& folder);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();
  void kill(int signal) const;
  /// Waits until `state` is true; returns false if the process ends before, or after `seconds`.
  bool wait_until(const std::function<bool()>& state, double seconds = patience);
  /// The output of the process so far, "out" or "err".
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
/// The lines on stderr that the program wrote, without the lines of mpirun.
std::vector<std::string> complaints(const Outcome& outcome);

/// Expects that the run has ended with status 0 and without text on stderr.
void expect_success(const Outcome& outcome);
/// Expects that the run was refused before any computation: one line that begins with `traverse: ` and contains all
/// `parts`, a status other than 0, no summary, no results file.
void expect_refusal(const Workplace& workplace, const Outcome& outcome, const std::vector<std::string>& parts);

/// Two spans of 20 m (4 elements each) and a body on a sprung axle: 6,000 kg, at 40 m/s.
extern const char* const two_spans;
extern const char* const quarter_car;
constexpr double quarter_car_weight = 6000.0 * 9.81;  // N
std::string small_scene();

}  // namespace traverse::test
