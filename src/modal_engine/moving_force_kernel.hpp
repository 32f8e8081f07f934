// Passages of the same moving forces at several speeds, one in each SIMD lane. All runs are sampled at the same
// distances, so that the static correction is the same number in every lane.
//
// The modes move exactly from window to window. Only windows with a bound above the largest value so far are sampled,
// at regular intervals, and peaks between samples are interpolated by parabolas. When a force passes a break of the
// influence lines in a window, only the responses with a kink there are sampled.
#pragma once

#include "modal_engine/moving_force_bounds.hpp"
#include "modal_engine/moving_force_samples.hpp"

namespace traverse::modal_engine {
namespace {

template <int W>
class MovingForceBatch : Lanes<W> {
  using Own = Lanes<W>;
  using Own::any;
  using Own::fill;
  using Own::lanes;
  using typename Own::Lane;
  using typename Own::Mask;

 public:
  MovingForceBatch(const ForceTask& task, double* work)
      : task_(task),
        modes_(task.modes),
        probes_(task.probes),
        motion_(task),
        bounds_(task, motion_),
        samples_(task, motion_) {
    lay_out(work);
  }
  long size() const { return used_ * W; }

  void run() {
    speed_ = *lanes(task_.speed);
    end_ = *lanes(task_.end);
    motion_.begin();
    bounds_.begin();
    samples_.begin();
    while (begin_windows()) {
      if (task_.only_bounds)
        record_bounds();
      else
        sample_windows();
      if (!task_.proceed(task_.context)) return;
    }
    for (int i = 0; i < 3 * probes_; ++i) {
      lanes(task_.peak)[i] = samples_.peak[i];
      lanes(task_.peak_time)[i] = samples_.place[i] / speed_;
    }
  }

 private:
  static constexpr double least_parts = 2.0;       // of a window: three samples define a parabola
  static constexpr double same_end = 1.0 + 1e-12;  // equal distances except for rounding
  static constexpr double same_step = 1.0 - 1e-9;  // equal steps except for rounding
  // Vectors for windows that are treated together, and number of these windows.
  static constexpr long most_vectors = 1024, least_windows = 48;

  /// A window with the state at its start and the bounds of the responses in it.
  struct Window {
    double start, end;             // m travelled
    long interval, last_interval;  // at its start and before its end
    Lane *state, *bound;
    double bounds[3];  // sums of the bounds of deflections, accelerations and moments
    bool sampled;
  };

  void lay_out(double* work) {
    const auto in_lanes = [&](long count) { return allocate_from<Lane>(work, used_, W, count); };
    motion_.lay_out(work, used_);
    samples_.lay_out(work, used_);
    bounds_.lay_out(work, used_);
    end_state_ = in_lanes(2L * modes_);
    const long vectors = 2L * modes_ + 3L * probes_;  // of a window
    capacity_ = most_vectors / vectors;
    if (capacity_ < least_windows || task_.only_bounds) capacity_ = least_windows;
    windows_ = allocate_from<Window>(work, used_, W, capacity_);
    Lane* const of_windows = in_lanes(capacity_ * vectors);
    for (long k = 0; work != nullptr && k < capacity_; ++k) {
      windows_[k].state = of_windows + k * vectors;
      windows_[k].bound = windows_[k].state + 2L * modes_;
    }
  }

  /// Finds the runs that have not ended at this distance; false after the end of all runs.
  bool find_runs(double at) {
    samples_.runs = at > 0.0 ? end_ > fill(at * same_end) : end_ >= Lane{};
    return any(samples_.runs);
  }

  /// Moves through as many windows as memory permits; false if there is none before the end of all runs.
  bool begin_windows() {
    for (count_ = 0; count_ < capacity_ && find_runs(motion_.s); ++count_) {
      Window& own = windows_[count_];
      own.start = motion_.s;
      own.interval = motion_.interval;
      own.end = end_of_window();
      own.sampled = false;
      motion_.copy_state(own.state);
      bounds_.find(stretch_, own.end, own.bound, own.bounds);
      const long first = task_.first_move[stretch_], past = task_.first_move[stretch_ + 1];
      for (long k = first; k < past; ++k) {
        own.last_interval = motion_.interval;
        motion_.make_move(k, past == first + 1 ? own.end : task_.move_end[k]);
      }
      motion_.place_again();
      next_window();
    }
    return count_ > 0;
  }
  bool in_last_stretch() const { return stretch_ + 1 == task_.stretches; }
  double end_of_window() const {
    if (in_last_stretch()) return motion_.s + task_.last_window;
    const double end = task_.stretch_end[stretch_], parts = task_.stretch_parts[stretch_];
    if (part_ + 1.0 == parts) return end;
    const double start = stretch_ > 0 ? task_.stretch_end[stretch_ - 1] : 0.0;
    return start + (end - start) * ((part_ + 1.0) / parts);
  }
  void next_window() {
    if (in_last_stretch()) return;
    part_ += 1.0;
    if (part_ < task_.stretch_parts[stretch_]) return;
    part_ = 0.0;
    ++stretch_;
  }

