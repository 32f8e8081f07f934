// Keeps one row of numbers per run in columns, and determines the extremes of a column with their run and probe for the
// datasets, the summary and the terminal. Also texts and attributes of the model that all runs have.
#include "results/study_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/broadcast.hpp"
#include "results/sweep.hpp"
#include "results/terminal.hpp"

namespace traverse::results {

StudyTable::StudyTable(const options::Study& study, std::size_t probes, bool wheels,
                       const std::vector<options::VerdictLimit>& limits, const options::Study* all)
    : study_(study),
      all_(all),
      missing_(all != nullptr ? study.runs() : 0, all != nullptr ? all->runs() / study.runs() : 0),
      runs_(study.runs()),
      probes_(probes),
      limits_(limits),
      finished_(runs_, 0.0),
      reasons_(limits.size()) {
  for (const StudyColumn& column : study_columns) {
    if ((column.of_wheels && !wheels) || (column.each == StudyColumn::limit && limits.empty())) continue;
    const std::size_t width = column.each == StudyColumn::probe   ? probes
                              : column.each == StudyColumn::limit ? limits.size()
                                                                  : 1;
    columns_.push_back({&column, width, std::vector<double>(runs_ * width, not_run)});
    width_ += width;
  }
}

void StudyTable::put(std::size_t run, const double* numbers, std::size_t runs) {
  if (all_ != nullptr) {
    const std::size_t row = all_->place(run, all_->sensitivity->axis);
    merge(row, numbers);
    missing_[row] -= runs;
    if (missing_[row] == 0) finished_[row] = 1.0;
    return;
  }
  for (Column& column : columns_) {
    std::copy_n(numbers, column.width, column.values.begin() + static_cast<std::ptrdiff_t>(run * column.width));
    numbers += column.width;
  }
  finished_[run] = 1.0;
}

/// Numbers that are equal in several runs get the least of their times or stations, in any order of the runs.
void StudyTable::merge(std::size_t row, const double* numbers) {
  std::vector<char> replaced;  // numbers of the last column that is no time or station: 1: replaced, 2: equal
  for (Column& column : columns_) {
    const std::string_view name = column.what->name;
    const bool follows = name.ends_with("_time") || name == "judged_x", least = name.starts_with("least_");
    if (!follows) replaced.assign(column.width, 0);
    for (std::size_t k = 0; k < column.width; ++k, ++numbers) {
      double& value = column.values[row * column.width + k];
      if (!follows)
        replaced[k] = *numbers == value                                                    ? 2
                      : std::isnan(value) || (least ? *numbers < value : *numbers > value) ? 1
                                                                                           : 0;
      if (replaced[k] == 1 || (follows && replaced[k] == 2 && *numbers < value)) value = *numbers;
    }
  }
}

void StudyTable::broadcast(MPI_Comm comm) {
  for (Column& column : columns_) column.values = base::broadcast(comm, std::move(column.values));
  finished_ = base::broadcast(comm, std::move(finished_));
  for (std::string& reason : reasons_) reason = base::broadcast(comm, std::move(reason));
}

options::Study rows_of(const options::Study& study) {
  if (!study.sensitivity) return study;
  options::Study rows = study;
  const std::size_t axis = study.sensitivity->axis;
  std::erase_if(rows.dimensions, [axis](const options::StudyDimension& d) { return d.axis != axis; });
  for (options::StudyDimension& d : rows.dimensions) d.axis = 0;
  rows.axes = {study.axes[axis]};
  rows.sensitivity->axis = 0;
  return rows;
}

std::size_t StudyTable::finished_runs() const {
  return static_cast<std::size_t>(std::count(finished_.begin(), finished_.end(), 1.0));
}

const StudyTable::Column* StudyTable::find(const std::string& name) const {
  const auto column =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.what->name == name; });
  return column == columns_.end() ? nullptr : &*column;
}

