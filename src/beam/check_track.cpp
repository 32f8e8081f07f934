// Checks the properties of a layered track sleeper by sleeper, the positions of rail joints and expansion devices, and
// whether the sleepers hold the rail vertically and along x.
#include "check_track.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "traverse/base/error.hpp"

namespace traverse::beam {
namespace {

constexpr double node_tolerance = 1e-6;  // largest distance of a joint from its node, relative to an element's length

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
    if (std::abs(nodes - std::round(nodes)) > node_tolerance)
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
  const double tolerance = node_tolerance * rail.element;
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
