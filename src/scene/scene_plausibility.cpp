// Checks for input that is possible but unusual: a train behind the bridge, speeds in km/h, profiles in mm, short
// tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "norm/en1991.hpp"
#include "options/parse_number.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double far_away = 1000.0;            // m
constexpr double greatest_by_friction = 10.0;  // m/s2: deceleration of a car on a dry road
constexpr double rough_range = 0.25;  // m, of heights, and their mean slope, from which they are probably in mm
constexpr double rough_slope = 0.1;
constexpr double level_part = 1e-3;       // height at the end of a profile, relative to its range, that is level
constexpr double rounding = 1e-6;         // relative to a length
constexpr double least_approach = 100.0;  // m: a few wavelengths of the slowest motion of a car

/// The wheels or forces of one course. x is measured from the bridge end at which they enter.
struct Moving {
  std::vector<double> x;  // at the start, m
  base::SpeedLaw law;
  bool driven = true;     // its speed is prescribed
  const char* what = "";  // "wheel" or "force"
  std::string option;     // the option of the positions
};

std::vector<Moving> moving_things(const Scene& scene) {
  std::vector<Moving> things;
  const train::Course* last = nullptr;
  const auto add = [&](const train::Course* course, const base::SpeedLaw& law, const char* what, const char* block,
                       const std::vector<double>& x) {
    if (x.empty()) return;
    const bool driven = what[0] == 'f' || (course ? course->drive : scene.train.drive) == Drive::constant;
    if (things.empty() || things.back().what != what || course != last)
      things.push_back({{}, law, driven, what, (course ? course->name : block) + std::string("_positions")});
    last = course;
    for (const double one : x) things.back().x.push_back(law.direction() < 0.0 ? scene.beam->length() - one : one);
  };
  static constexpr const char *wheel = "wheel", *force = "force";
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i)
    add(course_of(scene.train, i), law_of(scene.train, i), wheel, "train", wheels_at_start(scene, i));
  for (std::size_t i = 0; i < scene.load.positions.size(); ++i)
    add(course_of(scene.load, i), law_of(scene.load, i), force, "load",
        {scene.load.positions[i] - 0.5 * length_of(scene.load, i),
         scene.load.positions[i] + 0.5 * length_of(scene.load, i)});
  return things;
}

/// The end of the bridge with its track. Wheels and forces that start beyond it never load it.
double end_of_bridge(const beam::BeamModel& beam) {
  return std::accumulate(beam.spans.begin(), beam.spans.end(), beam.track ? beam.track->approach : 0.0);
}

void check_start(const Options& o, const Moving& moving, Scene& scene) {
  const double end = end_of_bridge(*scene.beam);
  const double front = *std::max_element(moving.x.begin(), moving.x.end()),
               rear = *std::min_element(moving.x.begin(), moving.x.end());
  if (rear > end * (1.0 + rounding)) {
    const std::string why = fmt::format("every {} starts beyond the bridge, which ends at {:g} m", moving.what,
                                        moving.law.direction() < 0.0 ? scene.beam->length() - end : end);
    if (scene.analysis == Analysis::transient && moving.law.direction() != 0.0 && moving.driven)
      o.refuse(moving.option, why + ", and moves away from it; allowed: positions before or on the bridge");
    scene.notes.push_back(fmt::format("{}: {} ({})", moving.option, why, "no load on the bridge"));
  }
  if (scene.analysis != Analysis::transient || moving.law.direction() == 0.0 || front >= 0.0) return;
  const double arrival = moving.law.time_of(-front * moving.law.direction());
  if (std::isinf(arrival)) {
    scene.notes.push_back(fmt::format("{}: the first {} starts {:g} m before the bridge and stops before it",
                                      moving.option, moving.what, -front));
    return;
  }
  if (scene.end_time && *scene.end_time < arrival) {
    scene.notes.push_back(
        fmt::format("the run ends at {:g} s (ts_max_time), before the first {} reaches the bridge at {:g} s",
                    *scene.end_time, moving.what, arrival));
  } else if (front < -far_away) {
    scene.notes.push_back(fmt::format("{}: the first {} starts {:g} m before the bridge and reaches it after {:g} s",
                                      moving.option, moving.what, -front, arrival));
  }
}

/// The rearmost and the foremost wheel of a vehicle of the train.
std::pair<double, double> extent(const Scene& scene, std::size_t vehicle) {
  const std::vector<double> x = wheels_at_start(scene, vehicle);
  return {*std::min_element(x.begin(), x.end()), *std::max_element(x.begin(), x.end())};
}

