#include "results/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "results/terminal.hpp"

namespace traverse::results {
namespace {

std::string train_of(const Sweep& sweep, std::size_t train) {
  return sweep.trains.empty() ? "scene" : fmt::format("A{}", sweep.trains[train]);
}

double km_per_hour(const Sweep& sweep, const SweepPlace& place) { return 3.6 * sweep.speed[place.speed]; }

/// " @ 230", with the station where there are several.
std::string at_text(const Sweep& sweep, const SweepPlace& place) {
  const std::string speed = fmt::format(" @ {:.4g}", km_per_hour(sweep, place));
  return sweep.probes.size() == 1 ? speed : speed + fmt::format(", {:.4g}", sweep.probes[place.probe]);
}

std::string amplification_text(double value) { return value > 0.0 ? fmt::format("{:.4g}", value) : "unknown"; }

/// The index of the extreme value of runs that have ended; values.size() where none has.
template <class Better>
std::size_t extreme_run(const std::vector<double>& values, Better better) {
  std::size_t at = values.size();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i]) && (at == values.size() || better(values[i], values[at]))) at = i;
  return at;
}

std::size_t least_run(const std::vector<double>& values) { return extreme_run(values, std::less<>()); }
std::size_t greatest_run(const std::vector<double>& values) { return extreme_run(values, std::greater<>()); }

void add_place(const Sweep& sweep, const std::string& name, const SweepPlace& place, std::vector<Attribute>& list) {
  list.push_back({name + "_place", sweep.probes[place.probe]});
  list.push_back({name + "_speed", sweep.speed[place.speed]});
  if (!sweep.trains.empty()) list.push_back({name + "_train", static_cast<long>(sweep.trains[place.train])});
}

void add_peaks(const Sweep& sweep, std::vector<Attribute>& list) {
  SweepPlace place;
  const auto add = [&](const std::string& name, const Sweep::Peaks& peaks) {
    if (!find_largest(sweep, peaks.value, place)) return;
    list.push_back({name, peaks.value[place.at]});
    list.push_back({name + "_time", peaks.time[place.at]});
    add_place(sweep, name, place, list);
  };
  add("deflection", sweep.deflection);
  add("acceleration", sweep.acceleration);
  add("moment", sweep.moment);
  if (!find_largest(sweep, sweep.deflection.value, place)) return;
  const double rest = sweep.static_deflection[place.train * sweep.probes.size() + place.probe];
  if (rest > 0.0) list.push_back({"static_deflection", rest});
  if (sweep.amplification[place.at] > 0.0) list.push_back({"amplification", sweep.amplification[place.at]});
  if (!find_largest(sweep, sweep.amplification, place) || !(sweep.amplification[place.at] > 0.0)) return;
  list.push_back({"greatest_amplification", sweep.amplification[place.at]});
  add_place(sweep, "greatest_amplification", place, list);
}

void add_wheels(const Sweep& sweep, std::vector<Attribute>& list) {
  const auto add = [&](const std::string& name, const std::vector<double>& values, std::size_t run) {
    if (run == values.size()) return;
    list.push_back({name, values[run]});
    list.push_back({name + "_speed", sweep.speed[run % sweep.speed.size()]});
  };
  add("least_wheel_force", sweep.least_wheel_force, least_run(sweep.least_wheel_force));
  add("greatest_wheel_force", sweep.greatest_wheel_force, greatest_run(sweep.greatest_wheel_force));
  if (const std::size_t run = greatest_run(sweep.longest_loss); run < sweep.longest_loss.size()) {
    double losses = 0.0;
    for (const double count : sweep.contact_losses) losses += std::isnan(count) ? 0.0 : count;
    list.push_back({"contact_losses", std::lround(losses)});
    list.push_back({"longest_loss", sweep.longest_loss[run]});
  }
}

std::vector<Attribute> attributes_of(const Sweep::Model& model) {
  std::vector<Attribute> list = {{"modes", static_cast<long>(model.modes)}};
  list.push_back({model.in_bays ? "elements_per_bay" : "elements_per_span", static_cast<long>(model.elements)});
  if (model.time_step > 0.0) list.push_back({"time_step", model.time_step});
  if (!model.method.empty()) list.push_back({"method", model.method});
  if (model.accuracy > 0.0) list.push_back({"accuracy", model.accuracy});
  return list;
}

