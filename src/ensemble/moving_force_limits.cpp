// Evaluates the exact modal solution at equal intervals, filters the accelerations, and determines rotations,
// amplification and the other limited quantities.
#include "ensemble/moving_force_limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrate/modal_motion.hpp"
#include "run/deck_acceleration.hpp"
#include "run/low_pass.hpp"

namespace traverse::ensemble {

MovingForceLimits::MovingForceLimits(const scene::Scene& scene, run::SharedBeam& shared, double cutoff_frequency)
    : scene_(scene),
      shared_(shared),
      cutoff_frequency_(cutoff_frequency),
      by_modes_(shared.modal->modes() < shared.modal->probes().count),
      count_(by_modes_ ? shared.modal->modes() : shared.modal->probes().count),
      rotates_(scene.limits_quantity("end_rotation") || scene.limits_quantity("joint_rotation")),
      twists_(scene.limits_quantity("track_twist") && shared.beam->model().torsion),
      rotations_(run::DeckRotations(*shared.beam).unknowns().size()),
      slopes_(shared.modal->slopes(run::DeckRotations(*shared.beam).unknowns(),
                                   twists_ ? scene.output.probes : std::vector<double>(),
                                   scene.self_weight ? scene.gravity : 0.0, scene.output.eccentricities)) {}

std::vector<results::EvaluatedQuantity> MovingForceLimits::evaluate(std::size_t train, double end_time,
                                                                    std::span<const base::ProbePeaks> peaks,
                                                                    std::span<const double> static_deflection) {
  std::vector<std::string> ignored;
  const run::Plan plan = run::plan_exact_in_time(scene_, end_time, shared_.first_period(), ignored);
  run::LimitCheck check(scene_, no_fleet_, &*shared_.beam);
  sample_run(train, plan, check);

  results::Summary summary;
  if (cutoff_frequency_ > 0.0 && run::filter_obstacle(cutoff_frequency_, plan, peaks.size()).empty())
    summary.low_passed = filtered(plan.interval);
  return check.evaluate(std::move(summary), peaks, static_deflection);
}

/// Samples the run at the same instants as a single run.
void MovingForceLimits::sample_run(std::size_t train, const run::Plan& plan, run::LimitCheck& check) {
  const integrate::ForceHistory& history = histories_.try_emplace(train, slopes_.influence, scene_.load).first->second;
  const structure::ModalBridge& bridge = *shared_.modal;
  integrate::ModalMotion motion(bridge, history, scene_.load.speed, scene_.start == scene::Start::equilibrium);
  motion.prepare(plan.interval);
  const std::size_t modes = bridge.modes();
  std::vector<double> slopes(slopes_.count);
  const auto sample = [&] {
    if (!rotates_ && !twists_) return;
    std::copy(slopes_.weight.begin(), slopes_.weight.end(), slopes.begin());
    motion.add_channels(modes, slopes_.count, slopes.data());
    for (std::size_t i = 0; i < modes; ++i)
      for (std::size_t k = 0; k < slopes_.count; ++k) slopes[k] += slopes_.of_q[i * slopes_.count + k] * motion.q()[i];
    check.rotations(motion.time(), std::span(slopes).first(rotations_));
    check.twist_rates(motion.time(), std::span(slopes).subspan(rotations_));
  };
  const double slack = 1e-3 * std::min(plan.interval, plan.end_time);
  const auto instants = static_cast<std::size_t>(std::floor((plan.end_time + slack) / plan.interval)) + 1;
  series_.resize(instants * count_);
  for (std::size_t k = 0; k < instants; ++k) {
    const double t = static_cast<double>(k) * plan.interval;
    const double at = t > plan.end_time - slack ? plan.end_time : t;
    // The rate of the twist jumps where a force passes: its extremes are there.
    while (twists_ && motion.next_event() < at) {
      motion.advance(motion.next_event());
      sample();
      motion.pass_event();
      sample();
    }
    rotates_ || twists_ ? motion.advance(at) : motion.advance_acceleration(at);
    sample();
    double* row = &series_[k * count_];
    if (by_modes_)
      for (std::size_t i = 0; i < modes; ++i) row[i] = motion.acceleration()[i];
    else
      at_probes(motion.acceleration().data(), row);
  }
  if (motion.time() >= plan.end_time) return;
  motion.advance(plan.end_time);
  sample();
}

void MovingForceLimits::at_probes(const double* of_modes, double* row) const {
  const structure::ModalProbes& probes = shared_.modal->probes();
  const std::size_t modes = shared_.modal->modes(), count = probes.count;
  const double* shape = probes.deflection.data();
  for (std::size_t p = 0; p < count; ++p, ++shape) {
    double sum = 0.0;
    for (std::size_t i = 0; i < modes; ++i) sum += shape[i * count] * of_modes[i];
    row[p] = sum;
  }
}

/// The largest extreme of the probes' accelerations. Only instants at which the greatest shapes of the modes permit it
/// are evaluated, each with its neighbours: an extreme is interpolated from five samples.
base::Extreme MovingForceLimits::largest_at_probes(double interval) {
  const std::size_t probes = shared_.modal->probes().count, instants = series_.size() / count_;
  const std::vector<double>& shapes = shared_.modal->probes().deflection;
  std::vector<double> greatest_shape(count_, 0.0);
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t p = 0; p < probes; ++p)
      greatest_shape[i] = std::max(greatest_shape[i], std::abs(shapes[i * probes + p]));
  bounds_.resize(instants);
  for (std::size_t k = 0; k < instants; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count_; ++i) sum += greatest_shape[i] * std::abs(series_[k * count_ + i]);
    bounds_[k] = sum;
  }
  const auto largest = static_cast<std::size_t>(std::max_element(bounds_.begin(), bounds_.end()) - bounds_.begin());
  rows_.resize(instants * probes);
  at_probes(&series_[largest * count_], rows_.data());
  double reached = 0.0;
  for (std::size_t p = 0; p < probes; ++p) reached = std::max(reached, std::abs(rows_[p]));
  base::Extreme peak;
  for (std::size_t k = 0; k < instants;) {
    if (bounds_[k] < run::share_of_largest_sample * reached) {
      ++k;
      continue;
    }
    const std::size_t first = k - std::min<std::size_t>(k, 2);
    std::size_t past = k;  // the end of the stretch: three instants without the bound
    for (std::size_t quiet = 0; past < instants && quiet < 3; ++past)
      quiet = bounds_[past] < run::share_of_largest_sample * reached ? quiet + 1 : 0;
    for (std::size_t j = first; j < past; ++j) at_probes(&series_[j * count_], &rows_[(j - first) * probes]);
    const base::Extreme one =
        run::largest_peak(std::span<const double>(rows_).first((past - first) * probes), probes, interval, first);
    if (std::abs(one.value) > std::abs(peak.value)) peak = one;
    k = past;
  }
  return peak;
}

results::LowPassed MovingForceLimits::filtered(double interval) {
  const run::LowPass filter(cutoff_frequency_, interval);
  filter.apply(series_, count_);
  if (!by_modes_)
    return run::low_passed_peak(run::largest_peak(series_, count_, interval), scene_.output.probes, cutoff_frequency_,
                                interval);
  return run::low_passed_peak(largest_at_probes(interval), scene_.output.probes, cutoff_frequency_, interval);
}

}  // namespace traverse::ensemble
