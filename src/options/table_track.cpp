// Rows of the option table: a layered track, whose properties may change along x, and its stretches.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "derived_rows.hpp"
#include "traverse/beam/layered_track.hpp"

namespace traverse::options {
namespace {

using enum Kind;

// clang-format off
constexpr Row rail_rows[] = {
  {"track_rail_EI", number_or_file, "N m2", "", positive, "", 0, "layered track: rail's bending stiffness (both rails), or a file x,value"},
  {"track_rail_EA", number_or_file, "N", "", positive, "", 0, "layered track: rail's axial stiffness, or a file x,value; needed for longitudinal action only"},
  {"track_rail_GA", number, "N", "", positive, "", 0, "layered track: rail's shear stiffness; left out: it does not shear"},
  {"track_rail_mass", number_or_file, "kg/m", "", positive, "", 0, "layered track: rail's mass per length, or a file x,value"},
  {"track_rail_area", number, "m2", "", positive, "", 0, "layered track: cross-section of both rails, for their stress along x"},
  {"track_rail_temperature", number, "K", "0", any, "", 0, "layered track: warmer than when the rail was laid"},
  {"track_rail_expansion", number, "1/K", "1.2e-5", not_negative, "", 0, "layered track: rail's coefficient of expansion"},
  {"track_rail_ends", choice, "", "free", any, "free held", 0, "layered track: whether the ends of the modelled rail are held along x, as where the track goes on"},
  {"track_rail_hinges", numbers, "m", "", any, "", 0, "layered track: stations of rail joints that carry no moment, at nodes of the rail"},
  {"track_rail_expansion_devices", numbers, "m", "", any, "", 0, "layered track: stations of rail expansion devices, which carry no axial force, at nodes of the rail between sleepers"},
  {"track_spacing", number, "m", "", positive, "", 0, "layered track: from sleeper to sleeper"},
  {"track_offset", number, "m", "0", any, "", 0, "layered track: x of one of the sleepers"},
  {"track_elements_per_bay", integer, "", "2", {1, 100}, "", 0, "layered track: rail elements from sleeper to sleeper; the bridge has as many"},
};

constexpr Row further_rows[] = {
  {"track_ballast_own_mass", flag, "", "false", any, "", 0, "layered track: on the bridge too the ballast is a mass by itself on the sub-ballast's spring; false: it rides on the bridge"},
  {"track_shear_k", number, "N/m", "0", not_negative, "", 0, "layered track: stiffness between neighbouring masses of ballast that move by themselves"},
  {"track_shear_c", number, "Ns/m", "0", not_negative, "", 0, "layered track: damping between them"},
  {"track_stretches", texts, "", "", any, "", 0, "layered track: names of stretches where some of its properties differ"},
  {"track_approach", number, "m", "(the train's length and more)", not_negative, "", 0, "layered track: length modelled on either side"},
};

constexpr Row ends_of_stretch[] = {
  {"from", number, "m", "", any, "", 0, "where the stretch begins: sleepers from there on belong to it"},
  {"to", number, "m", "", any, "", 0, "where it ends: sleepers up to there"},
  {"sleepers", choice, "", "standard", any, "standard none", 0, "none: there are neither sleepers nor pads; the ballast stays"},
};
// clang-format on

/// What a property is when it is not given; stiffnesses have none.
std::string_view fallback_of(std::string_view name) {
  return name.ends_with("_k") && !name.ends_with("loaded_k") ? "" : "0";
}

std::string more_of(std::string_view name) {
  if (name == "ballast_k") return "; left out: sleepers stand on the next layer";
  if (name == "subballast_k") return ", on the ground and below track_ballast_own_mass; left out: rigid";
  return "";
}

}  // namespace

std::span<const Row> track_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(rail_rows), std::end(rail_rows));
    for (const beam::TrackProperty& p : beam::track_properties)
      all.push_back({kept(fmt::format("track_{}", p.name)), number_or_file, p.unit, fallback_of(p.name), not_negative,
                     "", 0, kept(fmt::format("layered track: {}, or a file x,value{}", p.text, more_of(p.name)))});
    all.insert(all.end(), std::begin(further_rows), std::end(further_rows));
    return all;
  }();
  return rows;
}

std::span<const Row> stretch_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(ends_of_stretch), std::end(ends_of_stretch));
    for (const beam::TrackProperty& p : beam::track_properties)
      all.push_back({p.name, number_or_file, p.unit, "(that of the whole track)", not_negative, "", 0,
                     kept(fmt::format("{}, or a file x,value", p.text))});
    return all;
  }();
  return rows;
}

}  // namespace traverse::options
