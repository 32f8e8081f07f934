// Extremes of sampled curves, of whose errors `accuracy` speaks. Between samples they are those of parabolas. Where a
// wheel passes a probe the moment has a kink, at a sample of its own (option step_probes); with damping b K it relaxes
// behind it, within times of b, which may be much shorter than a step.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "traverse/app/scene.hpp"
#include "traverse/beam/recovery.hpp"

namespace traverse::app {

enum Quantity : std::size_t { deflection, acceleration, moment, wheel_force, quantities };
inline constexpr std::array<const char*, quantities> quantity_names = {"deflection", "acceleration", "moment",
                                                                       "wheel force"};

struct Peak {
  double value = 0.0;  // signed
  double time = 0.0;   // s
  int place = 0;       // probe or wheel
};

/// The extremes of one curve, as samples come.
class Curve {
 public:
  /// Calls note(value, time) for the extreme that is known with this sample. kinks: ascending times at which the curve
  /// may have one.
  template <class Note>
  void add(double t, double value, const std::vector<double>& kinks, Note&& note);
  /// After the last sample: its value counts too.
  template <class Note>
  void finish(Note&& note) const {
    if (count_ > 0) note(value_[2], time_[2]);
  }

 private:
  std::array<double, 3> time_{}, value_{};  // the latest samples, the last one at the end
  std::size_t count_ = 0;
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

/// The extremes of a run: those above half of the largest so far.
class Peaks {
 public:
  Peaks() = default;
  /// passages: of each probe, the times at which something passes it; lag: of the moments, b of Rayleigh damping in s,
  /// where responses have rates.
  Peaks(std::vector<std::vector<double>> passages, std::size_t wheels, double lag = 0.0);

  void add(double t, std::span<const beam::Response> probes, std::span<const double> wheel_forces);
  void finish();
  /// There are none: the run failed.
  static Peaks of_failure();
  bool failed() const { return failed_; }

  const std::vector<Peak>& of(Quantity q) const { return found_[q]; }
  const Peak& largest(Quantity q) const { return largest_[q]; }
  /// Of each probe or wheel.
  const std::vector<Peak>& largest_of_each(Quantity q) const { return each_[q]; }

 private:
  void note(Quantity q, std::size_t place, double value, double time);

  std::vector<std::vector<double>> passages_;
  double lag_ = 0.0;
  std::vector<RelaxingCurve> moments_;  // instead, where they lag
  std::vector<std::array<Curve, wheel_force>> probes_;
  std::vector<Curve> wheels_;
  std::array<std::vector<Peak>, quantities> found_;
  std::array<Peak, quantities> largest_{};
  bool failed_ = false;
  std::array<std::vector<Peak>, quantities> each_;
};

/// What the largest extremes of two runs differ by, relative to them: or what those near them (above 0.9; of wheel
/// forces, of what they vary by) that lie in both within `reach` s of each other let expect, where the largest ones
/// agree by chance. 0 where there are none, 1 where a run failed.
double difference(const Peaks& rough, const Peaks& fine, Quantity q, double reach);

/// What the largest ones alone differ by.
double peak_difference(const Peaks& rough, const Peaks& fine, Quantity q);

/// When wheels and forces pass each probe of the scene, where their x is known beforehand and the beam carries them
/// itself; else none.
std::vector<std::vector<double>> passages_of(const Scene& scene);

}  // namespace traverse::app
