// What follows a run in time: recorders, checkpoints, displays. The run itself evaluates peaks and diagnostics.
#pragma once

#include <functional>
#include <utility>

#include "integrate/stepper.hpp"

namespace traverse::run {

class Observer {
 public:
  virtual ~Observer() = default;
  /// Collective. At t = 0 and at the end of every step, after the evaluation of this instant.
  virtual void sample(const integrate::Instant& /*instant*/) {}
  /// Collective. At the end of every step, t in s. False: the run stops here, and may be continued.
  virtual bool step(double /*t*/, long /*steps*/) { return true; }
  /// Collective. Before every step, after all calls for earlier steps: the run may be archived.
  virtual void before_step(double /*t*/) {}
};

/// An observer by functions; an empty one does nothing.
class ObserverBy : public Observer {
 public:
  using Sample = std::function<void(const integrate::Instant&)>;
  using Step = std::function<bool(double, long)>;
  explicit ObserverBy(Sample sample, Step step = {}) : sample_(std::move(sample)), step_(std::move(step)) {}
  void sample(const integrate::Instant& instant) override {
    if (sample_) sample_(instant);
  }
  bool step(double t, long steps) override { return !step_ || step_(t, steps); }

 private:
  Sample sample_;
  Step step_;
};

}  // namespace traverse::run