/// The overlap of two neighbouring vehicles, m, by their wheels or by their lengths.
double overlap(const Options& o, const Scene& scene, std::size_t front, std::size_t rear) {
  const auto name = [&](std::size_t i) {
    return scene.vehicles[static_cast<std::size_t>(scene.train.vehicles[i])].name;
  };
  double deepest = extent(scene, rear).second - extent(scene, front).first;
  const auto length = [&](std::size_t i) { return o.optional_number("vehicle_" + name(i) + "_length"); };
  if (const auto a = length(front), b = length(rear); a && b)
    deepest = std::max(deepest, 0.5 * (*a + *b) - (scene.train.positions[front] - scene.train.positions[rear]));
  return deepest;
}

void record_overlaps(const Options& o, Scene& scene) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    if (!wheels_at_start(scene, i).empty()) order.push_back(i);
  }
  const std::vector<double>& x = scene.train.positions;
  const auto course = [&](std::size_t i) { return course_of(scene.train, i); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return course(a) != course(b) ? a < b : x[a] > x[b]; });
  std::size_t pairs = 0, first = 0;
  double deepest = 0.0;
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    if (course(order[i]) != course(order[i + 1])) continue;  // on different tracks
    const double by = overlap(o, scene, order[i], order[i + 1]);
    if (!(by > rounding * (1.0 + std::abs(x[order[i]])))) continue;
    if (pairs++ == 0) first = i;
    deepest = std::max(deepest, by);
  }
  if (pairs == 0) return;
  scene.notes.push_back(fmt::format(
      "vehicles {} and {} of the train overlap{}, by up to {:.3g} m (train_positions, "
      "train_spacing)",
      order[first], order[first + 1], pairs > 1 ? fmt::format(" and {} more pairs", pairs - 1) : "", deepest));
}

/// Checks that wheels that start in equilibrium are on a surface.
void check_ground(const Options& o, const Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  for (const bool right : {false, true}) {
    const char* option = right ? "surface_right" : "surface_left";
    if (beam.ground[right ? 1 : 0]) continue;
    if (beam.track) o.refuse(option, "a layered track continues on the ground beyond the bridge; allowed: rigid");
    if (scene.start != Start::equilibrium) continue;
    for (const double x : wheels_at_start(scene))
      if (right ? x > beam.length() : x < 0.0)
        o.refuse(option, fmt::format("a wheel starts at x = {:g} m, where there is no surface; allowed: rigid, "
                                     "train_positions on the beam from 0 to {:g} m, or scene_start given",
                                     x, beam.length()));
  }
}

/// The greatest magnitude of the acceleration of a train or load, m/s2.
double greatest_acceleration(const base::SpeedLaw& law) {
  const std::vector<double> kinks = law.kinks();
  double greatest = 0.0;
  for (std::size_t i = 0; i + 1 < kinks.size(); ++i)
    greatest = std::max(greatest, std::abs(law.acceleration(0.5 * (kinks[i] + kinks[i + 1]))));
  return greatest;
}

void record_speed(const Options& o, const std::string& block, const base::SpeedLaw& law, Scene& scene) {
  const std::string table = table_of_motion(o, {block, {}});
  const std::string option = table.empty() ? block + "_speed" : table;
  if (const std::string line = norm::unusual_speed(option, law.fastest()); !line.empty()) scene.notes.push_back(line);
  if (const double acceleration = greatest_acceleration(law); acceleration > greatest_by_friction)
    scene.notes.push_back(fmt::format(
        "{}: the speed changes by up to {:.4g} m/s2, more than the friction of wheels allows; speeds are in "
        "m/s, not km/h, and positions in m, not km",
        option, acceleration));
}

void record_speeds(const Options& o, Scene& scene) {
  if (scene.sweep && !scene.sweep->speeds.empty()) {
    const std::string line = norm::unusual_speed("sweep_speed", scene.sweep->speeds.back());
    if (!line.empty()) scene.notes.push_back(line);
    return;
  }
  const auto record = [&](const char* block, const auto& moving, bool moves) {
    if (moves && moving.courses.empty()) record_speed(o, block, base::SpeedLaw(moving.speed), scene);
    for (const train::Course& course : moving.courses) record_speed(o, course.name, course.speed, scene);
  };
  record("train", scene.train, !scene.train.vehicles.empty());
  record("load", scene.load, !scene.load.forces.empty());
}

/// Adds a note on a table that does not cover the beam, which is continued by its end values, or is longer.
void record_table(const std::string& option, const beam::Distribution& table, double length, Scene& scene) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> x = table.breaks(-infinity, infinity);
  if (x.empty()) return;
  const double slack = rounding * length;
  const bool late = x.front() > slack, early = x.back() < length - slack;
  if (late || early) {
    scene.notes.push_back(
        fmt::format("{}: the table goes from {:g} to {:g} m, the beam from 0 to {:g} m; {} applies outside the table",
                    option, x.front(), x.back(), length,
                    late && early ? "each end value"
                    : late        ? "its first value"
                                  : "its last value"));
  }
  if (x.front() < -slack || x.back() > length + slack) {
    scene.notes.push_back(fmt::format("{}: the table goes from {:g} to {:g} m, beyond the beam from 0 to {:g} m",
                                      option, x.front(), x.back(), length));
  }
}

