// The cut-off frequency of EN 1990, A2.4.4.2.1, the greatest of 30 Hz, 1.5 times the first and the third distinct
// natural frequency, and the low-pass filtering of the stored accelerations.
#include "run/deck_acceleration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "modes/modes.hpp"
#include "run/low_pass.hpp"
#include "run/response_extremes.hpp"

namespace traverse::run {
namespace {

constexpr double least_frequency = 30.0;    // Hz; EN 1990, A2.4.4.2.1
constexpr double first_factor = 1.5;        // factor of the first frequency; EN 1990, A2.4.4.2.1
constexpr std::size_t frequency_count = 3;  // number of distinct frequencies
constexpr double wanted_instants = 20.0;    // in a period of the cut-off frequency
constexpr double least_instants = 8.0;      // in a period of the cut-off frequency
constexpr double spacing_tolerance = 1e-9;
constexpr double instant_tolerance = 1e-6;  // relative to the interval
constexpr double same_frequency = 1e-6;     // relative difference below which two frequencies are equal
constexpr int cheap_nodes = 1000;           // largest number of nodes for which computing frequencies is cheap
constexpr double extreme_delay = 1.5;       // instants: an extreme is known one and a half instants later
constexpr double unsettled_periods = 3.0;   // periods of the cut-off frequency, until the effect of an end has decayed

/// The distinct frequencies, ascending, rad/s.
std::vector<double> distinct_of_modes(const std::vector<double>& omega) {
  std::vector<double> frequencies;
  for (const double one : omega)
    if (one > 0.0 && (frequencies.empty() || one > frequencies.back() * (1.0 + same_frequency)))
      frequencies.push_back(one);
  frequencies.resize(std::min(frequencies.size(), frequency_count));
  return frequencies;
}

}  // namespace

std::vector<double> first_frequencies(const SharedBeam& shared) {
  std::vector<double> frequencies;
  if (shared.beam->model().given)
    frequencies = distinct_of_modes(shared.beam->model().given->omega);
  else if (const beam::Beam& beam = *shared.beam;
           beam.rail() == nullptr && beam.model().dampers.empty() && !beam.model().nonlinear())
    frequencies = modes::distinct_frequencies(beam, frequency_count);
  else
    frequencies =
        modes::distinct_frequencies(beam::Beam(beam.comm(), linearised(bridge_alone(beam.model()))), frequency_count);
  for (double& omega : frequencies) omega /= 2.0 * std::numbers::pi;
  return frequencies;
}

double cutoff_of(const std::vector<double>& frequencies) {
  if (frequencies.empty()) return least_frequency;
  return std::max({least_frequency, first_factor * frequencies.front(), frequencies.back()});
}

bool filters_deck(const scene::Scene& scene) {
  return scene.beam && scene.analysis == options::Analysis::transient && !scene.output.probes.empty() &&
         scene.output.low_pass.value_or(least_frequency) > 0.0 &&
         (scene.limits_deck_acceleration() || scene.output.low_pass_requested);
}

bool frequencies_are_cheap(const beam::Beam& beam) {
  const std::vector<int>& elements = beam.model().elements;  // a mesh with one element may have a single frequency
  return beam.mesh().nodes() <= cheap_nodes && *std::min_element(elements.begin(), elements.end()) > 1;
}

double cutoff_frequency(const scene::Scene& scene, const SharedBeam& shared, bool affordable,
                        std::vector<std::string>& notes) {
  if (!shared.beam || scene.output.probes.empty() || scene.analysis != options::Analysis::transient) return 0.0;
  if (scene.output.low_pass) return *scene.output.low_pass;
  if (!affordable && !shared.modal) {
    notes.emplace_back(
        "deck accelerations are not low-passed: f1 and f3 of so long a bridge are not computed unasked; "
        "-output_lowpass 30 names a frequency in Hz");
    return 0.0;
  }
  const std::vector<double> f = first_frequencies(shared);
  const double first = f.empty() ? 0.0 : f.front(), third = f.empty() ? 0.0 : f.back(), greatest = cutoff_of(f);
  notes.push_back(
      fmt::format("deck accelerations are given unfiltered and low-passed at {:.6g} Hz, the largest of 30 Hz, 1.5 f1 = "
                  "{:.6g} Hz and f{} = {:.6g} Hz; -output_lowpass changes it",
                  greatest, first_factor * first, f.size(), third));
  return greatest;
}

double spacing_for(double frequency) { return 1.0 / (wanted_instants * frequency); }

double longest_spacing_for(double frequency) { return 1.0 / (least_instants * frequency); }

double unsettled_end(double frequency) { return unsettled_periods / frequency; }

std::string filter_obstacle(double frequency, const Plan& plan, std::size_t series, const char* what, double spacing) {
  if (plan.interval > spacing * longest_spacing_for(frequency) * (1.0 + spacing_tolerance))
    return fmt::format("samples or steps of {:g} s are too long for {:g} Hz; allowed: at most {:g} s", plan.interval,
                       frequency, longest_spacing_for(frequency));
  const double numbers = static_cast<double>(series) * (1.0 + plan.end_time / plan.interval);
  if (numbers > DeckAcceleration::max_stored)
    return fmt::format("{} {} at {:.3g} instants take more than {:.0f} MB; take fewer of them", series, what,
                       1.0 + plan.end_time / plan.interval, DeckAcceleration::max_stored * sizeof(double) / 1048576.0);
  return {};
}

DeckAcceleration::DeckAcceleration(double frequency, const Plan& plan, const std::vector<double>& stations)
    : frequency_(frequency),
      interval_(plan.interval),
      stored_each_(static_cast<std::size_t>(plan.stored)),
      stations_(stations) {
  rows_.reserve(stations.size() * static_cast<std::size_t>(2.0 + plan.end_time / plan.interval));
}

void DeckAcceleration::add(double t, std::span<const recovery::Response> probes) {
  const double due = static_cast<double>(instants_) * interval_;
  if (std::abs(t - due) > instant_tolerance * interval_) return;
  for (const recovery::Response& probe : probes) rows_.push_back(probe.acceleration);
  ++instants_;
}

std::size_t filter(std::vector<double>& rows, std::size_t count, double frequency, double interval) {
  LowPass(frequency, interval).apply(rows, count);
  const std::size_t instants = rows.size() / count;
  const double settled = static_cast<double>(instants) - unsettled_end(frequency) / interval;
  return static_cast<std::size_t>(std::max(0.0, std::ceil(settled)));
}

void DeckAcceleration::finish(ResponseExtremes& peaks) {
  const std::size_t settled = filter(rows_, stations_.size(), frequency_, interval_);
  settled_until_ = (static_cast<double>(settled) - extreme_delay) * interval_;
  peaks.add_low_passed(std::span<const double>(rows_).first(settled * stations_.size()), interval_);
}

results::LowPassed low_passed_peak(const Extreme& peak, const std::vector<double>& stations, double frequency,
                                   double interval) {
  return {{peak.value, peak.time, stations[static_cast<std::size_t>(peak.place)]}, frequency, interval, low_pass_name};
}

results::Recorder::Dataset DeckAcceleration::stored() const {
  const std::size_t n = stations_.size();
  results::Recorder::Dataset set{"/probes/acceleration_lowpass", {0, n}, {}, "m/s2"};
  for (std::size_t k = 0; k < instants_; k += stored_each_, ++set.shape[0])
    set.values.insert(set.values.end(), rows_.begin() + static_cast<std::ptrdiff_t>(k * n),
                      rows_.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
  return set;
}

}  // namespace traverse::run
