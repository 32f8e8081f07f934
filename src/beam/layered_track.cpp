// Checks a layered track, and assembles the masses of sleepers and ballast, the springs and dampers between rail,
// sleeper, ballast, the bridge element below the sleeper and the ground, and the shear of the ballast.
#include "layered_track.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "assembly.hpp"
#include "beam/shape.hpp"
#include "traverse/base/error.hpp"

namespace traverse::beam {
namespace {

/// The station rounded to 2^-32 of its element, so that sleepers at equal positions are equal to the last bit; matrices
/// and factors that repeat are stored once.
Station on_grid(Station station) {
  constexpr double grid = 4294967296.0;
  station.xi = std::round(station.xi * grid) / grid;
  return station;
}

/// The matrix of k (a - b)^2/2 between two unknowns: [k, -k; -k, k].
std::array<double, 4> between(double k) { return {k, -k, -k, k}; }

/// Adds a spring and a damper: to the stiffness with k, to the damping with c.
template <class Add>
void add_layer(const Spring& spring, Rows& stiffness, Rows& damping, Add add) {
  add(spring.k, stiffness);
  add(spring.c, damping);
}

void add_on_bridge(const Sleeper& s, const Line& bridge, const Layout& layout, const LayeredTrack& track, Rows& mass,
                   Rows& stiffness, Rows& damping) {
  const auto [v1, theta1, v2, theta2] = bridge.transverse(s.at.element);
  const Element& element = bridge.mesh.element(s.at.element);
  const PointShape below = shape_at(bridge, Direction::vertical, s.at, 0.0, bridge.eccentricity(0));
  const SleeperConnection connection = connection_of(s, track, layout);
  mass.add(below.unknown, outer(connection.mass, below.shape));
  std::array<double, 9> direction{1.0};
  std::array<int, 9> unknowns{connection.unknown};
  std::ranges::copy(below.unknown, unknowns.begin() + 1);
  std::ranges::transform(below.shape, direction.begin() + 1, std::negate());
  add_layer(connection.spring, stiffness, damping,
            [&](double k, Rows& rows) { rows.add(unknowns, outer(k, direction)); });
  if (connection.along < 0) return;
  // The beam's surface at the height e above its axis moves by u - e theta along x.
  const auto [u1, u2] = bridge.axial(s.at.element);
  const auto phi = linear(s.at.xi);
  const auto turn = rotation(s.at.xi, element.length, element.shear);
  const double e = bridge.model.surface_height;
  const std::array<double, 7> along{1.0, -phi[0], -phi[1], e * turn[0], e * turn[1], e * turn[2], e * turn[3]};
  const std::array<int, 7> unknowns_along{connection.along, u1, u2, v1, theta1, v2, theta2};
  add_layer(connection.spring_along, stiffness, damping,
            [&](double k, Rows& rows) { rows.add(unknowns_along, outer(k, along)); });
}

constexpr double joint_tolerance = 1e-6;  // largest distance of a joint from its node, relative to an element's length

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

[[noreturn]] void reject(const std::string& option, double value, const std::string& allowed) {
  throw InputError(option + " is " + text_of(value) + "; " + allowed);
}

void check_positive(const Distribution& d, const std::string& option, const std::string& unit) {
  for (const double value : {d.minimum(), d.maximum()})
    if (!std::isfinite(value) || !(value > 0.0)) reject(option, value, "it must be positive (" + unit + ")");
}

void check_not_negative(const Distribution& d, const std::string& option, std::string_view unit) {
  for (const double value : {d.minimum(), d.maximum()})
    if (!std::isfinite(value) || !(value >= 0.0))
      reject(option, value, "it must not be negative (" + std::string(unit) + ")");
}

void check_properties(const LayeredTrack& track) {
  for (std::size_t i = 0; i < track_property_count; ++i) {
    const TrackProperty& property = track_properties[i];
    const std::string name(property.name);
    if (const Distribution* along = property.along(track)) check_not_negative(*along, "track_" + name, property.unit);
    for (const TrackStretch& s : track.stretches)
      if (s.values[i]) check_not_negative(*s.values[i], "track_" + s.name + "_" + name, property.unit);
  }
  check_not_negative(track.shear.k, "track_shear_k", "N/m");
  check_not_negative(track.shear.c, "track_shear_c", "N s/m");
}

/// Visits the stations of the grid of sleepers, from the left end of the track.
template <class Visit>
void for_sleepers(const BeamModel& model, Visit visit) {
  const RailMesh rail = rail_mesh(model);
  for (int node = 0; node <= rail.elements; node += model.track->elements_per_bay) {
    const double x = rail.x(node);
    visit(x, x >= model.start && x <= model.end());
  }
}

/// Checks a value that must be positive at a sleeper. The message names the option of the whole track or of the last
/// TrackStretch that sets it.
void check_at(double value, double x, const LayeredTrack& track, const char* name) {
  if (value > 0.0) return;
  std::string option = "track_" + std::string(name);
  for (const TrackStretch& s : track.stretches)
    for (std::size_t i = 0; i < track_property_count; ++i)
      if (s.values[i] && track_properties[i].name == name && s.contains(x, 1e-9 * track.spacing))
        option = "track_" + s.name + "_" + name;
  throw InputError(option + " is " + text_of(value) + " at the sleeper at x = " + text_of(x) +
                   " m; it must be positive");
}

/// Checks that a station of the grid is supported. Pads or ballast may have failed, but not both.
void check_sleeper(const LayeredTrack& track, double x, bool on_bridge) {
  const TrackValues values = track.at(x);
  if (track.ballast && track.subballast && (!on_bridge || track.own_mass)) {
    check_at(values.ballast_mass, x, track, "ballast_mass");
    check_at(values.subballast.k, x, track, "subballast_k");
  }
  if (!track.has_sleeper(x)) return;
  const bool moves = track.ballast || (track.subballast && !on_bridge);
  if (!moves) return;
  check_at(values.sleeper_mass, x, track, "sleeper_mass");
  if (values.gap > 0.0) {
    check_at(values.pad.k, x, track, "pad_k");
    check_at(values.ballast.k, x, track, "ballast_k");
  }
  const double below = track.ballast ? values.ballast.k : values.subballast.k;
  if (!(values.pad.k + below > 0.0))
    throw InputError("the sleeper at x = " + text_of(x) +
                     " m has neither pad nor ballast (track_pad_k, track_ballast_k); to leave it out: sleepers none");
}

/// Whether this sleeper supports the rail without a gap.
bool supports_rail(const LayeredTrack& track, double x, bool on_bridge) {
  const TrackValues values = track.at(x);
  const double below = track.ballast ? values.ballast.k : track.subballast && !on_bridge ? values.subballast.k : 1.0;
  return values.gap == 0.0 && values.pad.k > 0.0 && below > 0.0;
}

/// Checks that each part of the rail between its joints is supported by at least two sleepers.
void check_rail_support(const BeamModel& model) {
  BeamModel rail = rail_model(model);
  rail.axial = false;
  rail.foundation = {};
  bool along = false;
  for_sleepers(model, [&](double x, bool on_bridge) {
    if (supports_rail(*model.track, x, on_bridge)) {
      PointFoundation point;
      point.x = x;
      point.k = 1.0;
      rail.foundation.vertical.push_back(point);
    }
    along = along || model.track->at(x).longitudinal.k > 0.0;
  });
  const std::string floating = floating_motion(rail);
  if (!floating.empty())
    throw InputError("track_pad_k: too few sleepers without a gap carry the rail, which can float away (" + floating +
                     ")");
  if (model.axial && !along)
    throw InputError("track_longitudinal_k is 0 at every sleeper; along x something must hold the rail");
}

void check_stretches(const BeamModel& model) {
  for (const TrackStretch& s : model.track->stretches) {
    bool any = false;
    for_sleepers(model, [&](double x, bool) { any = any || s.contains(x, 1e-9 * model.track->spacing); });
    if (!any)
      throw InputError("track_" + s.name + "_from, track_" + s.name + "_to: no sleeper of the track stands from " +
                       text_of(s.from) + " to " + text_of(s.to) + " m; they stand every " +
                       text_of(model.track->spacing) + " m (track_spacing, track_offset, track_approach)");
  }
}

/// Checks that joints and expansion devices are at nodes of the rail.
void check_at_nodes(const RailMesh& rail, const std::vector<double>& stations, const char* option,
                    const std::string& subject) {
  double before = rail.start;
  for (const double x : stations) {
    if (!(x > before) || !(x < rail.x(rail.elements)))
      reject(option, x, subject + " lie within the track, from left to right, each at a place of its own");
    const double nodes = (x - rail.start) / rail.element;
    if (std::abs(nodes - std::round(nodes)) > joint_tolerance)
      reject(option, x,
             subject + " stand at nodes of the rail, which are " + text_of(rail.element) +
                 " m apart (track_spacing over track_elements_per_bay), one at every sleeper");
    before = x;
  }
}

/// Checks expansion devices. A sleeper at a device would hold both of its sides, and the rail between two devices needs
/// a sleeper that holds it.
void check_devices(const BeamModel& model) {
  const LayeredTrack& track = *model.track;
  const RailMesh rail = rail_mesh(model);
  const char* option = "track_rail_expansion_devices";
  const std::vector<double>& devices = track.expansion_devices;
  check_at_nodes(rail, devices, option, "expansion devices");
  std::vector<char> held(devices.size() + 1, 0);  // whether the rail between two devices is held along x
  held.front() = held.back() = track.rail_ends_held ? 1 : 0;
  const double tolerance = joint_tolerance * rail.element;
  for_sleepers(model, [&](double x, bool) {
    const auto device = std::lower_bound(devices.begin(), devices.end(), x - tolerance);
    if (device != devices.end() && *device <= x + tolerance && track.has_sleeper(x))
      reject(option, *device,
             "a sleeper stands there; expansion devices stand between sleepers, at nodes of the rail " +
                 text_of(rail.element) + " m apart (track_spacing over track_elements_per_bay)");
    if (track.at(x).longitudinal.k > 0.0) held[static_cast<std::size_t>(device - devices.begin())] = 1;
  });
  for (const double x : track.rail_hinges)
    if (std::any_of(devices.begin(), devices.end(), [&](double device) { return std::abs(device - x) <= tolerance; }))
      reject(option, x, "a joint of the rail stands there (track_rail_hinges)");
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] == 0)
      reject(option, devices[std::min(i, devices.size() - 1)],
             i < devices.size() ? "no sleeper to its left holds the rail along x (track_longitudinal_k)"
                                : "no sleeper to its right holds the rail along x (track_longitudinal_k)");
}

}  // namespace