void print_wheels(const Sweep& sweep) {
  const auto print = [&](const char* label, const std::vector<double>& values, std::size_t run) {
    if (run == values.size()) return;
    fmt::print("  {:<22}{:.4g} kN @ {:.4g}\n", label, 1e-3 * values[run], 3.6 * sweep.speed[run % sweep.speed.size()]);
  };
  print("least wheel force", sweep.least_wheel_force, least_run(sweep.least_wheel_force));
  print("greatest wheel force", sweep.greatest_wheel_force, greatest_run(sweep.greatest_wheel_force));
}

bool find_among(const Sweep& sweep, const std::vector<double>& values, std::size_t from, std::size_t past,
                SweepPlace& place) {
  std::size_t at = past;
  for (std::size_t i = from; i < past; ++i)
    if (!std::isnan(values[i]) && (at == past || values[i] > values[at])) at = i;
  if (at == past) return false;
  const std::size_t probes = sweep.probes.size(), speeds = sweep.speed.size();
  place = {at / probes / speeds, at / probes % speeds, at % probes, at};
  return true;
}

using Row = std::vector<std::string>;

/// Of a train whose largest deflection is at `place`.
Row row_of(const Sweep& sweep, std::size_t train, const SweepPlace& place) {
  SweepPlace own;
  const auto text = [&](const std::vector<double>& values, double scale, const char* unit) {
    if (!find_largest(sweep, values, train, own)) return std::string("unknown");
    return fmt::format("{:.5g} {}{}", scale * values[own.at], unit, at_text(sweep, own));
  };
  const std::string acceleration = text(sweep.acceleration.value, 1.0, "m/s2");
  const std::string moment = text(sweep.moment.value, 1e-3, "kN m");
  const bool known = find_largest(sweep, sweep.amplification, train, own) && sweep.amplification[own.at] > 0.0;
  return {train_of(sweep, train),
          fmt::format("{:.5g} mm{}", 1e3 * sweep.deflection.value[place.at], at_text(sweep, place)),
          amplification_text(sweep.amplification[place.at]),
          acceleration,
          moment,
          known ? amplification_text(sweep.amplification[own.at]) + at_text(sweep, own) : "unknown"};
}

}  // namespace

bool find_largest(const Sweep& sweep, const std::vector<double>& values, std::size_t train, SweepPlace& place) {
  const std::size_t size = sweep.speed.size() * sweep.probes.size();
  return find_among(sweep, values, train * size, (train + 1) * size, place);
}

bool find_largest(const Sweep& sweep, const std::vector<double>& values, SweepPlace& place) {
  return find_among(sweep, values, 0, values.size(), place);
}

void record(const Sweep& sweep, Recorder& recorder) {
  std::vector<Recorder::Dataset> sets = {{"/sweep/speed", {sweep.speed.size()}, sweep.speed, "m/s"}};
  if (sweep.refined) sets.push_back({"/sweep/added", {sweep.speed.size()}, sweep.refined->added, "1"});
  if (!sweep.trains.empty())
    sets.push_back({"/sweep/hslm_a", {sweep.trains.size()}, {sweep.trains.begin(), sweep.trains.end()}, "1"});
  const std::vector<std::size_t> shape = {sweep.rows(), sweep.speed.size(), sweep.probes.size()};
  const auto add = [&](const std::string& name, const Sweep::Peaks& peaks, const char* unit) {
    sets.push_back({"/sweep/peak_" + name, shape, peaks.value, unit});
    sets.push_back({"/sweep/peak_" + name + "_time", shape, peaks.time, "s"});
  };
  add("deflection", sweep.deflection, "m");
  add("acceleration", sweep.acceleration, "m/s2");
  add("moment", sweep.moment, "N m");
  sets.push_back({"/sweep/amplification", shape, sweep.amplification, "1"});
  sets.push_back({"/sweep/static_deflection", {shape[0], shape[2]}, sweep.static_deflection, "m"});
  const auto of_runs = [&](const char* name, const std::vector<double>& values, const char* unit) {
    if (!values.empty()) sets.push_back({std::string("/sweep/") + name, {shape[0], shape[1]}, values, unit});
  };
  of_runs("least_wheel_force", sweep.least_wheel_force, "N");
  of_runs("greatest_wheel_force", sweep.greatest_wheel_force, "N");
  of_runs("contact_losses", sweep.contact_losses, "1");
  of_runs("longest_loss", sweep.longest_loss, "s");
  if (!sweep.model.expected_errors.empty()) {
    std::vector<double> promised = sweep.unseen;
    for (double& run : promised) run = 1.0 - run;  // not_run stays
    of_runs("promised", promised, "1");
  }
  if (!sweep.judged.limits.empty()) {
    const std::vector<std::size_t> of_limits = {shape[0], shape[1], sweep.judged.limits.size()};
    sets.push_back({"/sweep/judged", of_limits, sweep.judged.value, "as /verdicts/quantity"});
    sets.push_back({"/sweep/judged_x", of_limits, sweep.judged.x, "m"});
  }
  recorder.datasets(sets);
  recorder.attributes("/sweep", attributes_of(sweep.model));
}

