#include "lanes/crossing_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace traverse::lanes {
namespace {

TaskMethod task_method(const structure::Method& method) {
  TaskMethod t;
  t.stages = static_cast<int>(method.stages.size());
  t.known = method.step.known;
  for (std::size_t i = 0; i < method.stages.size(); ++i) {
    const structure::StageRule& rule = method.stages[i];
    t.time[i] = rule.time;
    t.w_in_v[i] = rule.w_in_v;
    std::copy(rule.a_in_v.begin(), rule.a_in_v.end(), t.a_in_v[i]);
    std::copy(rule.a_in_w.begin(), rule.a_in_w.end(), t.a_in_w[i]);
    t.rate = rule.rate;
    t.displacement = rule.displacement;
  }
  t.end_w_in_v = method.step.w_in_v;
  std::copy(method.step.a_in_v.begin(), method.step.a_in_v.end(), t.end_a_in_v);
  std::copy(method.step.a_in_w.begin(), method.step.a_in_w.end(), t.end_a_in_w);
  std::copy(method.step.a_next.begin(), method.step.a_next.end(), t.a_next);
  std::copy(method.step.power.begin(), method.step.power.end(), t.power);
  return t;
}

/// The largest magnitude of each of the first channels at the breaks: of modes, whose waves are longer than elements.
std::vector<double> largest_values(const structure::PiecewiseCubic& influence, std::size_t count) {
  std::vector<double> largest(count, 0.0);
  for (std::size_t piece = 0; piece < influence.pieces(); ++piece)
    for (std::size_t i = 0; i < count; ++i)
      largest[i] = std::max(largest[i], std::abs(influence.coefficients[4 * influence.channels * piece + i]));
  return largest;
}

}  // namespace

CrossingNumbers::CrossingNumbers(const CrossingPlan& plan, std::span<const CrossingRun> runs, std::size_t width)
    : runs_(runs), width_(width), level_until_(plan.level_until) {
  task_.width = static_cast<int>(width_);
  task_.method = task_method(plan.method);
  task_.speed = side_by_side(1, [](const CrossingRun& run, std::size_t) { return run.speed; });
  task_.end_time = side_by_side(1, [](const CrossingRun& run, std::size_t) { return run.end_time; });
  if (runs.front().train != nullptr) add_train(*runs.front().train);
  if (runs.front().forces != nullptr) add_forces(*runs.front().forces);
  add_bridge(*plan.bridge, plan.exact_modes);
  add_track();
  task_.stretches = static_cast<int>(plan.stretches.size());
  task_.stretch = plan.stretches.data();
  task_.kinks = static_cast<int>(plan.kinks.size());
  task_.kink = plan.kinks.data();
}

template <class Has>
CrossingNumbers::Pattern CrossingNumbers::pattern_of(int rows, int columns, Has has) {
  Pattern p;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j)
      if (has(static_cast<std::size_t>(i * columns + j))) p.column.push_back(j);
    p.row.push_back(static_cast<int>(p.column.size()));
  }
  return p;
}

// value(run, i) of every run, for i up to count.
template <class Value>
const double* CrossingNumbers::side_by_side(std::size_t count, Value value) {
  engine::Aligned& numbers = *numbers_.emplace_back(std::make_unique<engine::Aligned>(count * width_));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t lane = 0; lane < width_; ++lane)
      numbers.data()[i * width_ + lane] = value(runs_[std::min(lane, runs_.size() - 1)], i);
  return numbers.data();
}