std::vector<Sleeper> sleepers_of(const Line& bridge, int first, int past) {
  const LayeredTrack& track = *bridge.model.track;
  const RailMesh rail = rail_mesh(bridge.model);
  const double rounding = 1e-9 * rail.element;
  std::vector<Sleeper> sleepers;
  const int per_bay = track.elements_per_bay;
  for (int node = (std::max(first, 0) + per_bay - 1) / per_bay * per_bay; node < std::min(past, rail.elements + 1);
       node += per_bay) {
    Sleeper s;
    s.x = rail.x(node);
    s.rail_node = node;
    s.on_bridge = s.x >= bridge.mesh.start() - rounding && s.x <= bridge.mesh.end() + rounding;
    s.side = s.on_bridge ? 0 : s.x < bridge.mesh.start() ? -1 : 1;
    // Between two separate spans the sleeper is on the right-hand span, as in the numbering, independent of the
    // rounding of x.
    if (s.on_bridge) s.at = on_grid(bridge.mesh.locate(s.x + rounding));
    s.values = track.at(s.x);
    s.missing = !track.has_sleeper(s.x);
    s.sleeper_moves = !s.missing && (track.ballast || (track.subballast && !s.on_bridge));
    s.ballast_moves = track.ballast && track.subballast && (!s.on_bridge || track.own_mass);
    sleepers.push_back(s);
  }
  return sleepers;
}

