// Distributes groups of runs over the ranks, computes compatible runs in batches and stores their results. Arranges the
// peaks in the table of a study as curves over the speed, one for each combination of the other axes, and inserts the
// new speeds into the study.
#include "study/study_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "ensemble/result_gather.hpp"
#include "results/stage.hpp"
#include "results/sweep.hpp"

namespace traverse::study {
namespace {

using Groups = std::vector<std::vector<std::size_t>>;

/// The results of a run, or the greatest results of several runs with this one, in the order of the table, preceded by
/// the run's index and the number of runs.
std::vector<double> row_of(std::size_t run, std::size_t runs, const ensemble::CaseResult& result,
                           const std::vector<double>& probes, bool wheels) {
  std::vector<double> row = {static_cast<double>(run), static_cast<double>(runs)};
  const auto add = [&](auto get) {
    for (std::size_t p = 0; p < probes.size(); ++p) row.push_back(get(p));
  };
  const auto or_unknown = [](double value) { return value > 0.0 ? value : results::StudyTable::not_run; };
  add([&](std::size_t p) { return probes[p]; });
  for (const auto quantity :
       {&base::ProbePeaks::deflection, &base::ProbePeaks::acceleration, &base::ProbePeaks::moment}) {
    add([&](std::size_t p) { return (result.peaks[p].*quantity).value; });
    add([&](std::size_t p) { return (result.peaks[p].*quantity).time; });
  }
  add([&](std::size_t p) { return or_unknown(result.static_deflection[p]); });
  add([&](std::size_t p) { return result.peaks[p].deflection.value / or_unknown(result.static_deflection[p]); });
  if (wheels)
    row.insert(row.end(),
               {result.least_wheel_force, result.greatest_wheel_force, result.contact_losses, result.longest_loss});
  row.push_back(result.outside_trials ? 1.0 : 0.0);
  for (const results::EvaluatedQuantity& quantity : result.evaluated) row.push_back(quantity.value);
  for (const results::EvaluatedQuantity& quantity : result.evaluated) row.push_back(quantity.x);
  return row;
}

/// Stores why a run does not evaluate quantities of limits.
void set_reasons(const ensemble::CaseResult& result, results::StudyTable& table) {
  for (std::size_t l = 0; l < result.evaluated.size(); ++l)
    if (std::isnan(result.evaluated[l].value)) table.set_reason(l, result.evaluated[l].why);
}

/// The name of a group of a sweep, as "one of the runs of train A3 at 50 to 60 m/s (180 to 216 km/h)".
std::string name_in_sweep(const options::Study& study, const std::vector<std::size_t>& group) {
  const auto speed = [&](std::size_t run) { return study.value(run, study.dimensions[study.speeds]); };
  const double from = speed(group.front()), to = speed(group.back());
  const std::string name = results::train_name(study, study.place(group.front(), 0));
  const std::string train = name.empty() ? "" : " of train " + name;
  if (group.size() == 1) return fmt::format("the run{} at {:g} m/s ({:g} km/h)", train, from, 3.6 * from);
  return fmt::format("one of the runs{} at {:g} to {:g} m/s ({:g} to {:g} km/h)", train, from, to, 3.6 * from,
                     3.6 * to);
}

std::string name_of(const options::Study& study, const std::vector<std::size_t>& group) {
  if (study.sweep) return name_in_sweep(study, group);
  if (group.size() == 1) return fmt::format("the run at {}", results::point_text(study, group.front()));
  return fmt::format("one of the runs from {} to {}", results::point_text(study, group.front()),
                     results::point_text(study, group.back()));
}

/// Called with the index of a run, the number of runs that the results are of, and the results.
using Ended =
    std::function<void(std::size_t run, std::size_t runs, const ensemble::CaseResult&, const ensemble::CaseRunner&)>;

/// Computes the runs of a group: compatible ones together, the others separately.
void run_group(StudyScenes& scenes, const std::vector<std::size_t>& group, const std::function<void(double)>& reached,
               const Ended& ended) {
  std::vector<StudyScenes::Runner> runners;  // keeps the runners alive
  for (const std::size_t run : group) runners.push_back(scenes.runner(scenes.runs()[run].base));
  std::vector<char> done(group.size(), 0);
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (done[i] != 0) continue;
    std::vector<ensemble::CaseRunner::Member> members;
    std::vector<std::size_t> places;
    for (std::size_t j = i; j < group.size(); ++j) {
      if (done[j] != 0 || !StudyScenes::compatible(runners[j], runners[i])) continue;
      members.push_back({runners[j].runs.get(), scenes.runs()[group[j]].own});
      places.push_back(j);
      done[j] = 1;
    }
    const std::vector<ensemble::CaseResult> results =
        ensemble::CaseRunner::run_together(scenes.runs()[group[i]].train, members, reached);
    for (std::size_t j = 0; j < results.size(); ++j) ended(group[places[j]], 1, results[j], *runners[places[j]].runs);
  }
}

/// Computes the greatest results of a group. Without bounds in some scene, for which dampers couple modes, all runs are
/// computed.
void run_greatest(StudyScenes& scenes, const std::vector<std::size_t>& group,
                  const std::function<void(double)>& reached, const Ended& ended) {
  std::vector<StudyScenes::Runner> runners;  // of different scenes
  std::vector<std::size_t> first, count;     // runs of each
  std::vector<ensemble::CaseRunner::Member> members;
  for (const std::size_t run : group) {
    const std::size_t base = scenes.runs()[run].base;
    auto known = std::find_if(runners.begin(), runners.end(), [&](const auto& one) { return one.base == base; });
    if (known == runners.end()) {
      known = runners.insert(known, scenes.runner(base));
      first.push_back(run);
      count.push_back(0);
    }
    ++count[static_cast<std::size_t>(known - runners.begin())];
    members.push_back({known->runs.get(), scenes.runs()[run].own});
  }
  if (!std::all_of(runners.begin(), runners.end(), [](const auto& one) { return one.runs->has_bounds(); })) {
    for (const std::size_t run : group) run_group(scenes, {run}, reached, ended);
    return;
  }
  const std::vector<ensemble::CaseResult> results =
      ensemble::CaseRunner::greatest(scenes.runs()[group.front()].train, members);
  for (std::size_t i = 0; i < results.size(); ++i) ended(first[i], count[i], results[i], *runners[i].runs);
}

/// The runs of each row of the table.
Groups runs_of_rows(const options::Study& study) {
  const std::size_t axis = study.sensitivity->axis;
  Groups rows(study.axes[axis].length);
  for (std::size_t run = 0; run < study.runs(); ++run) rows[study.place(run, axis)].push_back(run);
  return rows;
}

/// The groups that contain unknown runs. A continued study computes whole groups again, so that its last digits equal
/// the digits of an uninterrupted study. A sweep's groups contain unknown runs only, the longest first, so that all
/// ranks end at about the same time.
Groups groups_of(StudyScenes& scenes, const std::vector<char>& known) {
  const bool sweep = scenes.study().sweep;
  if (scenes.only_greatest()) return runs_of_rows(scenes.study());
  Groups groups = scenes.groups(sweep ? known : std::vector<char>());
  std::erase_if(groups, [&](const std::vector<std::size_t>& group) {
    return std::all_of(group.begin(), group.end(), [&](std::size_t run) { return known[run] != 0; });
  });
  if (sweep)
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const auto& a, const auto& b) { return scenes.duration(a) > scenes.duration(b); });
  return groups;
}

