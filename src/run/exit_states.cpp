// Finds the instant at which the last wheel of a vehicle passes an end, by the cubic through its positions and speeds.
// The times at which wheels pass axle load scales follow from the speed law.
#include "run/exit_states.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::run {
namespace {

/// The number of the vehicle's first body among the bodies of all units.
std::size_t first_body(const train::Fleet& fleet, const train::Member& member) {
  auto first = static_cast<std::size_t>(member.first_body);
  for (int k = 0; k < member.unit; ++k) first += fleet.vehicles[k].mechanism.model().bodies.size();
  return first;
}

constexpr double same_step = 2e-3;  // relative to the step: instants within half of this share the end of a step

/// The contacts of wheels, each with its first contact point only.
std::vector<const train::WheelContact*> first_points(const train::Fleet& fleet) {
  std::vector<const train::WheelContact*> wheels;
  for (const train::WheelContact& c : fleet.wheels)
    if (!c.is_further) wheels.push_back(&c);
  return wheels;
}

}  // namespace

ExitStates::ExitStates(const scene::Scene& scene) {
  if (!scene.beam) return;
  steps_end_before_exits_ = scene.contact_tolerance != 0.0;
  const beam::BeamModel& beam = *scene.beam;
  double last = beam.start;
  for (const double span : beam.spans) last += span;
  const std::vector<double>& probes = scene.output.probes;
  for (const bool right : {false, true}) {
    if (beam.ground[right ? 1 : 0]) continue;
    OpenEnd end{right ? last : beam.start, right ? 1.0 : -1.0, -1};
    for (std::size_t i = 0; i < probes.size(); ++i)
      if (std::abs(probes[i] - end.x) <= 1e-9 * (1.0 + std::abs(end.x))) end.probe = static_cast<int>(i);
    ends_.push_back(end);
  }
}

/// The cubic through both motions, h apart, at the share s of the time between them.
ExitStates::Motion ExitStates::between(const Motion& a, const Motion& b, double h, double s) {
  const double rise = b.value - a.value, c = 3.0 * rise - h * (2.0 * a.rate + b.rate),
               d = h * (a.rate + b.rate) - 2.0 * rise;
  if (h == 0.0) return b;
  return {a.value + s * (h * a.rate + s * (c + s * d)), a.rate + s * (2.0 * c + s * 3.0 * d) / h};
}

/// The share of the time h since the last instant after which all wheels of a vehicle are beyond the end; above 1 if
/// they are not.
double ExitStates::share_before_exit(const OpenEnd& end, const train::Fleet& fleet, const train::Member& member,
                                     double h) const {
  constexpr double never = 2.0;
  const train::MovingVehicle& vehicle = fleet.vehicles[member.unit];
  const std::size_t first = first_body(fleet, member);
  double latest = member.type->wheels.empty() ? never : 0.0;
  for (const train::Wheel& wheel : member.type->wheels) {
    const int body = member.first_body + wheel.body;
    const multibody::Frame& frame = vehicle.state.frames[static_cast<std::size_t>(body) + 1];
    const Motion now{frame.origin.x(), frame.velocity.x()};
    if (!(end.outward * (now.value - end.x) > 0.0)) return never;
    const Motion& before = before_[first + static_cast<std::size_t>(wheel.body)][0];
    if (end.outward * (before.value - end.x) > 0.0) continue;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double s = 0.5 * (low + high);
      (end.outward * (between(before, now, h, s).value - end.x) > 0.0 ? high : low) = s;
    }
    latest = std::max(latest, high);
  }
  return latest;
}

/// Whether a guided wheel leaves the end, which is released from its force at once: the instant before, at which a step
/// ends, has the tip's motion.
bool ExitStates::leaves_guide(const train::Member& member) const {
  return steps_end_before_exits_ && std::ranges::any_of(member.type->wheels, [](const train::Wheel& wheel) {
           return wheel.law.kind == contact::LawKind::two_sided;
         });
}

void ExitStates::add(double t, const train::Fleet& fleet, const std::vector<recovery::Response>& probes) {
  if (ends_.empty()) return;
  std::vector<std::array<Motion, 3>> bodies;
  for (const train::MovingVehicle& vehicle : fleet.vehicles)
    for (std::size_t i = 1; i < vehicle.state.frames.size(); ++i) {
      const multibody::Frame& f = vehicle.state.frames[i];
      bodies.push_back({Motion{f.origin.x(), f.velocity.x()}, {f.origin.y(), f.velocity.y()}, {f.angle, f.omega}});
    }
  std::vector<Motion> tips;
  for (const OpenEnd& end : ends_) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    tips.push_back(end.probe < 0 ? Motion{unknown, unknown}
                                 : Motion{probes[end.probe].deflection, probes[end.probe].velocity});
  }
  const bool first_instant = before_.empty();
  if (first_instant) {
    has_left_.assign(fleet.members.size(), 0);
    before_ = bodies;
    tips_before_ = tips;
    time_before_ = t;
  }
  const double h = t - time_before_;
  for (std::size_t m = 0; m < fleet.members.size(); ++m)
    for (std::size_t e = 0; e < ends_.size() && !has_left_[m]; ++e) {
      const train::Member& member = fleet.members[m];
      const double s = share_before_exit(ends_[e], fleet, member, h);
      if (s > 1.0) continue;
      has_left_[m] = 1;
      if (first_instant) continue;
      const std::size_t first = first_body(fleet, member);
      for (std::size_t i = 0; i < member.type->mechanism.bodies.size(); ++i) {
        Record record{time_before_ + s * h, static_cast<int>(m), static_cast<int>(i), {}, {}};
        for (std::size_t c = 0; c < 3; ++c)
          record.motion[c] = between(before_[first + i][c], bodies[first + i][c], h, s);
        record.tip = leaves_guide(member)
                         ? Motion{tips_before_[e].value + s * h * tips_before_[e].rate, tips_before_[e].rate}
                         : between(tips_before_[e], tips[e], h, s);
        records_.push_back(record);
      }
    }
  before_.swap(bodies);
  tips_before_.swap(tips);
  time_before_ = t;
}