SleeperConnection connection_of(const Sleeper& s, const LayeredTrack& track, const Layout& layout) {
  const int column = s.rail_node * layout.block;
  const int along = layout.place[rail_u] < 0 ? -1 : column + layout.place[rail_u];
  const Spring longitudinal = s.linear_longitudinal();
  if (s.ballast_moves) return {s.ballast_unknown(layout), s.values.subballast, 0.0, along, longitudinal};
  if (track.ballast) return {s.unknown(layout), s.linear_ballast(), s.values.ballast_mass, along, longitudinal};
  return {column + layout.place[rail_v], s.values.pad, s.values.sleeper_mass, along, longitudinal};
}

std::vector<std::pair<int, double>> masses_of(const Sleeper& s, const Layout& layout) {
  std::vector<std::pair<int, double>> masses;
  if (s.sleeper_moves) masses.emplace_back(s.unknown(layout), s.values.sleeper_mass);
  if (s.ballast_moves) masses.emplace_back(s.ballast_unknown(layout), s.values.ballast_mass);
  return masses;
}

void release_sleeper(const Sleeper& s, const Layout& layout, Slice& slice) {
  for (const auto& [unknown, mass] : masses_of(s, layout)) slice.release(unknown);
}

void add_track(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping) {
  const LayeredTrack& track = *bridge.model.track;
  for (const Sleeper& s : sleepers_of(bridge, slice.first - 1, slice.first + slice.local + 1)) {
    if (s.on_bridge) {
      add_on_bridge(s, bridge, layout, track, mass, stiffness, damping);
    } else {
      visit_ground_springs(s, track, layout, [&](int unknown, const Spring& spring, bool) {
        add_layer(spring, stiffness, damping,
                  [&](double k, Rows& rows) { rows.add(std::array{unknown}, std::array{k}); });
      });
    }
    const auto connect = [&](const Spring& spring, int above, int below) {
      add_layer(spring, stiffness, damping, [&](double k, Rows& rows) {
        rows.add(std::array{above, below}, between(k));
      });
    };
    if (s.ballast_moves && s.sleeper_moves) connect(s.linear_ballast(), s.unknown(layout), s.ballast_unknown(layout));
    for (const auto& [unknown, node_mass] : masses_of(s, layout)) mass.add(std::array{unknown}, std::array{node_mass});
    // Without a separate sleeper mass the pad acts on the next layer.
    if (s.sleeper_moves) connect(s.values.pad, s.rail_node * layout.block + layout.place[rail_v], s.unknown(layout));
  }
}

