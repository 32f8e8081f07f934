// train and load of a scene: what moves, from where, how fast.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "load_models.hpp"
#include "scene_parts.hpp"
#include "train/mirrored.hpp"

namespace traverse::app {
namespace {

using options::Options;

constexpr double most_forces = 1e5;

/// x of the wheel's centre that is in front towards `direction`, relative to the origin; 0 without wheels.
double front_of(const Vehicle& vehicle, double direction) {
  double front = 0.0;
  bool first = true;
  for (const Wheel& wheel : vehicle.wheels) {
    const double x = vehicle.mechanism.bodies[static_cast<std::size_t>(wheel.body)].position.x();
    front = first || direction * x > direction * front ? x : front;
    first = false;
  }
  return front;
}

/// Where something that comes from this side meets the bridge.
double entrance(const Scene& scene, double direction) {
  return direction < 0.0 && scene.beam ? scene.beam->length() : 0.0;
}

/// One train: its options, its types (indices into Scene::vehicles), and where it runs to.
struct ReadTrain {
  const Block& block;
  std::vector<int> order;
  double direction = 1.0;
};

/// Origins in the middle of vehicles of known length.
double gap_by_length(const Options& o, const std::string& spacing, const Vehicle& front, const Vehicle& rear) {
  double gap = 0.0;
  for (const Vehicle* vehicle : {&front, &rear}) {
    const std::string length = "vehicle_" + vehicle->name + "_length";
    if (!o.has(length)) o.refuse(spacing, "missing: distance from origin to origin (or " + length + ")");
    gap += 0.5 * o.number(length);
  }
  return gap;
}

std::vector<double> read_positions(const Options& o, const ReadTrain& train, const Scene& scene) {
  const std::vector<int>& order = train.order;
  const std::string positions = train.block.option("positions"), spacing = train.block.option("spacing");
  const auto vehicle = [&](std::size_t i) -> const Vehicle& {
    return scene.vehicles[static_cast<std::size_t>(order[i])];
  };
  std::vector<double> x;
  if (o.has(positions)) x = o.numbers(positions);
  if (x.size() > 1 || (order.size() == 1 && !x.empty())) {
    if (x.size() > 1 && o.has(spacing)) o.refuse(spacing, "all positions are given: leave the spacing out");
    if (x.size() != order.size()) {
      o.refuse(positions, order.size() == 1 ? fmt::format("has {} entries; wanted: 1, one a vehicle", x.size())
                                            : fmt::format("has {} entries; wanted: one, or {}, one a vehicle", x.size(),
                                                          order.size()));
    }
    return x;
  }
  if (x.empty()) x.push_back(entrance(scene, train.direction) - front_of(vehicle(0), train.direction));
  std::vector<double> gaps;
  if (o.has(spacing) && order.size() > 1) {
    gaps = o.numbers(spacing, order.size() - 1, "one per gap between vehicles");
  }
  for (std::size_t i = 1; i < order.size(); ++i) {
    const double gap = gaps.empty() ? gap_by_length(o, spacing, vehicle(i - 1), vehicle(i)) : gaps[i - 1];
    x.push_back(x.back() - train.direction * gap);
  }
  return x;
}

/// One load: its options, and where it runs to.
struct ReadLoad {
  const Block& block;
  double direction = 1.0;
};

/// x of the first axle at t = 0.
double read_first_axle(const Options& o, const ReadLoad& load, const Scene& scene, const std::string& trains) {
  const std::string positions = load.block.option("positions");
  if (!o.has(positions)) return entrance(scene, load.direction);
  const std::vector<double> given = o.numbers(positions);
  if (given.size() != 1) o.refuse(positions, "with " + trains + ": one number, x of the first axle at t = 0");
  return given.front();
}

MovingLoad placed(const AxleList& axles, double first, double direction) {
  MovingLoad load{axles.forces, axles.offsets, 0.0, {}};
  for (double& x : load.positions) x = first + direction * x;
  return load;
}

/// Over three sleepers (EN 1991-2, 6.3.6.1). from_zero: the foremost part stands where the foremost force stood.
void spread(double spacing, bool from_zero, double direction, MovingLoad& load) {
  MovingLoad parts;
  for (std::size_t i = 0; i < load.forces.size(); ++i)
    for (const auto& [part, ahead] : {std::pair{0.25, 1.0}, {0.5, 0.0}, {0.25, -1.0}}) {
      parts.forces.push_back(part * load.forces[i]);
      parts.positions.push_back(load.positions[i] + direction * (ahead - (from_zero ? 1.0 : 0.0)) * spacing);
    }
  load.forces = parts.forces;
  load.positions = parts.positions;
}

/// The train that an option of the block other than forces and sweep_hslm_a asks for.
AxleList named_train(const Options& o, const Block& block, const std::string& option) {
  if (option == block.option("hslm_a")) return hslm_a(o.integer(option));
  if (option == block.option("en15528")) return en15528(o.text(option), o.integer(block.option("wagons")));
  if (option == block.option("file")) return read_axles(o.path(option));
  const std::vector<double> given = o.numbers(option);  // load_hslm_b
  if (given[0] != std::floor(given[0]) || given[0] > most_forces)
    o.refuse(option, fmt::format("allowed: a whole number of forces up to {:g}, and their distance in m", most_forces));
  return hslm_b(static_cast<int>(given[0]), given[1]);
}

void read_forces(const Options& o, const ReadLoad& from, const Scene& scene, MovingLoad& load) {
  const std::string positions_option = from.block.option("positions"), forces_option = from.block.option("forces");
  const std::vector<double> positions =
      o.has(positions_option) ? o.numbers(positions_option) : std::vector<double>{entrance(scene, from.direction)};
  const std::vector<double> forces = o.numbers(forces_option);
  if (forces.size() == 1 || forces.size() == positions.size()) {
    load.forces = o.numbers(forces_option, positions.size(), "one a position");
    load.positions = positions;
    return;
  }
  const std::string why =
      fmt::format("{} forces but {} positions; wanted: one a force", forces.size(), positions.size());
  o.refuse(positions_option, o.has(positions_option) ? why : "missing: x of each force at t = 0");
}

/// The gaps of a coupler, each between vehicles that have its bodies, counted from the train's first one.
std::vector<int> read_gaps(const Options& o, const ReadTrain& train, const Scene& scene, const Coupler& coupler,
                           const std::string& name) {
  const int last = static_cast<int>(train.order.size()) - 1;
  const std::string after = train.block.option(name + "_after"), bodies = train.block.option(name + "_bodies");
  std::vector<int> gaps;
  if (o.has(after)) {
    gaps = o.integers(after);
  } else {
    for (int k = 0; k < last; ++k) gaps.push_back(k);
  }
  if (gaps.empty())
    o.refuse(train.block.option("couplers"),
             fmt::format("there is nothing for {} to join: give a train of two vehicles or more", name));
  std::sort(gaps.begin(), gaps.end());
  if (std::adjacent_find(gaps.begin(), gaps.end()) != gaps.end()) o.refuse(after, "allowed: every vehicle once");
  for (const int gap : gaps) {
    if (gap >= last)
      o.refuse(after, fmt::format("behind vehicle {} there is none; allowed: from 0 to {}", gap, last - 1));
    for (std::size_t end = 0; end < 2; ++end) {
      const Vehicle& vehicle =
          scene.vehicles[static_cast<std::size_t>(train.order[static_cast<std::size_t>(gap) + end])];
      const auto& names = vehicle.mechanism.bodies;
      const auto same = [&](const multibody::Body& b) { return b.name == coupler.bodies[end]; };
      if (std::none_of(names.begin(), names.end(), same))
        o.refuse(bodies, fmt::format("vehicle {} of the train, a {}, has no body '{}'", gap + static_cast<int>(end),
                                     vehicle.name, coupler.bodies[end]));
    }
  }
  return gaps;
}

/// The types of vehicles that trains are put together from, each read once for either direction.
class Types {
 public:
  Types(const Options& o, Scene& scene) : o_(o), scene_(scene) {}

