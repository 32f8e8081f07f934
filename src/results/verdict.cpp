// Selects the most unfavourable run of a study for every limit, prints one line per verdict, and writes the datasets of
// /verdicts.
#include "results/verdict.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return unit == "1" ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

std::string verdict_line(const Verdict& v) {
  std::string line =
      fmt::format("{}  {} {}  limit {}", v.word(), v.limit.clause, v.limit.quantity, with_unit(v.limit.value, v.unit));
  if (!v.evaluated()) {
    line += ": " + v.found.why;
  } else {
    const std::string factor = v.limit.factor == 1.0 ? "" : fmt::format(" (with the factor {:.4g})", v.limit.factor);
    line += fmt::format(", found {}{}, margin {:.3g} %", with_unit(v.found.value, v.unit), factor, 100.0 * v.margin());
    if (const std::string place = v.found.place(); !place.empty()) line += ", " + place;
    if (std::isfinite(v.found.time)) line += fmt::format(", t = {:.6g} s", v.found.time);
    if (v.exceeded_in > 0) line += fmt::format(", broken in {} of {} runs", v.exceeded_in, v.runs);
  }
  return v.limit.text.empty() ? line : line + " (" + v.limit.text + ")";
}

}  // namespace

std::string EvaluatedQuantity::place() const {
  if (std::isnan(x)) return thing;
  return fmt::format("{}{}x = {:.6g} m", thing, thing.empty() ? "" : ", ", x);
}

std::string Verdict::word() const { return !evaluated() ? "not judged" : within_limit() ? "kept" : "broken"; }

std::vector<Verdict> worst_of(const LimitResults& results, const std::function<std::string(std::size_t)>& run_text) {
  const std::size_t count = results.limits.size();
  std::vector<Verdict> verdicts;
  for (std::size_t l = 0; l < count; ++l) {
    Verdict verdict{
        results.limits[l], std::string(options::limit_quantity(results.limits[l].quantity)->unit), {}, 0, 0};
    for (std::size_t i = l; i < results.value.size(); i += count) {
      if (std::isnan(results.value[i])) continue;
      ++verdict.runs;
      if (results.value[i] > verdict.limit.value) ++verdict.exceeded_in;
      if (results.value[i] <= verdict.found.value) continue;
      verdict.found = {results.value[i], EvaluatedQuantity::unknown, results.x[i], run_text(i / count), ""};
    }
    if (std::isnan(verdict.found.value))
      verdict.found.why = results.why[l].empty()
                              ? "no run determines it; a single run with the options of one of them reports the reason"
                              : results.why[l];
    verdicts.push_back(verdict);
  }
  return verdicts;
}

void print_verdicts(const std::vector<Verdict>& verdicts, const std::vector<std::string>& unusual) {
  if (verdicts.empty()) return;
  fmt::print("verdicts\n");
  for (const Verdict& v : verdicts) fmt::print("  {}\n", printable(verdict_line(v)));
  for (const std::string& word : unusual) fmt::print("  note: {}\n", printable(word));
  std::fflush(stdout);
}

std::vector<std::string> names_of_limits(const std::vector<options::VerdictLimit>& limits) {
  std::vector<std::string> names;
  std::map<std::string, int> times;
  for (const options::VerdictLimit& limit : limits) {
    const int time = ++times[limit.quantity];
    names.push_back(time == 1 ? limit.quantity : fmt::format("{}_{}", limit.quantity, time));
  }
  return names;
}

void record_limits(Recorder& recorder, const std::vector<options::VerdictLimit>& limits) {
  recorder.names("/criterion", names_of_limits(limits));
}

void record_verdicts(Recorder& recorder, const std::vector<Verdict>& verdicts) {
  if (verdicts.empty()) return;
  std::vector<options::VerdictLimit> limits;
  for (const Verdict& v : verdicts) limits.push_back(v.limit);
  record_limits(recorder, limits);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::pair<std::string, std::string>> clause, quantity, verdict;
  std::vector<double> value, limit, factor, margin, time, runs, exceeded_in;
  for (const Verdict& v : verdicts) {
    clause.emplace_back(v.limit.clause, v.limit.text);
    quantity.emplace_back(v.limit.quantity, v.unit);
    verdict.emplace_back(v.word(), v.evaluated() ? v.found.place() : v.found.why);
    value.push_back(v.found.value);
    limit.push_back(v.limit.value);
    factor.push_back(v.limit.factor);
    margin.push_back(v.evaluated() ? v.margin() : unknown);
    time.push_back(v.found.time);
    runs.push_back(static_cast<double>(v.runs));
    exceeded_in.push_back(static_cast<double>(v.exceeded_in));
  }
  recorder.tables({{"/verdicts/clause", clause}, {"/verdicts/quantity", quantity}, {"/verdicts/verdict", verdict}});
  const std::vector<std::size_t> shape = {verdicts.size()};
  recorder.datasets({{"/verdicts/value", shape, value, "as /verdicts/quantity"},
                     {"/verdicts/limit", shape, limit, "as /verdicts/quantity"},
                     {"/verdicts/factor", shape, factor, "1"},
                     {"/verdicts/margin", shape, margin, "1"},
                     {"/verdicts/time", shape, time, "s"},
                     {"/verdicts/runs", shape, runs, "1"},
                     {"/verdicts/broken_in", shape, exceeded_in, "1"}});
}

}  // namespace traverse::results