bool shear_between(const Sleeper& left, const Sleeper& right, const Layout& layout) {
  if (!left.ballast_moves || !right.ballast_moves) return false;
  return layout.place[Kind::ballast] >= 0 || left.side == right.side;
}

std::vector<std::pair<Sleeper, Sleeper>> pairs_in_shear(const Line& bridge, const Layout& layout, int first, int past) {
  std::vector<std::pair<Sleeper, Sleeper>> pairs;
  const LayeredTrack& track = *bridge.model.track;
  if (track.shear.k == 0.0 && track.shear.c == 0.0) return pairs;
  const int elements_per_bay = track.elements_per_bay;
  const std::vector<Sleeper> sleepers = sleepers_of(bridge, first - elements_per_bay, past + elements_per_bay);
  for (std::size_t i = 0; i + 1 < sleepers.size(); ++i)
    if (shear_between(sleepers[i], sleepers[i + 1], layout)) pairs.emplace_back(sleepers[i], sleepers[i + 1]);
  return pairs;
}

void release_links(const Line& bridge, const Layout& layout, Slice& slice) {
  for (const auto& [left, right] : pairs_in_shear(bridge, layout, slice.first - 1, slice.first + slice.local + 1))
    visit_links(left, right, layout, [&](int unknown, double) { slice.release(unknown); });
}

