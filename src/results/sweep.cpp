#include "traverse/results/sweep.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace traverse::results {
namespace {

/// Place of the largest entry of a train's rows; entries of runs that have not ended do not count.
std::size_t largest(const Sweep& sweep, const std::vector<double>& values, std::size_t train) {
  const std::size_t size = sweep.speed.size() * sweep.probes.size();
  std::size_t at = train * size;
  for (std::size_t i = at; i < (train + 1) * size; ++i)
    if (values[i] > values[at] || values[at] != values[at]) at = i;
  return at;
}

}  // namespace

void record(const Sweep& sweep, Recorder& recorder) {
  std::vector<Recorder::Dataset> sets = {{"/sweep/speed", {sweep.speed.size()}, sweep.speed, "m/s"}};
  if (!sweep.trains.empty())
    sets.push_back({"/sweep/hslm_a", {sweep.trains.size()}, {sweep.trains.begin(), sweep.trains.end()}, "1"});
  const std::vector<std::size_t> shape = {sweep.rows(), sweep.speed.size(), sweep.probes.size()};
  const auto add = [&](const std::string& name, const Sweep::Peaks& peaks, const char* unit) {
    sets.push_back({"/sweep/peak_" + name, shape, peaks.value, unit});
    sets.push_back({"/sweep/peak_" + name + "_time", shape, peaks.time, "s"});
  };
  add("deflection", sweep.deflection, "m");
  add("acceleration", sweep.acceleration, "m/s2");
  add("moment", sweep.moment, "N m");
  sets.push_back({"/sweep/amplification", shape, sweep.amplification, "1"});
  if (!sweep.least_wheel_force.empty())
    sets.push_back({"/sweep/least_wheel_force", {shape[0], shape[1]}, sweep.least_wheel_force, "N"});
  recorder.datasets(sets);
}

Summary extremes(const Sweep& sweep) {
  Summary summary;
  for (std::size_t train = 0; train < sweep.rows(); ++train) {
    const auto note = [&](Extreme& extreme, const Sweep::Peaks& peaks) {
      const std::size_t at = largest(sweep, peaks.value, train);
      if (peaks.value[at] > extreme.value)
        extreme = {peaks.value[at], peaks.time[at], sweep.probes[at % sweep.probes.size()]};
    };
    note(summary.deflection, sweep.deflection);
    note(summary.acceleration, sweep.acceleration);
    note(summary.moment, sweep.moment);
    const double amplification = sweep.amplification[largest(sweep, sweep.amplification, train)];
    if (amplification > summary.amplification) summary.amplification = amplification;
  }
  return summary;
}

void print_sweep(const Sweep& sweep) {
  fmt::print("peaks\n  {:<6}{:>22}{:>24}{:>24}{:>18}\n", "train", "deflection, km/h", "acceleration, km/h",
             "moment, km/h", "amplification");
  for (std::size_t train = 0; train < sweep.rows(); ++train) {
    const auto text = [&](const std::vector<double>& values, double scale, const char* unit) {
      const std::size_t at = largest(sweep, values, train);
      const double speed = 3.6 * sweep.speed[at / sweep.probes.size() % sweep.speed.size()];
      return fmt::format("{:.5g} {} @ {:.4g}", scale * values[at], unit, speed);
    };
    fmt::print("  {:<6}{:>22}{:>24}{:>24}{:>18}\n",
               sweep.trains.empty() ? "scene" : fmt::format("A{}", sweep.trains[train]),
               text(sweep.deflection.value, 1e3, "mm"), text(sweep.acceleration.value, 1.0, "m/s2"),
               text(sweep.moment.value, 1e-3, "kN m"),
               fmt::format("{:.4g}", sweep.amplification[largest(sweep, sweep.amplification, train)]));
  }
  std::fflush(stdout);
}

}  // namespace traverse::results
