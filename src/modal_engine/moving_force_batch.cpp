// Prepares the tables of the vectorised kernel: modal forces over the distance, modal coefficients, windows with bounds
// and the breaks where a response has a kink or a jump.
//
// Channels of the force history: modal forces; then for each probe the static correction of the deflection (the static
// deflection minus the contribution of the modes), then for each probe that of the moment.
#include "modal_engine/moving_force_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/processor.hpp"
#include "engine/speed_class.hpp"

namespace traverse::modal_engine {

// Compiled from moving_force_kernel.cpp, once for each instruction set.
TRAVERSE_LANES_DECLARE(long work_size(const ForceTask& task); void run_passages(const ForceTask& task);)

namespace {

constexpr double negligible_kink = 1e-6;  // fraction of the largest slope, or of the largest value for a jump
constexpr double window_samples = 40.0;   // of a window at the lowest speed of its octave, about

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
  const Jumps jumps(history_);
  find_kinks(jumps);
  bounds_ = std::make_unique<ForceBounds>(bridge, history_, jumps, all_kink_);
}

/// If a modal force has a kink, all responses have one; otherwise the responses whose static correction has a kink.
void MovingForcePassages::find_kinks(const Jumps& jumps) {
  const std::size_t modes = bridge_.modes(), n = history_.channels, probes = bridge_.probes().count;
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
    const auto is_broken = [&](std::size_t k) { return jumps_in(k) || kink_in(k); };
    bool all = false;
    for (std::size_t k = 0; k < modes; ++k) all = all || is_broken(k);
    for (std::size_t k = modes; k < n && !all; ++k)
      if (is_broken(k)) kink_.push_back(static_cast<int>(k < modes + probes ? k - modes : k - modes + probes));
    all_kink_.push_back(all ? 1 : 0);
    first_kink_.push_back(static_cast<int>(kink_.size()));
  }
}

std::vector<std::vector<base::ProbePeaks>> MovingForcePassages::peaks(std::span<const double> speeds,
                                                                      std::span<const double> end_times,
                                                                      double samples_per_period,
                                                                      const std::function<bool()>& proceed,
                                                                      std::span<const base::ProbePeaks> least) const {
  return run(speeds, end_times, samples_per_period, proceed, least, false);
}

std::vector<std::vector<base::ProbePeaks>> MovingForcePassages::bounds(std::span<const double> speeds,
                                                                       std::span<const double> end_times,
                                                                       double samples_per_period,
                                                                       const std::function<bool()>& proceed) const {
  return run(speeds, end_times, samples_per_period, proceed, {}, true);
}

std::vector<std::vector<base::ProbePeaks>> MovingForcePassages::run(
    std::span<const double> speeds, std::span<const double> end_times, double samples_per_period,
    const std::function<bool()>& proceed, std::span<const base::ProbePeaks> least, bool only_bounds) const {
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
  task.instant = 2.0 * std::numbers::pi / bridge_.fastest_oscillation() / samples_per_period;
  task.ds = task.instant * engine::speed_of_class(engine::speed_class(speeds.front()));
  task.intervals = static_cast<long>(history_.start.size());
  task.channels = static_cast<int>(history_.channels);
  task.start = history_.start.data();
  task.coefficients = history_.coefficients.data();
  task.first_kink = first_kink_.data();
  task.kink = kink_.data();
  task.least_speed = std::exp2(engine::speed_octave(speeds.front()));
  const double window = window_samples * task.instant * task.least_speed;
  auto windows = windows_.find(window);
  if (windows == windows_.end()) windows = windows_.emplace(window, bounds_->windows(window)).first;
  const ForceWindows& own = windows->second;
  task.stretches = static_cast<long>(own.end.size());
  task.stretch_end = own.end.data();
  task.stretch_parts = own.parts.data();
  task.stretch_numbers = own.numbers.data();
  task.first_move = own.first_move.data();
  task.move_end = own.move_end.data();
  task.move_length = own.move_length.data();
  task.lengths = static_cast<int>(own.length.size());
  task.length = own.length.data();
  task.last_window = own.last;
  task.by_amplitude = bounds_->by_amplitude().data();
  task.only_bounds = only_bounds;
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
  std::vector<double> none(3 * probes, 0.0);  // of each response: the result if no peak is greater
  for (std::size_t i = 0; i < none.size() && !least.empty(); ++i) {
    const double limit = (least[i % probes].*responses[i / probes]).value;
    std::fill_n(peak.data() + i * width, width, std::max(limit, 0.0));
    if (limit >= 0.0) none[i] = std::numeric_limits<double>::quiet_NaN();
  }
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
        if (only_bounds || time.data()[at] >= 0.0) return base::Extreme{peak.data()[at], time.data()[at]};
        return base::Extreme{none[response * probes + p], none[response * probes + p]};
      };
      peaks[lane][p] = {of(0), of(1), of(2)};
    }
  return peaks;
}

}  // namespace traverse::modal_engine
