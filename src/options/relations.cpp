// The table of the relations between options, and their check. An option of the table is a name, a begin of names
// (NAME*) or a name with a value (NAME=VALUE); before each stands the begin of the block's names, and in a text in
// place of ~.
#include "options/relations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace traverse::options {
namespace {

enum class Verb { needs, needs_all, excludes, has_no_effect_without };
using enum Verb;

struct Relation {
  Related related;
  std::string_view options;  // separated by blanks, as the others
  Verb verb;
  std::string_view others;  // needs: one of them
  std::string_view text;    // of the message; empty: made from the names
};

// clang-format off
constexpr Relation relations[] = {
  {Related::scene, "beam_* support_* foundation_* track_rail* track_pad* track_sleeper* track_ballast* track_subballast* track_longitudinal* norm_*", excludes, "bridge_modes_file", "needs a bridge of elements (beam_spans); bridge_modes_file has only modes"},
  {Related::scene, "model_axial model_damping_ratios model_damping_bound model_additional_damping", excludes, "bridge_modes_file", "is not allowed with bridge_modes_file, which defines the modes and their damping"},
  {Related::scene, "scene_analysis=static scene_analysis=envelope scene_analysis=rail scene_analysis=screen", excludes, "bridge_modes_file", "needs a bridge of elements (beam_spans), bridge_modes_file has only modes; allowed: transient or modes"},
  {Related::scene, "bridge_track", needs, "bridge_modes_file", ""},
  {Related::scene, "beam_* support_* foundation_* surface_*", needs, "beam_spans bridge_modes_file", "there is no beam without beam_spans"},
  {Related::scene, "beam_damping_ratios", excludes, "beam_rayleigh", ""},
  {Related::scene, "beam_damping_frequencies", needs, "beam_damping_ratios", ""},
  {Related::scene, "foundation_shear_layer", excludes, "beam_tension foundation_rotational_bed_*", "acts as a rotational bed and as a tension; give only one of the three"},
  {Related::scene, "beam_tension", excludes, "foundation_rotational_bed_*", "acts as a rotational bed; give either this or foundation_rotational_bed"},
  {Related::scene, "foundation_shear_layer beam_tension", excludes, "beam_GA", "allowed for beams without shear deformation (beam_GA)"},
  {Related::scene, "beam_cracks_*", needs, "beam_cracks_x", "needs beam_cracks_x, the stations of the cracks"},
  {Related::scene, "beam_cracks_x", needs, "beam_cracks_k beam_cracks_width", "needs either beam_cracks_k, or beam_cracks_width with beam_cracks_EI_factor"},
  {Related::scene, "beam_cracks_k", excludes, "beam_cracks_width", ""},
  {Related::scene, "beam_cracks_width", needs, "beam_cracks_EI_factor", ""},
  {Related::scene, "beam_cracks_EI_factor", needs, "beam_cracks_width", ""},
  {Related::scene, "beam_GJ", needs, "beam_polar_inertia", ""},
  {Related::scene, "track_eccentricity track_curve_radius track_cant load_sideways_height tracks", excludes, "scene_analysis=rail scene_analysis=screen", "is for bridges that twist; rails by UIC 774-3 and screens have no torsion"},
  {Related::scene, "beam_ECw beam_polar_inertia beam_shear_centre beam_mass_centre support_torsion support_bearing_spacing norm_second_track track_eccentricity track_curve_radius track_cant load_sideways_height tracks foundation_vertical_eccentricity", needs, "beam_GJ", "belongs to a beam that twists, which needs beam_GJ"},
  {Related::scene, "beam_point_masses_x", needs, "beam_point_masses_mass", ""},
  {Related::scene, "beam_point_masses_mass", needs, "beam_point_masses_x", ""},
  {Related::scene, "beam_temperature_expansion beam_temperature_depth", needs, "beam_temperature_uniform beam_temperature_gradient", ""},
  {Related::scene, "support_scour", needs, "support_stiffness", "needs support_stiffness, which it reduces"},
  {Related::scene, "support_motion_values", needs, "support_motion support_motion_along", ""},
  {Related::scene, "support_motion support_motion_along", needs, "scene_analysis=transient", "is for transient runs only (scene_analysis)"},
  {Related::scene, "support_motion support_motion_along", excludes, "sweep_speed sweep_hslm_a", "is for single runs; allowed in studies, one by one, without sweep options"},
  {Related::scene, "sweep_speed sweep_hslm_a", needs, "scene_analysis=transient", "a sweep needs scene_analysis transient"},
  {Related::scene, "sweep_speed sweep_hslm_a", needs, "beam_spans bridge_modes_file", "a sweep needs a bridge (beam_spans)"},
  {Related::scene, "sweep_refine", has_no_effect_without, "sweep_speed sweep_hslm_a", "sweep_speed gives no speeds"},
  {Related::scene, "sweep_hslm_a", excludes, "loads", "is for one load; loads names several"},
  {Related::scene, "load_positions load_speed", has_no_effect_without, "load_forces load_hslm_a load_hslm_b load_en15528 load_file load_moments load_distributed loads sweep_hslm_a", "there are no load_forces"},
  {Related::scene, "track_rail_EI", needs, "beam_spans", "a layered track needs a bridge (beam_spans)"},
  {Related::scene, "track_rail* track_spacing track_offset track_pad* track_sleeper* track_ballast* track_subballast* track_longitudinal* track_approach track_elements* track_gap track_shear* track_stretches", needs, "track_rail_EI", "belongs to a layered track, which needs track_rail_EI"},
  {Related::scene, "track_ballast_c track_ballast_mass", needs, "track_ballast_k", ""},
  {Related::scene, "track_subballast_c", needs, "track_subballast_k", ""},
  {Related::scene, "track_ballast_own_mass track_shear_k track_shear_c", needs_all, "track_ballast_k track_subballast_k", "needs ballast masses that move separately: track_ballast_k, track_ballast_mass and track_subballast_k"},
  {Related::scene, "track_dips*", needs, "track_dips_x", "belongs to dips, which need track_dips_x"},
  {Related::scene, "output_probes output_probes_spacing", needs, "beam_spans bridge_modes_file", "needs a beam (beam_spans)"},
  {Related::scene, "output_rail output_sleepers", needs, "track_rail_EI", "needs a layered track (track_rail_EI)"},
  {Related::scene, "model_additional_damping", needs, "model_damping_bound", "needs model_damping_bound, to which it is added"},
  {Related::scene, "model_damping_ratios", excludes, "beam_damping_ratios beam_rayleigh", "give either these or Rayleigh damping (beam_damping_ratios, beam_rayleigh)"},
  {Related::scene, "model_damping_bound", needs, "beam_spans", "needs a bridge (beam_spans)"},
  {Related::scene, "model_damping_bound", excludes, "model_damping_ratios beam_damping_ratios beam_rayleigh", ""},
  {Related::scene, "norm_lane_gap", needs, "norm_lane_load", ""},
  {Related::scene, "scene_analysis=modes", needs, "beam_spans bridge_modes_file", "modes need a beam (beam_spans)"},
  {Related::scene, "scene_analysis=rail", needs, "track_rail_EI", "rail needs a bridge with a layered track (beam_spans, track_rail_EI)"},
  {Related::scene, "scene_analysis=rail", needs, "track_rail_area", "rail needs track_rail_area, for the stress of the rails"},
  {Related::scene, "scene_analysis=screen", needs_all, "screen_stock screen_fleet limits", ""},
  {Related::scene, "scene_analysis=screen", excludes, "beam_spans vehicle_* train_* trains load_* loads", "screen takes its bridges and trains from screen_stock and screen_fleet; allowed: no beam_, train_ and load_ options"},
  {Related::scene, "screen_*", has_no_effect_without, "scene_analysis=screen", "it belongs to scene_analysis screen"},
  {Related::scene, "uic774_*", has_no_effect_without, "scene_analysis=rail", "it belongs to scene_analysis rail"},
  {Related::scene, "study_*", has_no_effect_without, "study_vary_*", "study_vary names no option to vary"},
  {Related::scene, "find_*", has_no_effect_without, "find_option", "find_option names no option to search"},
  {Related::scene, "fit_*", has_no_effect_without, "fit_vary_*", "fit_vary names no option to estimate"},

  {Related::study, "sweep_hslm_a", excludes, "load_forces load_hslm_a load_hslm_b load_en15528 load_file", ""},
  {Related::study, "study_combine=together study_combine=random", excludes, "study_sensitivity=local study_sensitivity=morris study_sensitivity=sobol", "a sensitivity analysis (study_sensitivity) needs grid"},
  {Related::study, "study_combine=together study_combine=random", excludes, "find_option", "a search (find_option) needs grid"},
  {Related::study, "find_option", needs, "find_between", "find_between is missing: the least and the greatest value"},
  {Related::study, "find_quantity", needs, "find_equals", ""},
  {Related::study, "find_equals", needs, "find_quantity", ""},
  {Related::study, "find_keep", excludes, "find_quantity", ""},

  {Related::course, "speed_file", excludes, "speed", ""},
  {Related::course, "position_file", excludes, "speed speed_file", ""},
  {Related::course, "times", excludes, "positions speed_file position_file", ""},
  {Related::course, "speed_over", needs, "speed_file", "needs a table of speeds: ~speed_file"},

  {Related::load, "hslm_a hslm_b en15528 file", excludes, "forces hslm_a hslm_b en15528 file", ""},
  {Related::load, "moments", excludes, "spread", ""},
  {Related::load, "amplitude unbalance phase", needs, "frequency", ""},
  {Related::load, "frequency", needs, "amplitude unbalance", ""},
  {Related::load, "wagons", has_no_effect_without, "en15528", "it is for ~en15528"},
  {Related::load, "file_x formation", has_no_effect_without, "file", "it is for ~file"},

  {Related::part, "table", excludes, "stiffness force moment value rate", ""},
  {Related::part, "damper_table", excludes, "damping", ""},
  {Related::part, "preload", excludes, "free_length", ""},
  {Related::part, "preload", excludes, "winding_table", "with a winding_table give ~free_length"},
  {Related::part, "EA", excludes, "stiffness", ""},
  {Related::part, "drum", needs, "drum_radius", ""},
  {Related::part, "drum_radius", needs, "drum", ""},
  {Related::part, "length", needs, "lifts", ""},
  {Related::part, "lifts", needs, "length", ""},
  {Related::part, "bodies", excludes, "body reaction_body", ""},
  {Related::part, "delay", needs, "table", ""},
  {Related::part, "young poisson rail_young rail_poisson other_young other_poisson", excludes, "stiffness", ""},
  {Related::part, "line", excludes, "type=arc_arc", "is only for type arc_line"},
  {Related::part, "restitution", excludes, "damping", ""},
  {Related::part, "restitution_law", needs, "restitution", ""},
  {Related::part, "flat_angle", needs, "flat_length", ""},
  {Related::part, "polygon_order", needs, "polygon_amplitude", ""},
  {Related::part, "polygon_amplitude polygon_phase", needs, "polygon_order", ""},

  {Related::springs, "k c gap cubic side one_sided depth eccentricity limit spacing", needs, "x", "needs ~x, the stations"},
  {Related::springs, "x", needs, "k c cubic", ""},
  {Related::bed, "gap one_sided", needs, "k c cubic", "needs ~k, the stiffness of the bed"},

  {Related::damper, "mass", needs, "frequency k", ""},
  {Related::damper, "frequency", excludes, "k", ""},
  {Related::damper, "damping_ratio", excludes, "c", ""},

  {Related::measurement, "series", excludes, "frequency", ""},
  {Related::measurement, "frequency", needs_all, "value sd", ""},
  {Related::measurement, "column quantity x dataset component factor from to align offset gain lowpass", excludes, "frequency", "is not allowed with ~frequency"},
  {Related::measurement, "shape", needs, "frequency", "belongs to a mode: ~frequency"},
  {Related::measurement, "shape_sd", needs, "shape", ""},
  {Related::measurement, "value", excludes, "series", "is not allowed with ~series"},
  {Related::measurement, "quantity x", excludes, "dataset", "is not allowed with ~dataset"},
  {Related::measurement, "component", excludes, "quantity", "is not allowed with ~quantity"},
  {Related::measurement, "series", needs, "quantity dataset", ""},
  {Related::measurement, "series", needs, "x dataset", ""},
};
// clang-format on

/// The words of a list with the begin of the block's names before each.
std::vector<std::string> names_of(std::string_view list, const std::string& block) {
  std::vector<std::string> names;
  std::istringstream words{std::string(list)};
  for (std::string word; words >> word;) names.push_back(block + word);
  return names;
}

/// The name of the given option that NAME, NAME* or NAME=VALUE stands for; empty if there is none.
std::string given(const Options& o, const std::string& term) {
  if (term.ends_with('*')) {
    const Entry* entry = o.first_with_prefix(std::string_view(term).substr(0, term.size() - 1));
    return entry != nullptr ? entry->name : "";
  }
  const std::size_t equal = term.find('=');
  const std::string name = term.substr(0, equal);
  const bool fits = equal == std::string::npos ? o.has(name) : o.text(name) == term.substr(equal + 1);
  return fits ? name : "";
}

std::string text_of(const Relation& relation, const std::string& block, const std::string& other) {
  std::string text(relation.text);
  for (std::size_t at = 0; (at = text.find('~')) != std::string::npos;) text.replace(at, 1, block);
  if (!text.empty()) return text;
  if (relation.verb == excludes) return "give either this or " + other;
  if (relation.verb == needs_all) return "needs " + other;
  const std::vector<std::string> names = names_of(relation.others, block);
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "needs " : i + 1 < names.size() ? ", " : " or ") + names[i];
  return text;
}

