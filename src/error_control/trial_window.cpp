// Duration of a trial run. It ends when the first vehicle has crossed the first spans and every later span, vehicle or
// part of the track with different properties has been passed. Parts are compared by their parameters.
#include "error_control/trial_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::error_control {

using scene::Scene;

namespace {

constexpr std::size_t max_bridge_spans = 3;  // spans of a bridge that is crossed completely
constexpr double passed_spans = 1.1;         // spans: distance that includes the effects of the last wheel as it leaves
constexpr double bounce_share =
    0.75;                           // share of a vehicle's period until its wheel forces are largest behind the bridge
constexpr double tolerance = 1e-9;  // relative tolerance
constexpr int points_per_span = 8;
constexpr double passed_bays =
    10.0;  // bays of a layered track behind a feature until its effects on wheels are included

/// The longest bounce period of the vehicles, each on all its springs in parallel, s.
double longest_bounce(const Scene& scene) {
  double longest = 0.0;
  for (const int type : scene.train.vehicles) {
    const multibody::MechanismModel& mechanism = scene.vehicles[static_cast<std::size_t>(type)].mechanism;
    double mass = 0.0, stiffness = 0.0;
    for (const multibody::Body& body : mechanism.bodies) mass += body.mass;
    for (const multibody::Spring& spring : mechanism.springs) stiffness += spring.stiffness;
    if (stiffness > 0.0) longest = std::max(longest, 2.0 * std::numbers::pi * std::sqrt(mass / stiffness));
  }
  return longest;
}

/// x of the position that a vehicle has to pass in a trial run.
double passed_position(const Scene& scene) {
  const std::vector<double>& spans = scene.beam->spans;
  return passed_spans * (spans.size() <= max_bridge_spans ? scene.beam->length() : spans[0]);
}

/// x at t = 0 of the part of a vehicle that has to pass: its last wheel, in a train the middle of its wheels.
double last_position(const Scene& scene, std::size_t vehicle) {
  const std::vector<double> wheels = scene::wheels_at_start(scene, vehicle);
  if (wheels.empty()) return 0.0;
  const auto [rear, front] = std::minmax_element(wheels.begin(), wheels.end());
  return scene.train.vehicles.size() < 3 ? *rear : 0.5 * (*front + *rear);
}

/// x at t = 0 of the moving force that has to pass: the fourth one from the front, or the last one.
double last_force(const Scene& scene) {
  std::vector<double> positions = scene.load.positions;
  std::sort(positions.begin(), positions.end(), std::greater<>());
  return positions[std::min<std::size_t>(3, positions.size() - 1)];
}

/// The time at which the first vehicle, or without vehicles the first forces, have passed x, s.
double time_of_passing(const Scene& scene, double x) {
  return scene.train.vehicles.empty() ? (x - last_force(scene)) / scene.load.speed
                                      : (x - last_position(scene, 0)) / scene.train.speed;
}

/// All parameters that may distinguish a span from another one.
std::vector<double> parameters_of(const beam::BeamModel& beam, std::size_t span, double start) {
  const double length = beam.spans[span], middle = start + 0.5 * length;
  std::vector<double> numbers = {length};
  for (const std::size_t end : {span, span + 1})
    numbers.push_back((fixes_vertical(beam.supports[end]) ? 1.0 : 0.0) +
                      (fixes_rotation(beam.supports[end]) ? 2.0 : 0.0));
  const auto along = [&](const beam::Distribution& values) {
    for (int i = 0; i <= points_per_span; ++i)
      numbers.push_back(values.at(start + length * i / points_per_span, middle));
    for (const double x : values.breaks(start, start + length)) numbers.push_back((x - start) / length);
  };
  along(beam.EI);
  along(beam.mass);
  along(beam.rotary_inertia);
  if (beam.GA) along(*beam.GA);
  const auto law = [&](const beam::FoundationLaw& l) {
    numbers.insert(numbers.end(), {l.one_sided ? 1.0 : 0.0, l.gap, l.cubic, l.slides_at});
  };
  for_points(beam.foundation, [&](const beam::FoundationKind&, const auto& points) {
    for (const beam::PointFoundation& point : points) {
      const double place = (point.x - start) / length;
      if (place < -tolerance || place > 1.0 + tolerance) continue;
      numbers.insert(numbers.end(), {place, point.k, point.c});
      law(point.law);
    }
    numbers.push_back(-1.0);  // separator of the kinds
  });
  for_beds(beam.foundation, [&](const beam::FoundationKind&, const beam::Bed& bed) {
    along(bed.k);
    along(bed.c);
    law(bed.law);
  });
  for (const double x : beam.hinges)
    if (x > start && x < start + length) numbers.push_back((x - start) / length);
  for (const beam::Crack& crack : beam.cracks)
    if (crack.x > start && crack.x < start + length)
      numbers.insert(numbers.end(), {(crack.x - start) / length, crack.k});
  if (!beam.settlement.empty()) numbers.insert(numbers.end(), {beam.settlement[span], beam.settlement[span + 1]});
  return numbers;
}

bool equal(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::abs(x - y) <= tolerance * std::max({std::abs(x), std::abs(y), 1.0});
  });
}