void add_shear(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping) {
  const LayeredTrack& track = *bridge.model.track;
  const double n = track.elements_per_bay;
  const auto between = [](double k) { return std::array{k, -k, -k, k}; };
  for (const auto& [left, right] : pairs_in_shear(bridge, layout, slice.first - 1, slice.first + slice.local + 1)) {
    int previous = left.ballast_unknown(layout);
    const auto connect = [&](int unknown) {
      stiffness.add(std::array{previous, unknown}, between(n * track.shear.k));
      damping.add(std::array{previous, unknown}, between(n * track.shear.c));
      previous = unknown;
    };
    visit_links(left, right, layout, [&](int unknown, double link_mass) {
      mass.add(std::array{unknown}, std::array{link_mass});
      connect(unknown);
    });
    connect(right.ballast_unknown(layout));
  }
}

void check_track(const BeamModel& model) {
  const LayeredTrack& t = *model.track;
  check_positive(t.rail_EI, "track_rail_EI", "N m2");
  if (model.axial) check_positive(t.rail_EA, "track_rail_EA", "N");
  check_positive(t.rail_mass, "track_rail_mass", "kg/m");
  check_positive(t.spacing, "track_spacing", "m");
  if (t.elements_per_bay < 1) reject("track_elements_per_bay", t.elements_per_bay, "at least 1");
  check_not_negative(t.approach, "track_approach", "m");
  if (!((model.length() + 2.0 * t.approach) / t.spacing * t.elements_per_bay < 1e8))
    reject("track_spacing", t.spacing, "fewer than 1e8 rail elements are possible");
  check_properties(t);
  for (const char* name : {"longitudinal_loaded_k", "longitudinal_loaded_limit"})
    if (t.any_positive(name) && !t.slides())
      throw InputError(std::string("track_") + name +
                       " needs track_longitudinal_limit: it is that of sleepers that slide");
  if (!t.ballast && t.hangs()) throw InputError("track_gap needs track_ballast_k: it lies below a sleeper on ballast");
  if (t.uniform()) {
    if (!(t.pad.k.maximum() > 0.0)) reject("track_pad_k", 0.0, "it must be positive (N/m)");
    if (t.ballast && !(t.ballast->k.maximum() > 0.0)) reject("track_ballast_k", 0.0, "it must be positive (N/m)");
    if (t.subballast && !(t.subballast->k.maximum() > 0.0))
      reject("track_subballast_k", 0.0, "it must be positive (N/m)");
  }
  const RailMesh rail = rail_mesh(model);
  if (t.uniform()) {
    check_sleeper(t, rail.start, false);
    check_sleeper(t, model.start, true);
  } else {
    check_stretches(model);
    for_sleepers(model, [&](double x, bool on_bridge) { check_sleeper(t, x, on_bridge); });
  }
  check_at_nodes(rail, t.rail_hinges, "track_rail_hinges", "joints");
  if (!t.expansion_devices.empty()) check_devices(model);
  if (!t.uniform() || !t.rail_hinges.empty() || t.hangs())
    check_rail_support(model);
  else if (model.axial)
    check_positive(t.longitudinal.k, "track_longitudinal_k", "N/m");
  for (const Piece& piece : pieces_of(model)) {
    if (piece.elements < 1)
      reject("track_spacing", t.spacing,
             "every span, and what hinges leave of it, needs two rail elements or more (track_elements_per_bay)");
  }
}

}  // namespace traverse::beam