void record_tables(Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  const double length = std::accumulate(beam.spans.begin(), beam.spans.end(), 0.0);
  if (beam.cuts.empty()) record_table("beam_EI", beam.EI, length, scene);
  record_table("beam_EA", beam.EA, length, scene);
  if (beam.GA) record_table("beam_GA", *beam.GA, length, scene);
  record_table("beam_mass", beam.mass, length, scene);
  record_table("beam_rotary_inertia", beam.rotary_inertia, length, scene);
  for_beds(beam.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    const std::string option = "foundation_" + std::string(kind.name);
    record_table(option + "_k", bed.k, length, scene);
    record_table(option + "_c", bed.c, length, scene);
  });
}

/// Adds a note if the bridge and its foundation dissipate no energy.
void record_damping(Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  if (scene.analysis != Analysis::transient || scene.damping.rayleigh || scene.damping.ratios || beam.given ||
      beam.track || !scene.damping_of_modes.empty() || beam.foundation.nonlinear())
    return;
  bool dampers = false;
  for_beds(beam.foundation,
           [&](const beam::FoundationKind&, const beam::Bed& bed) { dampers = dampers || bed.c.maximum() > 0.0; });
  for_points(beam.foundation, [&](const beam::FoundationKind&, const auto& points) {
    for (const beam::PointFoundation& point : points) dampers = dampers || point.c > 0.0;
  });
  if (dampers) return;
  scene.notes.emplace_back(
      "damping: none is given (beam_damping_ratios, model_damping_bound), so free vibration does not decay and "
      "resonances are higher and narrower than real ones; EN 1991-2 table 6.6 has ratios of at least 0.5 %");
}

/// Adds a note if the roughness, which begins at the first wheel and increases to its full height over some distance,
/// is small on the first span.
void record_rough_start(Scene& scene) {
  if (scene.analysis != Analysis::transient || !scene.roughness || scene.train.vehicles.empty() ||
      scene.train.courses.size() > 1)
    return;
  const double from = scene.roughness->start;
  const bool left = scene.roughness->to_the_left;
  const double ahead = left ? from - scene.beam->length() : -from, fade = scene.profile.fade();
  if (ahead >= fade) return;
  const double approach = std::max(least_approach, 2.0 * fade), x = scene.train.positions.front();
  scene.notes.push_back(
      fmt::format("train_positions: the roughness begins at the first wheel and has its full height after {:g} m, but "
                  "that wheel starts {:g} m before the bridge, so the roughness is small on the first span; "
                  "-train_positions {:g} starts {:g} m before it",
                  fade, ahead > 0.0 ? ahead : 0.0, left ? x - ahead + approach : x + ahead - approach, approach));
}

/// Adds a note on a file of axles with increasing x, where the last row is the front axle.
void record_axles(const Options& o, Scene& scene) {
  for (const Block& block : blocks_of(o, "loads")) {
    const std::string file = block.option("file");
    if (!o.has(file) || o.has(block.option("file_x")) || load_option(o, block.name) != file) continue;
    if (has_formations(o, file)) continue;
    const std::vector<std::vector<double>> rows = options::read_columns(o, file, {});
    if (!(rows[0].front() >= 0.0 && rows[0].back() > rows[0].front())) continue;
    scene.notes.push_back(fmt::format(
        "{}: x grows from row to row, so the force of {:g} kN in the last row is in front; if x are distances "
        "behind the first axle, use -{} backward",
        file, 1e-3 * rows[1].back(), block.option("file_x")));
  }
}

/// Checks that rounding of positions, which have the size of the radius, changes the force of a contact by less than
/// `noise` of its load, N.
void check_stiffness(const Options& o, const std::string& contact, const contact::Law& law, double radius, double load,
                     const char* unit) {
  constexpr double noise = 1e-3, eps = std::numeric_limits<double>::epsilon();
  if (law.kind == contact::LawKind::other || !(load > 0.0)) return;
  const double exponent = law.kind == contact::LawKind::hertz ? 1.5 : 1.0;
  const double penetration = contact::static_penetration(law, load), least = exponent * eps * radius / noise;
  if (penetration >= least) return;
  const std::string young = contact + "_young";
  o.refuse(
      o.has(young) ? young : contact + "_stiffness",
      fmt::format("a load of {:.3g} N presses the contact in by {:.1g} m, which rounding hides beside the radius of "
                  "{:g} m; allowed: a stiffness of at most {:.1g} {}",
                  load, penetration, radius, load / std::pow(least, exponent), unit));
}

