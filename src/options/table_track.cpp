// Rows of the option table: lines of tracks on a bridge that twists; a layered track, whose properties may vary along
// x, and its stretches; mass dampers.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "derived_rows.hpp"
#include "traverse/beam/layered_track.hpp"

namespace traverse::options {
namespace {

using enum Kind;

// clang-format off
constexpr Row track_lines[] = {
  {"track_eccentricity", number, "m", "0", any, "", 0, "distance of the track to the left of the beam's axis, seen along x; deflections at the probes are those of the track"},
  {"tracks", texts, "", "(one track: the options of track)", any, "", 0, "names of several tracks or lanes of a bridge that twists; each has its own block: NAME_eccentricity, curve and cant, and a running surface as of track: NAME_profile, ...; trains and loads name theirs, and each track has its own probes"},
  {"track_curve_radius", number, "m", "(straight)", any, "", 0, "radius of the track's curve, positive: a curve to the left; the centrifugal force turns the beam"},
  {"track_cant", number, "m", "0", any, "", 0, "height of the right rail above the left one; cant moves the weights to the left"},
  {"track_cant_base", number, "m", "1.5", positive, "", 0, "distance between the rails' centres, over which the cant is measured"},
  {"track_height", number, "m", "0", any, "", 0, "height of the rails above the shear centres, for centrifugal forces"},
  {"track_load_height", number, "m", "1.8", not_negative, "", 0, "height above the rails of the weights and of the centrifugal forces"},
};

constexpr Row rail_rows[] = {
  {"track_rail_EI", number_or_file, "N m2", "", positive, "", 0, "layered track: bending stiffness of both rails, or a file x,value"},
  {"track_rail_EA", number_or_file, "N", "", positive, "", 0, "layered track: axial stiffness of both rails, or a file x,value; only needed for longitudinal action"},
  {"track_rail_GA", number, "N", "", positive, "", 0, "layered track: shear stiffness of both rails; without it: no shear deformation"},
  {"track_rail_mass", number_or_file, "kg/m", "", positive, "", 0, "layered track: mass of both rails per length, or a file x,value"},
  {"track_rail_area", number, "m2", "", positive, "", 0, "layered track: cross-section area of both rails, for their axial stress"},
  {"track_rail_temperature", number, "K", "0", any, "", 0, "layered track: temperature change since the rail was laid, positive: warmer"},
  {"track_rail_expansion", number, "1/K", "1.2e-5", not_negative, "", 0, "layered track: coefficient of thermal expansion of the rails"},
  {"track_rail_ends", choice, "", "free", any, "free held", 0, "layered track: ends of the modelled rail along x; held: fixed, as where the track continues"},
  {"track_rail_hinges", numbers, "m", "", any, "", 0, "layered track: stations of rail joints that transmit no moment, at nodes of the rail"},
  {"track_rail_expansion_devices", numbers, "m", "", any, "", 0, "layered track: stations of rail expansion devices, which transmit no axial force, at nodes of the rail between sleepers"},
  {"track_spacing", number, "m", "", positive, "", 0, "layered track: sleeper spacing"},
  {"track_offset", number, "m", "0", any, "", 0, "layered track: x of one sleeper"},
  {"track_elements_per_bay", integer, "", "2", {1, 100}, "", 0, "layered track: rail elements between two sleepers; the bridge has the same number"},
};

constexpr Row further_rows[] = {
  {"track_ballast_own_mass", flag, "", "false", any, "", 0, "layered track: the ballast on the bridge is a separate mass on the sub-ballast spring; false: its mass is added to the bridge"},
  {"track_shear_k", number, "N/m", "0", not_negative, "", 0, "layered track: stiffness between neighbouring ballast masses that move separately"},
  {"track_shear_c", number, "Ns/m", "0", not_negative, "", 0, "layered track: damping between these masses"},
  {"track_stretches", texts, "", "", any, "", 0, "layered track: names of stretches with different properties"},
  {"track_approach", number, "m", "(from the train's length)", not_negative, "", 0, "layered track: length of track modelled on either side of the bridge"},
};

constexpr Row ends_of_stretch[] = {
  {"from", number, "m", "", any, "", 0, "x of the start; sleepers from there on belong to the stretch"},
  {"to", number, "m", "", any, "", 0, "x of the end; sleepers up to there belong to the stretch"},
  {"sleepers", choice, "", "standard", any, "standard none", 0, "none: no sleepers and no pads; the ballast remains"},
};

constexpr Row rows_of_damper[] = {
  {"x", number, "m", "", not_negative, "", 0, "station of the tuned mass damper"},
  {"mass", number, "kg", "", positive, "", 0, "its mass"},
  {"frequency", number, "Hz", "", positive, "", 0, "its natural frequency on a beam at rest"},
  {"damping_ratio", number, "1", "0", {0.0, 10.0}, "", 0, "its damping ratio on a beam at rest"},
  {"k", number, "N/m", "", positive, "", 0, "stiffness of its spring, instead of frequency"},
  {"c", number, "Ns/m", "", not_negative, "", 0, "coefficient of its dashpot, instead of damping_ratio"},
};
// clang-format on

/// The default of a property; stiffnesses have none.
std::string_view fallback_of(std::string_view name) {
  return name.ends_with("_k") && !name.ends_with("loaded_k") ? "" : "0";
}

/// An addition to the text of a property.
std::string addition_for(std::string_view name) {
  if (name == "ballast_k") return "; without it: the next layer supports the sleepers";
  if (name == "subballast_k")
    return "; on the ground, and on the bridge with track_ballast_own_mass; without it: rigid";
  return "";
}

}  // namespace

std::span<const Row> track_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(track_lines), std::end(track_lines));
    all.insert(all.end(), std::begin(rail_rows), std::end(rail_rows));
    for (const beam::TrackProperty& p : beam::track_properties)
      all.push_back(
          {permanent(fmt::format("track_{}", p.name)), number_or_file, p.unit, fallback_of(p.name), not_negative, "", 0,
           permanent(fmt::format("layered track: {}{}; also as a file x,value", p.text, addition_for(p.name)))});
    all.insert(all.end(), std::begin(further_rows), std::end(further_rows));
    return all;
  }();
  return rows;
}

std::span<const Row> damper_rows() { return rows_of_damper; }

std::span<const Row> stretch_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(ends_of_stretch), std::end(ends_of_stretch));
    for (const beam::TrackProperty& p : beam::track_properties)
      all.push_back({p.name, number_or_file, p.unit, "(that of the whole track)", not_negative, "", 0,
                     permanent(fmt::format("{}; also as a file x,value", p.text))});
    return all;
  }();
  return rows;
}

}  // namespace traverse::options