ensemble::SharedWork work_of(StudyScenes& scenes, const Groups& groups, results::StudyTable& table,
                             ensemble::ResultGather& gather) {
  ensemble::SharedWork work;
  for (const std::vector<std::size_t>& group : groups) work.pieces.push_back({group.size(), scenes.duration(group)});
  const bool wheels = table.find("least_wheel_force") != nullptr;
  const bool greatest = scenes.only_greatest();
  work.compute = [&, wheels, greatest](std::size_t piece, const std::function<void(double)>& reached) {
    const auto ended = [&](std::size_t run, std::size_t runs, const ensemble::CaseResult& result,
                           const ensemble::CaseRunner& runner) {
      if (!result.ended) return;
      set_reasons(result, table);
      gather.send(row_of(run, runs, result, runner.probes(), wheels));
    };
    const auto progress = [&](double t) {
      reached(t);
      gather.collect();
    };
    if (greatest)
      run_greatest(scenes, groups[piece], progress, ended);
    else
      run_group(scenes, groups[piece], progress, ended);
    gather.collect();
  };
  work.name = [&](std::size_t piece) { return name_of(scenes.study(), groups[piece]); };
  return work;
}

using options::Study;
using results::StudyTable;

constexpr std::array peaks = {"peak_deflection", "peak_acceleration", "peak_moment", "greatest_wheel_force"};

