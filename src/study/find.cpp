// Reduces the table of a search to the greatest ratio at each value of its option, and words, prints and stores the
// intervals within the bound.
#include "study/find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/broadcast.hpp"
#include "run/process.hpp"
#include "traverse/base/error.hpp"

namespace traverse::study {
namespace {

using options::Find;
using options::Study;
using results::StudyTable;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A column of the table that the search bounds, and its bound.
struct Bounded {
  const StudyTable::Column* column = nullptr;
  std::size_t first = 0, count = 0;  // numbers of a row
  double bound = 0.0;
  std::size_t limit = 0;  // index of the limit; of no limit: 0
  std::string quantity;
};

/// The greatest number of a quantity in a run; NaN: unknown.
double greatest(const Bounded& bounded, std::size_t run) {
  const auto begin =
      bounded.column->values.begin() + static_cast<std::ptrdiff_t>(run * bounded.column->width + bounded.first);
  double value = unknown;
  for (std::size_t i = 0; i < bounded.count; ++i)
    value = std::fmax(value, std::abs(begin[static_cast<std::ptrdiff_t>(i)]));
  return value;
}

bool is_determined(const Bounded& bounded, std::size_t runs) {
  for (std::size_t run = 0; run < runs; ++run)
    if (!std::isnan(greatest(bounded, run))) return true;
  return false;
}

/// The quantities that the search names: those of all limits of runs, of one limit, or peaks.
std::vector<Bounded> named_columns(const StudyTable& table) {
  const Find& find = *table.study().find;
  std::vector<Bounded> named;
  const StudyTable::Column* judged = table.find("judged");
  for (std::size_t l = 0; l < table.limits().size(); ++l) {
    const options::VerdictLimit& limit = table.limits()[l];
    named.push_back({judged, l, 1, find.value.value_or(limit.value), l, limit.quantity});
    if (find.value) break;
  }
  if (const StudyTable::Column* column = table.find(find.quantity); named.empty() && column != nullptr)
    named.push_back({column, 0, column->width, *find.value, 0, find.quantity});
  return named;
}

/// The named quantities that runs determine.
std::vector<Bounded> bounded_columns(const StudyTable& table) {
  std::vector<Bounded> bounded = named_columns(table);
  std::erase_if(bounded, [&](const Bounded& one) { return !is_determined(one, table.runs()); });
  return bounded;
}

std::string name_of(const Study& study, std::size_t run) {
  std::string name;
  for (const options::StudyDimension& d : study.dimensions)
    if (std::find(study.find->for_each.begin(), study.find->for_each.end(), d.axis) != study.find->for_each.end())
      name += fmt::format("{}{} {:.6g}", name.empty() ? "" : ", ", d.name(), study.value(run, d));
  return name;
}

/// Records the ratio of a run if it is the greatest at its value.
void record_greatest(FoundAnswer& answer, std::size_t place, double ratio, std::size_t run, std::size_t limit) {
  if (ratio <= answer.ratio[place]) return;  // false if none is known yet
  answer.ratio[place] = ratio;
  answer.run[place] = run;
  answer.limit[place] = limit;
}

/// A value of the option in words: "1.234e+11 N m2", "63.1 m/s (227 km/h)".
std::string in_words(const options::StudyDimension& searched, double value) {
  if (searched.unit == "m/s") return fmt::format("{:.6g} m/s ({:.5g} km/h)", value, 3.6 * value);
  return searched.unit == "1" ? fmt::format("{:.6g}", value) : fmt::format("{:.6g} {}", value, searched.unit);
}

/// What governs at the searched value `place`, outside an interval.
std::string governing(const StudyTable& table, const FoundAnswer& answer, std::size_t place) {
  const std::vector<Bounded> bounded = bounded_columns(table);
  const auto found = std::find_if(bounded.begin(), bounded.end(), [&](const Bounded& one) {
    return bounded.size() == 1 || one.limit == answer.limit[place];
  });
  if (std::isnan(answer.ratio[place])) return "not every run determines the quantities";
  return fmt::format("{} is {:.4g} times its bound in the run at {}", found->quantity, answer.ratio[place],
                     results::point_text(table.study(), answer.run[place]));
}

std::string condition(const StudyTable& table) {
  const Find& find = *table.study().find;
  if (find.value) return fmt::format("{} does not exceed {:g}", find.quantity, *find.value);
  return find.quantity.empty() ? "all limits are kept" : fmt::format("the limit of {} is kept", find.quantity);
}

std::string reason_of(const StudyTable& table, const Bounded& one) {
  const std::string why = table.reason(one.limit);
  return one.quantity + (why.empty() ? "" : ": " + why);
}

void print_answer(const StudyTable& table, const FoundAnswer& answer) {
  const Study& study = table.study();
  const options::StudyDimension& searched = study.dimensions[study.find->dimension];
  const std::vector<double>& values = searched.values;
  const std::string name = answer.name.empty() ? "" : answer.name + ": ";
  if (answer.intervals.empty()) {
    const auto least = std::min_element(answer.ratio.begin(), answer.ratio.end());
    const auto place = static_cast<std::size_t>(least - answer.ratio.begin());
    fmt::print("  {}for no value between {} and {}; closest at {}, where {}\n", name,
               in_words(searched, values.front()), in_words(searched, values.back()), in_words(searched, values[place]),
               governing(table, answer, place));
    return;
  }
  for (const WithinInterval& one : answer.intervals) {
    fmt::print("  {}from {}{} to {}{}\n", name, in_words(searched, one.from),
               one.from_is_end ? " (the least value of the search)" : "", in_words(searched, one.to),
               one.to_is_end ? " (the greatest value of the search)" : "");
    const auto place = [&](double value) {
      return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
    };
    if (!one.from_is_end) fmt::print("    below: {}\n", governing(table, answer, place(one.from) - 1));
    if (!one.to_is_end) fmt::print("    above: {}\n", governing(table, answer, place(one.to) + 1));
  }
}

}  // namespace

std::vector<FoundAnswer> answers_of(const StudyTable& table) {
  const Study& study = table.study();
  const options::StudyDimension& searched = study.dimensions[study.find->dimension];
  const std::size_t count = searched.values.size();
  const FoundAnswer none{"",
                         std::vector<double>(count, unknown),
                         std::vector<std::size_t>(count, 0),
                         std::vector<std::size_t>(count, 0),
                         {}};
  std::map<std::vector<std::size_t>, std::size_t> known;
  std::vector<FoundAnswer> answers;
  FoundAnswer all = none;
  const std::vector<Bounded> bounded = bounded_columns(table);
  for (std::size_t run = 0; run < table.runs(); ++run) {
    std::vector<std::size_t> key;
    for (const std::size_t axis : study.find->for_each) key.push_back(study.place(run, axis));
    const auto [found, is_new] = known.try_emplace(std::move(key), answers.size());
    if (is_new) {
      answers.push_back(none);
      answers.back().name = name_of(study, run);
    }
    const std::size_t place = study.place(run, searched.axis);
    for (const Bounded& one : bounded) {
      const double ratio = greatest(one, run) / one.bound;
      record_greatest(answers[found->second], place, ratio, run, one.limit);
      record_greatest(all, place, ratio, run, one.limit);
    }
  }
  if (answers.size() > 1) {
    all.name = "all";
    answers.push_back(std::move(all));
  }
  for (FoundAnswer& answer : answers) answer.intervals = intervals_within(searched.values, answer.ratio);
  return answers;
}

std::vector<double> values_to_add(const StudyTable& table) {
  const Study& study = table.study();
  std::vector<std::vector<double>> ratios;
  for (FoundAnswer& answer : answers_of(table)) ratios.push_back(std::move(answer.ratio));
  return values_to_add(study.dimensions[study.find->dimension].values, ratios, study.find->accuracy);
}

std::string undetermined(const StudyTable& table) {
  if (!bounded_columns(table).empty()) return "";
  const std::vector<Bounded> named = named_columns(table);
  return "find_option: no run determines " +
         (named.empty() ? table.study().find->quantity : reason_of(table, named.front()));
}

namespace {

/// Why the search has no answer; empty if it has one.
std::string search_obstacle(const StudyTable& table) {
  if (std::string why = undetermined(table); !why.empty()) return why;
  if (const std::vector<double> wanted = values_to_add(table); !wanted.empty())
    return fmt::format(
        "find_option: the intervals are not known to {:g} after {} values ({} more are needed): the results contain "
        "those computed; use a larger find_accuracy, a smaller range or more find_points",
        table.study().find->accuracy, table.study().dimensions[table.study().find->dimension].values.size(),
        wanted.size());
  return "";
}

}  // namespace

void check_answers(MPI_Comm comm, const StudyTable& table) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const std::string why = base::broadcast(comm, rank == 0 ? search_obstacle(table) : "");
  if (!why.empty()) throw SolverError(why);
}

