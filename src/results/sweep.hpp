// The peaks of a sweep: in the file under /sweep and /summary, and as a table on the terminal.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"

namespace traverse::results {

/// Speeds that were added near the peaks.
struct Refined {
  std::vector<double> added;  // of every speed: 1 where it was not asked for, else 0
  double wanted = 0.0;        // relative, of every peak over the speed
  double uncertainty = 0.0;   // the same, what is left
  std::string curve{};        // whose it is
};
void print(const Refined& refined);
/// speeds_added, peak_uncertainty, peak_uncertainty_of.
void add_to(std::vector<Attribute>& summary, const Refined& refined);

struct Sweep {
  static constexpr double not_run = std::numeric_limits<double>::quiet_NaN();

  std::vector<double> speed;   // m/s
  std::vector<int> trains;     // numbers of HSLM-A; empty: one train, whatever it is
  std::vector<double> probes;  // stations, m
  /// Magnitudes [trains][speeds][probes] and when they occurred; not_run where no run got to its end.
  struct Peaks {
    std::vector<double> value, time;
  };
  Peaks deflection, acceleration, moment;  // m, m/s2, N m
  std::vector<double> amplification;       // of the deflection over that at rest; 0: unknown
  std::vector<double> static_deflection;   // [trains][probes], m, largest magnitude; not_run: unknown
  // [trains][speeds], all empty without vehicles that roll: N, N, losses of contact of all wheels, s.
  std::vector<double> least_wheel_force, greatest_wheel_force, contact_losses, longest_loss;
  std::vector<double> unseen;  // [trains][speeds]: 1 where a run has met what no trial run has seen

  Judged judged;  // by the scene's limits, runs as [trains][speeds]

  std::optional<Refined> refined;  // where speeds were to be added

  /// How every run is computed.
  struct Model {
    int modes = 0;           // 0: by elements
    int elements = 0;        // of the longest span, or of the rail in a sleeper bay
    bool in_bays = false;    // the latter
    double time_step = 0.0;  // s; 0: exact in time, or chosen for each run
    double accuracy = 0.0;   // from which mesh, step and modes were chosen; 0: they were given
    /// Relative, of the peaks whose accuracy is promised.
    std::vector<std::pair<std::string, double>> expected_errors{};
    /// How many runs they do not hold in, by Sweep::unseen, said in words; "" where there are none.
    std::string not_promised(const std::vector<double>& unseen) const;
    std::string method{};  // of runs side by side, as -ts_type names it; empty: as TS takes it

    void keep(base::Bytes& bytes) { bytes(modes, elements, in_bays, time_step, accuracy, expected_errors, method); }
  } model;

  std::size_t rows() const { return trains.empty() ? 1 : trains.size(); }
};

/// The same trains and probes at the speeds of both, ascending; no speed is in both. Model and refinement are those of
/// `a`.
Sweep joined(const Sweep& a, const Sweep& b);

/// Where one number of a sweep belongs.
struct SweepPlace {
  std::size_t train = 0, speed = 0, probe = 0;  // indices
  std::size_t at = 0;                           // in [trains][speeds][probes]
};

/// Of runs that have ended, the place of the largest value of one train, or of all. False where none has ended.
bool find_largest(const Sweep& sweep, const std::vector<double>& values, std::size_t train, SweepPlace& place);
bool find_largest(const Sweep& sweep, const std::vector<double>& values, SweepPlace& place);

/// How the whole sweep went.
struct SweepCourse {
  long runs = 0, planned = 0;  // that ended; all
  double wall_seconds = 0.0;
  std::string ended;  // "reached its end", or why it stopped
};

/// Writes it under /sweep.
void record(const Sweep& sweep, Recorder& recorder);
/// /summary: the largest of all runs, each with its train, speed, probe and time; what is not known is left out.
std::vector<Attribute> summary_of(const Sweep& sweep, const SweepCourse& course);
/// Peaks of each train over all speeds and probes, each with its own speed and probe, and the amplification of the
/// largest deflection beside it.
void print_sweep(const Sweep& sweep);
/// A verdict on each limit, of the whole sweep.
std::vector<Verdict> verdicts_of(const Sweep& sweep);
/// "by 3 modes", "by 24 elements a span and steps of 0.00055 s".
std::string method_of(const Sweep::Model& model);
/// The line about runs that could not stay beside others; "" where there are none.
std::string computed_alone(long runs);

}  // namespace traverse::results
