// Computes a study or a sweep: choice of the numerical model, rounds of runs with added speeds, results.
#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/broadcast.hpp"
#include "base/notes.hpp"
#include "engine/processor.hpp"
#include "error_control/mode_search.hpp"
#include "results/sweep.hpp"
#include "results/terminal.hpp"
#include "run/deflection_check.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "study/find.hpp"
#include "study/prepared_study.hpp"
#include "study/study_file.hpp"
#include "study/study_runs.hpp"
#include "study/sweep_findings.hpp"
#include "traverse/options/input.hpp"

namespace traverse::study {

using options::Study;

namespace {

constexpr double max_listed = 5.0;      // a dimension with more values is not listed value by value
constexpr double long_duration = 10.0;  // s: estimated duration from which modes are suggested
constexpr double quicker_ratio = 0.2;   // relative duration that modes must not exceed to be suggested

/// "track_seed: 1000 values from 1 to 1000".
std::string description(const options::StudyDimension& d, bool of_design) {
  const auto [least, greatest] = std::minmax_element(d.values.begin(), d.values.end());
  if (d.law != "list")
    return fmt::format("{}: {} {} ({}) from {:g} to {:g}", d.name(), d.values.size(),
                       of_design ? "values of the design" : "draws", d.law, *least, *greatest);
  if (static_cast<double>(d.values.size()) > max_listed)
    return fmt::format("{}: {} values from {:g} to {:g}", d.name(), d.values.size(), *least, *greatest);
  std::string list;
  for (const double value : d.values) list += fmt::format("{}{:g}", list.empty() ? "" : ", ", value);
  return fmt::format("{}: {}", d.name(), list);
}

/// What the runs of one batch may differ in.
std::string differences(StudyScenes::Mixing mixing) {
  if (mixing == StudyScenes::Mixing::nothing) return "speed and track";
  if (mixing == StudyScenes::Mixing::vehicles) return "speed, track and vehicle parameters";
  return "speed, track and parameters of vehicles and bridge";
}

void describe_runs(const Study& study, std::vector<std::string>& notes) {
  if (study.sweep) {
    const std::vector<double>& speeds = results::speeds_of_sweep(study);
    const std::size_t trains = results::trains_of(study);
    notes.push_back(fmt::format(
        "sweep of {} runs: {} speed{} from {:g} to {:g} m/s, {} train{}; the values above are those of the first run",
        study.runs(), speeds.size(), speeds.size() == 1 ? "" : "s", speeds.front(), speeds.back(), trains,
        trains == 1 ? "" : "s"));
  } else {
    std::string axes;
    for (const Study::Axis& axis : study.axes)
      axes += fmt::format("{}{} of {}", axes.empty() ? "" : " times ", axis.length, axis.name);
    notes.push_back(
        fmt::format("study of {} runs ({}); the values above are those of the first run", study.runs(), axes));
    for (const options::StudyDimension& d : study.dimensions)
      notes.push_back(description(d, study.sensitivity.has_value()));
  }
}

/// Suggests modes for a sweep of `seconds` on all ranks if these are much faster.
void suggest_modes(const scene::Scene& scene, double seconds, int ranks, bool chosen, std::vector<std::string>& notes) {
  const std::optional<error_control::QuickerModes> quicker = error_control::quicker_modes(scene);
  if (!quicker || quicker->seconds >= quicker_ratio * seconds * ranks) return;
  notes.push_back(
      fmt::format("quicker: -model_modes {} (all modes up to {:.3g} Hz) would take about {}{}", quicker->modes,
                  quicker->frequency, results::duration_text(quicker->seconds / ranks),
                  scene.modes_open && !chosen
                      ? "; without ts_dt and a given number of elements, modes are chosen if they are accurate enough"
                      : ""));
}

/// Adds notes on the number of runs, their estimated duration and the way of computing them.
void describe(const scene::Scene& scene, StudyScenes& scenes, const results::RunModel& model, std::size_t known,
              int ranks, std::vector<std::string>& notes) {
  const Study& study = scenes.study();
  const ensemble::CaseRunner& first = *scenes.runner(0).runs;
  describe_runs(study, notes);
  if (known > 0)
    notes.push_back(fmt::format("{} of them are read from the existing results file", known));
  else if (study.resume)
    notes.push_back(fmt::format("study_resume: {} contains no finished run of this study", scene.output.file));
  if (first.has_lanes())
    notes.push_back(base::detail(
        fmt::format("up to {} runs{} are advanced together, one in each lane of {} vectors", first.width(),
                    study.sweep ? "" : fmt::format(" that differ in {} only", differences(scenes.mixing())),
                    engine::instructions())));
  else if (!first.why_not_in_batches().empty() && !scene.vehicles.empty())
    notes.push_back("runs are computed one by one: " + first.why_not_in_batches());
  if (study.find) notes.emplace_back("values of the option are added until all ends of its intervals are known");
  if (study.refine > 0.0)
    notes.push_back(
        fmt::format("speeds are added until the error of the peaks over the speed is below {:g}", study.refine));
  if (study.refine < 0.0)
    notes.emplace_back(
        "speeds are added where a limit may be exceeded between two of them; -sweep_refine 1e-2 resolves every peak, "
        "0 adds none");
  double motion = 0.0;
  for (const StudyRun& run : scenes.runs()) motion += first.duration(run.train, run.own.speed);
  const double rows = static_cast<double>(results::rows_of(study).runs());
  const double part = (rows - static_cast<double>(known)) / rows;
  const double seconds = part * first.cost() * motion / ranks;
  const bool has_cost = std::isfinite(seconds);
  const bool by_bounds = scenes.only_greatest();
  notes.push_back(fmt::format("the {} is computed {}{}{}{}", study.sweep ? "sweep" : "study", results::method_of(model),
                              has_cost ? "; estimated time " : "", has_cost && by_bounds ? "at most " : "",
                              has_cost ? results::duration_text(seconds) : ""));
  if (by_bounds)
    notes.emplace_back(
        "only the greatest peaks over all options that are no factors are needed; bounds exclude the runs without one");
  if (ranks > 1) notes.push_back(base::detail(fmt::format("{} ranks share the runs by a common queue", ranks)));
  if (study.sweep && has_cost && seconds >= long_duration)
    suggest_modes(scene, seconds, ranks, model.accuracy > 0.0, notes);
}

std::size_t max_values_of(const Study& study, std::size_t given) {
  return study.refine < 0.0 ? max_speeds_by_default(given) : max_speeds(given);
}

/// The dimension whose values are added in rounds.
std::size_t extended_dimension(const Study& study) { return study.find ? study.find->dimension : study.speeds; }
bool adds_values(const Study& study) { return study.find || study.refine != 0.0; }

/// Rounds of runs; each round has the speeds, or the values of a search, of the round before and added ones.
class Rounds {
 public:
  /// width: width of a resonance, relative to the speed.
  Rounds(MPI_Comm comm, const scene::Scene& scene, StudyScenes& scenes, const results::RunModel& model, double width,
         results::StoredStudy stored, const std::vector<std::string>& notes)
      : comm_(comm),
        scene_(scene),
        scenes_(scenes),
        model_(model),
        width_(width),
        stored_(std::move(stored)),
        notes_(notes),
        given_(ascending(scenes.study(), extended_dimension(scenes.study()))) {
    begin(scenes.study());
  }