void print_answers(const StudyTable& table, const std::vector<FoundAnswer>& answers) {
  const Study& study = table.study();
  fmt::print("find  {}: {}\n", study.dimensions[study.find->dimension].name(), condition(table));
  for (const FoundAnswer& answer : answers) print_answer(table, answer);
  for (const Bounded& one : named_columns(table))
    if (!is_determined(one, table.runs())) fmt::print("  not part of the search: {}\n", reason_of(table, one));
}

void record_answers(const StudyTable& table, const std::vector<FoundAnswer>& answers, results::Recorder& recorder) {
  const Study& study = table.study();
  const options::StudyDimension& searched = study.dimensions[study.find->dimension];
  const std::size_t values = searched.values.size();
  std::vector<std::string> names;
  std::vector<double> ratio, run, limit, answer_of, ends, at_end;
  for (const FoundAnswer& answer : answers) {
    for (const WithinInterval& one : answer.intervals) {
      answer_of.push_back(static_cast<double>(names.size()));
      ends.insert(ends.end(), {one.from, one.to});
      at_end.insert(at_end.end(), {one.from_is_end ? 1.0 : 0.0, one.to_is_end ? 1.0 : 0.0});
    }
    names.push_back(answer.name.empty() ? "all" : answer.name);
    ratio.insert(ratio.end(), answer.ratio.begin(), answer.ratio.end());
    run.insert(run.end(), answer.run.begin(), answer.run.end());
    limit.insert(limit.end(), answer.limit.begin(), answer.limit.end());
  }
  recorder.names("/answer", names);
  recorder.datasets({{"/find/value", {values}, searched.values, searched.unit},
                     {"/find/ratio", {answers.size(), values}, ratio, "1"},
                     {"/find/run", {answers.size(), values}, run, "1"},
                     {"/find/limit", {answers.size(), values}, limit, "1"},
                     {"/find/interval", {answer_of.size(), 2}, ends, searched.unit},
                     {"/find/interval_answer", {answer_of.size()}, answer_of, "1"},
                     {"/find/interval_at_end", {answer_of.size(), 2}, at_end, "1"}});
  recorder.attributes(
      "/find", {{"option", searched.name()}, {"condition", condition(table)}, {"accuracy", study.find->accuracy}});
}

}  // namespace traverse::study
