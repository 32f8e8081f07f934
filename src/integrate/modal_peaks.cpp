// Samples the exact modal solution several times per period of the highest mode, and interpolates each extreme by the
// parabola through three neighbouring samples.
#include "integrate/modal_peaks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace traverse::integrate {
namespace {

constexpr long instants_between_checks = 4096;  // between calls of `proceed`

/// The vertex of the parabola through three samples, of which the middle one is the largest.
base::Extreme vertex(const std::array<double, 3>& t, const std::array<double, 3>& y) {
  const double before = (y[1] - y[0]) / (t[1] - t[0]), after = (y[2] - y[1]) / (t[2] - t[1]);
  const double second_difference = (after - before) / (t[2] - t[0]);
  const double at = 0.5 * (t[0] + t[1]) - 0.5 * before / second_difference;
  return {y[1] + (at - t[1]) * (before + second_difference * (at - t[0])), at};
}

/// The responses at the last samples, and their peaks so far.
class PeakTracker {
 public:
  explicit PeakTracker(std::size_t count) : peaks_(count) { rows_.fill(std::vector<double>(count)); }

  /// The array for the responses of a new sample.
  std::vector<double>& next() {
    std::rotate(rows_.begin(), rows_.begin() + 1, rows_.end());
    return rows_[2];
  }
  /// Evaluates the new sample.
  void add(double t) {
    t_ = {t_[1], t_[2], t};
    ++known_;
    for (std::size_t i = 0; i < peaks_.size(); ++i) {
      const double value = std::abs(rows_[2][i]), middle = std::abs(rows_[1][i]);
      if (value > peaks_[i].value) peaks_[i] = {value, t};
      if (known_ >= 3 && middle > near_largest * peaks_[i].value && middle > value) interpolate_peak(i);
    }
  }
  /// Starts a new curve: the motion has a kink here.
  void restart() { known_ = 1; }
  const std::vector<base::Extreme>& peaks() const { return peaks_; }

 private:
  static constexpr double near_largest =
      0.9;  // relative to the largest so far: a sample below this limit has no larger vertex

  void interpolate_peak(std::size_t i) {
    const double sign = rows_[1][i] < 0.0 ? -1.0 : 1.0;
    const std::array<double, 3> y = {sign * rows_[0][i], sign * rows_[1][i], sign * rows_[2][i]};
    if (y[1] < y[0]) return;
    const base::Extreme top = vertex(t_, y);
    if (top.value > peaks_[i].value) peaks_[i] = top;
  }

  std::size_t known_ = 0;  // samples without a kink between them
  std::array<double, 3> t_{};
  std::array<std::vector<double>, 3> rows_;  // rows of the last samples
  std::vector<base::Extreme> peaks_;
};

/// The deflections of all probes at one instant, their accelerations, their moments.
void evaluate_probes(const structure::ModalBridge& bridge, const ModalMotion& motion, std::vector<double>& responses) {
  const structure::ModalProbes& probes = bridge.probes();
  const std::size_t n = probes.count;
  double *deflections = responses.data(), *accelerations = deflections + n, *moments = accelerations + n;
  std::copy(probes.weight_deflection.begin(), probes.weight_deflection.end(), deflections);
  std::fill_n(accelerations, n, 0.0);
  std::copy(probes.weight_moment.begin(), probes.weight_moment.end(), moments);
  motion.add_channels(bridge.modes(), n, deflections);
  motion.add_channels(bridge.modes() + n, n, moments);
  for (std::size_t i = 0; i < bridge.modes(); ++i) {
    const double q = motion.q()[i], rate = motion.rate()[i], acceleration = motion.acceleration()[i];
    const double *deflection = &probes.deflection[i * n], *moment = &probes.moment[i * n];
    const double *by_rate = &probes.moment_by_rate[i * n], *by_acceleration = &probes.moment_by_acceleration[i * n];
    for (std::size_t p = 0; p < n; ++p) {
      deflections[p] += deflection[p] * q;
      accelerations[p] += deflection[p] * acceleration;
      moments[p] += moment[p] * q + by_rate[p] * rate + by_acceleration[p] * acceleration;
    }
    for (std::size_t p = 0; !probes.deflection_by_rate.empty() && p < n; ++p)
      deflections[p] += probes.deflection_by_rate[i * n + p] * rate;
  }
}

}  // namespace

std::vector<base::ProbePeaks> modal_peaks(const structure::ModalBridge& bridge, const ForceHistory& history,
                                          double speed, bool equilibrium, double end_time, double instants,
                                          const std::function<bool()>& proceed) {
  ModalMotion motion(bridge, history, speed, equilibrium);
  const double fastest = *std::max_element(bridge.omega().begin(), bridge.omega().end());
  const double interval = 2.0 * std::numbers::pi / fastest / instants;
  motion.prepare(interval);
  const std::size_t n = bridge.probes().count;
  PeakTracker tracker(3 * n);
  const auto sample = [&] {
    evaluate_probes(bridge, motion, tracker.next());
    tracker.add(motion.time());
  };
  sample();
  while (motion.time() < end_time) {
    // Samples count from the last event: steps of the prepared length cost least.
    const double event = std::min(motion.next_event(), end_time);
    const double from = motion.time();
    for (long i = 1; from + static_cast<double>(i) * interval < event; ++i) {
      if (i % instants_between_checks == 0 && !proceed()) return {};
      motion.advance(from + static_cast<double>(i) * interval);
      sample();
    }
    motion.advance(event);
    sample();
    motion.pass_event();
    tracker.restart();
  }
  std::vector<base::ProbePeaks> peaks;
  for (std::size_t p = 0; p < n; ++p)
    peaks.push_back({tracker.peaks()[p], tracker.peaks()[n + p], tracker.peaks()[2 * n + p]});
  return peaks;
}

}  // namespace traverse::integrate
