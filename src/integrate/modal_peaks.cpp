#include "traverse/integrate/modal_peaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace traverse::integrate {
namespace {

constexpr double instants_a_period = 20.0;  // of the fastest mode

/// The vertex of the parabola through three instants, where the middle one is the largest.
Peak vertex(const std::array<double, 3>& t, const std::array<double, 3>& y) {
  const double before = (y[1] - y[0]) / (t[1] - t[0]), after = (y[2] - y[1]) / (t[2] - t[1]);
  const double bend = (after - before) / (t[2] - t[0]);
  const double at = 0.5 * (t[0] + t[1]) - 0.5 * before / bend;
  return {y[1] + (at - t[1]) * (before + bend * (at - t[0])), at};
}

/// A response over time, from instant to instant.
class Curve {
 public:
  void add(double t, double value) {
    if (count_ > 2) {
      t_ = {t_[1], t_[2], t};
      y_ = {y_[1], y_[2], value};
    } else {
      t_[count_] = t;
      y_[count_] = value;
    }
    ++count_;
    peak_.note(std::abs(value), t);
    if (count_ < 3) return;
    const double sign = y_[1] < 0.0 ? -1.0 : 1.0;
    const std::array<double, 3> y = {sign * y_[0], sign * y_[1], sign * y_[2]};
    if (y[1] <= peak_.value * near || y[1] < y[0] || y[1] < y[2] || (y[1] == y[0] && y[1] == y[2])) return;
    const Peak top = vertex(t_, y);
    peak_.note(top.value, top.time);
  }
  /// What comes has a kink with what was.
  void restart() {
    if (count_ == 0) return;
    t_[0] = t_[std::min<std::size_t>(count_, 3) - 1];
    y_[0] = y_[std::min<std::size_t>(count_, 3) - 1];
    count_ = 1;
  }
  const Peak& peak() const { return peak_; }

 private:
  static constexpr double near = 0.9;  // of the largest so far: no vertex of less can be larger
  std::size_t count_ = 0;
  std::array<double, 3> t_{}, y_{};
  Peak peak_;
};

/// The responses of all probes at one instant.
struct Seen {
  std::vector<double> deflection, acceleration, moment;
};

void see(const ModalBridge& bridge, const ModalMotion& motion, Seen& seen) {
  const ModalProbes& probes = bridge.probes();
  const std::size_t n = probes.count;
  seen.deflection = probes.weight_deflection;
  seen.moment = probes.weight_moment;
  seen.acceleration.assign(n, 0.0);
  motion.add_channels(bridge.modes(), n, seen.deflection.data());
  motion.add_channels(bridge.modes() + n, n, seen.moment.data());
  for (std::size_t i = 0; i < bridge.modes(); ++i) {
    const double q = motion.q()[i], rate = motion.rate()[i], acceleration = motion.acceleration()[i];
    const double *deflection = &probes.deflection[i * n], *moment = &probes.moment[i * n];
    const double *by_rate = &probes.moment_by_rate[i * n], *by_acceleration = &probes.moment_by_acceleration[i * n];
    for (std::size_t p = 0; p < n; ++p) {
      seen.deflection[p] += deflection[p] * q;
      seen.acceleration[p] += deflection[p] * acceleration;
      seen.moment[p] += moment[p] * q + by_rate[p] * rate + by_acceleration[p] * acceleration;
    }
  }
}

struct ProbeCurves {
  Curve deflection, acceleration, moment;
};

}  // namespace

std::vector<ProbePeaks> modal_peaks(const ModalBridge& bridge, const ForceHistory& history, double speed,
                                    bool equilibrium, double end_time) {
  ModalMotion motion(bridge, history, speed, equilibrium);
  const double fastest = *std::max_element(bridge.omega().begin(), bridge.omega().end());
  const double interval = 2.0 * std::numbers::pi / fastest / instants_a_period;
  motion.expect(interval);
  std::vector<ProbeCurves> curves(bridge.probes().count);
  Seen seen;
  const auto look = [&] {
    see(bridge, motion, seen);
    for (std::size_t p = 0; p < curves.size(); ++p) {
      curves[p].deflection.add(motion.time(), seen.deflection[p]);
      curves[p].acceleration.add(motion.time(), seen.acceleration[p]);
      curves[p].moment.add(motion.time(), seen.moment[p]);
    }
  };
  look();
  while (motion.time() < end_time) {
    // Instants count from the last event: steps of the expected length cost least.
    const double event = std::min(motion.next_event(), end_time);
    const double from = motion.time();
    for (int i = 1; from + i * interval < event; ++i) {
      motion.advance(from + i * interval);
      look();
    }
    motion.advance(event);
    look();
    motion.pass_event();
    for (ProbeCurves& c : curves) {
      c.deflection.restart();
      c.acceleration.restart();
      c.moment.restart();
    }
  }
  std::vector<ProbePeaks> peaks;
  for (const ProbeCurves& c : curves) peaks.push_back({c.deflection.peak(), c.acceleration.peak(), c.moment.peak()});
  return peaks;
}

std::vector<double> static_peaks(const ModalBridge& bridge, const ForceHistory& history) {
  const std::size_t n = history.channels, modes = bridge.modes();
  const ModalProbes& probes = bridge.probes();
  std::vector<double> peaks;
  for (std::size_t p = 0; p < probes.count; ++p) {
    double peak = std::abs(probes.weight_deflection[p]);
    for (std::size_t interval = 0; interval + 1 < history.start.size(); ++interval) {
      std::array<double, 4> c{};  // of the deflection over the distance
      for (std::size_t k = 0; k < 4; ++k) {
        const double* g = history.interval(interval) + k * n;
        c[k] = g[modes + p];
        for (std::size_t i = 0; i < modes; ++i)
          c[k] += probes.deflection[i * probes.count + p] * g[i] / (bridge.omega()[i] * bridge.omega()[i]);
      }
      c[0] += probes.weight_deflection[p];
      const double length = history.start[interval + 1] - history.start[interval];
      const auto look = [&](double s) {
        if (s >= 0.0 && s <= length) peak = std::max(peak, std::abs(c[0] + s * (c[1] + s * (c[2] + s * c[3]))));
      };
      look(0.0);
      look(length);
      const double root = c[2] * c[2] - 3.0 * c[1] * c[3];  // where the slope is zero
      if (root < 0.0) continue;
      const double far = -(c[2] + std::copysign(std::sqrt(root), c[2]));
      if (c[3] != 0.0) look(far / (3.0 * c[3]));
      if (far != 0.0) look(c[1] / far);
    }
    peaks.push_back(peak);
  }
  return peaks;
}

}  // namespace traverse::integrate
