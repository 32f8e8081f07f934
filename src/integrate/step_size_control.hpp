// Lengths of adaptive steps: the longest step halved k times, with the level k. A few factorisations are sufficient for
// all levels, and if the longest step divides the sampling interval, the shorter ones do too. Steps of a run are
// counted before it, from the times at which they have to end.
#pragma once

#include <vector>

namespace traverse::integrate {

/// `whole` divided into the smallest number of equal steps that are not longer than `most`.
double shared_evenly(double whole, double most);

class StepSizeControl {
 public:
  explicit StepSizeControl(double longest) : longest_(longest) {}

  /// The longest step that the errors so far allow, s.
  double allowed_step() const { return length(level_); }
  double length(int level) const;

  /// Whether a step of h (s) is accurate enough; error: error over the tolerance. If not, allowed_step() becomes
  /// shorter than h. On the highest level all steps are accepted, because shorter steps would not reduce the error at a
  /// jump.
  bool evaluate(double h, double error);
  /// The next step, if `remaining` (s) is the time until a step has to end; not longer than allowed_step() and `most`
  /// (s). All steps have the length of a level, except the last ones before an end that is not a multiple of it.
  double next_step(double remaining, double most) const;

 private:
  int level_within(double most) const;

  double longest_;
  int level_ = 0;  // 0: the longest
  int accurate_steps_ =
      0;  // number of successive steps on this level that would be accurate enough on the next longer one
};

/// Counts the steps of a run before it, from the times at which steps have to end.
struct StepCount {
  double steps = 0.0;
  double lengths = 0.0;  // lengths of steps for which the beam's matrix has to be factored, also again
};

/// Steps of at most `longest` from 0 to `end` that end at every multiple of `interval` and at `stops` (ascending), all
/// in s: between two ends they are equal, as in Stepper::run. The factorisations for the last `stored` lengths are
/// kept.
StepCount count_steps(double end, double interval, double longest, const std::vector<double>& stops,
                      std::size_t stored);

}  // namespace traverse::integrate