void check_contacts(const Options& o, const Scene& scene) {
  for (const Vehicle& vehicle : scene.vehicles) {
    double weight = 0.0;
    for (const multibody::Body& body : vehicle.mechanism.bodies) weight += body.mass * scene.gravity;
    const auto check = [&](const std::string& name, const contact::Law& law, double radius, double load) {
      check_stiffness(o, "vehicle_" + vehicle.name + "_" + name, law, std::abs(radius), load,
                      law.kind == contact::LawKind::hertz ? "N/m^1.5" : "N/m");
    };
    for (const Wheel& wheel : vehicle.wheels)
      check(wheel.name, wheel.law, wheel.radius, weight / static_cast<double>(vehicle.wheels.size()));
    for (const contact::BodyContact& contact : vehicle.contacts)
      check(contact.name, contact.law, std::max(contact.radii[0], contact.radii[1]), weight);
  }
}

/// Adds a note on a profile whose heights are probably in mm.
void record_heights(const std::string& option, const std::vector<double>& x, const std::vector<double>& h,
                    Scene& scene) {
  const auto [least, greatest] = std::minmax_element(h.begin(), h.end());
  double rise = 0.0;
  for (std::size_t i = 1; i < h.size(); ++i) rise += std::abs(h[i] - h[i - 1]);
  const double slope = rise / (x.back() - x.front());
  if (*greatest - *least < rough_range || slope < rough_slope) return;
  scene.notes.push_back(
      fmt::format("{}: heights from {:g} to {:g} m, with a mean slope of {:.2g}, are no track; heights are possibly "
                  "given in mm; their unit is m",
                  option, *least, *greatest, slope));
}

/// Adds a note on a profile that is not where the wheels are, or that ends on the bridge at another height than 0.
void record_extent(const std::string& option, const std::vector<double>& x, const std::vector<double>& h,
                   Scene& scene) {
  const double length = std::accumulate(scene.beam->spans.begin(), scene.beam->spans.end(), 0.0);
  const std::vector<double> wheels = wheels_at_start(scene);
  const double first = std::min(0.0, *std::min_element(wheels.begin(), wheels.end())),
               last = std::max(length, *std::max_element(wheels.begin(), wheels.end()));
  const double slack = rounding * length;
  if (x.front() > last || x.back() < first) {
    scene.notes.push_back(fmt::format(
        "{}: the table goes from x = {:g} to {:g} m, but the wheels and the bridge are between {:g} and {:g} m, where "
        "the track is level",
        option, x.front(), x.back(), first, last));
    return;
  }
  const double level = level_part * (*std::max_element(h.begin(), h.end()) - *std::min_element(h.begin(), h.end()));
  const bool late = x.front() > slack && std::abs(h.front()) > level,
             early = x.back() < length - slack && std::abs(h.back()) > level;
  if (late || early)
    scene.notes.push_back(fmt::format(
        "{}: the table goes from x = {:g} to {:g} m, the bridge from 0 to {:g} m; outside the table the track is level",
        option, x.front(), x.back(), length));
}

/// Adds notes on files of profiles.
void record_profiles(const Options& o, Scene& scene) {
  std::vector<std::string> names = {"track_profile"};
  for (const train::Course& course : scene.train.courses) names.push_back(course.name + "_profile");
  for (const std::string& option : names) {
    if (!o.has(option) || !o.is_table(option)) continue;
    const std::vector<std::vector<double>> columns = options::read_columns(o, option, profile_columns);
    record_heights(option, columns[0], columns[1], scene);
    if (scene.beam && !wheels_at_start(scene).empty()) record_extent(option, columns[0], columns[1], scene);
  }
}

void record_unusual_input(const Options& o, const NamedVehicles& vehicles, Scene& scene) {
  check_contacts(o, scene);
  if (!vehicles.unused.empty())
    scene.notes.push_back(
        fmt::format("defined, but not in the train (train_vehicles): {}", fmt::join(vehicles.unused, ", ")));
  record_overlaps(o, scene);
  record_speeds(o, scene);
  record_profiles(o, scene);
  if (!scene.beam) return;
  check_ground(o, scene);
  record_tables(scene);
  record_damping(scene);
  record_rough_start(scene);
  record_axles(o, scene);
  if (scene.analysis == Analysis::modes) return;
  for (const Moving& moving : moving_things(scene)) check_start(o, moving, scene);
}

}  // namespace

void check_plausibility(const Options& o, const NamedVehicles& vehicles, Scene& scene) {
  const std::size_t before = scene.notes.size();
  record_unusual_input(o, vehicles, scene);
  scene.unusual.assign(scene.notes.begin() + static_cast<std::ptrdiff_t>(before), scene.notes.end());
}

}  // namespace traverse::scene