  void record_bounds() {
    for (long k = 0; k < count_; ++k) {
      find_runs(windows_[k].start);
      const Lane* bound = windows_[k].bound;
      for (int i = 0; i < 3 * probes_; ++i) {
        Lane& largest = samples_.peak[i];
        largest = samples_.runs & (bound[i] > largest) ? bound[i] : largest;
      }
    }
  }

  /// Samples the windows that may have a peak: those with the largest bounds first, so that the others hardly have one.
  void sample_windows() {
    const double end = motion_.s;
    const long end_interval = motion_.interval;
    motion_.copy_state(end_state_);
    for (int kind = 0; kind < 3; ++kind) sample_window(windows_[largest_bounds(kind)]);
    for (long k = 0; k < count_; ++k) sample_window(windows_[k]);
    motion_.set_state(end_state_, end_interval, end);
  }
  /// The window with the largest bounds of a kind of response, in the mean of all probes and runs.
  long largest_bounds(int kind) const {
    long found = 0;
    for (long k = 1; k < count_; ++k)
      if (windows_[k].bounds[kind] > windows_[found].bounds[kind]) found = k;
    return found;
  }

  void sample_window(Window& own) {
    if (own.sampled || !find_runs(own.start) || !samples_.begin_window(own.bound)) return;
    own.sampled = true;
    last_interval_ = own.last_interval;
    find_next_end();
    motion_.set_state(own.state, own.interval, own.start);
    const double wanted = __builtin_ceil((own.end - own.start) / task_.ds * same_step);
    const double parts = wanted > least_parts ? wanted : least_parts, step = (own.end - own.start) / parts;
    motion_.set_step(step);
    samples_.sample();
    for (double k = 1.0; k <= parts && any(samples_.runs); k += 1.0)
      advance_to(k < parts ? own.start + k * step : own.end);
    samples_.end_window();
  }

  bool has_event_until(double to) const { return motion_.interval < last_interval_ && motion_.next_event() <= to; }

  void advance_to(double to) {
    if (!has_event_until(to)) {
      end_runs_until(to);
      motion_.move_regularly(to);
    } else {
      while (has_event_until(to)) {
        const double event = motion_.next_event();
        end_runs_until(event);
        motion_.move_to(event);
        pass_event();
      }
      end_runs_until(to);
      motion_.move_to(to);
    }
    samples_.sample();
  }

  void pass_event() {
    const int first = task_.first_kink[motion_.interval + 1], past = task_.first_kink[motion_.interval + 2];
    for (int k = first; k < past; ++k) samples_.sample_before_kink(task_.kink[k]);
    motion_.enter_next();
    for (int k = first; k < past; ++k) samples_.start_after_kink(task_.kink[k]);
  }

  void find_next_end() {
    next_end_ = 1e300;
    for (int l = 0; l < W; ++l)
      if (Own::is_set(samples_.runs, l) && Own::numbers(end_)[l] < next_end_) next_end_ = Own::numbers(end_)[l];
  }

  /// Samples the runs that end before the distance `to`, which lies in this interval, at their ends.
  void end_runs_until(double to) {
    if (next_end_ > to * same_end) return;
    const Mask ending = samples_.runs & (end_ <= fill(to * same_end));
    const Lane at = ending ? end_ : fill(motion_.s);
    motion_.move_lanes(at);
    samples_.sample_ends(ending, at);
    motion_.move_back();
    samples_.runs &= ~ending;
    find_next_end();
  }

  const ForceTask& task_;
  const int modes_, probes_;
  ForcedModes<W> motion_;
  WindowBounds<W> bounds_;
  ForceSamples<W> samples_;
  long used_ = 0;
  Lane speed_{}, end_{};
  double next_end_ = 0.0;      // distance at which the next of the runs ends, m
  Window* windows_ = nullptr;  // windows that are treated together
  long capacity_ = 0, count_ = 0;
  long stretch_ = 0;           // of the next window
  double part_ = 0.0;          // windows before it in this stretch
  long last_interval_ = 0;     // of the window that is sampled
  Lane* end_state_ = nullptr;  // after these windows
};

}  // namespace
}  // namespace traverse::modal_engine