  /// Collective. Further values of the extended dimension for the first round.
  void add(const std::vector<double>& values) {
    if (!values.empty()) begin(with_values(scenes_.study(), extended_dimension(scenes_.study()), values));
  }
  /// Collective. Copies the results of earlier runs from the file and returns their number. The first round has the
  /// values that an interrupted study has added: the file always contains all known runs.
  std::size_t copy_stored() {
    if (scenes_.study().sensitivity) return 0;  // its file has no single runs
    if (adds_values(scenes_.study())) add(base::broadcast(comm_, added_before()));
    known_ = copy_known(comm_, stored_, *table_);
    return static_cast<std::size_t>(std::count(known_.begin(), known_.end(), 1));
  }
  /// Collective. InputError if the study is a search and neither its first nor its last run determines its quantities.
  void check_search() {
    if (!scenes_.study().find) return;
    int rank = 0;
    MPI_Comm_rank(comm_, &rank);
    const std::string why = base::broadcast(comm_, rank == 0 ? undetermined_in_first_and_last() : "");
    if (!why.empty()) throw InputError(why);
  }
  /// Collective. Computes all rounds and leaves their file open.
  ensemble::RunFailure run(results::Place place, StudyCourse& course) {
    course.known = std::count(known_.begin(), known_.end(), 1);
    while (true) {
      file_.emplace(comm_, std::move(place), scene_, model_, *table_, notes_);
      ensemble::RunFailure failure = compute_runs(comm_, scenes_, known_, *table_, [this] { file_->update(); });
      if (!adds_values(scenes_.study())) return failure;
      const bool ends = failure.failed() || run::signal_on_any(comm_) != 0;
      const std::vector<double> more = ends ? std::vector<double>() : next();
      if (more.empty()) {
        if (scenes_.study().find) return failure;
        for (const double speed : ascending(scenes_.study(), scenes_.study().speeds))
          refined_.added.push_back(std::binary_search(given_.begin(), given_.end(), speed) ? 0.0 : 1.0);
        course.refined = std::move(refined_);
        return failure;
      }
      const results::StoredStudy last = stored_of(*table_);
      begin(with_values(scenes_.study(), extended_dimension(scenes_.study()), more));
      const std::vector<char> before = copy_known(comm_, last, *table_);
      known_ = copy_known(comm_, stored_, *table_);
      course.known += std::count(known_.begin(), known_.end(), 1) - std::count(before.begin(), before.end(), 1);
      file_.reset();
      place = results::claim_place(comm_, scene_.output.file);
    }
  }
  const results::StudyTable& table() const { return *table_; }
  StudyFile& file() { return *file_; }

