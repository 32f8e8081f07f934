// Computes the passage times of all wheels from the speed law, and stores time, speed and normal force at each of them.
#include "run/axle_load_records.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::app {
namespace {

constexpr double shared_end = 2e-3;  // of a step: instants closer than half of this share the end of a step

/// The contacts of wheels, without further points of the same wheel.
std::vector<const train::WheelContact*> first_points(const train::Fleet& fleet) {
  std::vector<const train::WheelContact*> wheels;
  for (const train::WheelContact& c : fleet.wheels)
    if (!c.is_further) wheels.push_back(&c);
  return wheels;
}

}  // namespace

std::vector<AxleLoadRecords::Due> AxleLoadRecords::due_of(const Scene& scene) {
  std::vector<Due> due;
  std::size_t wheel = 0;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    const base::SpeedLaw law = train::law_of(scene.train, i);
    for (const double start : wheels_at_start(scene, i)) {
      for (const double place : scene.output.passages)
        if (const double time = law.time_of(place - start); time > 0.0 && std::isfinite(time))
          due.push_back({time, place, wheel});
      ++wheel;
    }
  }
  std::stable_sort(due.begin(), due.end(), [](const Due& a, const Due& b) { return a.time < b.time; });
  return due;
}

std::vector<double> axle_passage_times(const Scene& scene) {
  std::vector<double> times;
  for (const AxleLoadRecords::Due& due : AxleLoadRecords::due_of(scene)) times.push_back(due.time);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

AxleLoadRecords::AxleLoadRecords(const Scene& scene, double time_step)
    : due_(due_of(scene)), tolerance_(shared_end * time_step) {}

void AxleLoadRecords::add(double t, const train::Fleet& fleet) {
  if (due_.empty()) return;
  const auto wheels = first_points(fleet);
  if (at_start_.empty())
    for (const train::WheelContact* c : wheels) at_start_.push_back(fleet.load(*c).normal);
  for (; next_ < due_.size() && due_[next_].time <= t + tolerance_; ++next_) {
    const Due& due = due_[next_];
    const train::WheelContact& c = *wheels[due.wheel];
    const double ahead = due.place - fleet.coordinates(c).x(), speed = fleet.velocities(c).x();
    const double late = speed != 0.0 ? ahead / speed : 0.0;
    found_.push_back({t + late, due.place, speed, fleet.load(c).normal, at_start_[due.wheel], due.wheel});
  }
}

std::vector<results::Recorder::Dataset> AxleLoadRecords::datasets() const {
  std::vector<results::Recorder::Dataset> sets;
  const auto column = [&](const char* name, double Found::*member, const char* unit) {
    std::vector<double> values;
    for (const Found& found : found_) values.push_back(found.*member);
    sets.push_back({std::string("/passages/") + name, {values.size()}, std::move(values), unit});
  };
  column("x", &Found::place, "m");
  column("time", &Found::time, "s");
  column("speed", &Found::speed, "m/s");
  column("normal_force", &Found::force, "N");
  column("force_at_start", &Found::force_at_start, "N");
  return sets;
}

std::vector<std::pair<std::string, std::string>> AxleLoadRecords::wheels(const train::Fleet& fleet) const {
  std::vector<std::pair<std::string, std::string>> names, rows;
  for (const train::Member& member : fleet.members)
    for (const train::Wheel& wheel : member.type->wheels)
      names.emplace_back(std::to_string(&member - fleet.members.data()), wheel.name);
  for (const Found& found : found_) rows.push_back(names[found.wheel]);
  return rows;
}

}  // namespace traverse::app
