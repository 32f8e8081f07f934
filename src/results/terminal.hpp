// What a user reads while a run goes on: what was modelled, progress, and the summary. Rank 0 prints.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "modes/modes.hpp"
#include "results/recorder.hpp"

namespace traverse::results {

/// "12 ms", "3.4 s", "2 min 05 s", "1 h 10 min".
std::string duration_text(double seconds);

/// "modelled" lines: each one a thing and, after it, why or how it was chosen.
void print_modelled(const std::vector<std::string>& lines);

/// A table: each column as wide as its longest text, which stands on the right.
void print_columns(std::vector<std::vector<std::string>> rows);

/// Progress with the time left: on a terminal one line rewritten, otherwise a line every tenth of the run and every
/// half minute, and none for runs that end within two seconds. Costs nothing measurable when called every step.
class Progress {
 public:
  Progress(double start, double end, bool quiet);
  void update(double t, long steps);
  /// Of a sweep from 0 to 1: the part of its work that is done, and how many of its runs.
  void runs(double part, std::size_t done, std::size_t all);
  void done();

 private:
  template <class Text>
  void show(double t, Text what);

  double start_, end_;
  bool quiet_, terminal_;
  int shown_ = -1;
  std::chrono::steady_clock::time_point begin_, last_;
  long calls_ = 0;
};

void print_summary(const Summary& summary, const std::string& file);
/// With damping each row ends with a damped mode. Both sides ascend; where they are not the same modes, a line says so.
void print_modes(const modes::Modes& modes, double omega1, double omega2, double rayleigh_a, double rayleigh_b,
                 const modes::DampedModes& damped = {});

}  // namespace traverse::results