void CrossingNumbers::add_train(const TrainNumbers& train) {
  for (std::size_t k = 0; k < train.kinds.size(); ++k) {
    const VehicleNumbers& kind = train.kinds[k];
    const int f = kind.freedom;
    const auto size = static_cast<std::size_t>(f);
    const auto of = [&](std::vector<double> VehicleNumbers::*numbers, std::size_t count) {
      return side_by_side(count,
                          [=](const CrossingRun& run, std::size_t i) { return (run.train->kinds[k].*numbers)[i]; });
    };
    patterns_.push_back(std::make_unique<Pattern>(pattern_of(kind.wheels, f, [&](std::size_t i) {
      return std::any_of(runs_.begin(), runs_.end(),
                         [&](const CrossingRun& run) { return run.train->kinds[k].G[i] != 0.0; });
    })));
    const Pattern& wheels = *patterns_.back();
    kinds_.push_back({f, kind.wheels, of(&VehicleNumbers::M, size * size), of(&VehicleNumbers::C, size * size),
                      of(&VehicleNumbers::K, size * size), of(&VehicleNumbers::r0, size),
                      of(&VehicleNumbers::G, size * static_cast<std::size_t>(kind.wheels)),
                      of(&VehicleNumbers::G_along, size * static_cast<std::size_t>(kind.wheels)), wheels.row.data(),
                      wheels.column.data(), kind.bend.data()});
  }
  for (const TrainNumbers::Vehicle& vehicle : train.vehicles) {
    double foremost = -1e300;
    for (int j = 0; j < train.kinds[vehicle.kind].wheels; ++j)
      foremost = std::max(foremost, train.x[static_cast<std::size_t>(vehicle.first_wheel + j)]);
    vehicles_.push_back({static_cast<int>(vehicle.kind), vehicle.first_coordinate, vehicle.first_wheel,
                         std::max(0.0, level_until_ - foremost)});
  }
  task_.kinds = static_cast<int>(kinds_.size());
  task_.kind = kinds_.data();
  task_.vehicles = static_cast<int>(vehicles_.size());
  task_.vehicle = vehicles_.data();
  task_.wheels = static_cast<int>(train.x.size());
  task_.coordinates = train.coordinates;
  task_.x = train.x.data();
  const auto of = [&](std::vector<double> TrainNumbers::*numbers) {
    return side_by_side(train.x.size(),
                        [=](const CrossingRun& run, std::size_t i) { return (run.train->*numbers)[i]; });
  };
  task_.penetration = of(&TrainNumbers::penetration);
  task_.stiffness = of(&TrainNumbers::stiffness);
  task_.hertz = train.hertz.data();
  task_.force_scale = train.force_scale;
  task_.radius = train.radius;
  task_.arm = train.arm.data();
  task_.x_rate = side_by_side(train.follow.size(),
                              [](const CrossingRun& run, std::size_t i) { return run.speed * run.train->follow[i]; });
}

void CrossingNumbers::add_forces(const ForceNumbers& forces) {
  task_.loads = static_cast<int>(forces.x.size());
  task_.load_x = forces.x.data();
  task_.load =
      side_by_side(forces.x.size(), [](const CrossingRun& run, std::size_t i) { return run.forces->force[i]; });
}

void CrossingNumbers::add_bridge(const structure::ModalBridge& bridge, bool exact_modes) {
  const std::size_t modes = bridge.modes();
  task_.modes = static_cast<int>(modes);
  task_.omega2 =
      side_by_side(modes, [&](const CrossingRun&, std::size_t i) { return bridge.omega()[i] * bridge.omega()[i]; });
  task_.coupled = bridge.coupled();
  task_.damping = side_by_side(task_.coupled ? modes * modes : modes, [&](const CrossingRun&, std::size_t i) {
    if (!task_.coupled) return 2.0 * bridge.sigma()[i];
    const auto row = static_cast<Eigen::Index>(i / modes), column = static_cast<Eigen::Index>(i % modes);
    return row == column ? 2.0 * bridge.sigma()[i / modes] : bridge.cross_damping()(row, column);
  });
  task_.exact_modes = exact_modes && !task_.coupled;
  task_.q = side_by_side(modes, [](const CrossingRun& run, std::size_t i) { return (*run.q)[i]; });
  const structure::PiecewiseCubic& influence = bridge.influence();
  largest_ = largest_values(influence, modes);
  task_.influence = {static_cast<int>(influence.pieces()), static_cast<int>(influence.channels),
                     influence.breaks.data(), influence.coefficients.data(), largest_.data()};
  const structure::ModalProbes& probes = bridge.probes();
  task_.probes = {static_cast<int>(probes.count),
                  probes.deflection.data(),
                  probes.moment.data(),
                  probes.moment_by_rate.data(),
                  probes.moment_by_acceleration.data(),
                  probes.deflection_by_rate.empty() ? nullptr : probes.deflection_by_rate.data()};
  task_.left_out = {bridge.next_omega() * bridge.next_omega(), 2.0 * bridge.next_sigma(), bridge.lag()};
}

void CrossingNumbers::add_track() {
  const auto* track = runs_.front().track;
  if (track == nullptr || track->values.empty()) return;
  const bool shared =
      std::all_of(runs_.begin(), runs_.end(), [&](const CrossingRun& run) { return run.track == track; });
  task_.heights = {static_cast<int>(track->values.size() / 2), shared, track->start, track->distance,
                   track->values.data()};
  for (const CrossingRun& run : runs_)
    if (run.track == nullptr || run.track->values.size() != track->values.size() || run.track->start != track->start ||
        run.track->distance != track->distance)
      throw std::logic_error("runs side by side over tracks with other stations");
  if (!shared)
    task_.heights.values =
        side_by_side(track->values.size(), [](const CrossingRun& run, std::size_t i) { return run.track->values[i]; });
}

}  // namespace traverse::lanes
