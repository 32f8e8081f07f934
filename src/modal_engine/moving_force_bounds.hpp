// Bounds of the responses in a window, in the lanes of a batch of passages: of force_bounds.hpp, and a closer one for
// accelerations. The acceleration -(omega^2 y + 2 sigma y') of a free oscillation is a free oscillation as well. In a
// window that is short for a mode it is a linear function of the time, plus at most its amplitude times (omega t)^2
// / 2.
#pragma once

#include "modal_engine/moving_force_motion.hpp"

namespace traverse::modal_engine {
namespace {

template <int W>
class WindowBounds : Lanes<W> {
  using Own = Lanes<W>;
  using Own::greater;
  using Own::magnitude;
  using Own::root;

 public:
  using typename Own::Lane;

  WindowBounds(const ForceTask& task, const ForcedModes<W>& motion)
      : task_(task), modes_(task.modes), probes_(task.probes), motion_(motion) {}

  void lay_out(double* work, long& used) {
    Lane** const of_modes[] = {&amplitude_, &acceleration_, &value_, &change_, &saved_};
    for (Lane** own : of_modes) *own = allocate_from<Lane>(work, used, W, modes_);
    flexibility_ = allocate_from<double>(work, used, W, modes_);
    stiffness_ = allocate_from<double>(work, used, W, modes_);
    slow_ = allocate_from<int>(work, used, W, modes_);
  }
  void begin() {
    speed_ = *Own::lanes(task_.speed);
    for (int i = 0; i < modes_; ++i) {
      const double omega2 = task_.omega2[i];
      flexibility_[i] = 1.0 / omega2;
      stiffness_[i] = omega2 * largest_ratio(task_.damping[i] * task_.damping[i] / omega2);
    }
  }

  /// Bounds of the responses from the present distance to the end of a window in a stretch, and for each kind of
  /// response the sum of all probes and runs.
  void find(long stretch, double end, Lane* bound, double* sums) {
    const double *mode = task_.stretch_numbers + stretch * (2L * modes_ + 6L * probes_), *response = mode + 2L * modes_;
    find_amplitudes(mode, end - motion_.s);
    for (int kind = 0, i = 0; kind < 3; ++kind) {
      Lane sum{};
      for (int p = 0; p < probes_; ++p, ++i) {
        bound[i] = response[i] + response[3 * probes_ + i] * speed_;
        if (kind == 1)
          bound[i] += of_acceleration(p);
        else
          for (int k = 0; k < modes_; ++k) bound[i] += by_amplitude(k, kind / 2, p) * amplitude_[k];
        bound[i] *= 1.0 + rounding;
        sum += bound[i];
      }
      sums[kind] = 0.0;
      for (int lane = 0; lane < W; ++lane) sums[kind] += Own::numbers(sum)[lane];
    }
  }

 private:
  static constexpr double rounding = 1e-9;    // relative error of bounds, and much more
  static constexpr double short_phase = 1.0;  // of a slow mode in a window

  /// kind: 0 for deflections, 1 for moments.
  double by_amplitude(int mode, int kind, int probe) const {
    return task_.by_amplitude[(2L * mode + kind) * probes_ + probe];
  }

  /// The largest amplitude of (omega^2 y + 2 sigma y') / omega^2 over that of y, from the square of 2 sigma / omega:
  /// the norm of the matrix (1, d; -d, 1 - d^2).
  static double largest_ratio(double square) {
    const double a = 1.0 + square, b = square + (1.0 - square) * (1.0 - square), mixed = square * square * square;
    return __builtin_sqrt(0.5 * (a + b + __builtin_sqrt((a - b) * (a - b) + 4.0 * mixed)));
  }

  void find_amplitudes(const double* mode, double length) {
    const Lane time = length / speed_, half_square = 0.5 * time * time;
    const double longest = length / task_.least_speed;
    slow_count_ = 0;
    for (int i = 0; i < modes_; ++i) {
      const double omega2 = task_.omega2[i], damping = task_.damping[i], flexibility = flexibility_[i];
      const Lane y = motion_.deviation(i, flexibility), rate = motion_.deviation_rate(i, flexibility);
      const Lane forced = mode[2 * i] * speed_ + mode[2 * i + 1];
      const Lane free = root(y * y + flexibility * rate * rate);
      amplitude_[i] = free + forced;
      acceleration_[i] = stiffness_[i] * amplitude_[i];
      if (stiffness_[i] * longest * longest > short_phase * short_phase) continue;
      slow_[slow_count_++] = i;
      value_[i] = omega2 * y + damping * rate;
      change_[i] = (omega2 * rate - damping * value_[i]) * time;
      saved_[i] = stiffness_[i] * free * (1.0 - stiffness_[i] * half_square);
    }
  }

  /// The lesser of the sum of all amplitudes and the bound with linear functions of the slow modes.
  Lane of_acceleration(int p) const {
    Lane sum{}, start{}, change{}, saved{};
    for (int k = 0; k < modes_; ++k) sum += by_amplitude(k, 0, p) * acceleration_[k];
    for (int s = 0; s < slow_count_; ++s) {
      const int k = slow_[s];
      const double shape = task_.deflection[k * probes_ + p];
      start += shape * value_[k];
      change += shape * change_[k];
      saved += by_amplitude(k, 0, p) * saved_[k];
    }
    const Lane linear = greater(magnitude(start), magnitude(start + change));
    return linear < saved ? sum - saved + linear : sum;
  }

  const ForceTask& task_;
  const int modes_, probes_;
  const ForcedModes<W>& motion_;
  Lane speed_{};
  // For each mode: A; the bound of omega^2 y + 2 sigma y'. Of a slow mode: its value at the start of the window, its
  // linear change until the end, and by how much the bound of its difference from this linear function is less.
  Lane *amplitude_ = nullptr, *acceleration_ = nullptr, *value_ = nullptr, *change_ = nullptr, *saved_ = nullptr;
  double *flexibility_ = nullptr, *stiffness_ = nullptr;  // 1 / omega^2; acceleration over A
  int* slow_ = nullptr;                                   // modes whose phase changes little in the window
  int slow_count_ = 0;
};

}  // namespace
}  // namespace traverse::modal_engine
