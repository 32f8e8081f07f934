// Duration of a trial run: until the first vehicle has crossed the first spans, and until every later span, vehicle or
// stretch of track with other properties has been crossed, which is decided by comparing their numbers.
#include "error_control/trial_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::app {
namespace {

constexpr std::size_t crossed_in_full = 3;  // spans
constexpr double behind = 1.1;              // spans, until what the last wheel does as it leaves is seen
constexpr double part_of_swing = 0.75;      // of a vehicle, until it presses its wheels most behind the bridge
constexpr double same_number = 1e-9;        // relative
constexpr int places_a_span = 8;
constexpr double bays_behind = 10.0;  // of a layered track, until what stirs wheels there is seen

/// s, of the vehicles that are there, each on all its springs at once.
double longest_swing(const Scene& scene) {
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

/// x of what has to be crossed for a vehicle to have been seen.
double reach(const Scene& scene) {
  const std::vector<double>& spans = scene.beam->spans;
  return behind * (spans.size() <= crossed_in_full ? scene.beam->length() : spans[0]);
}

/// x at t = 0 of what of a vehicle has to have crossed: its last wheel, in a train its middle.
double last_to_watch(const Scene& scene, std::size_t vehicle) {
  const std::vector<double> wheels = wheels_at_start(scene, vehicle);
  if (wheels.empty()) return 0.0;
  const auto [rear, front] = std::minmax_element(wheels.begin(), wheels.end());
  return scene.train.vehicles.size() < 3 ? *rear : 0.5 * (*front + *rear);
}

/// The same of moving forces: the fourth of them.
double last_force_to_watch(const Scene& scene) {
  std::vector<double> positions = scene.load.positions;
  std::sort(positions.begin(), positions.end(), std::greater<>());
  return positions[std::min<std::size_t>(3, positions.size() - 1)];
}

/// When the first vehicle, or without vehicles the first forces, have passed x, s.
double passed(const Scene& scene, double x) {
  return scene.train.vehicles.empty() ? (x - last_force_to_watch(scene)) / scene.load.speed
                                      : (x - last_to_watch(scene, 0)) / scene.train.speed;
}

/// All that tells a span from another one, in numbers.
std::vector<double> numbers_of(const beam::BeamModel& beam, std::size_t span, double left) {
  const double length = beam.spans[span], middle = left + 0.5 * length;
  std::vector<double> numbers = {length};
  for (const std::size_t end : {span, span + 1})
    numbers.push_back((fixes_vertical(beam.supports[end]) ? 1.0 : 0.0) +
                      (fixes_rotation(beam.supports[end]) ? 2.0 : 0.0));
  const auto along = [&](const beam::Distribution& values) {
    for (int i = 0; i <= places_a_span; ++i) numbers.push_back(values.at(left + length * i / places_a_span, middle));
    for (const double x : values.breaks(left, left + length)) numbers.push_back((x - left) / length);
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
      const double place = (point.x - left) / length;
      if (place < -same_number || place > 1.0 + same_number) continue;
      numbers.insert(numbers.end(), {place, point.k, point.c});
      law(point.law);
    }
    numbers.push_back(-1.0);  // between the kinds
  });
  for_beds(beam.foundation, [&](const beam::FoundationKind&, const beam::Bed& bed) {
    along(bed.k);
    along(bed.c);
    law(bed.law);
  });
  for (const double x : beam.hinges)
    if (x > left && x < left + length) numbers.push_back((x - left) / length);
  for (const beam::Crack& crack : beam.cracks)
    if (crack.x > left && crack.x < left + length) numbers.insert(numbers.end(), {(crack.x - left) / length, crack.k});
  if (!beam.settlement.empty()) numbers.insert(numbers.end(), {beam.settlement[span], beam.settlement[span + 1]});
  return numbers;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::abs(x - y) <= same_number * std::max({std::abs(x), std::abs(y), 1.0});
  });
}

