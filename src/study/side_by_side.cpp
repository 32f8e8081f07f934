#include "study/side_by_side.hpp"

#include <algorithm>
#include <cmath>

#include "integrate/integrator_choice.hpp"
#include "lanes/speed_class.hpp"
#include "run/passage.hpp"

namespace traverse::app {
namespace {

constexpr double one_place = 1e-9;         // m: events nearer than that are one
constexpr double most_of_tracks = 2.56e8;  // bytes, of tracks that are kept

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
  plan_.bridge = &*shared.modal;
  plan_.kinks = system_.corners();
  plan_.level_until = scene.profile.level() ? shared.beam->mesh().start() : -1e300;
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

void SideBySide::expect(double past) {
  tracks_.clear();
  track_past_ = past;
  const auto [rear, front] = std::minmax_element(train_.x.begin(), train_.x.end());
  track_distance_ =
      lanes::track_distance(scene_.profile, fleet_.vehicles.front().wheels.front().radius, *rear, *front + track_past_);
}

/// All tracks of a spectrum have their stations where the scene's own has.
SideBySide::Track SideBySide::track(const std::optional<std::uint64_t>& seed, double past) {
  const auto [rear, front] = std::minmax_element(train_.x.begin(), train_.x.end());
  const double radius = fleet_.vehicles.front().wheels.front().radius;
  if (past > track_past_) expect(past);
  const auto known = std::find_if(tracks_.begin(), tracks_.end(), [&](const auto& one) { return one.first == seed; });
  if (known != tracks_.end()) return known->second;
  const track::Profile other = seed ? scene_.roughness->profile(*seed) : track::Profile();
  const lanes::TrackNumbers made =
      lanes::track_numbers(seed ? other : scene_.profile, radius, *rear, *front + track_past_, track_distance_);
  if (static_cast<double>((tracks_.size() + 1) * made.values.size() * sizeof(double)) > most_of_tracks &&
      !tracks_.empty())
    tracks_.pop_front();
  return tracks_.emplace_back(seed, std::make_shared<lanes::TrackNumbers>(made)).second;
}

structure::Method method_of(const Scene& scene) {
  const structure::MethodRow* row = structure::find_method(scene.sweep->method);
  return row != nullptr ? row->make(row->parameter.value) : *integrate::own_method();
}

SideBySide::Steps SideBySide::steps() const { return {method_of(scene_), *scene_.time_step}; }

double SideBySide::spacing(const Steps& steps, double speed) {
  return steps.longest * lanes::speed_of_class(lanes::speed_class(speed));
}

void SideBySide::Ready::stretch(const std::vector<double>& events, double ds, double past, const Steps& steps) {
  std::vector<lanes::TaskStretch>& stretches = plan_.stretches;
  double from = 0.0;
  long kept = 0;
  const auto add = [&](double to, bool kink, bool keeps) {
    stretches.push_back({to, std::max(1L, static_cast<long>(std::ceil((to - from) / ds - one_place))), kink, keeps});
    from = to;
  };
  const auto keep_until = [&](double to) {  // and leaves out what is there
    if (!steps.keeps) return;
    for (double next = static_cast<double>(kept + 1) * ds; next < to - one_place;
         next = static_cast<double>(++kept + 1) * ds)
      add(next, false, true);
  };
  for (const double event : events) {
    keep_until(event);
    const bool keeps = steps.keeps && static_cast<double>(kept + 1) * ds < event + one_place;
    add(event, true, keeps);
    kept += keeps ? 1 : 0;
  }
  keep_until(past);
  const auto last = static_cast<long>(std::ceil((past - from) / ds - one_place));
  // Runs that end elsewhere must not shape each other's steps.
  if (last > 0) stretches.push_back({steps.trial ? past : from + static_cast<double>(last) * ds, last});
}

SideBySide::Ready SideBySide::ready(std::span<const LaneRun> runs, const Steps& steps) {
  std::vector<Member> members;
  for (const LaneRun& run : runs) members.push_back({this, run});
  return ready(members, steps);
}

SideBySide::Ready SideBySide::ready(std::span<const Member> members, const Steps& steps) {
  const SideBySide& first = *members.front().lanes;
  Ready ready;
  ready.plan_ = first.plan_;
  lanes::CrossingPlan& plan = ready.plan_;
  plan.method = steps.method;
  plan.exact_modes = steps.method.stages.size() == 1;
  const double ds = spacing(steps, members.front().run.speed);
  double past = 0.0;
  for (const Member& member : members) past = std::max(past, member.run.speed * member.run.end);
  ready.stretch(first.events(past), ds, past, steps);
  for (const auto& [lanes, run] : members) {
    ready.tracks_.push_back(lanes->track(run.seed, past + ds));
    ready.crossings_.push_back({&lanes->train_, ready.tracks_.back().get(), nullptr, &lanes->q_, run.speed, run.end});
  }
  return ready;
}

bool SideBySide::join(const SideBySide& other) {
  const auto same_kind = [](const lanes::VehicleNumbers& a, const lanes::VehicleNumbers& b) {
    return a.freedom == b.freedom && a.wheels == b.wheels;
  };
  const auto same_vehicle = [](const lanes::TrainNumbers::Vehicle& a, const lanes::TrainNumbers::Vehicle& b) {
    return a.kind == b.kind && a.first_coordinate == b.first_coordinate && a.first_wheel == b.first_wheel;
  };
  const auto near = [](double a, double b) { return std::abs(a - b) < one_place; };
  const lanes::TrainNumbers& its = other.train_;
  const bool same_train =
      std::equal(train_.kinds.begin(), train_.kinds.end(), its.kinds.begin(), its.kinds.end(), same_kind) &&
      std::equal(train_.vehicles.begin(), train_.vehicles.end(), its.vehicles.begin(), its.vehicles.end(),
                 same_vehicle) &&
      std::equal(train_.x.begin(), train_.x.end(), its.x.begin(), its.x.end(), near) && train_.hertz == its.hertz;
  if (!same_train || plan_.bridge != other.plan_.bridge || plan_.kinks != other.plan_.kinks ||
      plan_.level_until != other.plan_.level_until || scene_.output.probes != other.scene_.output.probes ||
      track_past_ != other.track_past_ || track_distance_ != other.track_distance_)
    return false;
  train_.x = its.x;
  train_.arm = its.arm;
  train_.force_scale = its.force_scale;
  for (std::size_t k = 0; k < train_.kinds.size(); ++k) train_.kinds[k].bend = its.kinds[k].bend;
  return true;
}

std::vector<double> SideBySide::static_deflection() {
  std::vector<double> deflection;
  for (const double x : scene_.output.probes)
    deflection.push_back(system_.weights().static_peak(x, train::WheelPaths(), 0.0));
  return deflection;
}

}  // namespace traverse::app
