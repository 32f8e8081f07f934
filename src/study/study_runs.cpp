// Distributes groups of runs over the ranks, computes compatible runs in batches and stores their results.
#include "study/study_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

}  // namespace traverse::study
