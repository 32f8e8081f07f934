// A table of paths. A * in a path is any text without a slash; in a dimension it is the text of the path's last one.
#include "results/dataset_words.hpp"

#include <algorithm>
#include <array>

namespace traverse::results {
namespace {

struct Row {
  std::string_view path, dimensions, long_name;  // the first row that fits is used; no name: the last word of the path
};

constexpr Row dataset_rows[] = {
    {"time", "time", "time"},
    {"probes/x", "probes/x", "station of the probe"},
    {"probes/deflection", "time probes/x", "deflection of the beam, upward positive"},
    {"probes/relative_deflection", "time probes/x", "deflection of the beam relative to its supports, upward positive"},
    {"probes/velocity", "time probes/x", "vertical velocity of the beam"},
    {"probes/acceleration", "time probes/x", "vertical acceleration of the beam"},
    {"probes/acceleration_lowpass", "time probes/x", "low-passed vertical acceleration of the beam"},
    {"probes/moment", "time probes/x", "bending moment, positive in sagging"},
    {"probes/shear", "time probes/x", "shear force"},
    {"probes/twist", "time probes/x", "twist, positive if the left side goes up"},
    {"probes/eccentricity", "probes/x", "distance of the probe's track to the left of the beam's axis"},
    {"probes/track_twist", "time probes/x",
     "twist of a track of 1.435 m over 3 m, by its rate along the bridge at the probe"},
    {"supports/torque", "time supports/x", "torque of the support on the beam, positive as the twist"},
    {"supports/left_bearing", "time supports/x", "upward force of the left bearing on the beam"},
    {"supports/right_bearing", "time supports/x", "upward force of the right bearing on the beam"},
    {"probes/torsional_moment", "time probes/x", "torsional moment, positive as the twist on the section's right side"},
    {"probes/axial_force", "time probes/x", "axial force, positive in tension"},
    {"probes/*", "time probes/x", ""},
    {"rail/devices/x", "rail/devices/x", "station of the expansion device of the rail"},
    {"rail/devices/opening", "time rail/devices/x", "opening of the expansion device"},
    {"rail/stations/x", "rail/stations/x", "station of the rail"},
    {"rail/stations/*", "time rail/stations/x", "* of the rail"},
    {"rail/*", "time probes/x", "* of the rail"},
    {"vehicles/*/*/position", "time coordinate", "position of the body"},
    {"vehicles/*/*/velocity", "time coordinate", "velocity of the body"},
    {"vehicles/*/*/acceleration", "time coordinate", "acceleration of the body"},
    {"vehicles/*/*/contact_position", "time direction", "running surface under the wheel"},
    {"vehicles/*/*/contact_velocity", "time direction", "velocity of the running surface along the path of the wheel"},
    {"vehicles/*/*/contact_acceleration", "time direction",
     "acceleration of the running surface along the path of the wheel"},
    {"vehicles/*/*/reaction", "time component", "reaction of the joint on its second body"},
    {"vehicles/*/*/*", "time", ""},
    {"couplers/*/gap", "couplers/*/gap", "number of the vehicle in front of the coupler"},
    {"couplers/*/*", "time couplers/*/gap", "* of the coupler"},
    {"supports/x", "supports/x", "station of the support"},
    {"supports/reaction", "time supports/x component", "reaction of the support on the beam"},
    {"supports/*", "time supports/x", "* of the support"},
    {"foundation/*_bed/*", "time span", "* of the bed on a span"},
    {"foundation/*/x", "foundation/*/x", "station of the foundation point"},
    {"foundation/*/force", "time foundation/*/x", "force of the foundation point on the beam"},
    {"foundation/*/moment", "time foundation/*/x", "moment of the foundation point on the beam"},
    {"outputs/*", "time", ""},
    {"track/profile/x", "track/profile/x", "station of the running surface"},
    {"track/profile/height", "track/profile/x", "height of the running surface before any deflection"},
    {"track/profile/*/x", "track/profile/*/x", "station of the running surface of a train"},
    {"track/profile/*/height", "track/profile/*/x", "height of the running surface of a train before any deflection"},
    {"track/hanging/x", "track/hanging/x", "station of the hanging sleeper"},
    {"track/hanging/*", "time track/hanging/x", "* of the hanging sleeper"},
    {"track/sleepers/x", "track/sleepers/x", "station of the sleeper"},
    {"track/sleepers/*", "time track/sleepers/x", "* of the sleeper"},
    {"balance/*", "time direction", "resultant of all forces on the structure: *"},
    {"energy/residual", "time", "imbalance of the energies"},
    {"energy/*", "time", "energy: *"},
    {"envelope/static_deflection", "probes/x", "greatest static deflection"},
    {"envelope/*", "probes/x extreme", "envelope of the *"},
    {"trains/name", "train column", "name of the train, and number of its first vehicle"},
    {"trains/on_bridge", "train bound", "from the first wheel on the bridge to the last"},
    {"trains/*", "train", ""},
    {"spans/x", "span bound", "ends of the span"},
    {"spans/*_train", "span", "train nearest to the largest *"},
    {"spans/*", "span", "largest *"},
    {"shape/x", "shape/x", "station"},
    {"shape/deflection", "shape/x", "deflection at the instant of its greatest magnitude"},
    {"separations/*", "separation column", ""},
    {"exit/position", "exit_body coordinate", "position of the body as it leaves the beam"},
    {"exit/velocity", "exit_body coordinate", "velocity of the body as it leaves the beam"},
    {"exit/*", "exit_body column", ""},
    {"passages/*", "passage column", ""},
    {"modes/x", "modes/x", "station"},
    {"modes/shape", "mode modes/x", "shape of the mode, greatest magnitude 1"},
    {"modes/slope", "mode modes/x", "slope of the shape of the mode"},
    {"modes/damped_shape", "damped_mode modes/x part", "complex shape of the damped mode"},
    {"modes/damp*", "damped_mode", ""},
    {"modes/decay_rate", "damped_mode", ""},
    {"modes/*", "mode", ""},
    {"sweep/speed", "sweep/speed", "speed of the train"},
    {"sweep/hslm_a", "sweep/hslm_a", "number of the train of HSLM-A"},
    {"sweep/added", "sweep/speed", "whether the sweep added the speed"},
    {"sweep/static_deflection", "sweep/hslm_a probes/x", "greatest static deflection"},
    {"sweep/judged", "sweep/hslm_a sweep/speed criterion", "value of the quantity with a limit"},
    {"sweep/judged_x", "sweep/hslm_a sweep/speed criterion", "station of the quantity with a limit"},
    {"sweep/*", "sweep/hslm_a sweep/speed probes/x", ""},
    {"resonances/*", "resonance column", ""},
    {"cancellations/*", "cancellation column", ""},
    {"study/statistics/quantiles", "study/statistics/quantiles", "level of the quantile"},
    {"study/statistics/peak_*_quantile*", "study_group probe study/statistics/quantiles", ""},
    {"study/statistics/amplification_quantile*", "study_group probe study/statistics/quantiles", ""},
    {"study/statistics/judged_quantile*", "study_group criterion study/statistics/quantiles", ""},
    {"study/statistics/judged_x_quantile*", "study_group criterion study/statistics/quantiles", ""},
    {"study/statistics/*_quantile*", "study_group study/statistics/quantiles", ""},
    {"study/statistics/peak_*", "study_group probe", ""},
    {"study/statistics/amplification_*", "study_group probe", ""},
    {"study/statistics/judged_*", "study_group criterion", ""},
    {"study/statistics/*", "study_group", ""},
    {"study/shape", "study_axis", "length of the axis"},
    {"study/judged", "run criterion", "value of the quantity with a limit"},
    {"study/judged_x", "run criterion", "station of the quantity with a limit"},
    {"study/*", "run probe", ""},
    {"find/value", "find/value", "searched value of the option"},
    {"find/ratio", "answer find/value", "greatest ratio of a run to its bound"},
    {"find/run", "answer find/value", "run with the greatest ratio"},
    {"find/limit", "answer find/value", "limit with the greatest ratio"},
    {"find/interval", "interval end", "values of the option within the bound"},
    {"find/interval_answer", "interval", "answer to which the interval belongs"},
    {"find/interval_at_end", "interval end", "whether the end is one of the searched range"},
    {"sensitivity/units", "quantity column", "quantity and unit"},
    {"sensitivity/*", "quantity factor", ""},
    {"fit/correlation", "unknown other_unknown", "correlation of two estimates"},
    {"fit/standard_error", "unknown", "standard error of the estimate"},
    {"fit/frequencies/measured", "measured_frequency", "measured natural frequency"},
    {"fit/frequencies/computed", "measured_frequency", "natural frequency computed with the estimates"},
    {"fit/frequencies/sd", "measured_frequency", "standard deviation of the measured frequency"},
    {"fit/frequencies/mac", "measured_frequency", "modal assurance criterion of the measured and the computed shape"},
    {"fit/shapes/*/x", "fit/shapes/*/x", "place of a measured deflection of the mode"},
    {"fit/shapes/*/measured", "fit/shapes/*/x", "measured shape"},
    {"fit/shapes/*/computed", "fit/shapes/*/x", "computed shape, in the scale that is closest to the measured one"},
    {"fit/series/*/time", "fit/series/*/time", "time by the clock of the measurement"},
    {"fit/series/*/measured", "fit/series/*/time", "measured value"},
    {"fit/series/*/computed", "fit/series/*/time", "value computed with the estimates"},
    {"fit/series_sd", "measured_series", "standard deviation of a measured value"},
    {"fit/starts/misfit", "fit_start", "misfit at the end of the minimisation"},
    {"fit/starts/estimate", "fit_start unknown", "values at the end of the minimisation"},
    {"fit/*", "unknown", ""},
    {"quantities/peaks", "quantity_of_peaks column", "quantity and unit"},
    {"quantities/limits", "quantity_of_limits column", "quantity and unit"},
    {"verdicts/*", "criterion column", ""},
    {"screen/speed", "screen/speed", "speed"},
    {"screen/bridge_*", "bridge", "bridge: *"},
    {"screen/formation_*", "formation", "formation: *"},
    {"screen/row_digest", "bridge", "digest of a finished row"},
    {"screen/governing_formation", "bridge", "number of the governing formation of the bridge, from 0"},
    {"screen/governing_bridge", "formation", "number of the governing bridge of the formation, from 0"},
    {"screen/ratio", "bridge formation", "largest response over its limit"},
    {"screen/bound", "bridge formation", "largest bound of a response over its limit"},
    {"screen/permitted_speed", "bridge formation", "greatest speed up to which all limits are kept"},
    {"screen/governing_speed", "bridge formation", "speed of the largest response over its limit"},
    {"screen/exceeding_speeds", "bridge formation", "number of speeds at which a limit is exceeded"},
    {"screen/decided_by", "bridge formation", "how the pair was decided"},
    {"rail_forces/x", "rail_forces/x", "middle of the rail element"},
    {"rail_forces/sleeper_x", "rail_forces/sleeper_x", "station of the sleeper"},
    {"rail_forces/bearing_x", "rail_forces/bearing_x", "station of the longitudinal support"},
    {"rail_forces/front", "rail_forces/front", "position of the front of the train"},
    {"rail_forces/device_x", "rail_forces/device_x", "station of the expansion device"},
    {"rail_forces/*/*_stress", "rail_forces/x", "additional stress of the rail: *"},
    {"rail_forces/*/least_slip", "rail_forces/sleeper_x", "least displacement of the rail relative to the deck"},
    {"rail_forces/*/greatest_slip", "rail_forces/sleeper_x", "greatest displacement of the rail relative to the deck"},
    {"rail_forces/*/bearing", "rail_forces/bearing_x", "force of the longitudinal support on the bridge"},
    {"rail_forces/*/opening", "rail_forces/device_x", "opening of the expansion device"},
    {"rail_forces/*/*", "of_the_greatest", "greatest value, its station, and the position of the front of the train"},
    {"static/alpha", "static_load", "classification factor of the load"},
    {"static/load", "static_load column", "train or load model, and its clause"},
    {"static/x", "static/x", "station of the section"},
    {"static/reaction_x", "static/reaction_x", "station of the support"},
    {"static/end_rotation_x", "static/end_rotation_x", "end of the deck"},
    {"static/joint_rotation_x", "static/joint_rotation_x", "station of the joint"},
    {"static/reaction", "static_load static/reaction_x extreme", "static reaction, upward positive"},
    {"static/end_rotation", "static_load static/end_rotation_x extreme", "static rotation of the end of the deck"},
    {"static/joint_rotation", "static_load static/joint_rotation_x extreme", "static rotation between two decks"},
    {"static/*", "static_load static/x extreme", "static *"},
    {"norm/determinant_length", "span", "determinant length of EN 1991-2 6.4.5.3"},
    {"norm/phi", "span", "dynamic factor Phi of EN 1991-2 6.4.5.2"},
    {"norm/*", "norm_effect column", ""},
    {"options", "option column", "name and value of the option"},
    {"input/files", "input_file column", "path and text of the file"},
    {"input/*", "input_option column", "name of the option as given"},
};

/// Whether the text fits the pattern; `star` becomes what its last * stands for.
bool fits(std::string_view pattern, std::string_view text, std::string& star) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() != '*')
    return !text.empty() && pattern.front() == text.front() && fits(pattern.substr(1), text.substr(1), star);
  for (std::size_t length = 0; length <= text.size(); ++length) {
    if (length > 0 && text[length - 1] == '/') return false;
    if (!fits(pattern.substr(1), text.substr(length), star)) continue;
    if (pattern.find('*', 1) == pattern.npos) star = text.substr(0, length);
    return true;
  }
  return false;
}

