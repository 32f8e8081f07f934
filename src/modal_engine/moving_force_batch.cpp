// Prepares the tables of the vectorised kernel: modal forces over the distance, modal coefficients and the breaks where
// a response has a kink or a jump. Static peaks follow from the extremes of cubic polynomials.
//
// Channels of the force history: modal forces; then for each probe the static correction of the deflection (the static
// deflection minus the contribution of the modes), then for each probe that of the moment.
#include "modal_engine/moving_force_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/processor.hpp"
#include "engine/speed_class.hpp"

namespace traverse::modal_engine {

// Compiled from moving_force_kernel.cpp, once for each instruction set.
TRAVERSE_LANES_DECLARE(long work_size(const ForceTask& task); void run_passages(const ForceTask& task);)

namespace {

constexpr double negligible_kink = 1e-6;  // fraction of the largest slope, or of the largest value for a jump

/// The coefficients of one channel in an interval, by powers of the distance since its start.
std::array<double, 4> cubic_of(const integrate::ForceHistory& history, std::size_t interval, std::size_t channel) {
  const double* c = history.interval(interval) + channel;
  const std::size_t n = history.channels;
  return {c[0], c[n], c[2 * n], c[3 * n]};
}

/// The largest magnitudes of each channel and of its slope at the starts of the intervals, and the jumps of both there.
struct Jumps {
  explicit Jumps(const integrate::ForceHistory& history)
      : largest(history.channels, 0.0), steepest(largest), value(history.coefficients.size() / 4), slope(value) {
    const std::size_t n = history.channels;
    for (std::size_t i = 0; i < history.start.size(); ++i) {
      const double* c = history.interval(i);
      for (std::size_t k = 0; k < n; ++k) {
        largest[k] = std::max(largest[k], std::abs(c[k]));
        steepest[k] = std::max(steepest[k], std::abs(c[n + k]));
      }
      if (i == 0) continue;
      const double d = history.start[i] - history.start[i - 1];
      const double* b = history.interval(i - 1);
      for (std::size_t k = 0; k < n; ++k) {
        const double b1 = b[n + k], b2 = b[2 * n + k], b3 = b[3 * n + k];
        value[i * n + k] = std::abs(c[k] - (b[k] + d * (b1 + d * (b2 + d * b3))));
        slope[i * n + k] = std::abs(c[n + k] - (b1 + d * (2.0 * b2 + 3.0 * d * b3)));
      }
    }
  }

