#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "accuracy/kept_choice.hpp"
#include "engine/processor.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/deflection_check.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/signals.hpp"
#include "share_runs.hpp"
#include "study/returns.hpp"
#include "study/study_choice.hpp"
#include "study/study_file.hpp"
#include "study/study_refinement.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double most_told = 5.0;  // values of a dimension that are listed one by one

/// "track_seed: 1000 values from 1 to 1000".
std::string words_of(const StudyDimension& d) {
  const auto [least, greatest] = std::minmax_element(d.values.begin(), d.values.end());
  if (d.law != "list")
    return fmt::format("{}: {} draws ({}) from {:g} to {:g}", d.name(), d.values.size(), d.law, *least, *greatest);
  if (static_cast<double>(d.values.size()) > most_told)
    return fmt::format("{}: {} values from {:g} to {:g}", d.name(), d.values.size(), *least, *greatest);
  std::string list;
  for (const double value : d.values) list += fmt::format("{}{:g}", list.empty() ? "" : ", ", value);
  return fmt::format("{}: {}", d.name(), list);
}

/// How many runs, what they will take, and how they go.
void announce(const StudyScenes& scenes, const CaseRunner& first, const results::Sweep::Model& model, std::size_t known,
              int ranks, std::vector<std::string>& notes) {
  const std::size_t runs = scenes.runs().size();
  std::string axes;
  for (const Study::Axis& axis : scenes.study().axes)
    axes += fmt::format("{}{} of {}", axes.empty() ? "" : " times ", axis.length, axis.name);
  notes.push_back(fmt::format("study of {} runs ({}); above for the first one", runs, axes));
  for (const StudyDimension& d : scenes.study().dimensions) notes.push_back(words_of(d));
  if (known > 0) notes.push_back(fmt::format("{} of them are known from the results file that was there", known));
  if (first.has_lanes())
    notes.push_back(fmt::format("up to {} runs that differ in {} alone go side by side, in the lanes of {} vectors",
                                first.width(),
                                scenes.mixes(first.width()) ? "speed, track and vehicles' numbers" : "speed and track",
                                engine::instructions()));
  else if (!first.why_no_lanes().empty())
    notes.push_back("runs go one by one: " + first.why_no_lanes());
  if (scenes.study().refine > 0.0)
    notes.push_back(
        fmt::format("speeds are added until the peaks over the speed are known to {:g}", scenes.study().refine));
  double motion = 0.0;
  for (const StudyRun& run : scenes.runs()) motion += first.duration(0, run.own.speed);
  const double part = static_cast<double>(runs - known) / static_cast<double>(runs);
  const bool told = model.modes > 0 || model.time_step > 0.0;
  notes.push_back(fmt::format(
      "the study is {}{}", results::method_of(model),
      told ? ", which will take about " + results::duration_text(part * first.cost() * motion / ranks) : ""));
  if (ranks > 1)
    notes.push_back(fmt::format("{} ranks share the runs, each takes the next one when it is free", ranks));
}

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
  for (const results::Finding& finding : result.findings) row.push_back(finding.value);
  for (const results::Finding& finding : result.findings) row.push_back(finding.x);
  return row;
}

std::string name_of(const Study& study, const std::vector<std::size_t>& group) {
  if (group.size() == 1) return fmt::format("the run at {}", results::point_text(study, group.front()));
  return fmt::format("one of the runs from {} to {}", results::point_text(study, group.front()),
                     results::point_text(study, group.back()));
}

/// The runs of a group: side by side as far as they can be, the others by themselves.
void run_pieces(StudyScenes& scenes, const std::vector<std::size_t>& group, const std::function<void(double)>& reached,
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
    const std::vector<CaseResult> results = CaseRunner::run_together(0, members, reached);
    for (std::size_t j = 0; j < results.size(); ++j) ended(group[places[j]], results[j], *runners[places[j]].runs);
  }
}

