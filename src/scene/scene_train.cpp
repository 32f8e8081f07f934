// Reads the trains of a scene: vehicles, positions, couplers and speeds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "scene_parts.hpp"
#include "train/train_unit.hpp"

namespace traverse::scene {
namespace {

using options::Options;

/// x of the centre of the front wheel in this direction, relative to the origin; 0 without wheels.
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

/// The options of one train, its vehicles (indices into Scene::vehicles) and its direction.
struct TrainBlock {
  const Block& block;
  std::vector<int> order;
  double direction = 1.0;
  std::string name;  // the block's; of a timetable with the number of the run
};

/// The distance of two origins, which are in the middle of vehicles of known length.
double gap_by_length(const Options& o, const std::string& spacing, const Vehicle& front, const Vehicle& rear) {
  double gap = 0.0;
  for (const Vehicle* vehicle : {&front, &rear}) {
    const std::string length = "vehicle_" + vehicle->name + "_length";
    if (!o.has(length))
      o.refuse(spacing, "missing: the distance between the origins of neighbouring vehicles (or " + length + ")");
    gap += 0.5 * o.number(length);
  }
  return gap;
}

std::vector<double> read_positions(const Options& o, const TrainBlock& train, const Scene& scene) {
  const std::vector<int>& order = train.order;
  const std::string positions = train.block.option("positions"), spacing = train.block.option("spacing");
  const auto vehicle = [&](std::size_t i) -> const Vehicle& {
    return scene.vehicles[static_cast<std::size_t>(order[i])];
  };
  std::vector<double> x;
  if (o.has(positions)) x = o.numbers(positions);
  if (x.size() > 1 || (order.size() == 1 && !x.empty())) {
    if (x.size() > 1 && o.has(spacing)) o.refuse(spacing, "not allowed if all positions are given");
    return o.numbers(positions, order.size(), "one per vehicle");
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

/// The gaps between vehicles in which a coupler is, counted from the front of the train. The vehicles must have its
/// bodies.
std::vector<int> read_gaps(const Options& o, const TrainBlock& train, const Scene& scene, const Coupler& coupler,
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
    o.refuse(train.block.option("couplers"), fmt::format("{} needs a train of at least two vehicles", name));
  std::sort(gaps.begin(), gaps.end());
  for (const int gap : gaps) {
    if (gap >= last)
      o.refuse(after, fmt::format("there is no vehicle behind vehicle {}; allowed: from 0 to {}", gap, last - 1));
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

/// The types of vehicles of all trains. Each is read once for each direction.
class VehicleTypes {
 public:
  VehicleTypes(const Options& o, Scene& scene) : o_(o), scene_(scene) {}

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

/// By how much the trains of a timetable are ahead of one that enters the bridge at t = 0, m: those that are on the
/// bridge during the run. positions: of this train's vehicles.
std::vector<double> leads_of(const Options& o, const TrainBlock& train, const std::vector<double>& positions,
                             const Scene& scene) {
  const std::string option = train.block.option("times");
  const double speed = std::abs(o.number(train.block.option("speed")));
  if (speed == 0.0) o.refuse(option, "a train of a timetable runs; allowed: a speed that is not 0");
  const auto wheel = [&](std::size_t i, double direction) {
    return positions[i] + front_of(scene.vehicles[static_cast<std::size_t>(train.order[i])], direction);
  };
  const double length =
      std::abs(wheel(0, train.direction) - wheel(positions.size() - 1, -train.direction));  // between outer wheels
  const double on_bridge = ((scene.beam ? scene.beam->length() : 0.0) + length) / speed;    // s
  std::vector<double> leads;
  for (const double time : o.numbers(option)) {
    const double enters = time - o.number("trains_from");
    if (enters + on_bridge < 0.0 || (scene.end_time && enters > *scene.end_time)) continue;
    leads.push_back(-enters * speed);
  }
  return leads;
}

void read_couplers(const Options& o, const TrainBlock& train, bool alone, Scene& scene) {
  const std::string list = train.block.option("couplers");
  if (!o.has(list)) return;
  const int first = static_cast<int>(scene.train.vehicles.size() - train.order.size());
  for (const std::string& name : o.texts(list)) {
    Coupler coupler = read_coupler(o, train.block, name);
    coupler.gaps = read_gaps(o, train, scene, coupler, name);
    for (int& gap : coupler.gaps) gap += first;
    if (train.direction < 0.0) coupler = train::mirrored(std::move(coupler));
    if (!alone) coupler.name = train.name + "_" + name;
    scene.train.couplers.push_back(std::move(coupler));
  }
}

bool rolls(const TrainBlock& train, const Scene& scene) {
  return std::any_of(train.order.begin(), train.order.end(),
                     [&](int type) { return !scene.vehicles[static_cast<std::size_t>(type)].wheels.empty(); });
}

Drive read_drive(const Options& o, const TrainBlock& train, const Scene& scene) {
  const std::string option = train.block.option("drive"), table = table_of_motion(o, train.block);
  const std::string drive = o.has(option) ? o.choice(option) : rolls(train, scene) ? "constant" : "free";
  if (drive == "free" && !table.empty())
    o.refuse(table, o.has(option) ? "prescribes the speed, which is not possible with " + option + " free"
                                  : "prescribes the speed of wheels, but the train has none");
  return drive == "free" ? Drive::free : Drive::constant;
}

/// x of the front wheel of the train that was added last.
double front_wheel(const TrainBlock& train, const Scene& scene) {
  std::optional<double> front;
  for (std::size_t i = scene.train.vehicles.size() - train.order.size(); i < scene.train.vehicles.size(); ++i)
    for (const double x : wheels_at_start(scene, i))
      if (!front || train.direction * x > train.direction * *front) front = x;
  return front.value_or(0.0);
}

double read_speed(const Options& o, const TrainBlock& train, const Scene& scene) {
  const std::string option = train.block.option("speed");
  const bool needed = rolls(train, scene) && scene.analysis == Analysis::transient;
  return needed || o.has(option) ? o.number(option) : 0.0;
}

train::Course course_of_train(const Options& o, const TrainBlock& train, Scene& scene) {
  train::Course course;
  course.name = train.name;
  course.first = scene.train.vehicles.size() - train.order.size();
  course.drive = read_drive(o, train, scene);
  double front = front_wheel(train, scene);
  if (const std::optional<double> start = start_by_table(o, train.block)) {
    for (std::size_t i = course.first; i < scene.train.positions.size(); ++i)
      scene.train.positions[i] += *start - front;
    front = *start;
  }
  course.speed = !table_of_motion(o, train.block).empty() ? read_motion(o, train.block, front)
                                                          : base::SpeedLaw(read_speed(o, train, scene));
  const Track* track = track_of_block(o, train.block, scene);
  course.track = carry(track, scene);
  for (const std::string& owner : {train.block.name, track == nullptr ? std::string() : track->name}) {
    if (owner.empty() || !o.has(owner + "_profile")) continue;
    course.profile =
        std::make_shared<track::Profile>(read_profile(o, owner, front, train.direction < 0.0, scene).profile);
    break;
  }
  return course;
}

/// Adds the vehicles of a train that is ahead of these positions by `lead` (m), with their couplers.
void add_vehicles(const Options& o, const TrainBlock& train, const std::vector<double>& positions, double lead,
                  bool alone, Scene& scene) {
  for (const double x : positions) scene.train.positions.push_back(x + train.direction * lead);
  scene.train.vehicles.insert(scene.train.vehicles.end(), train.order.begin(), train.order.end());
  read_couplers(o, train, alone, scene);
}

void add_course(const Options& o, const TrainBlock& train, Scene& scene) {
  scene.train.courses.push_back(course_of_train(o, train, scene));
  const train::Course& course = scene.train.courses.back();
  if (course.drive == Drive::free) scene.train.drive = Drive::free;
  scene.train.speed = std::max(scene.train.speed, course.speed.fastest());
}

}  // namespace

void read_trains(const Options& o, const NamedVehicles& vehicles, Scene& scene) {
  if (vehicles.train.empty()) return;
  VehicleTypes types(o, scene);
  const bool courses = needs_courses(o, vehicles.trains);
  for (const Block& block : vehicles.trains) {
    TrainBlock train{block, {}, direction_of(o, block), block.name};
    for (const std::string& name : block.vehicles) train.order.push_back(types.index_of(name, train.direction));
    const std::vector<double> positions = read_positions(o, train, scene);
    if (o.has(block.option("times"))) {
      std::size_t run = 0;
      for (const double lead : leads_of(o, train, positions, scene)) {
        train.name = fmt::format("{}_{}", block.name, ++run);
        add_vehicles(o, train, positions, lead, false, scene);
        add_course(o, train, scene);
      }
      continue;
    }
    add_vehicles(o, train, positions, 0.0, vehicles.trains.size() == 1, scene);
    if (!courses) {
      scene.train.track = carry(track_of_block(o, block, scene), scene);
      scene.train.drive = read_drive(o, train, scene);
      const bool swept = scene.sweep && !scene.sweep->speeds.empty() && !stands(o, block);
      scene.train.speed = swept ? scene.sweep->speeds.front() : read_speed(o, train, scene);
      return;
    }
    add_course(o, train, scene);
  }
  if (scene.train.vehicles.empty())
    o.refuse(vehicles.trains.front().option("times"),
             "no train of the timetable is on the bridge during the run (trains_from, ts_max_time)");
}

}  // namespace traverse::scene
