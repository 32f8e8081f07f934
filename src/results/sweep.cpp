// Arranges the rows of a sweep's table by trains and speeds, and prints the peaks of each train, how many speeds were
// added, the remaining uncertainty of the peaks, and the speeds of the first mode in km/h. Writes the datasets of
// resonance speeds v = f d/i and cancellation speeds.
#include "results/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "results/terminal.hpp"

namespace traverse::results {
namespace {

constexpr const char* trains_option = "hslm_a";

double km_per_hour(const StudyTable& table, const StudyPlace& place) {
  const options::Study& study = table.study();
  return 3.6 * study.value(place.run, study.dimensions[study.speeds]);
}

/// " @ 230", with the station if there are several.
std::string at_text(const StudyTable& table, const StudyPlace& place) {
  std::string speed = fmt::format(" @ {:.4g}", km_per_hour(table, place));
  if (table.probes() == 1) return speed;
  return speed + fmt::format(", {:.4g}", table.find("probes_x")->values[place.run * table.probes() + place.probe]);
}

std::string amplification_text(double value) { return std::isnan(value) ? "unknown" : fmt::format("{:.4g}", value); }

/// The largest value of one train.
bool find_largest(const StudyTable& table, const char* column, std::size_t train, StudyPlace& place) {
  const std::size_t speeds = speeds_of_sweep(table.study()).size();
  return find_extreme(table, column, true, place, train * speeds, (train + 1) * speeds);
}

/// The printed row of a train whose largest deflection is at `place`.
std::vector<std::string> row_of(const StudyTable& table, std::size_t train, const StudyPlace& place) {
  StudyPlace largest;
  const auto text = [&](const char* column, std::string_view quantity) {
    if (!find_largest(table, column, train, largest)) return std::string("unknown");
    return in_engineering_units(quantity, largest.value, 5) + at_text(table, largest);
  };
  const double amplification = table.find("amplification")->values[place.run * table.probes() + place.probe];
  const std::string name = train_name(table.study(), train);
  return {name.empty() ? "scene" : name,
          text("peak_deflection", "deflection"),
          amplification_text(amplification),
          text("peak_acceleration", "acceleration"),
          text("peak_moment", "moment"),
          find_largest(table, "amplification", train, largest)
              ? amplification_text(largest.value) + at_text(table, largest)
              : "unknown"};
}

/// Static deflections [trains, probes], from the first run of each train that has them.
std::vector<double> static_deflections(const StudyTable& table) {
  const std::vector<double>& of_runs = table.find("static_deflection")->values;
  const std::size_t trains = trains_of(table.study()), probes = table.probes();
  std::vector<double> values(trains * probes, StudyTable::not_run);
  for (std::size_t run = table.runs(); run-- > 0;)
    for (std::size_t p = 0; p < probes; ++p)
      if (const double value = of_runs[run * probes + p]; !std::isnan(value))
        values[table.study().place(run, 0) * probes + p] = value;
  return values;
}

long added_speeds(const Refined& refined) { return std::count(refined.added.begin(), refined.added.end(), 1.0); }

}  // namespace

options::Study sweep_study(const std::vector<int>& trains, std::vector<double> speeds) {
  options::Study study;
  study.sweep = true;
  study.axes = {{"train", trains.empty() ? 1 : trains.size()}, {"speed", speeds.size()}};
  if (!trains.empty())
    study.dimensions.push_back({{trains_option}, "1", true, "list", {trains.begin(), trains.end()}, 0});
  study.speeds = study.dimensions.size();
  study.dimensions.push_back({{speed_of_sweep}, "m/s", false, "list", std::move(speeds), 1});
  return study;
}

std::size_t trains_of(const options::Study& sweep) { return sweep.axes.front().length; }

const std::vector<double>& speeds_of_sweep(const options::Study& sweep) {
  return sweep.dimensions[sweep.speeds].values;
}

std::string train_name(const options::Study& sweep, std::size_t train) {
  if (sweep.speeds == 0) return "";
  return fmt::format("A{:g}", sweep.dimensions.front().values[train]);
}

std::vector<Recorder::Dataset> sweep_datasets(const StudyTable& table, bool estimates) {
  const options::Study& study = table.study();
  std::vector<Recorder::Dataset> sets;
  for (const options::StudyDimension& d : study.dimensions)
    sets.push_back({"/sweep/" + d.name(), {d.values.size()}, d.values, d.unit});
  const std::size_t trains = trains_of(study), speeds = speeds_of_sweep(study).size();
  for (const StudyTable::Column& column : table.columns()) {
    const std::string_view name = column.what->name;
    if (name == "probes_x" || (name == "unseen" && !estimates)) continue;
    Recorder::Dataset set{fmt::format("/sweep/{}", name), {trains, speeds}, column.values, column.what->unit};
    for (const std::size_t size : column.shape()) set.shape.push_back(size);
    if (name == "static_deflection") {
      set.shape = {trains, table.probes()};
      set.values = static_deflections(table);
    } else if (name == "amplification") {  // 0: unknown in this run
      for (std::size_t i = 0; i < set.values.size(); ++i)
        if (table.finished(i / column.width) && std::isnan(set.values[i])) set.values[i] = 0.0;
    } else if (name == "unseen") {
      set.name = "/sweep/promised";
      for (double& value : set.values) value = 1.0 - value;  // NaN is preserved
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

void print_sweep(const StudyTable& table) {
  fmt::print("peaks, each @ its speed in km/h{}\n", table.probes() == 1 ? "" : ", probe in m");
  std::vector<std::vector<std::string>> rows = {
      {"train", "deflection", "its amplification", "acceleration", "moment", "greatest amplification"}};
  StudyPlace place;
  for (std::size_t train = 0; train < trains_of(table.study()); ++train)
    if (find_largest(table, "peak_deflection", train, place)) rows.push_back(row_of(table, train, place));
  print_columns(std::move(rows));
  const auto print = [&](const char* label, const char* column, bool largest) {
    if (find_extreme(table, column, largest, place))
      fmt::print("  {:<22}{} @ {:.4g}\n", label, in_engineering_units("force", place.value), km_per_hour(table, place));
  };
  print("least wheel force", "least_wheel_force", false);
  print("greatest wheel force", "greatest_wheel_force", true);
  std::fflush(stdout);
}

void print(const Refined& refined) {
  const long added = added_speeds(refined), given = static_cast<long>(refined.added.size()) - added;
  std::string remaining = "no speed between the computed ones can have a higher peak";
  if (refined.wanted == 0.0)
    remaining =
        refined.uncertainty > 0.0
            ? fmt::format(
                  "between two computed speeds a limit may still be exceeded ({}); -sweep_refine 1e-2 adds more speeds",
                  refined.curve)
            : "every limit that is satisfied at the computed speeds is also satisfied between them";
  else if (refined.uncertainty > 0.0)
    remaining = fmt::format("between the computed speeds, peaks can be at most {:.1g} higher than found ({}){}",
                            refined.uncertainty, refined.curve,
                            refined.uncertainty > refined.wanted ? ", more than the requested accuracy" : "");
  fmt::print("  {} speeds added to {}; {}\n", added, given, remaining);
}

void add_to(std::vector<Attribute>& summary, const Refined& refined) {
  summary.push_back({"speeds_added", added_speeds(refined)});
  summary.push_back({"peak_uncertainty", refined.uncertainty});
  summary.push_back({"peak_uncertainty_of", refined.curve});
}

void record(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
            const std::vector<Cancellation>& cancellations, Recorder& recorder) {
  std::vector<Recorder::Dataset> sets;
  const auto add = [&sets](const char* name, const char* unit, const auto& list, auto get) {
    std::vector<double> values;
    for (const auto& one : list) values.push_back(get(one));
    if (!values.empty()) sets.push_back({name, {values.size()}, values, unit});
  };
  if (!trains.empty())
    add("/resonances/hslm_a", "1", resonances,
        [&](const Resonance& r) { return static_cast<double>(trains[r.train]); });
  add("/resonances/mode", "1", resonances, [](const Resonance& r) { return static_cast<double>(r.mode); });
  add("/resonances/order", "1", resonances, [](const Resonance& r) { return static_cast<double>(r.order); });
  add("/resonances/frequency", "Hz", resonances, [](const Resonance& r) { return r.frequency; });
  add("/resonances/distance", "m", resonances, [](const Resonance& r) { return r.distance; });
  add("/resonances/speed", "m/s", resonances, [](const Resonance& r) { return r.speed; });
  add("/resonances/deflection_speed", "m/s", resonances, [](const Resonance& r) { return r.of_deflection; });
  add("/resonances/acceleration_speed", "m/s", resonances, [](const Resonance& r) { return r.of_acceleration; });
  add("/cancellations/mode", "1", cancellations, [](const Cancellation& c) { return static_cast<double>(c.mode); });
  add("/cancellations/half_waves", "1", cancellations,
      [](const Cancellation& c) { return static_cast<double>(c.half_waves); });
  add("/cancellations/speed", "m/s", cancellations, [](const Cancellation& c) { return c.speed; });
  recorder.datasets(sets);
}

void print(const std::vector<int>& trains, const std::vector<Resonance>& resonances,
           const std::vector<Cancellation>& cancellations) {
  const std::size_t none = std::max<std::size_t>(1, trains.size());
  std::size_t last = none;
  for (const Resonance& r : resonances) {
    if (r.mode != 1) continue;
    if (last == none) fmt::print("resonances v = f1 d/i of f1 {:.4g} Hz, km/h", r.frequency);
    if (r.train != last)
      fmt::print("\n  {}d {:.4g} m", trains.empty() ? "" : fmt::format("{:>5}  ", fmt::format("A{}", trains[r.train])),
                 r.distance);
    last = r.train;
    fmt::print("; i {} predicted {:.4g}, {}", r.order, 3.6 * r.speed,
               std::isnan(r.of_deflection) ? "no peak there" : fmt::format("found {:.4g}", 3.6 * r.of_deflection));
  }
  if (last < none) fmt::print("\n");
  std::string speeds;
  for (const Cancellation& c : cancellations)
    if (c.mode == 1) speeds += fmt::format("{}{:.4g}", speeds.empty() ? "" : ", ", 3.6 * c.speed);
  if (!speeds.empty()) fmt::print("cancellation speeds v = 2 f1 L/(2 k + 1): {} km/h\n", speeds);
  std::fflush(stdout);
}

}  // namespace traverse::results
