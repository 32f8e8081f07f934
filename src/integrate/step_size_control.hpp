// Lengths of adaptive steps from a ladder, the longest step halved again and again: a handful of factorisations serves
// all of them, and where the longest step fits between samples the shorter ones do.
#pragma once

namespace traverse::integrate {

/// The length of as few equal steps as go into `whole`, no longer than `most`.
double shared_evenly(double whole, double most);

class StepSizeControl {
 public:
  explicit StepSizeControl(double longest) : longest_(longest) {}

  /// The longest step that the errors so far allow, s.
  double wanted() const { return length(level_); }
  double length(int level) const;

  /// Whether a step of h (s) with this error, as part of the tolerance, is good enough; `wanted` is shorter than h
  /// where not. On the lowest rung all are: shorter ones would not make a jump smaller.
  bool judge(double h, double error);
  /// The step to take when there are `left` (s) until the next one has to end, no longer than wanted and `most` (s).
  /// All steps are rungs of the ladder, but for the last ones before an end that is off the ladder.
  double towards(double left, double most) const;

 private:
  int rung_within(double most) const;

  double longest_;
  int level_ = 0;  // 0: the longest
  int calm_ = 0;   // steps on this rung after each other that would have been good enough on the next one
};

}  // namespace traverse::integrate
