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

namespace traverse::app {
namespace {

constexpr double least_frequency = 30.0;  // Hz; EN 1990, A2.4.4.2.1
constexpr double of_the_first = 1.5;      // times the first frequency, in the same place
constexpr std::size_t counted = 3;        // distinct frequencies
constexpr double wanted_instants = 20.0;  // in a period of the frequency that counts
constexpr double least_instants = 8.0;    // in the same
constexpr double slack_of_spacing = 1e-9;
constexpr double at_an_instant = 1e-6;     // of the interval
constexpr double copies = 1e-6;            // relative distance below which two frequencies are one
constexpr int cheap_nodes = 1000;          // up to which frequencies take no time
constexpr double extremes_behind = 1.5;    // instants: the last one after which an extreme is known from the next
constexpr double unsettled_periods = 3.0;  // of the filter's frequency, until an end has died away

/// rad/s, ascending: those that differ.
std::vector<double> distinct_of_modes(const std::vector<double>& omega) {
  std::vector<double> found;
  for (const double one : omega)
    if (one > 0.0 && (found.empty() || one > found.back() * (1.0 + copies))) found.push_back(one);
  found.resize(std::min(found.size(), counted));
  return found;
}

}  // namespace

std::vector<double> first_frequencies(const SharedBeam& shared) {
  std::vector<double> found;
  if (shared.beam->model().given)
    found = distinct_of_modes(shared.beam->model().given->omega);
  else if (const beam::Beam& beam = *shared.beam; beam.rail() == nullptr && !beam.model().nonlinear())
    found = modes::distinct_frequencies(beam, counted);
  else
    found = modes::distinct_frequencies(beam::Beam(beam.comm(), linearised(bridge_alone(beam.model()))), counted);
  for (double& omega : found) omega /= 2.0 * std::numbers::pi;
  return found;
}

bool filters_deck(const Scene& scene) {
  return scene.beam && scene.analysis == Analysis::transient && !scene.output.probes.empty() &&
         scene.output.low_pass.value_or(least_frequency) > 0.0 &&
         (scene.limits_deck_acceleration() || scene.output.low_pass_asked);
}

bool frequencies_are_cheap(const beam::Beam& beam) {
  const std::vector<int>& elements = beam.model().elements;  // of which one may have no two frequencies
  return beam.mesh().nodes() <= cheap_nodes && *std::min_element(elements.begin(), elements.end()) > 1;
}

double frequency_that_counts(const Scene& scene, const SharedBeam& shared, bool affordable,
                             std::vector<std::string>& notes) {
  if (!shared.beam || scene.output.probes.empty() || scene.analysis != Analysis::transient) return 0.0;
  if (scene.output.low_pass) return *scene.output.low_pass;
  if (!affordable && !shared.modal) {
    notes.emplace_back(
        "deck accelerations are not low-passed: f1 and f3 of so long a bridge are not computed unasked; "
        "-output_lowpass 30 names a frequency in Hz");
    return 0.0;
  }
  const std::vector<double> f = first_frequencies(shared);
  const double first = f.empty() ? 0.0 : f.front(), third = f.empty() ? 0.0 : f.back();
  const double greatest = std::max({least_frequency, of_the_first * first, third});
  notes.push_back(fmt::format(
      "deck accelerations without and with a low-pass at {:.6g} Hz: the greatest of 30 Hz, 1.5 f1 = {:.6g} Hz and "
      "f{} = {:.6g} Hz; -output_lowpass changes it",
      greatest, of_the_first * first, f.size(), third));
  return greatest;
}

double spacing_for(double frequency) { return 1.0 / (wanted_instants * frequency); }

double longest_spacing_for(double frequency) { return 1.0 / (least_instants * frequency); }

double unsettled_end(double frequency) { return unsettled_periods / frequency; }

std::string no_filter(double frequency, const Plan& plan, std::size_t series, const char* what) {
  if (plan.interval > longest_spacing_for(frequency) * (1.0 + slack_of_spacing))
    return fmt::format("samples or steps of {:g} s are too long for {:g} Hz; allowed: at most {:g} s", plan.interval,
                       frequency, longest_spacing_for(frequency));
  const double numbers = static_cast<double>(series) * (1.0 + plan.end_time / plan.interval);
  if (numbers > DeckAcceleration::most_kept)
    return fmt::format("{} {} at {:.3g} instants take more than {:.0f} MB; take fewer of them", series, what,
                       1.0 + plan.end_time / plan.interval, DeckAcceleration::most_kept * sizeof(double) / 1048576.0);
  return {};
}

DeckAcceleration::DeckAcceleration(double frequency, const Plan& plan, const std::vector<double>& stations)
    : frequency_(frequency),
      interval_(plan.interval),
      stored_each_(static_cast<std::size_t>(plan.stored)),
      stations_(stations) {
  kept_.reserve(stations.size() * static_cast<std::size_t>(2.0 + plan.end_time / plan.interval));
}

void DeckAcceleration::add(double t, std::span<const beam::Response> probes) {
  const double due = static_cast<double>(instants_) * interval_;
  if (std::abs(t - due) > at_an_instant * interval_) return;
  for (const beam::Response& probe : probes) kept_.push_back(probe.acceleration);
  ++instants_;
}

std::size_t filter(std::vector<double>& rows, std::size_t count, double frequency, double interval) {
  LowPass(frequency, interval).apply(rows, count);
  const std::size_t instants = rows.size() / count;
  const double settled = static_cast<double>(instants) - unsettled_end(frequency) / interval;
  return static_cast<std::size_t>(std::max(0.0, std::ceil(settled)));
}

void DeckAcceleration::finish(ResponseExtremes& peaks) {
  const std::size_t settled = filter(kept_, stations_.size(), frequency_, interval_);
  settled_until_ = (static_cast<double>(settled) - extremes_behind) * interval_;
  peaks.add_low_passed(std::span<const double>(kept_).first(settled * stations_.size()), interval_);
}

results::LowPassed peak_of(const std::vector<double>& rows, const std::vector<double>& stations, double frequency,
                           double interval) {
  const Extreme peak = largest_peak(rows, stations.size(), interval);
  return {{peak.value, peak.time, stations[static_cast<std::size_t>(peak.place)]}, frequency, interval, low_pass_name};
}

results::Recorder::Dataset DeckAcceleration::stored() const {
  const std::size_t n = stations_.size();
  results::Recorder::Dataset set{"/probes/acceleration_lowpass", {0, n}, {}, "m/s2"};
  for (std::size_t k = 0; k < instants_; k += stored_each_, ++set.shape[0])
    set.values.insert(set.values.end(), kept_.begin() + static_cast<std::ptrdiff_t>(k * n),
                      kept_.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
  return set;
}

}  // namespace traverse::app