/// The largest of a run's values in a column; NaN if the run has not ended.
double number_of(const StudyTable::Column& column, std::size_t run) {
  const auto begin = column.values.begin() + static_cast<std::ptrdiff_t>(run * column.width);
  return *std::max_element(begin, begin + static_cast<std::ptrdiff_t>(column.width));
}

/// The curve of each run and its position on it.
struct Curves {
  std::vector<std::string> names;
  std::vector<std::size_t> curve, place;  // for each run
};

/// Whether runs with different values on an axis belong to different curves.
bool separates_curves(const Study& study, std::size_t axis) {
  return axis != study.dimensions[study.speeds].axis &&
         std::find(study.over.begin(), study.over.end(), axis) == study.over.end();
}

/// " of A3" for a sweep, " at track_seed 5" for a study.
std::string curve_name(const Study& study, std::size_t run) {
  std::string name;
  if (study.sweep) {
    name = results::train_name(study, study.place(run, 0));
    return name.empty() ? name : " of " + name;
  }
  for (const options::StudyDimension& d : study.dimensions)
    if (separates_curves(study, d.axis))
      name += fmt::format("{} {} {:.6g}", name.empty() ? " at" : ",", d.name(), study.value(run, d));
  return name;
}

Curves sort_runs(const Study& study) {
  Curves curves;
  const options::StudyDimension& speeds = study.dimensions[study.speeds];
  const std::vector<double> sorted = ascending(study, study.speeds);
  std::map<std::vector<std::size_t>, std::size_t> known;
  for (std::size_t run = 0; run < study.runs(); ++run) {
    std::vector<std::size_t> at;
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis)
      if (separates_curves(study, axis)) at.push_back(study.place(run, axis));
    const auto [found, is_new] = known.try_emplace(at, curves.names.size());
    if (is_new) curves.names.push_back(curve_name(study, run));
    curves.curve.push_back(found->second);
    const double speed = study.value(run, speeds);
    curves.place.push_back(
        static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), speed) - sorted.begin()));
  }
  return curves;
}

/// The curves of a quantity over the speed. Each value is the greatest number(run) of the runs of that curve and speed.
template <class Number>
std::vector<SpeedCurve> curves_of_quantity(const Study& study, std::string quantity, Number number) {
  const Curves runs = sort_runs(study);
  std::vector<SpeedCurve> curves;
  std::replace(quantity.begin(), quantity.end(), '_', ' ');
  const std::size_t speeds = study.dimensions[study.speeds].values.size();
  for (const std::string& name : runs.names)
    curves.push_back({quantity + name, std::vector<double>(speeds, std::numeric_limits<double>::quiet_NaN())});
  for (std::size_t run = 0; run < study.runs(); ++run) {
    double& greatest = curves[runs.curve[run]].value[runs.place[run]];
    greatest = std::fmax(greatest, number(run));
  }
  return curves;
}