 private:
  void begin(const Study& study) {
    scenes_.enumerate(study);
    rows_ = results::rows_of(study);
    const Study* const all = study.sensitivity ? &scenes_.study() : nullptr;
    table_.emplace(rows_, scene_.output.probes.size(), has_wheels(scene_), scene_.limits, all);
    known_.assign(scenes_.study().runs(), 0);
  }
  /// Collective. The speeds or searched values to be added, by the table of rank 0. Empty: the results are known well
  /// enough, or the number of values would exceed its limit.
  std::vector<double> next() {
    const Study& study = scenes_.study();
    int rank = 0;
    MPI_Comm_rank(comm_, &rank);
    std::vector<double> values;
    if (rank == 0) {
      values = study.find ? values_to_add(*table_) : speeds_to_add();
      const std::size_t known = study.dimensions[extended_dimension(study)].values.size();
      if (known + values.size() > max_values_of(study, given_.size())) values.clear();
    }
    return base::broadcast(comm_, std::move(values));
  }
  /// On rank 0: the values of finished runs of the file that are between the given ones.
  std::vector<double> added_before() const {
    const auto finished = stored_.datasets.find("finished");
    if (finished == stored_.datasets.end()) return {};
    const Study& study = scenes_.study();
    const std::vector<double>& all = stored_.datasets.at(study.dimensions[extended_dimension(study)].name());
    std::set<double> added;
    for (std::size_t run = 0; run < all.size(); ++run)
      if (finished->second[run] == 1.0 && all[run] > given_.front() && all[run] < given_.back()) added.insert(all[run]);
    for (const double value : given_) added.erase(value);
    return {added.begin(), added.end()};
  }
  std::string undetermined_in_first_and_last() {
    results::StudyTable tried = *table_;
    try {
      for (const std::size_t run : {std::size_t{0}, tried.runs() - 1}) compute_run(scenes_, run, tried);
    } catch (const Error&) {
      return "";  // the search itself reports the failure
    }
    return undetermined(tried);
  }
  std::vector<double> speeds_to_add() {
    Refinement found = next_speeds(*table_, width_);
    refined_.wanted = std::max(scenes_.study().refine, 0.0);
    refined_.uncertainty = found.uncertainty;
    refined_.curve = found.curve;
    return found.speeds;
  }

