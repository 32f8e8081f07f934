// The deck's acceleration as practice judges it: up to a frequency that counts, above which it is filtered out.
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

namespace traverse::app {

/// Whether a transient run of the scene filters the accelerations of its probes, where its steps allow.
bool filters_deck(const Scene& scene);

/// Whether there are two frequencies for certain, and finding them takes no time.
bool frequencies_are_cheap(const beam::Beam& beam);

/// Collective. Hz, ascending: the first three distinct frequencies of bending; with model_modes those of its modes.
std::vector<double> first_frequencies(const SharedBeam& shared);

/// Collective, after SharedBeam::prepare. The frequency (Hz) up to which accelerations count in this scene; 0: they are
/// not filtered. As the scene says, else the greatest of 30 Hz, 1.5 f1 and f3, of the bridge's distinct frequencies of
/// bending. affordable: whether to compute these. Says in `notes` what was chosen.
double frequency_that_counts(const Scene& scene, const SharedBeam& shared, bool affordable,
                             std::vector<std::string>& notes);

/// Longest distance between instants, s, at which an acceleration is filtered well.
double spacing_for(double frequency);
/// The same beyond which it is not filtered.
double longest_spacing_for(double frequency);

/// The end of a series, s, in which the filter knows too little of what follows: there it gives about what it was
/// given, with all that is above its frequency.
double unsettled_end(double frequency);

/// Why so many series of a run of this plan cannot be filtered at this frequency; empty where they can. what: "probes",
/// which fewer output_probes make fewer, or "wheels".
std::string no_filter(double frequency, const Plan& plan, std::size_t series, const char* what = "probes");

/// The peak of accelerations that have been filtered; rows: of all stations at each instant.
results::LowPassed peak_of(const std::vector<double>& rows, const std::vector<double>& stations, double frequency,
                           double interval);

/// Filters series, rows of `count` at instants `interval` s apart from 0 on. Returns how many of the rows lie before
/// the unsettled end.
std::size_t filter(std::vector<double>& rows, std::size_t count, double frequency, double interval);

/// Keeps the acceleration of every probe at the plan's interval until the end of the run, when it is filtered. Eight
/// bytes an instant and probe, `most_kept` at most.
class DeckAcceleration {
 public:
  static constexpr double most_kept = 33554432.0;  // numbers, 256 MB

  DeckAcceleration(double frequency, const Plan& plan, const std::vector<double>& stations);

  /// Takes an instant at a multiple of the plan's interval, and leaves out the others.
  void add(double t, std::span<const beam::Response> probes);
  /// After the last instant, once: filters all series, and adds the extremes before their unsettled ends to the peaks.
  void finish(ResponseExtremes& peaks);
  /// After finish. The peak of the whole series.
  results::LowPassed peak() const { return peak_of(kept_, stations_, frequency_, interval_); }
  /// Whether that is within the unsettled end.
  bool ends_unsettled() const { return peak().extreme.time > settled_until_; }
  /// After finish. The filtered series at the stored samples.
  results::Recorder::Dataset stored() const;
  void keep(base::Bytes& bytes) { bytes(kept_, instants_); }

 private:
  double frequency_, interval_;
  std::size_t stored_each_;
  std::vector<double> stations_;
  std::vector<double> kept_;  // a row of probes for each instant
  std::size_t instants_ = 0;
  double settled_until_ = 0.0;  // s
};

}  // namespace traverse::app