void add_spans(const Scene& scene, std::vector<LaterEvent>& list) {
  const beam::BeamModel& beam = *scene.beam;
  std::vector<std::vector<double>> kinds;
  double left = beam.start;
  for (std::size_t i = 0; i < beam.spans.size(); left += beam.spans[i++]) {
    std::vector<double> numbers = numbers_of(beam, i, left);
    if (std::any_of(kinds.begin(), kinds.end(), [&](const auto& kind) { return same(kind, numbers); })) continue;
    kinds.push_back(std::move(numbers));
    list.push_back({passed(scene, left + behind * beam.spans[i]),
                    fmt::format("the span from {:g} to {:g} m, unlike those before it", left, left + beam.spans[i])});
  }
}

void add_vehicles(const Scene& scene, std::vector<LaterEvent>& list) {
  std::vector<int> types;
  for (std::size_t i = 0; i < scene.train.vehicles.size(); ++i) {
    const int type = scene.train.vehicles[i];
    if (std::find(types.begin(), types.end(), type) != types.end()) continue;
    types.push_back(type);
    list.push_back({(reach(scene) - last_to_watch(scene, i)) / scene.train.speed,
                    fmt::format("vehicle {}, unlike those before it", i)});
  }
}

void add_profile(const Scene& scene, std::vector<LaterEvent>& list) {
  const track::Profile& profile = scene.profile;
  if (profile.level() || (profile.is_rough() && profile.kinks().empty())) return;  // no dips on top
  const double length = scene.beam->length();
  const bool bump = std::isfinite(profile.shortest_wave());
  // a table stirs wheels most where it is most sharply bent
  const double x = bump ? profile.kinks().back() : profile.sharpest_place(0.0, length);
  if (x <= length)
    list.push_back({passed(scene, x + behind * scene.beam->spans[0]), fmt::format("the track's profile at {:g} m", x)});
}

/// Stretches of a layered track, where its tables change last, joints of its rail.
void add_track(const Scene& scene, std::vector<LaterEvent>& list) {
  if (!scene.beam->track) return;
  const beam::LayeredTrack& track = *scene.beam->track;
  const auto add = [&](double x, const std::string& what) {
    list.push_back({passed(scene, x + bays_behind * track.spacing), what});
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
          list.push_back({kinks.back(), fmt::format("what {} does until {:g} s", actuator.name, kinks.back())});
}

}  // namespace

double initial_window(const Scene& scene, double end) {
  double until = 0.0;
  if (!scene.train.vehicles.empty())
    until = scene.train.steady() ? (reach(scene) - last_to_watch(scene, 0)) / scene.train.speed : end;
  if (!scene.load.forces.empty())
    until = std::max(until, scene.load.courses.empty() && scene.load.speed > 0.0
                                ? (reach(scene) - last_force_to_watch(scene)) / scene.load.speed
                                : end);
  return until > 0.0 && until < end ? until : end;
}

bool vibrates_on(const Scene& scene) {
  const auto damps = [](const auto& spring) { return spring.damping > 0.0 || spring.law.has_value(); };
  return std::ranges::any_of(scene.train.vehicles, [&](int type) {
    const Vehicle& vehicle = scene.vehicles[static_cast<std::size_t>(type)];
    return std::ranges::none_of(vehicle.mechanism.springs, damps) &&
           std::ranges::none_of(vehicle.mechanism.torsion_springs, damps) &&
           std::ranges::none_of(vehicle.wheels, [](const Wheel& wheel) { return wheel.law.damping > 0.0; });
  });
}

double with_swing_behind(const Scene& scene, double until) {
  if (scene.train.vehicles.empty() || !scene.train.steady()) return until;
  const double leaves = passed(scene, scene.beam->end());
  return until < leaves ? until : std::max(until, leaves + part_of_swing * longest_swing(scene));
}

std::vector<LaterEvent> later_events(const Scene& scene, double seen, double end) {
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
  for (LaterEvent& meeting : list) meeting.until = std::min(meeting.until, end);
  std::erase_if(list, [&](const LaterEvent& meeting) { return meeting.until <= seen; });
  std::stable_sort(list.begin(), list.end(),
                   [](const LaterEvent& a, const LaterEvent& b) { return a.until < b.until; });
  return list;
}

}  // namespace traverse::app
