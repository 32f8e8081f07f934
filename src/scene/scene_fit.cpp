// Reads the options of a fit: the estimated options with their bounds, and the measurements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "options/relations.hpp"
#include "scene_parts.hpp"
#include "traverse/options/fit.hpp"
#include "vary_reader.hpp"

namespace traverse::scene {
namespace {

using options::Entry;
using options::Fit;
using options::FitParameter;
using options::Kind;
using options::Options;
using options::Row;

constexpr std::string_view fit_vary = "fit_vary_", fit_to = "fit_to_";
constexpr double default_shape_sd = 0.05;  // of the largest value of a shape
constexpr std::size_t most_parameters = 50, most_targets = 200, most_columns = 1000, fewest_values = 3;
constexpr double most_values = 1e6;     // of a series
constexpr double even_interval = 1e-3;  // largest relative difference of intervals of a filtered series

/// The option whose two numbers a fit sets to the same value.
constexpr std::string_view alike = "beam_damping_ratios";

/// A given option fit_to_NAME_row.
struct Target {
  std::string name;  // NAME
  const Row* row = nullptr;
};

std::optional<Target> target_of(const std::string& option) {
  if (!option.starts_with(fit_to)) return {};
  const std::string rest = option.substr(fit_to.size());
  for (const Row& row : options::fit_rows())
    if (const std::string end = "_" + std::string(row.name); rest.size() > end.size() && rest.ends_with(end))
      return Target{rest.substr(0, rest.size() - end.size()), &row};
  return {};
}

std::string name_of(const std::string& target, std::string_view row) {
  return std::string(fit_to) + target + "_" + std::string(row);
}

/// Whether it is an option beside the table of a given fit_to_NAME_series or fit_to_NAME_shape.
bool is_beside_table(const Options& o, const std::string& option) {
  const auto beside = options::beside_table(option);
  return beside && beside->first.starts_with(fit_to) &&
         (beside->first.ends_with("_series") || beside->first.ends_with("_shape")) && o.entries().has(beside->first);
}

/// An estimated option, or the entry of one that is a list: load_forces_2.
struct Varied {
  std::string option;
  int entry = 0;  // from 1; 0: the whole option
};

Varied varied(const Options& o, const std::string& given) {
  const std::string name = given.substr(fit_vary.size());
  const std::size_t end = name.find_last_of('_');
  double entry = 0.0;
  if (o.find_known(name) != nullptr || end == std::string::npos ||
      !options::parse_number(name.substr(end + 1), entry) || !(entry >= 1.0 && entry <= most_values) ||
      entry != std::floor(entry))
    return {name, 0};
  const Row* const list = o.find_known(name.substr(0, end));
  if (list == nullptr || list->kind != Kind::numbers) return {name, 0};
  return {name.substr(0, end), static_cast<int>(entry)};
}

[[noreturn]] void refuse_target(const Options& o, const std::string& option) {
  std::string rows;
  for (const Row& row : options::fit_rows()) rows += (rows.empty() ? "" : ", ") + std::string(row.name);
  o.refuse(option, fmt::format("allowed after fit_to: a name of the measurement, then one of {}", rows));
}

void declare_fit(Options& o) {
  for (const Entry& entry : o.entries()) {
    const std::string& name = entry.name;
    if (name.starts_with(fit_vary)) {
      o.check_known(name, varied(o, name).option);
      o.declare(name, options::fit_bounds_row());
    } else if (name.starts_with(fit_to) && !is_beside_table(o, name)) {
      const std::optional<Target> target = target_of(name);
      if (!target) refuse_target(o, name);
      o.declare(name, *target->row);
    }
  }
}

/// The reason why an option cannot be estimated; empty if it can.
std::string why_not_fitted(const Options& o, const std::string& option) {
  const Row& row = *o.find_known(option);
  if (option == alike) return "";
  for (const char* own : {"ts_", "contact_tolerance"})
    if (option.starts_with(own)) return "it belongs to the numerical model, which is the same for all runs";
  if (row.kind == Kind::integer || row.kind == Kind::integers) return "it is a whole number";
  return why_not_varied(o, option);
}

/// Sets the list of a parameter that is an entry of one.
void read_list(const Options& o, const std::string& given, int entry, FitParameter& parameter) {
  parameter.entry = entry;
  if (!o.entries().has(parameter.option))
    o.refuse(given, fmt::format("missing: {}, of which this is an entry", parameter.option));
  parameter.list = o.numbers(parameter.option);
  if (const auto count = static_cast<int>(parameter.list.size()); entry > count)
    o.refuse(given, fmt::format("{} has {} entries only", parameter.option, count));
}

/// The scene's own value of an option; none if it is not given or is no single number.
std::optional<double> own_value(const Options& o, const std::string& option, const Row& row) {
  if (!o.entries().has(option) && (row.fallback.empty() || row.fallback.front() == '(')) return {};
  if (row.kind == Kind::number_or_file && !o.is_number(option)) return {};
  if (row.kind == Kind::number || row.kind == Kind::number_or_file) return o.number(option);
  const std::vector<double> all = o.numbers(option);
  return all.empty() ? std::nullopt : std::optional(all.front());
}

FitParameter read_parameter(const Options& o, const std::string& given) {
  const auto [option, entry] = varied(o, given);
  const Row& row = *o.find_known(option);
  if (const std::string why = why_not_fitted(o, option); !why.empty())
    o.refuse(given, fmt::format("{} cannot be estimated: {}", option, why));
  const std::vector<std::string> words = o.texts(given);
  FitParameter parameter;
  parameter.option = option;
  parameter.unit = row.unit.empty() ? "1" : row.unit;
  const VaryReader reader(o, option);
  for (const auto& [bound, word] : {std::pair(&parameter.low, words[0]), std::pair(&parameter.high, words[1])}) {
    *bound = reader.number(given, word);
    reader.check(given, *bound);
  }
  if (entry > 0)
    read_list(o, given, entry, parameter);
  else
    parameter.copies = std::max(row.count, 1);
  if (!(parameter.low < parameter.high))
    o.refuse(given, "the lowest value must be below the highest; allowed: lowest, highest");
  const double low = parameter.low, high = parameter.high;
  const double middle = low > 0.0 ? std::sqrt(low) * std::sqrt(high) : 0.5 * (low + high);
  parameter.start =
      entry > 0 ? parameter.list[static_cast<std::size_t>(entry - 1)] : own_value(o, option, row).value_or(middle);
  if (parameter.start < low || parameter.start > high)
    o.refuse(given,
             fmt::format("the scene's value {} = {:g} is outside these bounds; a fit starts at the scene's value",
                         parameter.name(), parameter.start));
  return parameter;
}

options::MeasuredFrequency read_frequency(const Options& o, const std::string& target) {
  options::MeasuredFrequency mode{target,
                                  o.integer(name_of(target, "frequency")),
                                  o.number(name_of(target, "value")),
                                  o.number(name_of(target, "sd")),
                                  {},
                                  {}};
  const std::string option = name_of(target, "shape");
  if (!o.has(option)) return mode;
  const auto table =
      from_table(o, option, {2, 2, options::Order::rising, "m, ", false}, [](const auto& columns) { return columns; });
  mode.x = table[0];
  mode.shape = table[1];
  mode.shape_sd = o.has(name_of(target, "shape_sd")) ? o.number(name_of(target, "shape_sd")) : default_shape_sd;
  if (mode.x.size() < 2) o.refuse(option, "allowed: at least two rows, whose ratios are the shape");
  if (std::ranges::all_of(mode.shape, [](double value) { return value == 0.0; }))
    o.refuse(option, "every value is 0; wanted: at least one that is not");
  return mode;
}

/// The SI unit of a measured quantity.
std::string_view unit_of(std::string_view quantity) {
  return quantity == "velocity"       ? "m/s"
         : quantity == "acceleration" ? "m/s2"
         : quantity == "moment"       ? "N m"
         : quantity == "shear"        ? "N"
                                      : "m";
}

/// Reads the rows of a series between fit_to_NAME_from and fit_to_NAME_to.
void read_values(const Options& o, const std::string& target, options::MeasuredSeries& series) {
  const std::string option = name_of(target, "series");
  const auto column =
      static_cast<std::size_t>(o.has(name_of(target, "column")) ? o.integer(name_of(target, "column")) : 2);
  const std::string quantity = o.has(name_of(target, "quantity")) ? o.choice(name_of(target, "quantity")) : "";
  const std::string units = fmt::format("s, {}", quantity.empty() ? "" : unit_of(quantity));
  const bool own_factor = o.has(name_of(target, "factor"));  // which converts units, too
  const auto table = from_table(o, option, {2, most_columns, options::Order::rising, units, !own_factor},
                                [](auto columns) { return columns; });
  if (table.size() < column)
    o.refuse(option, fmt::format("the table has {} columns; allowed: at least {} ({})", table.size(), column,
                                 name_of(target, "column")));
  const double factor = o.optional_number(name_of(target, "factor")).value_or(1.0);
  if (factor == 0.0) o.refuse(name_of(target, "factor"), "allowed: any number but 0");
  const double from = o.optional_number(name_of(target, "from")).value_or(table[0].front());
  const double to = o.optional_number(name_of(target, "to")).value_or(table[0].back());
  for (std::size_t i = 0; i < table[0].size(); ++i) {
    if (table[0][i] < from || table[0][i] > to) continue;
    series.time.push_back(table[0][i]);
    series.value.push_back(factor * table[column - 1][i]);
  }
  if (series.time.size() < fewest_values || static_cast<double>(series.time.size()) > most_values)
    o.refuse(option,
             fmt::format(
                 "{} rows{}; allowed: {} to {:g}", series.time.size(),
                 o.has(name_of(target, "from")) || o.has(name_of(target, "to")) ? " between its times from and to" : "",
                 fewest_values, most_values));
}

void check_filter(const Options& o, const std::string& target, const options::MeasuredSeries& series) {
  if (!series.low_pass) return;
  const std::string option = name_of(target, "lowpass");
  const std::vector<double>& t = series.time;
  const double mean = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  for (std::size_t i = 1; i < t.size(); ++i)
    if (std::abs(t[i] - t[i - 1] - mean) > even_interval * mean)
      o.refuse(option, fmt::format("a filter needs rows at equal intervals; between {:g} and {:g} s there are {:g} s, "
                                   "the mean is {:g} s",
                                   t[i - 1], t[i], t[i] - t[i - 1], mean));
  if (*series.low_pass >= 0.5 / mean)
    o.refuse(option, fmt::format("allowed: below {:g} Hz, half of the measured values in a second", 0.5 / mean));
  if (const double duration = t.back() - t.front(); *series.low_pass * duration < 1.0)
    o.refuse(option, fmt::format("a filter leaves nothing of a record that is shorter than its period: the record has "
                                 "{:g} s; allowed: from {:.3g} Hz on",
                                 duration, 1.0 / duration));
}

/// Reads what was measured: a quantity at a station of the bridge, or any dataset.
void read_place(const Options& o, const std::string& target, options::MeasuredSeries& series) {
  if (o.has(name_of(target, "dataset"))) {
    const std::string path = o.text(name_of(target, "dataset"));
    series.dataset = (path.starts_with("/") ? "" : "/") + path;
    if (o.has(name_of(target, "component"))) series.component = o.integer(name_of(target, "component"));
    return;
  }
  series.dataset = "/probes/" + o.choice(name_of(target, "quantity"));
  series.x = o.number(name_of(target, "x"));
}

options::MeasuredSeries read_series(const Options& o, const std::string& target) {
  options::MeasuredSeries series;
  series.name = target;
  read_place(o, target, series);
  if (o.has(name_of(target, "sd"))) series.sd = o.number(name_of(target, "sd"));
  series.align = o.has(name_of(target, "align")) && o.flag(name_of(target, "align"));
  series.offset = o.has(name_of(target, "offset")) && o.flag(name_of(target, "offset"));
  series.gain = o.has(name_of(target, "gain")) && o.flag(name_of(target, "gain"));
  series.low_pass = o.optional_number(name_of(target, "lowpass"));
  read_values(o, target, series);
  check_filter(o, target, series);
  if (!series.align && series.time.front() < 0.0)
    o.refuse(name_of(target, "series"),
             fmt::format("begins at {:g} s, before the scene, which begins at 0; allowed: {} true, or {} 0",
                         series.time.front(), name_of(target, "align"), name_of(target, "from")));
  return series;
}

Fit read_measurements(const Options& o) {
  Fit fit;
  std::set<std::string> names;
  for (const Entry& entry : o.entries()) {
    if (is_beside_table(o, entry.name)) continue;
    if (entry.name.starts_with(fit_vary)) fit.parameters.push_back(read_parameter(o, entry.name));
    const std::optional<Target> target = target_of(entry.name);
    if (!target || !names.insert(target->name).second) continue;
    options::check_relations(o, options::Related::measurement, name_of(target->name, ""));
    const bool frequency = o.has(name_of(target->name, "frequency"));
    if (!frequency && !o.has(name_of(target->name, "series")))
      o.refuse(entry.name, fmt::format("the measurement {} needs either frequency or series", target->name));
    if (frequency)
      fit.frequencies.push_back(read_frequency(o, target->name));
    else
      fit.series.push_back(read_series(o, target->name));
  }
  if (fit.parameters.empty())
    throw InputError("fit_vary is missing: the options to be estimated, each with its lowest and highest value");
  if (names.empty()) throw InputError("fit_to is missing: the measurements, such as fit_to_first_frequency");
  if (fit.parameters.size() > most_parameters || names.size() > most_targets)
    throw InputError(fmt::format("a fit of {} options to {} measurements; allowed: at most {} and {}",
                                 fit.parameters.size(), names.size(), most_parameters, most_targets));
  fit.starts = o.integer("fit_starts");
  fit.seed = static_cast<std::uint64_t>(o.integer("fit_seed"));
  return fit;
}

void check_fit(const Options& o, const Scene& scene) {
  const Fit& fit = *scene.fit;
  const std::string& first = o.first_with_prefix(fit_vary)->name;
  if (!scene.beam) o.refuse(first, "a fit needs a bridge (beam_spans)");
  if (!fit.series.empty() && scene.analysis != Analysis::transient)
    o.refuse("scene_analysis", "a fit to a series needs scene_analysis transient");
  if (!fit.frequencies.empty() && scene.by_given_modes())
    o.refuse(name_of(fit.frequencies.front().name, "frequency"),
             "the frequencies of a bridge by given modes are input; allowed: bridges by beam_spans");
  for (const options::MeasuredSeries& series : fit.series) {
    const bool force = series.dataset == "/probes/moment" || series.dataset == "/probes/shear";
    if (scene.by_given_modes() && force)
      o.refuse(name_of(series.name, "series"), "given modes have no moments and no shear forces");
  }
}

std::string start_note(const Fit& fit) {
  std::string text;
  for (const FitParameter& p : fit.parameters)
    text += fmt::format("{}{} from {:g} to {:g}", text.empty() ? "" : ", ", p.name(), p.low, p.high);
  return fmt::format("fit of {}; the values of the scene are those of its start", text);
}

/// Checks the stations of the series before they are the probes of the scene.
void check_stations(const Options& o, const Fit& fit) {
  if (!o.has("beam_spans")) return;
  double length = 0.0;
  for (const double span : o.numbers("beam_spans")) length += span;
  for (const options::MeasuredSeries& series : fit.series)
    if (series.x) (void)place_on_beam(o, name_of(series.name, "x"), *series.x, length);
  for (const options::MeasuredFrequency& mode : fit.frequencies)
    for (const double x : mode.x) (void)place_on_beam(o, name_of(mode.name, "shape"), x, length);
}

/// The stations of the series in place of the scene's probes.
std::string stations_of(const Fit& fit) {
  std::set<double> stations;
  for (const options::MeasuredSeries& series : fit.series)
    if (series.x) stations.insert(*series.x);
  std::string text;
  for (const double x : stations) text += fmt::format("{}{}", text.empty() ? "" : ",", x);
  return text;
}

}  // namespace

bool describes_fit(const Options& o) {
  return o.first_with_prefix(fit_vary) != nullptr || o.first_with_prefix(fit_to) != nullptr;
}

Scene read_fit(const Options& given) {
  Options o = given;
  declare_parts(o);
  declare_fit(o);
  check_options(o);
  for (const char* other : {"sweep_speed", "sweep_hslm_a", "restart"})
    if (o.has(other)) o.refuse(other, "is not allowed in a fit, which computes single runs of one scene");
  const Fit fit = read_measurements(o);
  check_stations(o, fit);
  std::vector<double> start;
  for (const FitParameter& parameter : fit.parameters) start.push_back(parameter.start);
  Scene scene = read_scene_of_fit(given, fit, start, fit.series.empty());
  scene.fit = fit;
  scene.notes.insert(scene.notes.begin(), start_note(fit));
  scene.notes.insert(scene.notes.end(), o.notes().begin(), o.notes().end());
  scene.options = o.all();
  check_fit(o, scene);
  return scene;
}

Scene read_scene_of_fit(const Options& given, const Fit& fit, const std::vector<double>& values, bool modes) {
  options::Entries entries;
  for (const Entry& entry : given.entries())
    if (!entry.name.starts_with("fit_")) entries.set(entry);
  std::map<std::string, std::vector<double>> lists;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const FitParameter& parameter = fit.parameters[i];
    if (parameter.entry > 0) {
      std::vector<double>& list = lists.try_emplace(parameter.option, parameter.list).first->second;
      list[static_cast<std::size_t>(parameter.entry - 1)] = values[i];
      entries.set({parameter.option, fmt::format("{}", fmt::join(list, ",")), "a value of the fit", 0});
      continue;
    }
    const std::string copies = parameter.copies > 1 ? fmt::format("*{}", parameter.copies) : "";
    entries.set({parameter.option, fmt::format("{}{}", values[i], copies), "a value of the fit", 0});
  }
  if (modes)
    entries.set({"scene_analysis", "modes", "a fit to frequencies", 0});
  else if (!stations_of(fit).empty())
    entries.set({"output_probes", stations_of(fit), "the stations of the measurements", 0});
  return read_scene(Options(std::move(entries)));
}

}  // namespace traverse::scene