/// Computes groups of runs and hands their numbers in.
SharedWork study_work(StudyScenes& scenes, const std::vector<std::vector<std::size_t>>& groups, bool wheels,
                      Returns& returns) {
  SharedWork work;
  const CaseRunner& first = *scenes.runner(0).runs;
  for (const std::vector<std::size_t>& group : groups) {
    double duration = 0.0;
    for (const std::size_t run : group) duration += first.duration(0, scenes.runs()[run].own.speed);
    work.pieces.push_back({group.size(), duration});
  }
  work.take = [&, wheels](std::size_t piece, const std::function<void(double)>& reached) {
    const std::vector<std::size_t>& group = groups[piece];
    run_pieces(
        scenes, group,
        [&](double t) {
          reached(t);
          returns.collect();
        },
        [&](std::size_t run, const CaseResult& result, const CaseRunner& runner) {
          if (result.ended) returns.send(row_of(run, result, runner.probes(), wheels));
        });
    returns.collect();
  };
  work.name = [&](std::size_t piece) { return name_of(scenes.study(), groups[piece]); };
  return work;
}

bool has_wheels(const Scene& scene) {
  return std::any_of(scene.vehicles.begin(), scene.vehicles.end(), [](const Vehicle& v) { return !v.wheels.empty(); });
}

/// Runs that are not known yet, in their groups.
std::vector<std::vector<std::size_t>> unknown_of(std::vector<std::vector<std::size_t>> groups,
                                                 const std::vector<char>& known) {
  std::erase_if(groups, [&](const std::vector<std::size_t>& group) {
    return std::all_of(group.begin(), group.end(), [&](std::size_t run) { return known[run] != 0; });
  });
  return groups;
}

/// Collective. Computes the groups and stores their numbers as they come. The failure of the earliest one.
RunFailure compute(MPI_Comm comm, StudyScenes& scenes, const std::vector<std::vector<std::size_t>>& groups,
                   results::StudyTable& table, StudyFile& file) {
  const results::Stage stage("runs of the study");
  Returns returns(comm, [&](const std::vector<double>& row) {
    table.put(static_cast<std::size_t>(row.front()), row.data() + 1);
    file.update();
  });
  const bool wheels = table.find("least_wheel_force") != nullptr;
  RunFailure failure = share_runs(comm, study_work(scenes, groups, wheels, returns), scenes.quiet());
  returns.finish();
  return first_of(comm, std::move(failure));
}

/// What is run together: the scene, whose study has more speeds from round to round.
struct Round {
  explicit Round(Scene with)
      : scene(std::move(with)),
        scenes(scene),
        table(*scene.study, scene.output.probes.size(), has_wheels(scene), scene.limits) {}

  const Scene scene;
  StudyScenes scenes;
  results::StudyTable table;
};

/// Collective. The next speeds, as rank 0 knows the peaks; none: they are known well enough, or these are too many.
std::vector<double> next_speeds(MPI_Comm comm, const Round& round, std::size_t most, results::Refined& refined) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::vector<double> next;
  if (rank == 0) {
    const std::vector<double> speeds = speeds_of(*round.scene.study);
    const Refinement found = refine(speeds, curves_of(round.table), refined.wanted);
    refined.uncertainty = found.uncertainty;
    refined.curve = found.curve;
    if (speeds.size() + found.speeds.size() <= most) next = found.speeds;
  }
  int size = static_cast<int>(next.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  next.resize(static_cast<std::size_t>(size));
  MPI_Bcast(next.data(), size, MPI_DOUBLE, 0, comm);
  return next;
}

/// Collective. Rounds of runs; the last one, with all runs of those before it, is left in `round`, its file in `file`.
class Rounds {
 public:
  Rounds(MPI_Comm comm, const NumericalModel& model, const results::Sweep::Model& as_stored,
         results::StoredStudy stored, const std::vector<std::string>& notes)
      : comm_(comm), model_(model), as_stored_(as_stored), stored_(std::move(stored)), notes_(notes) {}

