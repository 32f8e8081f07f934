// Extremes (peaks) of a run. Between samples a curve is interpolated by a polynomial of degree four
// (interpolated_extremum.hpp). The least and the greatest value at every probe form the envelopes along the bridge.
// When a wheel passes a probe, the moment there has a kink over time, and the shear jumps (probe_forces.hpp); option
// step_probes gives both an instant of their own. With damping b K both relax after that within a time of b, which may
// be much shorter than a step.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/load_movement.hpp"
#include "run/extremum_tracker.hpp"
#include "run/probe_forces.hpp"
#include "run/quantity.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// The least and the greatest value of one quantity at one probe, with their times.
struct Range {
  struct End {
    double value = 0.0, time = std::numeric_limits<double>::quiet_NaN();
    double other = 0.0;  // for a moment the shear at the same time, for a shear the moment
  };
  End least, greatest;
};

/// The signed extremes of a run above half of the largest one so far. Places are probes or wheels. Deflections are
/// relative to the line through the supports.
class ResponseExtremes {
 public:
  ResponseExtremes() = default;
  /// lag: lag of the moments, b of Rayleigh damping in s, if responses have rates; axial: the beam has axial
  /// displacements.
  ResponseExtremes(std::size_t probes, std::size_t wheels, double lag = 0.0, bool axial = false);

  /// passages: of probes since the previous instant, as of LoadMovement.
  void add(double t, std::span<const recovery::Response> probes, std::span<const double> wheel_forces,
           std::span<const recovery::StationPassage> passages = {});
  void finish();
  /// Adds the extremes of low-passed accelerations, rows of all probes at intervals of `interval` s from 0 on.
  void add_low_passed(std::span<const double> rows, double interval);
  /// The empty object of a failed run.
  static ResponseExtremes of_failure();
  bool failed() const { return failed_; }

  const std::vector<Extreme>& of(Quantity q) const { return peaks_[q]; }
  const Extreme& largest(Quantity q) const { return largest_[q]; }
  /// The largest extreme of each probe or wheel.
  const std::vector<Extreme>& largest_of_each(Quantity q) const { return largest_of_each_[q]; }
  /// The range of a probe's deflection, acceleration, moment or shear.
  const Range& range(Quantity q, std::size_t probe) const { return ranges_[probe][q]; }
  std::size_t probes() const { return ranges_.size(); }
  void keep(base::Bytes& bytes) { bytes(forces_, motions_, wheels_, peaks_, largest_, largest_of_each_, ranges_); }

 private:
  /// The motions whose extremes are tracked for each probe.
  static constexpr std::array motions = {deflection, acceleration, axial_displacement};
  void record_peak(Quantity q, std::size_t place, double value, double time);
  auto recorder_of(Quantity q, std::size_t probe);
  auto recorder_of_forces(std::size_t probe);
  void record_range(Quantity q, std::size_t probe, double value, double time, double other);

  double lag_ = 0.0;
  bool axial_ = false;
  std::vector<ProbeForces> forces_;
  std::vector<std::array<ExtremumTracker, motions.size()>> motions_;
  std::vector<ExtremumTracker> wheels_;
  std::vector<std::array<Range, quantities>> ranges_;
  std::array<std::vector<Extreme>, quantities> peaks_;
  std::array<Extreme, quantities> largest_{};
  bool failed_ = false;
  std::array<std::vector<Extreme>, quantities> largest_of_each_;
};

/// The least magnitude of the sample next to the largest extreme of a series, relative to its largest sample.
inline constexpr double share_of_largest_sample = 0.8;
/// The extreme with the largest magnitude of several series, rows of `series` values at intervals of `interval` s from
/// first * interval on; place: index of the series.
Extreme largest_peak(std::span<const double> rows, std::size_t series, double interval, std::size_t first = 0);

/// The relative difference of the largest extremes of two runs, or, if larger, twice the root mean square of the
/// differences of all extremes above 0.6 of the largest one that are nearest to each other in both runs, within
/// max_shift s, because the two largest ones may agree by chance. Wheel forces are compared by their variation about
/// the weight. 0 without extremes, 1 if a run failed.
double difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q, double max_shift);

/// The relative difference of the largest extremes only.
double peak_difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q);

/// The empty extremes of a run of the scene. lag: b of Rayleigh damping if responses have rates, s.
ResponseExtremes peaks_for(const scene::Scene& scene, std::size_t wheels, double lag);

}  // namespace traverse::run
