// Reads the options of a study: the varied options, their values and combination, statistics and refinement.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "results/study_table.hpp"
#include "results/terminal.hpp"
#include "scene_parts.hpp"
#include "vary_reader.hpp"

namespace traverse::scene {
namespace {

using options::Kind;
using options::Options;
using options::Row;

constexpr std::string_view study_prefix = VaryReader::prefix;
constexpr double most_study_peaks = 1e8;
constexpr double quickest_run = 5e-3;  // s: computing time of a train over a bridge in a SIMD batch

/// The option that an option study_vary_... varies.
struct Varied {
  std::string option;    // the varied option
  std::string_view how;  // "from", "normal", ...; empty: a list
};

std::optional<Varied> varied(const Options& o, const std::string& name) {
  if (!name.starts_with(study_prefix)) return {};
  const std::string rest = name.substr(study_prefix.size());
  if (o.find_known(rest) != nullptr) return Varied{rest, ""};
  for (const Row& row : options::vary_rows())
    if (const std::size_t own = row.name.size() + 1; rest.size() > own && rest.ends_with("_" + std::string(row.name)) &&
                                                     o.find_known(rest.substr(0, rest.size() - own)) != nullptr)
      return Varied{rest.substr(0, rest.size() - own), row.name};
  return {};
}

/// Declares the options study_vary_....
void declare_study(Options& o) {
  for (const options::Entry& entry : o.entries()) {
    const std::string& name = entry.name;
    if (!name.starts_with(study_prefix)) continue;
    const std::optional<Varied> what = varied(o, name);
    if (!what) {
      std::string option = name.substr(study_prefix.size());
      for (const Row& row : options::vary_rows())
        if (const std::size_t own = row.name.size() + 1; option.ends_with("_" + std::string(row.name))) {
          option.resize(option.size() - own);
          break;
        }
      o.check_known(name, option);  // varied() knows it otherwise
    }
    const std::span<const Row> rows = options::vary_rows();
    o.declare(name, what->how.empty() ? options::vary_list_row() : *options::find_row(rows, what->how));
  }
}

/// The options that study_vary_... names, in the given order.
std::vector<std::string> varied_options(const Options& o) {
  std::vector<std::string> names;
  for (const options::Entry& entry : o.entries()) {
    const std::optional<Varied> what = varied(o, entry.name);
    if (what && std::find(names.begin(), names.end(), what->option) == names.end()) names.push_back(what->option);
  }
  return names;
}

/// The dimensions of sweep_speed and sweep_hslm_a, which a study also varies.
std::vector<StudyDimension> swept_dimensions(const Options& o, const NamedVehicles& vehicles) {
  std::vector<StudyDimension> dimensions;
  for (const char* sweep : {"sweep_hslm_a", "sweep_speed"})
    for (const char* list : {"trains", "loads"})
      if (o.has(sweep) && o.has(list))
        o.refuse(sweep, fmt::format("is for one train or load; with {} use a study that varies NAME_speed", list));
  if (o.has("sweep_hslm_a")) {
    StudyDimension trains{{"load_hslm_a"}, "1", true, "list", {}, 0};
    for (const int train : o.integers("sweep_hslm_a")) trains.values.push_back(train);
    dimensions.push_back(std::move(trains));
  }
  if (o.has("sweep_speed")) {
    const bool forces = forces_move(o);
    StudyDimension speeds{{}, "m/s", false, "list", read_speeds(o, "sweep_speed"), 0};
    const bool train_stands = stands(o, {"train", {}}), load_stands = stands(o, {"load", {}});
    if (!vehicles.train.empty() && !train_stands) speeds.options.emplace_back("train_speed");
    if ((forces && !load_stands) || vehicles.train.empty()) speeds.options.emplace_back("load_speed");
    if (speeds.options.empty() || (vehicles.train.empty() && load_stands))
      o.refuse("sweep_speed", "nothing moves, because the speed that is given for it is 0");
    dimensions.push_back(std::move(speeds));
  }
  return dimensions;
}

/// The dimension of a varied option and of the options with the same values, without the values. taken: the varied
/// options.
StudyDimension dimension_of(const Options& o, const std::string& option, const VaryReader& reader,
                            std::vector<std::string>& taken) {
  const std::string given = o.first_with_prefix(reader.name())->name;
  const std::string unit(reader.unit().empty() ? "1" : reader.unit());
  StudyDimension dimension{{option}, unit, reader.whole(), "list", {}, 0};
  reader.add_others(reader.name("also"), dimension);
  for (const std::string& one : dimension.options) {
    if (const std::string why = why_not_varied(o, one); !why.empty())
      o.refuse(given, fmt::format("{} cannot be varied: {}", one, why));
    if (std::find(taken.begin(), taken.end(), one) != taken.end())
      o.refuse(given, fmt::format("{} is varied twice", one));
    taken.push_back(one);
  }
  return dimension;
}

void read_dimensions(const Options& o, const NamedVehicles& vehicles, Study& study) {
  StudyAxes axes(o, study);
  std::vector<std::string> taken;
  if (describes_search(o)) {
    StudyDimension searched = searched_dimension(o);
    taken = searched.options;
    axes.add_listed(std::move(searched), 2.0);
  }
  for (StudyDimension& dimension : swept_dimensions(o, vehicles)) {
    for (const std::string& option : dimension.options)
      if (std::find(taken.begin(), taken.end(), option) != taken.end())
        o.refuse("find_option", option + " is also varied by the sweep; remove one of them");
    taken.insert(taken.end(), dimension.options.begin(), dimension.options.end());
    const double count = static_cast<double>(dimension.values.size());
    axes.add_listed(std::move(dimension), count);
  }
  for (const std::string& option : varied_options(o)) {
    const VaryReader reader(o, option);
    StudyDimension dimension = dimension_of(o, option, reader, taken);
    reader.check_one_way();
    if (const std::string law = reader.law(); !law.empty()) {
      dimension.law = law;
      axes.add_drawn(std::move(dimension), reader);
    } else {
      double count = 0.0;
      dimension.values = reader.has() ? reader.list(count) : reader.block(count);
      const std::string given = o.first_with_prefix(reader.name())->name;
      for (const double value : dimension.values) reader.check(given, value);
      axes.add_listed(std::move(dimension), count);
    }
  }
  axes.finish_design();
  if (axes.runs() > axes.most_runs())
    throw InputError(fmt::format("study_vary: {:.4g} runs ({}); allowed: at most {:g}. They would take {} even at {}",
                                 axes.runs(), axes.sizes(), axes.most_runs(),
                                 results::duration_text(quickest_run * axes.runs()),
                                 results::duration_text(quickest_run) + " each"));
}

void read_statistics(const Options& o, Study& study) {
  study.quantiles = o.numbers("study_statistics_quantiles");
  study.confidence = o.number("study_statistics_confidence");
  if (study.sensitivity) return;  // the points of a design are no sample
  const auto add = [&](std::size_t axis) {
    if (std::find(study.over.begin(), study.over.end(), axis) == study.over.end()) study.over.push_back(axis);
  };
  if (o.has("study_statistics_over")) {
    for (const std::string& word : o.texts("study_statistics_over")) {
      const auto named = [&](const StudyDimension& d) {
        return std::find(d.options.begin(), d.options.end(), word) != d.options.end();
      };
      const auto found = std::find_if(study.dimensions.begin(), study.dimensions.end(), named);
      if (found == study.dimensions.end())
        o.refuse("study_statistics_over", fmt::format("'{}' is not varied; allowed: options of study_vary", word));
      add(found->axis);
    }
  } else {
    for (const StudyDimension& d : study.dimensions)
      if (d.law != "list" || d.name() == "track_seed") add(d.axis);
  }
  if (study.over.empty() && o.has("study_statistics_quantiles"))
    o.refuse("study_statistics_quantiles",
             "no option is drawn; name the options of the statistics with study_statistics_over");
  std::sort(study.over.begin(), study.over.end());
}

bool is_speed(const StudyDimension& d) { return d.name() == "train_speed" || d.name() == "load_speed"; }

void read_refinement(const Options& o, Study& study) {
  const char* option = o.has("study_refine") ? "study_refine" : "sweep_refine";
  if (!o.has(option)) return;
  study.refine = o.number(option);
  if (study.refine == 0.0) return;
  const auto speeds = std::find_if(study.dimensions.begin(), study.dimensions.end(), is_speed);
  if (speeds == study.dimensions.end() || speeds->law != "list")
    o.refuse(option, "no list of speeds is varied; allowed with train_speed, load_speed or sweep_speed");
  if (std::count_if(study.dimensions.begin(), study.dimensions.end(),
                    [&](const StudyDimension& d) { return d.axis == speeds->axis; }) > 1)
    o.refuse(option, fmt::format("{} varies together with other options; allowed: study_combine grid", speeds->name()));
  if (std::set<double>(speeds->values.begin(), speeds->values.end()).size() != speeds->values.size() ||
      speeds->values.size() < fewest_to_refine)
    o.refuse(option, fmt::format("{} has {} values; allowed: at least {}, each once, between which others are added",
                                 speeds->name(), speeds->values.size(), fewest_to_refine));
  study.speeds = static_cast<std::size_t>(speeds - study.dimensions.begin());
  if (std::find(study.over.begin(), study.over.end(), speeds->axis) != study.over.end())
    o.refuse(option, "not allowed with statistics over the speed (study_statistics_over)");
}

}  // namespace

double least_damping(const Scene& scene) {
  if (scene.damping.ratios) return std::min(scene.damping.ratios->first, scene.damping.ratios->second);
  const std::vector<double>& ratios = scene.by_given_modes() ? scene.beam->given->ratio : scene.damping_of_modes;
  return ratios.empty() ? 0.0 : *std::min_element(ratios.begin(), ratios.end());
}

namespace {

/// Adds a note if limits are checked at speeds with larger steps than the half-power width of a resonance, 2 zeta v.
void record_coarse_speeds(Scene& scene) {
  const Study& study = *scene.study;
  const auto speeds = std::find_if(study.dimensions.begin(), study.dimensions.end(), is_speed);
  if (speeds == study.dimensions.end() || speeds->law != "list" || study.refine > 0.0 || !scene.has_run_limits())
    return;
  if (study.find && speeds == study.dimensions.begin() + static_cast<std::ptrdiff_t>(study.find->dimension)) return;
  std::vector<double> v = speeds->values;
  std::sort(v.begin(), v.end());
  const double width = 2.0 * least_damping(scene);
  for (std::size_t i = v.size(); i-- > 1;) {
    if (!(width > 0.0) || v[i] - v[i - 1] <= width * v[i - 1]) continue;
    scene.unusual.push_back(fmt::format(
        "{}: the step from {:g} to {:g} km/h is larger than the half-power width of a resonance there, 2 zeta v = "
        "{:.3g} km/h, so a limit may be exceeded between these speeds; use steps of {:.2g} km/h{}",
        speeds->name(), 3.6 * v[i - 1], 3.6 * v[i], 3.6 * width * v[i - 1], 3.6 * 0.25 * width * v[i - 1],
        study.find ? "" : ", or study_refine 1e-2"));
    scene.notes.push_back(scene.unusual.back());
    return;
  }
}

void check_study(const Options& o, Scene& scene) {
  const Study& study = *scene.study;
  const options::Entry* const varied_first = o.first_with_prefix(study_prefix);
  const std::string first = varied_first != nullptr ? varied_first->name : "find_option";
  if (scene.analysis != Analysis::transient) o.refuse(first, "a study needs scene_analysis transient");
  if (!scene.beam) o.refuse(first, "a study needs a bridge (beam_spans)");
  for (const StudyDimension& d : study.dimensions)
    if (d.name() == "track_seed" && !scene.roughness)
      o.refuse(first, fmt::format("track_seed has no effect: track_profile is {}", o.text("track_profile")));
  record_coarse_speeds(scene);
  const double runs = static_cast<double>(results::rows_of(study).runs());
  o.check_at_most(first, runs * static_cast<double>(scene.output.probes.size()), most_study_peaks, "runs times probes");
}

}  // namespace

std::string why_not_varied(const Options& o, const std::string& option) {
  const Row& row = *o.find_known(option);
  for (const char* own :
       {"study_", "find_", "fit_", "tao_", "sweep_", "output_", "scene_", "options_", "accuracy", "modes_"})
    if (option.starts_with(own)) return "it applies to all runs, not to a single one";
  const bool of_petsc = options::owned_by_petsc(option);
  if (of_petsc && option != "ts_dt" && option != "ts_max_time") return "PETSc reads it once, for all runs";
  if (of_petsc && o.entries().has(option)) return "it is given for all runs too; remove that option";
  const bool number = (row.kind == Kind::number && row.choices.empty()) ||
                      (row.kind == Kind::integer && row.choices.empty()) || row.kind == Kind::number_or_file ||
                      ((row.kind == Kind::numbers || row.kind == Kind::integers) && row.count <= 1);
  if (number) return "";
  return row.count > 1 ? fmt::format("it needs {}, not one number", options::allowed(row)) : "it is not a number";
}

std::vector<std::string> not_varied(Options given, const std::vector<std::string>& names) {
  declare_parts(given);
  std::vector<std::string> found;
  for (const std::string& name : names)
    if (!given.knows(name) || !why_not_varied(given, name).empty()) found.push_back(name);
  return found;
}

bool describes_study(const Options& o) { return o.first_with_prefix(study_prefix) != nullptr || describes_search(o); }

Scene read_study(const Options& given) {
  Options o = given;
  const NamedVehicles vehicles = declare_parts(o);
  declare_study(o);
  check_options(o);
  Study study;
  read_dimensions(o, vehicles, study);
  read_statistics(o, study);
  read_refinement(o, study);
  read_search(o, study);
  if (study.sensitivity && o.flag("study_resume"))
    o.refuse("study_resume", "not with study_sensitivity, whose file has no single runs");
  study.resume = o.flag("study_resume");
  std::vector<std::pair<std::string, std::string>> values = values_of_run(study, 0);
  Scene scene = read_scene_of_study(given, values);
  scene.study = std::move(study);
  finish_search(o, scene);
  if (o.has("output_lowpass_series"))
    scene.notes.emplace_back("output_lowpass_series has no effect: studies store no series");
  if (scene.norm) {
    scene.norm.reset();
    scene.notes.emplace_back(
        "studies have no static effects and no verdict of EN 1991-2; sweeps and single runs have them");
  }
  scene.options = o.all();
  check_study(o, scene);
  return scene;
}

std::vector<std::pair<std::string, std::string>> values_of_run(const Study& study, std::size_t run) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const StudyDimension& d : study.dimensions)
    for (const std::string& option : d.options) values.emplace_back(option, fmt::format("{}", study.value(run, d)));
  return values;
}

Scene read_scene_of_study(const options::Options& given,
                          const std::vector<std::pair<std::string, std::string>>& values) {
  options::Entries entries;
  for (const options::Entry& entry : given.entries())
    if (!entry.name.starts_with("study_") && !entry.name.starts_with("find_") && entry.name != "sweep_speed" &&
        entry.name != "sweep_refine" && entry.name != "sweep_hslm_a")
      entries.set(entry);
  for (const auto& [name, value] : values) entries.set({name, value, "a value of the study", 0});
  Options o(std::move(entries));
  Scene scene = read_scene(o);
  drop_peaks_without_estimate(scene);
  scene.sweep.emplace();
  scene.sweep->lanes = static_cast<std::size_t>(std::stoul(o.choice("sweep_lanes")));
  scene.sweep->instants = o.number("sweep_instants");
  return scene;
}

}  // namespace traverse::scene
