#include "study/side_by_side.hpp"

#include <algorithm>
#include <cmath>

#include "integrate/integrator_choice.hpp"
#include "lanes/speed_class.hpp"
#include "run/by_lanes.hpp"
#include "run/passage.hpp"

namespace traverse::app {
namespace {

constexpr double one_place = 1e-9;  // m: events nearer than that are one

}  // namespace

SideBySide::SideBySide(const Scene& scene, const SharedBeam& shared)
    : scene_(scene),
      shared_(shared),
      input_(system_input(scene, false)),
      system_(PETSC_COMM_SELF, carrier(scene, shared, input_), input_) {
  std::vector<double> y(static_cast<std::size_t>(system_.local_size()));
  system_.start(true, y.data());
  system_.linearise_vehicles(y.data());
  fleet_ = system_.fleet();
  obstacle_ = lanes::obstacle(fleet_);
  if (!obstacle_.empty()) return;
  train_ = lanes::train_numbers(fleet_);
  q_.assign(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(shared.modal->modes()));
  plan_ = lanes_plan(scene, shared, system_);
}

/// Distances at which a wheel meets a corner of the surface or passes a probe.
std::vector<double> SideBySide::events(double past) const {
  std::vector<double> events;
  for (const std::vector<double>& stations : {plan_.kinks, scene_.output.probes})
    for (const double station : stations)
      for (const double x : train_.x)
        if (station > x && station - x < past) events.push_back(station - x);
  std::sort(events.begin(), events.end());
  events.erase(std::unique(events.begin(), events.end(), [](double a, double b) { return b - a < one_place; }),
               events.end());
  return events;
}

void SideBySide::make_track(double past) {
  if (scene_.profile.level() || past <= track_past_) return;
  const auto [rear, front] = std::minmax_element(train_.x.begin(), train_.x.end());
  track_ = lanes::track_numbers(scene_.profile, fleet_.vehicles.front().wheels.front().radius, *rear, *front + past);
  track_past_ = past;
}

SideBySide::Steps SideBySide::steps() const {
  const structure::MethodRow* row = structure::find_method(scene_.sweep->method);
  return {row != nullptr ? row->make(row->parameter.value) : *integrate::own_method(), *scene_.time_step};
}

std::vector<lanes::CrossingResult> SideBySide::run(std::span<const double> speeds, std::span<const double> ends,
                                                   const Steps& steps) {
  plan_.method = steps.method;
  plan_.exact_modes = steps.method.stages.size() == 1;
  const double ds = steps.longest * lanes::speed_of_class(lanes::speed_class(speeds.front()));
  double past = 0.0;
  for (std::size_t i = 0; i < speeds.size(); ++i) past = std::max(past, speeds[i] * ends[i]);
  plan_.stretches.clear();
  double from = 0.0;
  for (const double event : events(past)) {
    plan_.stretches.push_back({event, std::max(1L, static_cast<long>(std::ceil((event - from) / ds - one_place)))});
    from = event;
  }
  const auto last = static_cast<long>(std::ceil((past - from) / ds - one_place));
  if (last > 0) plan_.stretches.push_back({past, last});
  make_track(past + ds);
  std::vector<lanes::CrossingRun> runs;
  for (std::size_t i = 0; i < speeds.size(); ++i) runs.push_back({&train_, &track_, nullptr, &q_, speeds[i], ends[i]});
  return lanes::cross(plan_, runs);
}

std::vector<double> SideBySide::static_deflection() {
  std::vector<double> deflection;
  for (const double x : scene_.output.probes)
    deflection.push_back(system_.weights().static_peak(x, train::WheelPaths(), 0.0));
  return deflection;
}

}  // namespace traverse::app