/// Options beside one that names a table: without it they are refused, without a table they have no effect.
void check_beside_tables(const Options& o, std::vector<std::string>& notes) {
  for (const Entry& entry : o.entries()) {
    const auto beside = beside_table(entry.name);
    if (!beside || o.find_known(entry.name) != beside->second) continue;
    if (!o.has(beside->first)) o.refuse(entry.name, fmt::format("needs {}, the table that it is for", beside->first));
    if (!o.is_table(beside->first))
      notes.push_back(fmt::format("{} has no effect: {} names no table", entry.name, beside->first));
  }
}

}  // namespace

std::vector<std::string> check_relations(const Options& o, Related related, const std::string& block) {
  std::vector<std::string> notes;
  if (related == Related::scene) check_beside_tables(o, notes);
  for (const Relation& relation : relations) {
    if (relation.related != related) continue;
    const std::vector<std::string> others = names_of(relation.others, block);
    for (const std::string& option : names_of(relation.options, block)) {
      const std::string name = given(o, option);
      if (name.empty()) continue;
      const auto is_given = [&](const std::string& other) {
        return (relation.verb != excludes || other != name) && !given(o, other).empty();
      };
      const auto found = relation.verb == needs_all ? std::find_if_not(others.begin(), others.end(), is_given)
                                                    : std::find_if(others.begin(), others.end(), is_given);
      const bool kept = (found == others.end()) == (relation.verb == needs_all || relation.verb == excludes);
      if (kept) continue;
      const std::string text = text_of(relation, block, found == others.end() ? "" : *found);
      if (relation.verb != has_no_effect_without) o.refuse(name, text);
      notes.push_back(name + " has no effect: " + text);
    }
  }
  return notes;
}

}  // namespace traverse::options