void add_spans(const Scene& scene, std::vector<LaterEvent>& list) {
  const beam::BeamModel& beam = *scene.beam;
  std::vector<std::vector<double>> kinds;
  double start = beam.start;
  for (std::size_t i = 0; i < beam.spans.size(); start += beam.spans[i++]) {
    std::vector<double> numbers = parameters_of(beam, i, start);
    if (std::any_of(kinds.begin(), kinds.end(), [&](const auto& kind) { return equal(kind, numbers); })) continue;
    kinds.push_back(std::move(numbers));
    list.push_back(
        {time_of_passing(scene, start + passed_spans * beam.spans[i]),
         fmt::format("the span from {:g} to {:g} m (different from all before it)", start, start + beam.spans[i])});
  }
}

void add_vehicles(const Scene& scene, std::vector<LaterEvent>& list) {
  std::vector<int> types;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    const int type = scene.train.vehicles[i];
    if (std::find(types.begin(), types.end(), type) != types.end()) continue;
    types.push_back(type);
    list.push_back({(passed_position(scene) - last_position(scene, i)) / scene.train.speed,
                    fmt::format("vehicle {} (different from all before it)", i)});
  }
}

void add_profile(const Scene& scene, std::vector<LaterEvent>& list) {
  const track::Profile& profile = scene.profile;
  if (profile.level() || (profile.is_rough() && profile.kinks().empty())) return;  // no dips in addition
  const double length = scene.beam->length();
  const bool bump = std::isfinite(profile.shortest_wave());
  // a table excites wheels most at its largest curvature
  const double x = bump ? profile.kinks().back() : profile.sharpest_place(0.0, length);
  if (x <= length)
    list.push_back({time_of_passing(scene, x + passed_spans * scene.beam->spans[0]),
                    fmt::format("the track's profile at {:g} m", x)});
}

/// Adds the parts of a layered track with other properties, the last changes of its tables, and joints of its rail.
void add_track(const Scene& scene, std::vector<LaterEvent>& list) {
  if (!scene.beam->track) return;
  const beam::LayeredTrack& track = *scene.beam->track;
  const auto add = [&](double x, const std::string& what) {
    list.push_back({time_of_passing(scene, x + passed_bays * track.spacing), what});
  };
  for (const beam::TrackStretch& stretch : track.stretches)
    add(stretch.to, fmt::format("the stretch {} of the track", stretch.name));
  for (const beam::TrackProperty& property : beam::track_properties) {
    const beam::Distribution* along = property.along(track);
    if (along == nullptr || along->uniform()) continue;
    const std::vector<double> breaks =
        along->breaks(scene.beam->start - track.approach, scene.beam->end() + track.approach);
    if (!breaks.empty()) add(breaks.back(), fmt::format("track_{} at {:g} m", property.name, breaks.back()));
  }
  if (!track.rail_hinges.empty())
    add(track.rail_hinges.back(), fmt::format("the joint of the rail at {:g} m", track.rail_hinges.back()));
  if (!track.expansion_devices.empty())
    add(track.expansion_devices.back(),
        fmt::format("the rail's expansion device at {:g} m", track.expansion_devices.back()));
}

void add_forces(const Scene& scene, std::vector<LaterEvent>& list) {
  for (const int type : scene.train.vehicles)
    for (const multibody::Actuator& actuator : scene.vehicles[static_cast<std::size_t>(type)].mechanism.actuators)
      for (const base::TimeFunction& action : actuator.action)
        if (const std::vector<double> kinks = action.kinks(); !kinks.empty())
          list.push_back({kinks.back(), fmt::format("the force of {} until {:g} s", actuator.name, kinks.back())});
}

}  // namespace

double initial_window(const Scene& scene, double end) {
  double until = 0.0;
  if (!scene.train.vehicles.empty())
    until = scene.train.steady() ? (passed_position(scene) - last_position(scene, 0)) / scene.train.speed : end;
  if (!scene.load.forces.empty())
    until = std::max(until, scene.load.courses.empty() && scene.load.speed > 0.0
                                ? (passed_position(scene) - last_force(scene)) / scene.load.speed
                                : end);
  return until > 0.0 && until < end ? until : end;
}

bool has_undamped_vehicle(const Scene& scene) {
  const auto damps = [](const auto& spring) { return spring.damping > 0.0 || spring.law.has_value(); };
  return std::ranges::any_of(scene.train.vehicles, [&](int type) {
    const train::Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(type)];
    return std::ranges::none_of(vehicle.mechanism.springs, damps) &&
           std::ranges::none_of(vehicle.mechanism.torsion_springs, damps) &&
           std::ranges::none_of(vehicle.wheels, [](const train::Wheel& wheel) { return wheel.law.damping > 0.0; });
  });
}

double extend_by_bounce(const Scene& scene, double until) {
  if (scene.train.vehicles.empty() || !scene.train.steady()) return until;
  const double leaves = time_of_passing(scene, scene.beam->end());
  return until < leaves ? until : std::max(until, leaves + bounce_share * longest_bounce(scene));
}

std::vector<LaterEvent> later_events(const Scene& scene, double covered, double end) {
  std::vector<LaterEvent> list;
  const bool train = !scene.train.vehicles.empty();
  const bool constant =
      train ? scene.train.steady() : !scene.load.forces.empty() && scene.load.courses.empty() && scene.load.speed > 0.0;
  if (constant) {
    add_spans(scene, list);
    add_vehicles(scene, list);
    add_profile(scene, list);
    add_track(scene, list);
  }
  add_forces(scene, list);
  for (LaterEvent& event : list) event.until = std::min(event.until, end);
  std::erase_if(list, [&](const LaterEvent& event) { return event.until <= covered; });
  std::stable_sort(list.begin(), list.end(),
                   [](const LaterEvent& a, const LaterEvent& b) { return a.until < b.until; });
  return list;
}

}  // namespace traverse::error_control
