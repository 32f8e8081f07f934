// Computes the passage times of all wheels from the speed law, and stores time, speed and normal force at each of them.
#include "run/axle_load_records.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::run {
namespace {

constexpr double same_step = 2e-3;  // relative to the step: instants within half of this share the end of a step

/// The contacts of wheels, each with its first contact point only.
std::vector<const train::WheelContact*> first_points(const train::Fleet& fleet) {
  std::vector<const train::WheelContact*> wheels;
  for (const train::WheelContact& c : fleet.wheels)
    if (!c.is_further) wheels.push_back(&c);
  return wheels;
}

}  // namespace

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
