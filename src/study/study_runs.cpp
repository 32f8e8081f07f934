// Deals groups of runs, computes each side by side as far as it can be, and hands their numbers in.
#include "study/study_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ensemble/result_gather.hpp"
#include "results/stage.hpp"
#include "results/sweep.hpp"

namespace traverse::app {
namespace {

using Groups = std::vector<std::vector<std::size_t>>;

/// A run's numbers in the order of the table, with its index before them.
std::vector<double> row_of(std::size_t run, const CaseResult& result, const std::vector<double>& probes, bool wheels) {
  std::vector<double> row = {static_cast<double>(run)};
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
  row.push_back(result.unseen ? 1.0 : 0.0);
  for (const results::EvaluatedQuantity& finding : result.findings) row.push_back(finding.value);
  for (const results::EvaluatedQuantity& finding : result.findings) row.push_back(finding.x);
  return row;
}

/// Of a sweep: "one of the runs of train A3 at 50 to 60 m/s (180 to 216 km/h)".
std::string name_in_sweep(const Study& study, const std::vector<std::size_t>& group) {
  const auto speed = [&](std::size_t run) { return study.value(run, study.dimensions[study.speeds]); };
  const double from = speed(group.front()), to = speed(group.back());
  const std::string name = results::train_name(study, study.place(group.front(), 0));
  const std::string train = name.empty() ? "" : " of train " + name;
  if (group.size() == 1) return fmt::format("the run{} at {:g} m/s ({:g} km/h)", train, from, 3.6 * from);
  return fmt::format("one of the runs{} at {:g} to {:g} m/s ({:g} to {:g} km/h)", train, from, to, 3.6 * from,
                     3.6 * to);
}

std::string name_of(const Study& study, const std::vector<std::size_t>& group) {
  if (study.sweep) return name_in_sweep(study, group);
  if (group.size() == 1) return fmt::format("the run at {}", results::point_text(study, group.front()));
  return fmt::format("one of the runs from {} to {}", results::point_text(study, group.front()),
                     results::point_text(study, group.back()));
}

/// The runs of a group: side by side as far as they can be, the others by themselves.
void run_group(StudyScenes& scenes, const std::vector<std::size_t>& group, const std::function<void(double)>& reached,
               const std::function<void(std::size_t, const CaseResult&, const CaseRunner&)>& ended) {
  std::vector<StudyScenes::Runner> runners;  // which stay as long as their runs
  for (const std::size_t run : group) runners.push_back(scenes.runner(scenes.runs()[run].base));
  std::vector<char> done(group.size(), 0);
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (done[i] != 0) continue;
    std::vector<CaseRunner::Member> members;
    std::vector<std::size_t> places;
    for (std::size_t j = i; j < group.size(); ++j) {
      if (done[j] != 0 || !scenes.beside(runners[j], runners[i])) continue;
      members.push_back({runners[j].runs.get(), scenes.runs()[group[j]].own});
      places.push_back(j);
      done[j] = 1;
    }
    const std::vector<CaseResult> results = CaseRunner::run_together(scenes.runs()[group[i]].train, members, reached);
    for (std::size_t j = 0; j < results.size(); ++j) ended(group[places[j]], results[j], *runners[places[j]].runs);
  }
}

/// Groups of runs that are not known. A study that goes on computes whole groups again, so that its last digits are
/// those of one that was not stopped. A sweep's groups have new runs only, the longest first, so that no rank ends long
/// after the others.
Groups groups_of(StudyScenes& scenes, const std::vector<char>& known) {
  const bool sweep = scenes.study().sweep;
  Groups groups = scenes.groups(scenes.runner(0).runs->width(), sweep ? known : std::vector<char>());
  std::erase_if(groups, [&](const std::vector<std::size_t>& group) {
    return std::all_of(group.begin(), group.end(), [&](std::size_t run) { return known[run] != 0; });
  });
  if (sweep)
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const auto& a, const auto& b) { return scenes.duration(a) > scenes.duration(b); });
  return groups;
}

SharedWork work_of(StudyScenes& scenes, const Groups& groups, results::StudyTable& table, ResultGather& returns) {
  SharedWork work;
  for (const std::vector<std::size_t>& group : groups) work.pieces.push_back({group.size(), scenes.duration(group)});
  const bool wheels = table.find("least_wheel_force") != nullptr;
  work.take = [&, wheels](std::size_t piece, const std::function<void(double)>& reached) {
    run_group(
        scenes, groups[piece],
        [&](double t) {
          reached(t);
          returns.collect();
        },
        [&](std::size_t run, const CaseResult& result, const CaseRunner& runner) {
          if (!result.ended) return;
          for (std::size_t l = 0; l < result.findings.size(); ++l)
            if (std::isnan(result.findings[l].value)) table.give_reason(l, result.findings[l].why);
          returns.send(row_of(run, result, runner.probes(), wheels));
        });
    returns.collect();
  };
  work.name = [&](std::size_t piece) { return name_of(scenes.study(), groups[piece]); };
  return work;
}

}  // namespace

RunFailure compute_runs(MPI_Comm comm, StudyScenes& scenes, const std::vector<char>& known, results::StudyTable& table,
                        StudyFile& file) {
  const results::Stage stage(scenes.study().sweep ? "runs of the sweep" : "runs of the study");
  ResultGather returns(comm, [&](const std::vector<double>& row) {
    table.put(static_cast<std::size_t>(row.front()), row.data() + 1);
    file.update();
  });
  const Groups groups = groups_of(scenes, known);
  RunFailure failure = run_cases_in_parallel(comm, work_of(scenes, groups, table, returns), scenes.quiet());
  returns.finish();
  return first_of(comm, std::move(failure));
}

}  // namespace traverse::app