  RunFailure run(std::unique_ptr<Round>& round, std::vector<char> known, results::Place place,
                 std::optional<StudyFile>& file, StudyCourse& course) {
    course.known = std::count(known.begin(), known.end(), 1);
    const std::vector<double> given =
        round->scene.study->refine > 0.0 ? speeds_of(*round->scene.study) : std::vector<double>();
    results::Refined refined;
    refined.wanted = round->scene.study->refine;
    while (true) {
      file.emplace(comm_, std::move(place), round->scene, as_stored_, round->table, notes_);
      const std::size_t width = round->scenes.runner(0).runs->width();
      RunFailure failure =
          compute(comm_, round->scenes, unknown_of(round->scenes.groups(width), known), round->table, *file);
      course.left_group += round->scenes.alone();
      if (refined.wanted == 0.0) return failure;
      const bool ends = failure.failed() || signal_on_any(comm_) != 0;
      const std::vector<double> next =
          ends ? std::vector<double>() : next_speeds(comm_, *round, most_speeds(given.size()), refined);
      if (next.empty()) {
        for (const double speed : speeds_of(*round->scene.study))
          refined.added.push_back(std::binary_search(given.begin(), given.end(), speed) ? 0.0 : 1.0);
        course.refined = std::move(refined);
        return failure;
      }
      Scene scene = round->scene;
      scene.study = with_speeds(*scene.study, next);
      auto more = std::make_unique<Round>(std::move(scene));
      more->scenes.choose(model_);
      const std::vector<char> before = take_known(comm_, stored_of(round->table), more->table);
      known = take_known(comm_, stored_, more->table);
      course.known += std::count(known.begin(), known.end(), 1) - std::count(before.begin(), before.end(), 1);
      file.reset();
      place = results::claim_place(comm_, round->scene.output.file);
      round = std::move(more);
    }
  }

 private:
  MPI_Comm comm_;
  const NumericalModel& model_;
  const results::Sweep::Model& as_stored_;
  results::StoredStudy stored_;  // by a run before this one
  const std::vector<std::string>& notes_;
};

}  // namespace

int run_study(MPI_Comm comm, const Scene& given, results::Place place) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  auto round = std::make_unique<Round>(given);
  StudyScenes& scenes = round->scenes;
  for (const std::size_t base : scenes.extreme_bases()) scenes.base(base);  // all input is checked first
  std::vector<std::string> notes;
  Choice choice;
  KeptChoice kept(comm, given);
  if (!kept.read(given, notes, choice)) {
    choice = choose_for_study(scenes, notes);
    if (choice.accuracy.measured) kept.write(notes, choice);
  }
  scenes.choose(choice.model);
  const results::Sweep::Model model =
      stored_model(with(scenes.base(scenes.extreme_bases().front()), choice.model), choice.accuracy);
  const CaseRunner& first = *scenes.runner(0, &notes).runs;
  notes.insert(notes.end(), given.notes.begin(), given.notes.end());
  for (const std::string& note : options::notes_on_unused(options::in_force())) notes.push_back(note);
  results::StoredStudy stored = stored_of(comm, given, model);
  const std::vector<char> known = take_known(comm, stored, round->table);
  announce(scenes, first, model, round->table.finished_runs(), ranks, notes);
  print_notes(comm, notes);

  const SignalsNoted noted;
  const auto begin = std::chrono::steady_clock::now();
  StudyCourse course;
  std::optional<StudyFile> file;
  const RunFailure failure =
      Rounds(comm, choice.model, model, std::move(stored), notes).run(round, known, std::move(place), file, course);
  const int signal = signal_on_any(comm);
  MPI_Allreduce(MPI_IN_PLACE, &course.left_group, 1, MPI_LONG, MPI_SUM, comm);
  course.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  course.ended = failure.failed() ? failure.message
                 : signal != 0    ? fmt::format("ended by signal {}", signal)
                                  : "reached its end";
  try {
    file->finish(course);
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  const results::StudyTable& table = round->table;
  if (rank == 0) print_study_course(table, model, course, given);
  if (failure.failed()) throw Error(failure.message, failure.status);
  double deflection = 0.0;
  if (results::StudyPlace largest; find_extreme(table, "peak_deflection", true, largest)) deflection = largest.value;
  MPI_Bcast(&deflection, 1, MPI_DOUBLE, 0, comm);
  check_deflection(comm, given, deflection);
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace traverse::app
