// Collects the extremes of wheels by train, and those of probes by span.
#include "run/line_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace traverse::run {
namespace {

using Datasets = std::vector<results::Recorder::Dataset>;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The outer wheels of a train at t = 0, m, and its speed.
struct RunningTrain {
  double rear = std::numeric_limits<double>::infinity(), front = -rear;
  base::SpeedLaw law;

  /// The distance between the train at t and the range from `left` to `right`; 0: they overlap.
  double distance(double t, double left, double right) const {
    const double way = law.distance(t);
    return std::max({0.0, rear + way - right, left - front - way});
  }
};

std::vector<RunningTrain> running_trains(const scene::Scene& scene) {
  std::vector<RunningTrain> trains;
  std::size_t next = 0;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    const std::vector<train::Course>& courses = scene.train.courses;
    if (next < courses.size() && courses[next].first == i) trains.push_back({.law = courses[next++].speed});
    for (const double x : scene::wheels_at_start(scene, i)) {
      trains.back().rear = std::min(trains.back().rear, x);
      trains.back().front = std::max(trains.back().front, x);
    }
  }
  return trains;
}

/// A peak of each train or span, one list for values and times.
struct Peaks {
  std::vector<double> values, times;

  void add(const Extreme& extreme) {
    const bool known = std::isfinite(extreme.value) && !std::isnan(extreme.time);
    values.push_back(known ? extreme.value : unknown);
    times.push_back(known ? extreme.time : unknown);
  }
  void store(const std::string& name, const char* unit, Datasets& sets) {
    const std::size_t count = values.size();
    sets.push_back({name, {count}, std::move(values), unit});
    sets.push_back({name + "_time", {count}, std::move(times), "s"});
  }
};

}  // namespace

Datasets peaks_of_trains(const scene::Scene& scene, const train::Fleet& fleet, const WheelExtremes& wheels) {
  Peaks least, greatest, unloading;
  std::vector<double> on_bridge;
  const std::vector<train::Course>& courses = scene.train.courses;
  std::size_t entry = 0, wheel = 0;  // in Fleet::wheels, and without further contact points
  for (std::size_t k = 0; k < courses.size(); ++k) {
    const int past =
        k + 1 < courses.size() ? fleet.members[courses[k + 1].first].unit : static_cast<int>(fleet.vehicles.size());
    const std::size_t first = wheel;
    for (; entry < fleet.wheels.size() && fleet.wheels[entry].vehicle < past; ++entry)
      if (!fleet.wheels[entry].is_further) ++wheel;
    const WheelExtremes::Extremes of_train = wheels.of(first, wheel);
    least.add(of_train.least);
    greatest.add(of_train.greatest);
    unloading.add(of_train.unloading.value < 0.0 ? Extreme{unknown, unknown} : of_train.unloading);
  }
  const double length = scene.beam ? scene.beam->length() : 0.0;
  for (const RunningTrain& train : running_trains(scene)) {
    const bool to_the_left = train.law.direction() < 0.0;
    on_bridge.push_back(train.law.time_of(to_the_left ? length - train.rear : -train.front));
    on_bridge.push_back(train.law.time_of(to_the_left ? -train.front : length - train.rear));
  }
  Datasets sets;
  least.store("/trains/least_wheel_force", "N", sets);
  greatest.store("/trains/greatest_wheel_force", "N", sets);
  unloading.store("/trains/wheel_unloading", "1", sets);
  if (scene.beam) sets.push_back({"/trains/on_bridge", {courses.size(), 2}, std::move(on_bridge), "s"});
  return sets;
}

std::vector<std::pair<std::string, std::string>> names_of_trains(const scene::Scene& scene) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const train::Course& course : scene.train.courses) names.emplace_back(course.name, std::to_string(course.first));
  return names;
}

Datasets peaks_of_spans(const scene::Scene& scene, const ResponseExtremes& peaks) {
  const std::vector<double>& spans = scene.beam->spans;
  const std::vector<double>& probes = scene.output.probes;
  const std::vector<RunningTrain> trains = running_trains(scene);
  std::vector<double> ends;
  double left = scene.beam->start;
  for (const double span : spans) {
    ends.insert(ends.end(), {left, left + span});
    left += span;
  }
  std::vector<std::size_t> order(probes.size());
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = p;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return probes[a] < probes[b]; });
  Datasets sets{{"/spans/x", {spans.size(), 2}, ends, "m"}};
  for (const Quantity q : {deflection, acceleration, moment}) {
    if (q == moment && scene.by_given_modes()) continue;
    Peaks of_spans;
    std::vector<double> by_train;
    auto probe = order.begin();
    for (std::size_t s = 0; s < spans.size(); ++s) {
      Extreme largest{0.0, unknown};
      while (probe != order.end() && probes[*probe] < ends[2 * s]) ++probe;
      for (auto p = probe; p != order.end() && probes[*p] <= ends[2 * s + 1]; ++p)
        if (const Extreme& extreme = peaks.largest_of_each(q)[*p]; std::abs(extreme.value) > std::abs(largest.value))
          largest = extreme;
      const auto nearest = std::min_element(trains.begin(), trains.end(), [&](const auto& one, const auto& other) {
        return one.distance(largest.time, ends[2 * s], ends[2 * s + 1]) <
               other.distance(largest.time, ends[2 * s], ends[2 * s + 1]);
      });
      const bool known = nearest != trains.end() && !std::isnan(largest.time);
      by_train.push_back(known ? static_cast<double>(nearest - trains.begin()) : unknown);
      of_spans.add(largest);
    }
    const std::string name = std::string("/spans/") + stored_names[q];
    of_spans.store(name, quantity_units[q], sets);
    sets.push_back({name + "_train", {spans.size()}, std::move(by_train), "1"});
  }
  return sets;
}

}  // namespace traverse::run
