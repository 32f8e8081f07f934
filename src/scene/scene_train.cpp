// train and load of a scene: what moves, from where, how fast.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene_parts.hpp"

namespace traverse::app {
namespace {

using options::Options;

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

/// Forces and positions relative to the first axle, backward negative (EN 1991-2, table 8.4 and figure 8.12).
struct Axles {
  double force = 0.0;  // N
  std::vector<double> offsets;
};

Axles hslm_a(int train) {
  struct Type {
    int coaches;
    double length, bogie, force;  // m, m, kN
  };
  static constexpr std::array<Type, 10> types = {{{18, 18.0, 2.0, 170.0},
                                                  {17, 19.0, 3.5, 200.0},
                                                  {16, 20.0, 2.0, 180.0},
                                                  {15, 21.0, 3.0, 190.0},
                                                  {14, 22.0, 2.0, 170.0},
                                                  {13, 23.0, 2.0, 180.0},
                                                  {13, 24.0, 2.0, 190.0},
                                                  {12, 25.0, 2.5, 190.0},
                                                  {11, 26.0, 2.0, 210.0},
                                                  {11, 27.0, 2.0, 210.0}}};
  const auto [coaches, length, bogie, force] = types[static_cast<std::size_t>(train - 1)];
  constexpr std::array power_car = {0.0, 3.0, 14.0, 17.0};
  constexpr double coupling = 3.525;  // from a power car's last axle to the first one of the end coach
  const double whole = 2.0 * power_car.back() + coupling + (coaches + 2) * length;
  std::vector<double> behind(power_car.begin(), power_car.end());
  behind.push_back(power_car.back() + coupling);
  behind.push_back(power_car.back() + coupling + bogie);
  const std::size_t mirrored = behind.size();
  for (int i = 1; i <= coaches + 1; ++i) {  // bogies between two coaches
    const double centre = power_car.back() + 0.5 * coupling + i * length;
    behind.push_back(centre - 0.5 * bogie);
    behind.push_back(centre + 0.5 * bogie);
  }
  for (std::size_t i = mirrored; i-- > 0;) behind.push_back(whole - behind[i]);
  Axles axles{force * 1e3, {}};
  for (const double x : behind) axles.offsets.push_back(-x);
  return axles;
}

/// x of the first axle at t = 0.
double read_first_axle(const Options& o, const std::string& trains) {
  if (o.has("load_forces")) o.refuse(trains, "give either load_forces or " + trains);
  if (!o.has("load_positions")) return 0.0;
  const std::vector<double> given = o.numbers("load_positions");
  if (given.size() != 1) o.refuse("load_positions", "with " + trains + ": one number, x of the first axle at t = 0");
  return given.front();
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

MovingLoad hslm_load(int train, double first) {
  const Axles axles = hslm_a(train);
  MovingLoad load;
  for (const double offset : axles.offsets) load.positions.push_back(first + offset);
  load.forces.assign(axles.offsets.size(), axles.force);
  return load;
}

void read_load(const Options& o, Scene& scene) {
  const bool swept = scene.sweep && !scene.sweep->trains.empty();
  const std::string option = swept ? "sweep_hslm_a" : o.has("load_hslm_a") ? "load_hslm_a" : "load_forces";
  if (!o.has(option)) return;
  if (option == "load_forces") {
    read_forces(o, scene.load);
  } else {
    const double first = read_first_axle(o, option);
    scene.load = hslm_load(swept ? scene.sweep->trains.front() : o.integer(option), first);
    if (swept)
      for (const int train : scene.sweep->trains) scene.sweep->loads.push_back(hslm_load(train, first));
  }
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
