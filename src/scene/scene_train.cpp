// train and load of a scene: what moves, from where, how fast.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "load_models.hpp"
#include "scene_parts.hpp"

namespace traverse::app {
namespace {

using options::Options;

constexpr double most_forces = 1e5;

/// x of the front wheel's centre relative to the origin; 0 without wheels.
double front_of(const Vehicle& vehicle) {
  double front = 0.0;
  bool first = true;
  for (const Wheel& wheel : vehicle.wheels) {
    const double x = vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)].position.x();
    front = first ? x : std::max(front, x);
    first = false;
  }
  return front;
}

/// Origins in the middle of vehicles of known length.
double gap_by_length(const Options& o, const Vehicle& front, const Vehicle& rear) {
  double gap = 0.0;
  for (const Vehicle* vehicle : {&front, &rear}) {
    const std::string length = "vehicle_" + vehicle->name + "_length";
    if (!o.has(length)) o.refuse("train_spacing", "missing: distance from origin to origin (or " + length + ")");
    gap += 0.5 * o.number(length);
  }
  return gap;
}

std::vector<double> read_positions(const Options& o, const Scene& scene) {
  const std::vector<int>& order = scene.train.vehicles;
  const auto vehicle = [&](std::size_t i) -> const Vehicle& {
    return scene.vehicles[static_cast<std::size_t>(order[i])];
  };
  std::vector<double> x;
  if (o.has("train_positions")) x = o.numbers("train_positions");
  if (x.size() > 1 || (order.size() == 1 && !x.empty())) {
    if (x.size() > 1 && o.has("train_spacing"))
      o.refuse("train_spacing", "all positions are given: leave the spacing out");
    if (x.size() != order.size()) {
      o.refuse("train_positions", order.size() == 1 ? fmt::format("has {} entries; wanted: 1, one a vehicle", x.size())
                                                    : fmt::format("has {} entries; wanted: one, or {}, one a vehicle",
                                                                  x.size(), order.size()));
    }
    return x;
  }
  if (x.empty()) x.push_back(-front_of(vehicle(0)));
  std::vector<double> gaps;
  if (o.has("train_spacing") && order.size() > 1) {
    gaps = o.numbers("train_spacing", order.size() - 1, "one per gap between vehicles");
  }
  for (std::size_t i = 1; i < order.size(); ++i) {
    x.push_back(x.back() - (gaps.empty() ? gap_by_length(o, vehicle(i - 1), vehicle(i)) : gaps[i - 1]));
  }
  return x;
}

/// x of the first axle at t = 0.
double read_first_axle(const Options& o, const std::string& trains) {
  if (!o.has("load_positions")) return 0.0;
  const std::vector<double> given = o.numbers("load_positions");
  if (given.size() != 1) o.refuse("load_positions", "with " + trains + ": one number, x of the first axle at t = 0");
  return given.front();
}

MovingLoad placed(const AxleList& axles, double first) {
  MovingLoad load{axles.forces, axles.offsets, 0.0};
  for (double& x : load.positions) x += first;
  return load;
}

/// Over three sleepers (EN 1991-2, 6.3.6.1). from_zero: the foremost part stands where the foremost force stood.
void spread(double spacing, bool from_zero, MovingLoad& load) {
  MovingLoad parts;
  for (std::size_t i = 0; i < load.forces.size(); ++i)
    for (const auto& [part, ahead] : {std::pair{0.25, 1.0}, {0.5, 0.0}, {0.25, -1.0}}) {
      parts.forces.push_back(part * load.forces[i]);
      parts.positions.push_back(load.positions[i] + (ahead - (from_zero ? 1.0 : 0.0)) * spacing);
    }
  load.forces = parts.forces;
  load.positions = parts.positions;
}

/// The train that an option other than load_forces and sweep_hslm_a asks for.
AxleList named_train(const Options& o, const std::string& option) {
  if (option == "load_hslm_a") return hslm_a(o.integer(option));
  if (option == "load_en15528") return en15528(o.text(option), o.integer("load_wagons"));
  if (option == "load_file") return read_axles(o.path(option));
  const std::vector<double> given = o.numbers(option);  // load_hslm_b
  if (given[0] != std::floor(given[0]) || given[0] > most_forces)
    o.refuse(option, fmt::format("allowed: a whole number of forces up to {:g}, and their distance in m", most_forces));
  return hslm_b(static_cast<int>(given[0]), given[1]);
}

void read_forces(const Options& o, MovingLoad& load) {
  const std::vector<double> positions =
      o.has("load_positions") ? o.numbers("load_positions") : std::vector<double>{0.0};
  const std::vector<double> forces = o.numbers("load_forces");
  if (forces.size() == 1 || forces.size() == positions.size()) {
    load.forces = o.numbers("load_forces", positions.size(), "one a position");
    load.positions = positions;
    return;
  }
  const std::string why =
      fmt::format("{} forces but {} positions; wanted: one a force", forces.size(), positions.size());
  o.refuse("load_positions", o.has("load_positions") ? why : "missing: x of each force at t = 0");
}

