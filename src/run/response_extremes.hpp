// Extremes (peaks) of a run; `accuracy` promises their errors. Between samples a curve is of fourth degree (turn.hpp).
// The least and the greatest of every probe are the envelopes along the bridge. Where a wheel passes a probe the moment
// has a kink, which gets a sample of its own (option step_probes), and the shear jumps (probe_forces.hpp). With damping
// b K they relax behind that within a time of b, which may be much shorter than a step.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"
#include "run/extremum_tracker.hpp"
#include "run/probe_forces.hpp"
#include "run/quantity.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// The least and the greatest of one quantity at one probe, and when.
struct Range {
  struct End {
    double value = 0.0, time = std::numeric_limits<double>::quiet_NaN();
    double other = 0.0;  // of a moment the shear that belongs to it, of a shear the moment
  };
  End least, greatest;
};

/// Of curves from sample to sample, over their largest value.
struct SecondDifference {
  double acceleration = 0.0, wheel_force = 0.0;
  /// How many times as large these are as others, the worse of both; infinite where those are none.
  double times(const SecondDifference& others) const;
};

/// The extremes of a run, signed: those above half of the largest so far. Places are probes or wheels.
class ResponseExtremes {
 public:
  ResponseExtremes() = default;
  /// passages: of each probe, the times at which something passes it; lag: of the moments, b of Rayleigh damping in s,
  /// where responses have rates; axial: the beam has axial displacements; passages_known: passages are all there are.
  ResponseExtremes(std::vector<std::vector<double>> passages, std::size_t wheels, double lag = 0.0, bool axial = false,
                   bool passages_known = true);

  void add(double t, std::span<const beam::Response> probes, std::span<const double> wheel_forces);
  void finish();
  /// The extremes of low-passed accelerations, rows of all probes at instants `interval` s apart from 0 on.
  void add_low_passed(std::span<const double> rows, double interval);
  /// The peaks of a run that failed: there are none.
  static ResponseExtremes of_failure();
  bool failed() const { return failed_; }

  const std::vector<Extreme>& of(Quantity q) const { return found_[q]; }
  const Extreme& largest(Quantity q) const { return largest_[q]; }
  /// How much accelerations and wheel forces bend from sample to sample, at most, over their largest: since the start,
  /// or since they were forgotten.
  SecondDifference roughness() const;
  void forget_roughness() { roughness_ = {}; }
  /// The largest extreme of each probe or wheel.
  const std::vector<Extreme>& largest_of_each(Quantity q) const { return each_[q]; }
  /// Of a probe's deflection, acceleration, moment or shear.
  const Range& range(Quantity q, std::size_t probe) const { return ranges_[probe][q]; }
  std::size_t probes() const { return ranges_.size(); }
  void keep(base::Bytes& bytes) { bytes(forces_, motions_, wheels_, found_, largest_, each_, ranges_, roughness_); }

 private:
  /// Of a probe: deflection, acceleration, axial displacement.
  static constexpr std::array motions = {deflection, acceleration, axial_displacement};
  void note(Quantity q, std::size_t place, double value, double time);
  auto record_of(Quantity q, std::size_t probe);
  auto record_of_forces(std::size_t probe);
  void record_range(Quantity q, std::size_t probe, double value, double time, double other);

  std::vector<std::vector<double>> passages_;
  double lag_ = 0.0;
  bool axial_ = false;
  std::vector<ProbeForces> forces_;
  std::vector<std::array<ExtremumTracker, motions.size()>> motions_;
  std::vector<ExtremumTracker> wheels_;
  std::vector<std::array<Range, quantities>> ranges_;
  std::array<std::vector<Extreme>, quantities> found_;
  std::array<Extreme, quantities> largest_{};
  SecondDifference roughness_;  // in m/s2 and N
  bool failed_ = false;
  std::array<std::vector<Extreme>, quantities> each_;
};

/// The extreme of largest magnitude of series side by side, rows of `series` at instants `interval` s apart from 0 on;
/// place: which series.
Extreme largest_peak(std::span<const double> rows, std::size_t series, double interval);

/// The relative difference of the largest extremes of two runs, or, where that is larger, twice the root mean square of
/// the differences of all extremes above 0.6 of the largest one that are each other's nearest in both runs, within
/// `reach` s: the largest two may agree by chance. Wheel forces are compared by how they vary about the weight. 0 where
/// there are no extremes, 1 where a run failed.
double difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q, double reach);

/// The relative difference of the largest extremes alone.
double peak_difference(const ResponseExtremes& rough, const ResponseExtremes& fine, Quantity q);

/// For each probe of the scene the times at which wheels and forces pass it, s. Empty where x of the wheels is not
/// known beforehand, or where they run on the rail of a layered track.
std::vector<std::vector<double>> passages_of(const Scene& scene);
/// Whether nothing else passes them.
bool knows_passages(const Scene& scene);
/// The peaks of a run of the scene, as yet none. lag: b of Rayleigh damping where responses have rates, s.
ResponseExtremes peaks_for(const Scene& scene, std::size_t wheels, double lag);

}  // namespace traverse::app
