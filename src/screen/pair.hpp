// The verdict on a formation over a bridge: a bound for each speed, and passages where it does not decide.
#pragma once

#include <limits>
#include <vector>

#include "screen/bridge_model.hpp"
#include "screen/fleet.hpp"
#include "screen/peak_search.hpp"
#include "screen/screen_task.hpp"
#include "screen/train_events.hpp"

namespace traverse::screen {

enum class DecidedBy { nothing, bound, passages };  // nothing: no speed of the screen is permitted to both

struct Verdict {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double bound = unknown;  // the largest bound over the speeds, relative to the limits
  /// The largest response over the speeds, relative to its limit: exact if passages decided, otherwise the bound.
  double ratio = unknown;
  double ratio_speed = unknown;  // m/s, at which it occurs
  double permitted = unknown;    // m/s: at this speed and all lower ones the limits are kept; 0: at none
  DecidedBy decided_by = DecidedBy::nothing;
  double exceeding = 0.0;  // number of speeds at which a limit is exceeded
};

/// Formations over one bridge. An object is used by one thread.
class Pairs {
 public:
  /// The model must outlive this object.
  explicit Pairs(const BridgeModel& model);

  Verdict judge(const Formation& formation);
  /// The bound at each of the speeds permitted to both, relative to the limits.
  std::vector<double> bounds(const Formation& formation);
  /// The computed value at each of these speeds: every interval is sampled, whatever its bound.
  std::vector<double> passages(const Formation& formation);
  /// The number of intervals sampled so far.
  long sampled() const { return sampled_; }

 private:
  void begin(const Formation& formation);
  std::size_t permitted_speeds(const Formation& formation) const;
  void set_group(std::size_t group);
  void bound_group(std::size_t group);
  /// The largest fraction of a limit for each lane of a group, where it is above the lane's number in limit_; by
  /// samples of every interval, or of those whose bound is above it.
  void pass_group(std::size_t group, bool every);
  void decide_by_passages(Verdict& verdict);
  /// Takes the results of a group into a verdict.
  void add_group(std::size_t group, Verdict& verdict) const;

  const BridgeModel& model_;
  TrainEvents events_;
  PeakSearch search_;
  ScreenTask task_;
  std::vector<double> beta_, omega2_, lambda2_, size_, bounds_;
  engine::Aligned limit_{lanes}, result_{lanes}, work_{0};
  std::size_t work_size_ = 0, group_ = 0;
  long sampled_ = 0;
};

}  // namespace traverse::screen