std::vector<Recorder::Dataset> StudyTable::results() const {
  std::vector<Recorder::Dataset> sets;
  for (const Column& column : columns_) {
    std::vector<std::size_t> shape = {runs_};
    for (const std::size_t size : column.shape()) shape.push_back(size);
    sets.push_back({std::string("/study/") + column.what->name, shape, column.values, column.what->unit});
  }
  return sets;
}

std::vector<Recorder::Dataset> StudyTable::coordinates() const {
  std::vector<Recorder::Dataset> sets;
  for (const options::StudyDimension& dimension : study_.dimensions) {
    std::vector<double> values(runs_);
    for (std::size_t run = 0; run < runs_; ++run) values[run] = study_.value(run, dimension);
    sets.push_back({"/study/" + dimension.name(), {runs_}, std::move(values), dimension.unit});
  }
  std::vector<double> shape;
  for (const options::Study::Axis& axis : study_.axes) shape.push_back(static_cast<double>(axis.length));
  sets.push_back({"/study/shape", {shape.size()}, shape, "1"});
  return sets;
}

Recorder::Dataset StudyTable::finished() const { return {"/study/finished", {runs_}, finished_, "1"}; }

std::vector<Verdict> StudyTable::verdicts() const {
  if (limits_.empty()) return {};
  LimitResults limit_results(limits_, 0);
  limit_results.value = find("judged")->values;
  limit_results.x = find("judged_x")->values;
  limit_results.why = reasons_;
  return worst_of(limit_results, [this](std::size_t run) { return point_text(study_, run); });
}

bool find_extreme(const StudyTable& table, const std::string& name, bool largest, StudyPlace& place) {
  return find_extreme(table, name, largest, place, 0, table.runs());
}

bool find_extreme(const StudyTable& table, const std::string& name, bool largest, StudyPlace& place, std::size_t first,
                  std::size_t past) {
  const StudyTable::Column* column = table.find(name);
  if (column == nullptr) return false;
  const std::size_t none = past * column->width;
  std::size_t at = none;
  for (std::size_t i = first * column->width; i < none; ++i) {
    const double value = column->values[i];
    if (std::isnan(value)) continue;
    if (at == none || (largest ? value > column->values[at] : value < column->values[at])) at = i;
  }
  if (at == none) return false;
  place = {at / column->width, at % column->width, column->values[at]};
  return true;
}

std::string point_text(const options::Study& study, std::size_t run) {
  if (study.sweep) {
    const std::string train = train_name(study, study.place(run, 0));
    const double speed = study.value(run, study.dimensions[study.speeds]);
    return fmt::format("{}{}at {:.5g} m/s ({:.4g} km/h)", train, train.empty() ? "" : " ", speed, 3.6 * speed);
  }
  std::string text;
  for (const options::StudyDimension& d : study.dimensions)
    text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", d.name(), study.value(run, d));
  return text;
}

namespace {

/// Adds the values of the varied options in a run.
void add_point(const options::Study& study, const std::string& name, std::size_t run, std::vector<Attribute>& list) {
  if (!study.sweep) return list.push_back({name + "_run", static_cast<long>(run)});
  for (const options::StudyDimension& d : study.dimensions) {
    const double value = study.value(run, d);
    if (d.whole)
      list.push_back({name + "_train", std::lround(value)});
    else
      list.push_back({name + "_speed", value});
  }
}

/// Adds the largest (or least) number of a column with its time, place and run, if it is known.
void add_extreme(const StudyTable& table, const std::string& name, const std::string& column, bool largest,
                 std::vector<Attribute>& list) {
  StudyPlace place;
  if (!find_extreme(table, column, largest, place)) return;
  list.push_back({name, place.value});
  const std::size_t at = place.run * table.probes() + place.probe;
  if (const StudyTable::Column* time = table.find(column + "_time")) list.push_back({name + "_time", time->values[at]});
  if (table.find(column)->what->each == StudyColumn::probe)
    list.push_back({name + "_place", table.find("probes_x")->values[at]});
  add_point(table.study(), name, place.run, list);
}

}  // namespace

