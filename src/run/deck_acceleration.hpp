// The deck acceleration below a cut-off frequency, by a low-pass filter (EN 1990, A2.4.4.2.1).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "run/plan.hpp"
#include "run/response_extremes.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Whether a transient run of the scene filters the accelerations of its probes, if its steps are short enough.
bool filters_deck(const scene::Scene& scene);

/// Whether at least two frequencies exist and computing them is cheap.
bool frequencies_are_cheap(const beam::Beam& beam);

/// Collective. The first three distinct bending frequencies, Hz, ascending; with model_modes the frequencies of its
/// modes.
std::vector<double> first_frequencies(const SharedBeam& shared);
/// The cut-off frequency of EN 1990, A2.4.4.2.1 for these first three frequencies, Hz.
double cutoff_of(const std::vector<double>& frequencies);

/// Collective, after SharedBeam::prepare. The cut-off frequency (Hz) of deck accelerations in this scene; 0: they are
/// not filtered. It is given by the scene, or is the greatest of 30 Hz, 1.5 f1 and f3, the bridge's distinct bending
/// frequencies. affordable: whether to compute these. Appends the choice to `notes`.
double cutoff_frequency(const scene::Scene& scene, const SharedBeam& shared, bool affordable,
                        std::vector<std::string>& notes);

/// The interval of instants, s, for accurate filtering.
double spacing_for(double frequency);
/// The longest interval with which an acceleration is filtered, s.
double longest_spacing_for(double frequency);

/// The duration of the end of a series, s, in which the filter lacks the later signal: there the filtered signal may
/// contain components above the cut-off frequency.
double unsettled_end(double frequency);

/// The reason why this number of series of a run with this plan cannot be filtered; empty if they can. what: "probes",
/// which output_probes reduces, or "wheels"; spacing: allowed interval of instants over longest_spacing_for().
std::string filter_obstacle(double frequency, const Plan& plan, std::size_t series, const char* what = "probes",
                            double spacing = 1.0);

/// The peak of filtered accelerations with the frequency and the interval of the filter; its place: index of a station.
results::LowPassed low_passed_peak(const Extreme& peak, const std::vector<double>& stations, double frequency,
                                   double interval);

/// Filters series, rows of `count` values at intervals of `interval` s from 0 on. Returns the number of rows before the
/// unsettled end.
std::size_t filter(std::vector<double>& rows, std::size_t count, double frequency, double interval);

/// Stores the acceleration of every probe at the plan's interval and filters all of them at the end of the run. Memory:
/// 8 bytes for each instant and probe, at most `max_stored` numbers.
class DeckAcceleration {
 public:
  static constexpr double max_stored = 33554432.0;  // numbers, 256 MB

  DeckAcceleration(double frequency, const Plan& plan, const std::vector<double>& stations);

  /// Stores an instant at a multiple of the plan's interval; ignores others.
  void add(double t, std::span<const recovery::Response> probes);
  /// After the last instant, once: filters all series and adds the extremes before their unsettled ends to the peaks.
  void finish(ResponseExtremes& peaks);
  /// After finish. The peak of the whole series.
  results::LowPassed peak() const {
    return low_passed_peak(largest_peak(rows_, stations_.size(), interval_), stations_, frequency_, interval_);
  }
  /// Whether the peak is within the unsettled end.
  bool ends_unsettled() const { return peak().extreme.time > settled_until_; }
  /// After finish. The filtered series at the stored samples.
  results::Recorder::Dataset stored() const;
  void keep(base::Bytes& bytes) { bytes(rows_, instants_); }

 private:
  double frequency_, interval_;
  std::size_t stored_each_;
  std::vector<double> stations_;
  std::vector<double> rows_;  // a row of probes for each instant
  std::size_t instants_ = 0;
  double settled_until_ = 0.0;  // s
};

}  // namespace traverse::run