  MPI_Comm comm_;
  const scene::Scene& scene_;
  StudyScenes& scenes_;
  const results::RunModel& model_;
  double width_;
  results::StoredStudy stored_;  // runs of an earlier, interrupted study
  const std::vector<std::string>& notes_;
  std::vector<double> given_;  // first values of the extended dimension, ascending
  Study rows_;                 // of the table
  std::optional<results::StudyTable> table_;
  std::vector<char> known_;  // 1 for each run whose results are known
  std::optional<StudyFile> file_;
  results::Refined refined_;
};

/// Collective. The largest deflection of all runs, m.
double largest_deflection(MPI_Comm comm, const results::StudyTable& table) {
  double deflection = 0.0;
  if (results::StudyPlace largest; find_extreme(table, "peak_deflection", true, largest)) deflection = largest.value;
  MPI_Bcast(&deflection, 1, MPI_DOUBLE, 0, comm);
  return deflection;
}

}  // namespace

int run_study(MPI_Comm comm, const scene::Scene& given, results::Place place) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  PreparedStudy prepared(comm, given);
  StudyScenes& scenes = prepared.scenes;
  std::vector<std::string>& notes = prepared.notes;
  const scene::Scene& scene = prepared.scene;
  const results::RunModel& model = prepared.model;
  notes.insert(notes.end(), given.notes.begin(), given.notes.end());
  for (const std::string& note : options::notes_on_unused(*given.given)) notes.push_back(note);
  std::optional<SweepFindings> findings;
  if (scenes.study().sweep) findings.emplace(scene, *prepared.first);
  SweepFindings* const found = findings ? &*findings : nullptr;
  Rounds rounds(comm, findings ? scene : given, scenes, model, findings ? findings->width_of_resonance() : 0.0,
                stored_of(comm, given, model), notes);
  const std::size_t known = rounds.copy_stored();
  if (known == 0) rounds.check_search();
  describe(scene, scenes, model, known, ranks, notes);
  run::print_notes(comm, given, notes);
  if (findings && scenes.study().refine > 0.0) rounds.add(findings->unresolved_speeds());

  const run::DeferredSignals noted;
  const auto begin = std::chrono::steady_clock::now();
  StudyCourse course;
  const ensemble::RunFailure failure = rounds.run(std::move(place), course);
  const int signal = run::signal_on_any(comm);
  course.separate_runs = scenes.separate_runs();
  MPI_Allreduce(MPI_IN_PLACE, &course.separate_runs, 1, MPI_LONG, MPI_SUM, comm);
  course.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  course.ended = failure.failed() ? failure.message
                 : signal != 0    ? fmt::format("ended by signal {}", signal)
                                  : "reached its end";
  const results::StudyTable& table = rounds.table();
  // A search has runs on both sides of each limit; its answer is not a verdict.
  std::vector<results::Verdict> verdicts = table.study().find ? std::vector<results::Verdict>() : table.verdicts();
  if (rank == 0 && findings) {
    findings->finish(table);
    findings->add_to(verdicts);
  }
  try {
    rounds.file().finish(course, verdicts, found);
  } catch (const FileError& error) {
    run::leave_together(comm, error);
  }
  if (rank == 0) print_study_course(table, model, course, verdicts, found, given);
  if (failure.failed()) throw Error(failure.message, failure.status);
  if (table.study().find && signal == 0) check_answers(comm, table);
  run::check_deflection(comm, given, largest_deflection(comm, table));
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace traverse::study