std::vector<results::Recorder::Dataset> ExitStates::datasets() const {
  std::vector<double> time, position, velocity, tip, tip_velocity;
  for (const Record& record : records_) {
    time.push_back(record.time);
    for (const Motion& m : record.motion) {
      position.push_back(m.value);
      velocity.push_back(m.rate);
    }
    tip.push_back(record.tip.value);
    tip_velocity.push_back(record.tip.rate);
  }
  const std::size_t n = records_.size();
  return {{"/exit/time", {n}, time, "s"},
          {"/exit/position", {n, 3}, position, "m, m, rad"},
          {"/exit/velocity", {n, 3}, velocity, "m/s, m/s, rad/s"},
          {"/exit/tip_deflection", {n}, tip, "m"},
          {"/exit/tip_velocity", {n}, tip_velocity, "m/s"}};
}

std::vector<std::pair<std::string, std::string>> ExitStates::bodies(const train::Fleet& fleet) const {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Record& record : records_)
    rows.emplace_back(std::to_string(record.member), fleet.members[static_cast<std::size_t>(record.member)]
                                                         .type->mechanism.bodies[static_cast<std::size_t>(record.body)]
                                                         .name);
  return rows;
}

std::vector<AxleLoadRecords::Event> AxleLoadRecords::events_of(const scene::Scene& scene) {
  std::vector<Event> events;
  std::size_t wheel = 0;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    const base::SpeedLaw law = train::law_of(scene.train, i);
    for (const double start : scene::wheels_at_start(scene, i)) {
      for (const double place : scene.output.passages)
        if (const double time = law.time_of(place - start); time > 0.0 && std::isfinite(time))
          events.push_back({time, place, wheel});
      ++wheel;
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  return events;
}

std::vector<double> axle_passage_times(const scene::Scene& scene) {
  std::vector<double> times;
  for (const AxleLoadRecords::Event& event : AxleLoadRecords::events_of(scene)) times.push_back(event.time);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

AxleLoadRecords::AxleLoadRecords(const scene::Scene& scene, double time_step)
    : events_(events_of(scene)), tolerance_(same_step * time_step) {}

void AxleLoadRecords::add(double t, const train::Fleet& fleet) {
  if (events_.empty()) return;
  const auto wheels = first_points(fleet);
  if (at_start_.empty())
    for (const train::WheelContact* c : wheels) at_start_.push_back(fleet.load(*c).normal);
  for (; next_ < events_.size() && events_[next_].time <= t + tolerance_; ++next_) {
    const Event& event = events_[next_];
    const train::WheelContact& c = *wheels[event.wheel];
    const double distance = event.place - fleet.coordinates(c).x(), speed = fleet.velocities(c).x();
    const double delay = speed != 0.0 ? distance / speed : 0.0;
    records_.push_back({t + delay, event.place, speed, fleet.load(c).normal, at_start_[event.wheel], event.wheel});
  }
}

std::vector<results::Recorder::Dataset> AxleLoadRecords::datasets() const {
  std::vector<results::Recorder::Dataset> sets;
  const auto column = [&](const char* name, double Record::*member, const char* unit) {
    std::vector<double> values;
    for (const Record& record : records_) values.push_back(record.*member);
    sets.push_back({std::string("/passages/") + name, {values.size()}, std::move(values), unit});
  };
  column("x", &Record::place, "m");
  column("time", &Record::time, "s");
  column("speed", &Record::speed, "m/s");
  column("normal_force", &Record::force, "N");
  column("force_at_start", &Record::force_at_start, "N");
  return sets;
}

std::vector<std::pair<std::string, std::string>> AxleLoadRecords::wheels(const train::Fleet& fleet) const {
  std::vector<std::pair<std::string, std::string>> names, rows;
  for (const train::Member& member : fleet.members)
    for (const train::Wheel& wheel : member.type->wheels)
      names.emplace_back(std::to_string(&member - fleet.members.data()), wheel.name);
  for (const Record& record : records_) rows.push_back(names[record.wheel]);
  return rows;
}

}  // namespace traverse::run