/// The curves of the quantity that limit number `l` is for.
std::vector<SpeedCurve> limited_curves(const StudyTable& table, std::size_t l) {
  const StudyTable::Column& limited = *table.find("judged");
  return curves_of_quantity(table.study(), table.limits()[l].quantity,
                            [&](std::size_t run) { return limited.values[run * limited.width + l]; });
}

}  // namespace

void compute_run(StudyScenes& scenes, std::size_t run, results::StudyTable& table) {
  const bool wheels = table.find("least_wheel_force") != nullptr;
  run_group(
      scenes, {run}, [](double) {},
      [&](std::size_t, std::size_t runs, const ensemble::CaseResult& result, const ensemble::CaseRunner& runner) {
        set_reasons(result, table);
        table.put(run, row_of(run, runs, result, runner.probes(), wheels).data() + 2, runs);
      });
}

ensemble::RunFailure compute_runs(MPI_Comm comm, StudyScenes& scenes, const std::vector<char>& known,
                                  results::StudyTable& table, const std::function<void()>& stored) {
  const results::Stage stage(scenes.study().sweep ? "runs of the sweep" : "runs of the study");
  ensemble::ResultGather gather(comm, [&](const std::vector<double>& row) {
    table.put(static_cast<std::size_t>(row[0]), row.data() + 2, static_cast<std::size_t>(row[1]));
    stored();
  });
  const Groups groups = groups_of(scenes, known);
  ensemble::RunFailure failure =
      ensemble::run_cases_in_parallel(comm, work_of(scenes, groups, table, gather), scenes.quiet());
  gather.finish();
  return ensemble::first_of(comm, std::move(failure));
}

std::vector<double> ascending(const Study& study, std::size_t dimension) {
  std::vector<double> values = study.dimensions[dimension].values;
  std::sort(values.begin(), values.end());
  return values;
}

std::vector<SpeedCurve> curves_of(const StudyTable& table) {
  std::vector<SpeedCurve> curves;
  const auto add = [&curves](const std::vector<SpeedCurve>& more) {
    curves.insert(curves.end(), more.begin(), more.end());
  };
  for (const char* peak : peaks)
    if (const StudyTable::Column* column = table.find(peak))
      if (column->width > 0)
        add(curves_of_quantity(table.study(), peak, [column](std::size_t run) { return number_of(*column, run); }));
  std::set<std::string> known;
  for (std::size_t l = 0; l < table.limits().size(); ++l) {
    const std::string& quantity = table.limits()[l].quantity;
    if (quantity != "contact_loss" && known.insert(quantity).second) add(limited_curves(table, l));
  }
  return curves;
}

std::vector<LimitedCurve> curves_below_limits(const StudyTable& table) {
  std::vector<LimitedCurve> below_limits;
  for (std::size_t l = 0; l < table.limits().size(); ++l) {
    const options::VerdictLimit& limit = table.limits()[l];
    if (limit.quantity == "contact_loss") continue;
    const std::vector<SpeedCurve> curves = limited_curves(table, l);
    const auto exceeds = [&](double value) { return value > limit.value; };
    if (std::any_of(curves.begin(), curves.end(),
                    [&](const SpeedCurve& curve) { return std::ranges::any_of(curve.value, exceeds); }))
      continue;
    for (const SpeedCurve& curve : curves) below_limits.push_back({curve, limit.value});
  }
  return below_limits;
}

Refinement next_speeds(const StudyTable& table, double width) {
  const std::vector<double> speeds = ascending(table.study(), table.study().speeds);
  return table.study().refine < 0.0 ? refine_for_limits(speeds, curves_below_limits(table), width)
                                    : refine(speeds, curves_of(table), table.study().refine);
}

Study with_values(Study study, std::size_t dimension, const std::vector<double>& added) {
  options::StudyDimension& extended = study.dimensions[dimension];
  extended.values.insert(extended.values.end(), added.begin(), added.end());
  std::sort(extended.values.begin(), extended.values.end());
  study.axes[extended.axis].length = extended.values.size();
  return study;
}

}  // namespace traverse::study