/// The gaps of a coupler, each between vehicles that have its bodies.
std::vector<int> read_gaps(const Options& o, const Scene& scene, const Coupler& coupler) {
  const int last = static_cast<int>(scene.train.vehicles.size()) - 1;
  const std::string after = "train_" + coupler.name + "_after", bodies = "train_" + coupler.name + "_bodies";
  std::vector<int> gaps;
  if (o.has(after)) {
    gaps = o.integers(after);
  } else {
    for (int k = 0; k < last; ++k) gaps.push_back(k);
  }
  if (gaps.empty())
    o.refuse("train_couplers",
             fmt::format("there is nothing for {} to join: give a train of two vehicles or more", coupler.name));
  std::sort(gaps.begin(), gaps.end());
  if (std::adjacent_find(gaps.begin(), gaps.end()) != gaps.end()) o.refuse(after, "allowed: every vehicle once");
  for (const int gap : gaps) {
    if (gap >= last)
      o.refuse(after, fmt::format("behind vehicle {} there is none; allowed: from 0 to {}", gap, last - 1));
    for (std::size_t end = 0; end < 2; ++end) {
      const Vehicle& vehicle =
          scene.vehicles[static_cast<std::size_t>(scene.train.vehicles[static_cast<std::size_t>(gap) + end])];
      const auto& names = vehicle.mechanism.bodies;
      const auto same = [&](const multibody::Body& b) { return b.name == coupler.bodies[end]; };
      if (std::none_of(names.begin(), names.end(), same))
        o.refuse(bodies, fmt::format("vehicle {} of the train, a {}, has no body '{}'", gap + static_cast<int>(end),
                                     vehicle.name, coupler.bodies[end]));
    }
  }
  return gaps;
}

}  // namespace

void read_train(const Options& o, const std::vector<std::string>& names, Scene& scene) {
  for (const std::string& name : names) {
    const auto same = [&](const Vehicle& v) { return v.name == name; };
    auto place = std::find_if(scene.vehicles.begin(), scene.vehicles.end(), same);
    if (place == scene.vehicles.end()) {
      scene.vehicles.push_back(read_vehicle(o, name));
      place = scene.vehicles.end() - 1;
    }
    scene.train.vehicles.push_back(static_cast<int>(place - scene.vehicles.begin()));
  }
  if (names.empty()) return;
  scene.train.positions = read_positions(o, scene);
  if (o.has("train_couplers"))
    for (const std::string& name : o.texts("train_couplers")) {
      scene.train.couplers.push_back(read_coupler(o, name));
      scene.train.couplers.back().gaps = read_gaps(o, scene, scene.train.couplers.back());
    }
  const auto has_wheels = [](const Vehicle& v) { return !v.wheels.empty(); };
  const bool rolls = std::any_of(scene.vehicles.begin(), scene.vehicles.end(), has_wheels);
  const std::string drive = o.has("train_drive") ? o.choice("train_drive") : rolls ? "constant" : "free";
  scene.train.drive = drive == "free" ? Drive::free : Drive::constant;
  const bool needed = rolls && scene.analysis == Analysis::transient;
  if (scene.sweep && !scene.sweep->speeds.empty()) {
    scene.train.speed = scene.sweep->speeds.front();
    return;
  }
  scene.train.speed = needed || o.has("train_speed") ? o.number("train_speed") : 0.0;
}

std::string load_option(const Options& o) {
  std::string given;
  for (const char* option : {"load_forces", "load_hslm_a", "load_hslm_b", "load_en15528", "load_file", "sweep_hslm_a"})
    if (o.has(option)) {
      if (!given.empty()) o.refuse(option, fmt::format("give either {} or {}", given, option));
      given = option;
    }
  return given;
}

void read_load(const Options& o, Scene& scene) {
  const bool swept = scene.sweep && !scene.sweep->trains.empty();
  const std::string option = swept ? "sweep_hslm_a" : load_option(o);
  if (option.empty()) return;
  if (option == "load_forces") {
    read_forces(o, scene.load);
  } else {
    const double first = read_first_axle(o, option);
    scene.load = placed(swept ? hslm_a(scene.sweep->trains.front()) : named_train(o, option), first);
    if (swept)
      for (const int train : scene.sweep->trains) scene.sweep->loads.push_back(placed(hslm_a(train), first));
  }
  if (o.has("load_spread")) {
    const double spacing = o.number("load_spread");
    spread(spacing, !o.has("load_positions"), scene.load);
    if (swept)
      for (MovingLoad& load : scene.sweep->loads) spread(spacing, !o.has("load_positions"), load);
  }
  if (option != "load_en15528" && o.has("load_wagons"))
    scene.notes.emplace_back("load_wagons has no effect: it is for load_en15528");
  if (!scene.beam) o.refuse(option, "moving forces need a beam (beam_spans)");
  const bool needed = scene.analysis == Analysis::transient && !o.has("train_speed");
  if (scene.sweep && !scene.sweep->speeds.empty()) {
    scene.load.speed = scene.sweep->speeds.front();
  } else if (o.has("load_speed") || needed) {
    scene.load.speed = o.number("load_speed");
  } else if (o.has("train_speed")) {
    scene.load.speed = o.number("train_speed");
  }
}

}  // namespace traverse::app
