// Extremes (peaks) of sampled curves; `accuracy` promises their errors. Between samples a curve is of fourth degree
// (turn.hpp). Where a wheel passes a probe the moment has a kink, which gets a sample of its own (option step_probes).
// With damping b K the moment relaxes behind the kink within a time of b, which may be much shorter than a step.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "recovery/recovery.hpp"
#include "run/turn.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

enum Quantity : std::size_t { deflection, acceleration, moment, wheel_force, low_passed, quantities };
inline constexpr std::array<const char*, quantities> quantity_names = {"deflection", "acceleration", "moment",
                                                                       "wheel force", "low-passed acceleration"};
/// The same in options and in the results file.
inline constexpr std::array<const char*, quantities> stored_names = {"deflection", "acceleration", "moment",
                                                                     "wheel_force", "acceleration_lowpass"};

struct Peak {
  double value = 0.0;  // signed
  double time = 0.0;   // s
  int place = 0;       // probe or wheel
};

/// The extremes of one curve, as samples come.
class Curve {
 public:
  /// Calls note(value, time) for the extreme that is known with this sample, two after it. kinks: ascending times at
  /// which the curve may have one.
  template <class Note>
  void add(double t, double value, const std::vector<double>& kinks, Note&& note);
  /// After the last sample: the extreme just before it.
  template <class Note>
  void rest(const std::vector<double>& kinks, Note&& note) const {
    if (seen_.count >= 3) look(3, kinks, note);
  }
  /// That, and its value counts too.
  template <class Note>
  void finish(const std::vector<double>& kinks, Note&& note) const {
    rest(kinks, note);
    if (seen_.count > 0) note(seen_.value.back(), seen_.time.back());
  }
  /// How far the latest three samples are from a straight line: their second difference, 0 where they are fewer.
  double bend() const;

 private:
  /// If the sample at i is extreme.
  template <class Note>
  void look(std::size_t i, const std::vector<double>& kinks, Note&& note) const;

  Samples seen_;
};

/// The extremes of a curve M that follows a smooth one by M + b dM/dt, but for its kinks, which have samples.
class RelaxingCurve {
 public:
  /// b in s. Between samples of values and rates M is a second power and exp(-t/b).
  template <class Note>
  void add(double t, double value, double rate, double b, Note&& note);
  template <class Note>
  void finish(Note&& note) const {
    if (known_) note(value_, time_);
  }

 private:
  double time_ = 0.0, value_ = 0.0, rate_ = 0.0;  // the latest sample
  bool known_ = false;
};

/// Of curves from sample to sample, over their largest value.
struct Bends {
  double acceleration = 0.0, wheel_force = 0.0;
  /// How many times as large these are as others, the worse of both; infinite where those are none.
  double times(const Bends& others) const;
};

/// The extremes of a run: those above half of the largest so far.
class Peaks {
 public:
  Peaks() = default;
  /// passages: of each probe, the times at which something passes it; lag: of the moments, b of Rayleigh damping in s,
  /// where responses have rates.
  Peaks(std::vector<std::vector<double>> passages, std::size_t wheels, double lag = 0.0);

  void add(double t, std::span<const beam::Response> probes, std::span<const double> wheel_forces);
  void finish();
  /// The extremes of low-passed accelerations, rows of all probes at instants `interval` s apart from 0 on.
  void add_low_passed(std::span<const double> rows, double interval);
  /// The peaks of a run that failed: there are none.
  static Peaks of_failure();
  bool failed() const { return failed_; }

  const std::vector<Peak>& of(Quantity q) const { return found_[q]; }
  const Peak& largest(Quantity q) const { return largest_[q]; }
  /// How much accelerations and wheel forces bend from sample to sample, at most, over their largest: since the start,
  /// or since they were forgotten.
  Bends bends() const;
  void forget_bends() { bend_ = {}; }
  /// The largest extreme of each probe or wheel.
  const std::vector<Peak>& largest_of_each(Quantity q) const { return each_[q]; }
  void keep(base::Bytes& bytes) { bytes(moments_, probes_, wheels_, found_, largest_, each_, bend_); }

 private:
  void note(Quantity q, std::size_t place, double value, double time);

  std::vector<std::vector<double>> passages_;
  double lag_ = 0.0;
  std::vector<RelaxingCurve> moments_;  // of the probes' moments where these lag; otherwise they are in probes_
  std::vector<std::array<Curve, wheel_force>> probes_;
  std::vector<Curve> wheels_;
  std::array<std::vector<Peak>, quantities> found_;
  std::array<Peak, quantities> largest_{};
  Bends bend_;  // in m/s2 and N
  bool failed_ = false;
  std::array<std::vector<Peak>, quantities> each_;
};

/// The extreme of largest magnitude of series side by side, rows of `series` at instants `interval` s apart from 0 on;
/// place: which series.
Peak largest_peak(std::span<const double> rows, std::size_t series, double interval);

/// The relative difference of the largest extremes of two runs, or, where that is larger, twice the root mean square of
/// the differences of all extremes above 0.6 of the largest one that are each other's nearest in both runs, within
/// `reach` s: the largest two may agree by chance. Wheel forces are compared by how they vary about the weight. 0 where
/// there are no extremes, 1 where a run failed.
double difference(const Peaks& rough, const Peaks& fine, Quantity q, double reach);

/// The relative difference of the largest extremes alone.
double peak_difference(const Peaks& rough, const Peaks& fine, Quantity q);

/// For each probe of the scene the times at which wheels and forces pass it, s. Empty where x of the wheels is not
/// known beforehand, or where they run on the rail of a layered track.
std::vector<std::vector<double>> passages_of(const Scene& scene);

}  // namespace traverse::app