std::vector<Attribute> summary_of(const Sweep& sweep, const SweepCourse& course) {
  std::vector<Attribute> list;
  add_peaks(sweep, list);
  add_wheels(sweep, list);
  for (const auto& [quantity, error] : sweep.model.expected_errors)
    list.push_back({"expected_error_" + quantity, error});
  if (sweep.refined) add_to(list, *sweep.refined);
  list.push_back({"runs", course.runs});
  list.push_back({"runs_planned", course.planned});
  list.push_back({"wall_seconds", course.wall_seconds});
  list.push_back({"ended", course.ended});
  return list;
}

void print_sweep(const Sweep& sweep) {
  fmt::print("peaks, each @ its speed in km/h{}\n", sweep.probes.size() == 1 ? "" : ", probe in m");
  std::vector<Row> rows = {
      {"train", "deflection", "its amplification", "acceleration", "moment", "greatest amplification"}};
  for (std::size_t train = 0; train < sweep.rows(); ++train)
    if (SweepPlace place; find_largest(sweep, sweep.deflection.value, train, place))
      rows.push_back(row_of(sweep, train, place));
  print_columns(std::move(rows));
  print_wheels(sweep);
  if (sweep.refined) print(*sweep.refined);
  std::fflush(stdout);
}

std::vector<Verdict> verdicts_of(const Sweep& sweep) {
  return worst_of(sweep.judged, [&sweep](std::size_t run) {
    const double speed = sweep.speed[run % sweep.speed.size()];
    const std::string train = sweep.trains.empty() ? "" : train_of(sweep, run / sweep.speed.size()) + " ";
    return fmt::format("{}at {:.5g} m/s ({:.4g} km/h)", train, speed, 3.6 * speed);
  });
}

std::string Sweep::Model::not_promised(const std::vector<double>& unseen) const {
  const auto count = std::count(unseen.begin(), unseen.end(), 1.0);
  if (expected_errors.empty() || count == 0) return {};
  return fmt::format(
      "nothing is promised of {} of the runs: they met what no trial run has seen, as wheels that lose contact or "
      "stops that are touched; -accuracy_whole makes trial runs as long as these",
      count);
}

std::string computed_alone(long runs) {
  if (runs == 0) return {};
  return fmt::format(
      "  {} of the runs left the others beside them, as their vehicles were too far from linear or a contact force did "
      "not converge, and were computed alone\n",
      runs);
}

std::string method_of(const Sweep::Model& model) {
  const std::string steps = model.time_step > 0.0 ? fmt::format(" and steps of {:g} s", model.time_step) : "";
  if (model.modes > 0) return fmt::format("by {} mode{}{}", model.modes, model.modes == 1 ? "" : "s", steps);
  return fmt::format("by {} elements a {}{}", model.elements, model.in_bays ? "sleeper bay" : "span", steps);
}

}  // namespace traverse::results
