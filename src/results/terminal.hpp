// Output on the terminal during a run: the description of the model, the progress and the summary. Rank 0 prints.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "modes/modes.hpp"
#include "results/recorder.hpp"

namespace traverse::results {

/// The units in which people read quantities: scripts/engineering_units.csv, which pictures and reports read too.
struct EngineeringUnit {
  std::string_view quantity, si, name;
  double factor = 1.0;  // from SI
};

/// The row of a quantity such as "deflection"; std::logic_error if there is none.
const EngineeringUnit& engineering_unit(std::string_view quantity);

/// "-4.213 mm": a value in SI units in its engineering unit.
std::string in_engineering_units(std::string_view quantity, double value, int digits = 4);

/// "12 ms", "3.4 s", "2 min 05 s", "1 h 10 min".
std::string duration_text(double seconds);

/// Prints the lines "modelled": each has a part of the model, followed by the reason or method of its choice.
void print_modelled(const std::vector<std::string>& lines);

/// Prints the lines "unusual input" of a scene.
void print_unusual(const std::vector<std::string>& lines);

/// Prints a table. Each column is as wide as its longest text; texts are aligned on the right.
void print_columns(std::vector<std::vector<std::string>> rows);

/// Prints progress with the remaining time: on a terminal in one line that is rewritten, otherwise in a line for each
/// tenth of the run and every half minute. Runs that end within two seconds have no such line. The cost of a call in
/// every step is not measurable.
class Progress {
 public:
  Progress(double start, double end, bool quiet);
  void update(double t, long steps);
  /// Progress of a sweep: the completed part of its work, from 0 to 1, and the number of completed runs.
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
/// Prints natural modes; with damping each row ends with a damped mode. Both lists are ascending. If a row has two
/// different modes, a line reports it.
void print_modes(const modes::Modes& modes, double omega1, double omega2, double rayleigh_a, double rayleigh_b,
                 const modes::DampedModes& damped = {});

}  // namespace traverse::results
