// The table of a sweep by trains and speeds, for /sweep and for the terminal, with the speeds that were added; and
// resonance and cancellation speeds, stored under /resonances and /cancellations and printed on the terminal.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "results/recorder.hpp"
#include "results/study_table.hpp"

namespace traverse::results {

inline constexpr const char* speed_of_sweep = "speed";  // name of its dimension
/// The study of a sweep: its axes are trains and speeds (m/s). trains: numbers of HSLM-A; empty: a single train.
options::Study sweep_study(const std::vector<int>& trains, std::vector<double> speeds);
/// The numbers of trains, and the speeds.
std::size_t trains_of(const options::Study& sweep);
const std::vector<double>& speeds_of_sweep(const options::Study& sweep);
/// "A3"; empty if the trains have no names.
std::string train_name(const options::Study& sweep, std::size_t train);

/// Datasets [trains, speeds] or [trains, speeds, probes] under /sweep; NaN if a run has not ended. estimates: the runs
/// have error estimates, except for those with events that no trial run covered.
std::vector<Recorder::Dataset> sweep_datasets(const StudyTable& table, bool estimates);
/// Prints the peaks of each train over all speeds and probes, each with its speed and probe, and the amplification at
/// the largest deflection.
void print_sweep(const StudyTable& table);

/// The speeds that were added to those of a sweep or a study.
struct Refined {
  std::vector<double> added;  // for each speed: 1 if it was added, else 0
  double wanted = 0.0;        // relative, of every peak over the speed; 0: refined near limits only
  double uncertainty = 0.0;   // relative, remaining
  std::string curve{};        // the curve with this uncertainty
};
void print(const Refined& refined);
/// Adds speeds_added, peak_uncertainty, peak_uncertainty_of.
void add_to(std::vector<Attribute>& summary, const Refined& refined);

/// A resonance speed v = f d/i of the bridge's frequency f and a train's axle distance d.
struct Resonance {
  std::size_t train = 0;    // index
  int mode = 1, order = 1;  // number of the distinct frequency, from 1; i
  double frequency = 0.0;   // Hz
  double distance = 0.0;    // m
  double speed = 0.0;       // m/s, predicted
  double width = 0.0;       // m/s: change of speed by which the first and the last axle differ by one period
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double of_deflection = none, of_acceleration = none;  // m/s, speeds of the peaks of the sweep near this speed
};

/// A speed at which a force leaves no free vibration of one mode of a simple span.
struct Cancellation {
  int mode = 1, half_waves = 3;  // n; half waves of the mode's vibration while the force crosses: n + 2 k
  double speed = 0.0;            // m/s
};

/// trains: numbers of HSLM-A; empty: a single train.
void record(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
            const std::vector<Cancellation>& cancellations, Recorder& recorder);
/// One line for each train with the resonances of the first frequency, and one for the cancellations of the first mode.
void print(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
           const std::vector<Cancellation>& cancellations);

}  // namespace traverse::results