std::vector<Attribute> summary_of(const StudyTable& table) {
  std::vector<Attribute> list;
  add_extreme(table, "deflection", "peak_deflection", true, list);
  add_extreme(table, "acceleration", "peak_acceleration", true, list);
  add_extreme(table, "moment", "peak_moment", true, list);
  if (StudyPlace place; find_extreme(table, "peak_deflection", true, place))
    for (const char* beside : {"static_deflection", "amplification"})
      if (const double value = table.find(beside)->values[place.run * table.probes() + place.probe]; !std::isnan(value))
        list.push_back({beside, value});
  add_extreme(table, "greatest_amplification", "amplification", true, list);
  add_extreme(table, "least_wheel_force", "least_wheel_force", false, list);
  add_extreme(table, "greatest_wheel_force", "greatest_wheel_force", true, list);
  StudyPlace longest;
  if (!find_extreme(table, "longest_loss", true, longest)) return list;
  double sum = 0.0;
  for (const double count : table.find("contact_losses")->values) sum += std::isnan(count) ? 0.0 : count;
  list.push_back({"contact_losses", std::lround(sum)});
  list.push_back({"longest_loss", longest.value});
  return list;
}

void print_study(const StudyTable& table) {
  fmt::print("extremes of all runs\n");
  StudyPlace place;
  const auto print = [&](const char* label, const char* column, bool largest, std::string_view quantity) {
    if (!find_extreme(table, column, largest, place)) return;
    const std::string value =
        quantity.empty() ? fmt::format("{:.4g}", place.value) : in_engineering_units(quantity, place.value);
    std::string where;
    if (table.probes() > 1 && table.find(column)->what->each == StudyColumn::probe)
      where = fmt::format("x = {:.4g} m, ", table.find("probes_x")->values[place.run * table.probes() + place.probe]);
    fmt::print("  {:<22}{:<18}{}{}\n", label, value, where, point_text(table.study(), place.run));
  };
  print("peak deflection", "peak_deflection", true, "deflection");
  print("peak acceleration", "peak_acceleration", true, "acceleration");
  print("peak moment", "peak_moment", true, "moment");
  print("amplification", "amplification", true, "");
  print("least wheel force", "least_wheel_force", false, "force");
  print("greatest wheel force", "greatest_wheel_force", true, "force");
}

std::vector<Attribute> attributes_of(const RunModel& model) {
  std::vector<Attribute> list = {{"modes", static_cast<long>(model.modes)}};
  list.push_back({model.in_bays ? "elements_per_bay" : "elements_per_span", static_cast<long>(model.elements)});
  if (model.time_step > 0.0) list.push_back({"time_step", model.time_step});
  if (!model.method.empty()) list.push_back({"method", model.method});
  if (model.accuracy > 0.0) list.push_back({"accuracy", model.accuracy});
  return list;
}

std::string method_of(const RunModel& model) {
  const std::string steps = model.time_step > 0.0 ? fmt::format(" and steps of {:g} s", model.time_step) : "";
  if (model.modes > 0) return fmt::format("by {} mode{}{}", model.modes, model.modes == 1 ? "" : "s", steps);
  return fmt::format("by {} elements a {}{}", model.elements, model.in_bays ? "sleeper bay" : "span", steps);
}

std::string extrapolation_note(const RunModel& model, const std::vector<double>& outside_trials) {
  const auto count = std::count(outside_trials.begin(), outside_trials.end(), 1.0);
  if (model.expected_errors.empty() || count == 0) return {};
  return fmt::format(
      "error estimates are not valid for {} of the runs, in which wheels lost contact, which happened in no trial run",
      count);
}

std::string separate_runs_note(long runs) {
  if (runs == 0) return {};
  return fmt::format(
      "  {} of the runs were computed separately, not in a batch: the residual of their linearised vehicles was too "
      "large, or a contact force did not converge\n",
      runs);
}

}  // namespace traverse::results