  std::vector<double> largest, steepest;  // for each channel
  std::vector<double> value, slope;       // [interval][channel]
};

}  // namespace

MovingForcePassages::MovingForcePassages(const structure::ModalBridge& bridge, const train::MovingLoad& load,
                                         bool equilibrium)
    : bridge_(bridge), history_(bridge.influence(), load), self_weight_(bridge.probes().weight_deflection) {
  for (std::size_t i = 0; i < bridge.modes(); ++i) {
    omega2_.push_back(bridge.omega()[i] * bridge.omega()[i]);
    damping_.push_back(2.0 * bridge.sigma()[i]);
    q_.push_back(equilibrium ? history_.interval(0)[i] / omega2_[i] : 0.0);
  }
  const std::vector<double>& moments = bridge.probes().weight_moment;
  self_weight_.insert(self_weight_.end(), moments.begin(), moments.end());
  find_kinks();
}

/// If a modal force has a kink, all responses have one; otherwise the responses whose static correction has a kink.
void MovingForcePassages::find_kinks() {
  const std::size_t modes = bridge_.modes(), n = history_.channels, probes = bridge_.probes().count;
  const Jumps jumps(history_);
  // A kink is ignored if it is small relative to the whole response.
  std::vector<double> largest = jumps.largest, steepest = jumps.steepest;
  for (std::size_t k = modes; k < n; ++k)
    for (std::size_t i = 0; i < modes; ++i) {
      const std::size_t at = i * probes + (k - modes) % probes;
      const double modal_coefficient =
          k < modes + probes ? bridge_.probes().deflection[at] : bridge_.probes().moment[at];
      largest[k] += std::abs(modal_coefficient) / omega2_[i] * jumps.largest[i];
      steepest[k] += std::abs(modal_coefficient) / omega2_[i] * jumps.steepest[i];
    }
  first_kink_ = {0};
  for (std::size_t i = 0; i < history_.start.size(); ++i) {
    const auto jumps_in = [&](std::size_t k) { return jumps.value[i * n + k] > negligible_kink * largest[k]; };
    const auto kink_in = [&](std::size_t k) { return jumps.slope[i * n + k] > negligible_kink * steepest[k]; };
    ForceEvent event = ForceEvent::smooth;
    for (std::size_t k = 0; k < modes; ++k) {
      if (jumps_in(k)) event = ForceEvent::all_jump;
      if (kink_in(k) && event != ForceEvent::all_jump) event = ForceEvent::all_kink;
    }
    for (std::size_t k = modes; k < n && event <= ForceEvent::kinks; ++k) {
      if (!jumps_in(k) && !kink_in(k)) continue;
      event = ForceEvent::kinks;
      kink_.push_back(static_cast<int>(k < modes + probes ? k - modes : k - modes + probes));
    }
    event_.push_back(event);
    first_kink_.push_back(static_cast<int>(kink_.size()));
  }
}

std::vector<std::vector<base::ProbePeaks>> MovingForcePassages::peaks(std::span<const double> speeds,
                                                                      std::span<const double> end_times,
                                                                      double samples_per_period,
                                                                      const std::function<bool()>& proceed) const {
  const std::size_t width = speeds.size() > 4 ? 8 : speeds.size() > 2 ? 4 : 2, probes = bridge_.probes().count;
  engine::Aligned speed(width), end(width), peak(3 * probes * width), time(3 * probes * width);
  for (std::size_t lane = 0; lane < width; ++lane) {
    const std::size_t run = std::min(lane, speeds.size() - 1);
    speed.data()[lane] = speeds[run];
    end.data()[lane] = speeds[run] * end_times[run];
  }
  ForceTask task;
  task.width = static_cast<int>(width);
  task.runs = static_cast<int>(speeds.size());
  task.speed = speed.data();
  task.end = end.data();
  const double fastest = *std::max_element(bridge_.omega().begin(), bridge_.omega().end());
  task.instant = 2.0 * std::numbers::pi / fastest / samples_per_period;
  task.ds = task.instant * engine::speed_of_class(engine::speed_class(speeds.front()));
  task.intervals = static_cast<long>(history_.start.size());
  task.channels = static_cast<int>(history_.channels);
  task.start = history_.start.data();
  task.coefficients = history_.coefficients.data();
  task.event = event_.data();
  task.first_kink = first_kink_.data();
  task.kink = kink_.data();
  task.modes = static_cast<int>(bridge_.modes());
  task.omega2 = omega2_.data();
  task.damping = damping_.data();
  task.q = q_.data();
  const structure::ModalProbes& forms = bridge_.probes();
  task.probes = static_cast<int>(probes);
  task.deflection = forms.deflection.data();
  task.moment = forms.moment.data();
  task.moment_by_rate = forms.moment_by_rate.data();
  task.moment_by_acceleration = forms.moment_by_acceleration.data();
  task.weight = self_weight_.data();
  bool stopped = false;
  const auto check = [&] {
    stopped = stopped || !proceed();
    return !stopped;
  };
  task.context = const_cast<void*>(static_cast<const void*>(&check));
  task.proceed = [](void* context) { return (*static_cast<decltype(check)*>(context))(); };
  task.peak = peak.data();
  task.peak_time = time.data();
  engine::Aligned work(static_cast<std::size_t>(TRAVERSE_LANES_CALL(work_size(task))));
  task.work = work.data();
  TRAVERSE_LANES_CALL(run_passages(task));
  if (stopped) return {};
  std::vector<std::vector<base::ProbePeaks>> peaks(speeds.size(), std::vector<base::ProbePeaks>(probes));
  for (std::size_t lane = 0; lane < speeds.size(); ++lane)
    for (std::size_t p = 0; p < probes; ++p) {
      const auto of = [&](std::size_t response) {
        const std::size_t at = (response * probes + p) * width + lane;
        return base::Extreme{peak.data()[at], time.data()[at]};
      };
      peaks[lane][p] = {of(0), of(1), of(2)};
    }
  return peaks;
}

std::vector<double> MovingForcePassages::static_peaks() const {
  const std::size_t modes = bridge_.modes();
  const structure::ModalProbes& probes = bridge_.probes();
  std::vector<double> peaks;
  for (const double weight : probes.weight_deflection) peaks.push_back(std::abs(weight));
  for (std::size_t interval = 0; interval + 1 < history_.start.size(); ++interval) {
    const double length = history_.start[interval + 1] - history_.start[interval];
    for (std::size_t p = 0; p < probes.count; ++p) {
      std::array<double, 4> c = cubic_of(history_, interval, modes + p);  // deflection over the distance
      for (std::size_t i = 0; i < modes; ++i) {
        const std::array<double, 4> force = cubic_of(history_, interval, i);
        for (std::size_t k = 0; k < 4; ++k) c[k] += probes.deflection[i * probes.count + p] * force[k] / omega2_[i];
      }
      c[0] += probes.weight_deflection[p];
      const auto evaluate = [&](double s) {
        if (s >= 0.0 && s <= length) peaks[p] = std::max(peaks[p], std::abs(c[0] + s * (c[1] + s * (c[2] + s * c[3]))));
      };
      evaluate(0.0);
      evaluate(length);
      const double discriminant = c[2] * c[2] - 3.0 * c[1] * c[3];  // for the zeros of the slope
      if (discriminant < 0.0) continue;
      const double larger_root_numerator = -(c[2] + std::copysign(std::sqrt(discriminant), c[2]));
      if (c[3] != 0.0) evaluate(larger_root_numerator / (3.0 * c[3]));
      if (larger_root_numerator != 0.0) evaluate(c[1] / larger_root_numerator);
    }
  }
  return peaks;
}

}  // namespace traverse::modal_engine