  int index_of(const std::string& name, double direction) {
    const std::pair key(name, direction < 0.0);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    Vehicle vehicle = read_vehicle(o_, name);
    scene_.vehicles.push_back(key.second ? train::mirrored(std::move(vehicle)) : std::move(vehicle));
    return known_[key] = static_cast<int>(scene_.vehicles.size()) - 1;
  }

 private:
  const Options& o_;
  Scene& scene_;
  std::map<std::pair<std::string, bool>, int> known_;
};

void read_couplers(const Options& o, const ReadTrain& train, bool alone, Scene& scene) {
  const std::string list = train.block.option("couplers");
  if (!o.has(list)) return;
  const int first = static_cast<int>(scene.train.vehicles.size() - train.order.size());
  for (const std::string& name : o.texts(list)) {
    Coupler coupler = read_coupler(o, train.block, name);
    coupler.gaps = read_gaps(o, train, scene, coupler, name);
    for (int& gap : coupler.gaps) gap += first;
    if (train.direction < 0.0) coupler = train::mirrored(std::move(coupler));
    if (!alone) coupler.name = train.block.option(name);
    scene.train.couplers.push_back(std::move(coupler));
  }
}

bool rolls(const ReadTrain& train, const Scene& scene) {
  return std::any_of(train.order.begin(), train.order.end(),
                     [&](int type) { return !scene.vehicles[static_cast<std::size_t>(type)].wheels.empty(); });
}

Drive read_drive(const Options& o, const ReadTrain& train, const Scene& scene) {
  const std::string option = train.block.option("drive"), file = train.block.option("speed_file");
  const std::string drive = o.has(option) ? o.choice(option) : rolls(train, scene) ? "constant" : "free";
  if (drive == "free" && o.has(file))
    o.refuse(file, o.has(option) ? "prescribes the speed; with " + option + " free only forces act"
                                 : "prescribes the speed of wheels, and the train has none");
  return drive == "free" ? Drive::free : Drive::constant;
}

/// x of the front wheel of the train that has been added last.
double front_wheel(const ReadTrain& train, const Scene& scene) {
  std::optional<double> front;
  for (std::size_t i = scene.train.vehicles.size() - train.order.size(); i < scene.train.vehicles.size(); ++i)
    for (const double x : wheels_at_start(scene, i))
      if (!front || train.direction * x > train.direction * *front) front = x;
  return front.value_or(0.0);
}

double read_speed(const Options& o, const ReadTrain& train, const Scene& scene) {
  const std::string option = train.block.option("speed");
  const bool needed = rolls(train, scene) && scene.analysis == Analysis::transient;
  return needed || o.has(option) ? o.number(option) : 0.0;
}

train::Course course_of_train(const Options& o, const ReadTrain& train, Scene& scene) {
  train::Course course;
  course.name = train.block.name;
  course.first = scene.train.vehicles.size() - train.order.size();
  course.drive = read_drive(o, train, scene);
  const double front = front_wheel(train, scene);
  course.speed = o.has(train.block.option("speed_file")) ? read_speed_file(o, train.block, front)
                                                         : base::SpeedLaw(read_speed(o, train, scene));
  if (o.has(train.block.option("profile")))
    course.profile = std::make_shared<track::Profile>(
        read_profile(o, train.block.name, front, train.direction < 0.0, scene).profile);
  return course;
}

}  // namespace

void read_trains(const Options& o, const NamedVehicles& vehicles, Scene& scene) {
  if (vehicles.train.empty()) return;
  Types types(o, scene);
  const bool courses = needs_courses(o, vehicles.trains);
  for (const Block& block : vehicles.trains) {
    ReadTrain train{block, {}, direction_of(o, block)};
    for (const std::string& name : block.vehicles) train.order.push_back(types.index_of(name, train.direction));
    const std::vector<double> positions = read_positions(o, train, scene);
    scene.train.positions.insert(scene.train.positions.end(), positions.begin(), positions.end());
    scene.train.vehicles.insert(scene.train.vehicles.end(), train.order.begin(), train.order.end());
    read_couplers(o, train, vehicles.trains.size() == 1, scene);
    if (!courses) {
      scene.train.drive = read_drive(o, train, scene);
      const bool swept = scene.sweep && !scene.sweep->speeds.empty();
      scene.train.speed = swept ? scene.sweep->speeds.front() : read_speed(o, train, scene);
      return;
    }
    scene.train.courses.push_back(course_of_train(o, train, scene));
    const train::Course& course = scene.train.courses.back();
    if (course.drive == Drive::free) scene.train.drive = Drive::free;
    scene.train.speed = std::max(scene.train.speed, course.speed.fastest());
  }
}

std::string load_option(const Options& o, const std::string& load) {
  std::string given;
  std::vector<std::string> names;
  for (const char* word : {"_forces", "_hslm_a", "_hslm_b", "_en15528", "_file"}) names.push_back(load + word);
  if (load == "load") names.emplace_back("sweep_hslm_a");
  for (const std::string& option : names)
    if (o.has(option)) {
      if (!given.empty()) o.refuse(option, fmt::format("give either {} or {}", given, option));
      given = option;
    }
  return given;
}

bool forces_move(const Options& o) { return o.has("loads") || !load_option(o).empty(); }

namespace {

/// The forces of one load at their places; `option` says which.
MovingLoad read_one_load(const Options& o, const ReadLoad& from, const std::string& option, Scene& scene) {
  const bool swept = option == "sweep_hslm_a", anywhere = !o.has(from.block.option("positions"));
  MovingLoad load;
  std::vector<MovingLoad> others;
  if (option == from.block.option("forces")) {
    read_forces(o, from, scene, load);
  } else {
    const double first = read_first_axle(o, from, scene, option);
    load =
        placed(swept ? hslm_a(scene.sweep->trains.front()) : named_train(o, from.block, option), first, from.direction);
    if (swept)
      for (const int train : scene.sweep->trains) others.push_back(placed(hslm_a(train), first, from.direction));
  }
  if (const std::string option_of_spread = from.block.option("spread"); o.has(option_of_spread)) {
    const double spacing = o.number(option_of_spread);
    spread(spacing, anywhere, from.direction, load);
    for (MovingLoad& other : others) spread(spacing, anywhere, from.direction, other);
  }
  if (swept) scene.sweep->loads = std::move(others);
  if (option != from.block.option("en15528") && o.has(from.block.option("wagons")))
    scene.notes.push_back(from.block.option("wagons") + " has no effect: it is for " + from.block.option("en15528"));
  return load;
}

double read_load_speed(const Options& o, const Block& block, const Scene& scene) {
  const std::string speed = block.option("speed");
  const bool needed = scene.analysis == Analysis::transient && !o.has("train_speed");
  if (scene.sweep && !scene.sweep->speeds.empty()) return scene.sweep->speeds.front();
  if (o.has(speed) || needed) return o.number(speed);
  return o.has("train_speed") ? o.number("train_speed") : 0.0;
}

}  // namespace

void read_load(const Options& o, Scene& scene) {
  const bool swept = scene.sweep && !scene.sweep->trains.empty();
  const std::vector<Block> blocks = blocks_of(o, "loads");
  const bool courses =
      needs_courses(o, blocks) || (o.has("train_speed") && !o.has("load_speed") && o.number("train_speed") < 0.0);
  if (swept && o.has("loads")) o.refuse("sweep_hslm_a", "is of one load; loads names several");
  for (const Block& block : blocks) {
    const std::string option = swept ? "sweep_hslm_a" : load_option(o, block.name);
    if (option.empty() && o.has("loads")) o.refuse(block.option("forces"), "missing: the forces of this load");
    if (option.empty()) return;
    if (!scene.beam) o.refuse(option, "moving forces need a beam (beam_spans)");
    const bool file = o.has(block.option("speed_file"));
    const double speed = file ? 0.0 : read_load_speed(o, block, scene);
    const ReadLoad from{block, file ? direction_of(o, block) : speed < 0.0 ? -1.0 : 1.0};
    MovingLoad load = read_one_load(o, from, option, scene);
    if (!courses) {
      scene.load = std::move(load);
      scene.load.speed = speed;
      return;
    }
    train::Course course;
    course.name = block.name;
    course.first = scene.load.forces.size();
    course.speed = file ? read_speed_file(o, block, load.positions.front()) : base::SpeedLaw(speed);
    scene.load.speed = std::max(scene.load.speed, course.speed.fastest());
    scene.load.courses.push_back(std::move(course));
    scene.load.forces.insert(scene.load.forces.end(), load.forces.begin(), load.forces.end());
    scene.load.positions.insert(scene.load.positions.end(), load.positions.begin(), load.positions.end());
  }
}

}  // namespace traverse::app
