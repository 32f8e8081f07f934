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

struct RunningTrain {
  std::string name;
  std::size_t first = 0;  // its first vehicle
  base::SpeedLaw law;
  bool is_driven = true;  // by the law
  // The outer wheels at t = 0, m.
  double rear = std::numeric_limits<double>::infinity(), front = -rear;

  /// The distance between the train at t and the range from `left` to `right`; 0: they overlap; infinite: unknown.
  double distance(double t, double left, double right) const {
    if (!is_driven) return std::numeric_limits<double>::infinity();
    const double way = law.distance(t);
    return std::max({0.0, rear + way - right, left - front - way});
  }
};

std::vector<RunningTrain> running_trains(const scene::Scene& scene) {
  std::vector<RunningTrain> trains;
  for (const train::Course& course : scene.train.courses) trains.push_back({course.name, course.first, course.speed});
  if (trains.empty() && !scene.vehicles.empty()) trains.push_back({"train", 0, base::SpeedLaw(scene.train.speed)});
  for (RunningTrain& train : trains) train.is_driven = drive_of(scene.train, train.first) == train::Drive::constant;
  for (std::size_t i = 0, k = 0; i < scene.train.vehicles.size(); ++i) {
    if (k + 1 < trains.size() && trains[k + 1].first == i) ++k;
    for (const double x : scene::wheels_at_start(scene, i)) {
      trains[k].rear = std::min(trains[k].rear, x);
      trains[k].front = std::max(trains[k].front, x);
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
  const std::vector<RunningTrain> trains = running_trains(scene);
  std::size_t entry = 0, wheel = 0;  // in Fleet::wheels, and without further contact points
  for (std::size_t k = 0; k < trains.size(); ++k) {
    const int past =
        k + 1 < trains.size() ? fleet.members[trains[k + 1].first].unit : static_cast<int>(fleet.vehicles.size());
    const std::size_t first = wheel;
    for (; entry < fleet.wheels.size() && fleet.wheels[entry].vehicle < past; ++entry)
      if (!fleet.wheels[entry].is_further) ++wheel;
    const WheelExtremes::Extremes of_train = wheels.of(first, wheel);
    least.add(of_train.least);
    greatest.add(of_train.greatest);
    unloading.add(of_train.unloading.value < 0.0 ? Extreme{unknown, unknown} : of_train.unloading);
  }
  const double length = scene.beam ? scene.beam->length() : 0.0;
  for (const RunningTrain& train : trains) {
    const bool to_the_left = train.law.direction() < 0.0;
    const auto time_of = [&](double way) { return train.is_driven ? train.law.time_of(way) : unknown; };
    on_bridge.push_back(time_of(to_the_left ? length - train.rear : -train.front));
    on_bridge.push_back(time_of(to_the_left ? -train.front : length - train.rear));
  }
  Datasets sets;
  least.store("/trains/least_wheel_force", "N", sets);
  greatest.store("/trains/greatest_wheel_force", "N", sets);
  unloading.store("/trains/wheel_unloading", "1", sets);
  if (scene.beam) sets.push_back({"/trains/on_bridge", {trains.size(), 2}, std::move(on_bridge), "s"});
  return sets;
}

std::vector<std::pair<std::string, std::string>> names_of_trains(const scene::Scene& scene) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const RunningTrain& train : running_trains(scene)) names.emplace_back(train.name, std::to_string(train.first));
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