std::string filled(std::string_view text, const std::string& star) {
  std::string filled(text);
  if (const std::size_t at = filled.find('*'); at != filled.npos) filled.replace(at, 1, star);
  return filled;
}

std::string with_blanks(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string flat(std::string_view path) {
  std::string name(path);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace

DatasetWords words_of(std::string_view path, std::size_t rank) {
  path.remove_prefix(path.starts_with('/') ? 1 : 0);
  const std::string_view end = "end/";
  const bool at_end = path.starts_with(end);  // the state between the last sample and the end of the run
  if (at_end) path.remove_prefix(end.size());
  DatasetWords words;
  std::string star;
  const auto row = std::find_if(std::begin(dataset_rows), std::end(dataset_rows),
                                [&](const Row& r) { return fits(r.path, path, star); });
  std::string_view list = row == std::end(dataset_rows) ? "" : row->dimensions;
  while (!list.empty() && words.dimensions.size() < rank) {
    const std::string name = filled(list.substr(0, list.find(' ')), star);
    words.dimensions.push_back((at_end && name == "time" ? "/end/" : "/") + name);
    list.remove_prefix(std::min(list.size(), list.substr(0, list.find(' ')).size() + 1));
  }
  if (words.dimensions.size() < rank) words.dimensions.clear();
  const bool named = row != std::end(dataset_rows) && !row->long_name.empty();
  words.long_name =
      with_blanks(named ? filled(row->long_name, star) : std::string(path.substr(path.find_last_of('/') + 1)));
  return words;
}

std::string name_of_dimension(std::string_view path) {
  path.remove_prefix(1);
  for (const std::string_view group : {"probes/", "sweep/", "study/", "fit/", "screen/"})
    if (path.starts_with(group)) path.remove_prefix(group.size());
  return flat(path);
}

std::vector<std::string> words_along(std::string_view dimension) {
  if (dimension == "/coordinate") return {"x", "y", "angle"};
  if (dimension == "/component") return {"fx", "fy", "moment"};
  if (dimension == "/direction") return {"x", "y"};
  if (dimension == "/extreme") return {"least", "greatest"};
  if (dimension == "/part") return {"real", "imaginary"};
  return {};
}

}  // namespace traverse::results
