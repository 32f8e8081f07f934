// One run in time from its start to its summary: the static equilibrium or the state of a checkpoint, steps with
// recording, checkpoints and signals, then the energy check, the verdicts on limits and the comparison with EN 1991-2.
// The run is repeated if the linear vehicles or the selected time step were not accurate enough.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "analyses.hpp"
#include "base/archive.hpp"
#include "prepare.hpp"
#include "results/recorder.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/checkpoints.hpp"
#include "run/deflection_check.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/simulation.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

/// Whether a run must be repeated, and how. mechanisms: the residual of linear vehicles exceeded
/// NumericalModel::residual_limit; shorter_steps: StepTooLong was thrown; finer: the errors were not within the
/// accuracy.
enum class Retry { none, mechanisms, shorter_steps, finer };

struct RunEnd {
  int status = 0;  // exit status of the program if the run is not repeated
  Retry again = Retry::none;
  std::string why;    // message of StepTooLong, for shorter_steps
  double step = 0.0;  // s, longest computed time step, for shorter_steps
};

/// A run at its start: the input is checked, the notes are printed, and no motion is computed yet.
struct ReadyRun {
  /// Collective. The job must outlive this object. Throws InputError if the job cannot be run. Prints the notes.
  explicit ReadyRun(Job& given);

  bool is_continued() const { return job.earlier != nullptr; }
  void reject_unfiltered() {
    if (counting > 0.0 && !simulation.evaluation().filters_deck()) accuracy.estimates[run::low_passed].accepted = false;
  }

  Job& job;
  int rank = 0;
  scene::Scene scene;
  error_control::Accuracy accuracy;
  double counting;                                  // Hz, cut-off frequency of deck accelerations; 0: no filter
  std::optional<run::Plan> earlier;                 // plan of the run that this run continues
  std::unique_ptr<coupling::TrainSharing> sharing;  // until the simulation has it; null: no other ranks
  run::Simulation simulation;
};

ReadyRun::ReadyRun(Job& given)
    : job(given),
      scene(given.scene),
      accuracy(given.accuracy),
      counting(prepare(scene, accuracy, given.beam, given.notes)),
      earlier(given.earlier == nullptr ? std::nullopt
                                       : std::optional(run::Plan{0.0, given.earlier->time_step, given.earlier->interval,
                                                                 given.earlier->stored})),
      sharing(run::call_to_share(given.waiting, scene)),
      simulation(scene, given.beam,
                 {.stored = true,
                  .limits = !scene.limits.empty(),
                  .wheel_filter = true,
                  .deck_cutoff = counting,
                  .filter_on_all = given.open != nullptr},
                 given.notes, earlier ? &*earlier : nullptr) {
  MPI_Comm_rank(job.comm, &rank);
  if (earlier && scene.model.step && earlier->time_step < *scene.model.step) {
    accuracy.reject_all();
    job.open = nullptr;
  }
  if (is_continued() && !(simulation.plan().end_time > job.earlier->time))
    throw InputError(fmt::format("restart: the run has come to {:g} s already, its end is at {:g} s", job.earlier->time,
                                 simulation.plan().end_time));
  simulation.system().share_trains(std::move(sharing));
  for (const std::string& note : options::notes_on_unused(*scene.given)) job.notes.push_back(note);
  reject_unfiltered();
  if (is_continued()) {
    base::Archive archive(job.comm, job.earlier->of_ranks);
    simulation.keep(archive);
    if (simulation.passage().stopped_at_limit())
      throw InputError(
          fmt::format("restart: the run has taken {} steps already, which is the limit of ts_max_steps; "
                      "raise it or leave it out",
                      simulation.passage().steps()));
    job.notes.push_back(fmt::format("goes on from t = {:g} s", job.earlier->time));
  }
  run::print_notes(job.comm, scene, job.notes);
}

/// Creates the results file, or opens the file of the run that this run continues.
results::Recorder recorder_of(ReadyRun& ready, const run::Outputs& outputs) {
  Job& job = ready.job;
  results::Layout layout = outputs.layout();
  const run::Plan& plan = ready.simulation.plan();
  if (ready.scene.analysis != options::Analysis::static_response) {
    layout.interval = plan.interval * static_cast<double>(plan.stored);
    layout.rows = static_cast<std::size_t>(plan.end_time / layout.interval) + 2;
  }
  if (ready.is_continued()) return {job.comm, std::move(job.place), layout, job.earlier->results};
  results::Recorder recorder(job.comm, std::move(job.place), layout, run::attributes(job.comm, ready.scene),
                             ready.scene.options);
  recorder.of_scene(run::digest_of(ready.scene));
  run::record_model(ready.scene, job.open == nullptr ? job.notes : std::vector<std::string>(), recorder);
  run::record_modes(job.beam, recorder);
  return recorder;
}

/// The checkpoint of the run that this run continues, or a checkpoint at the start.
results::Checkpoint so_far(const Job& job, results::Repeated repeated) {
  results::Checkpoint checkpoint;
  if (job.earlier != nullptr) checkpoint = *job.earlier;
  MPI_Comm_size(PETSC_COMM_WORLD, &checkpoint.given_ranks);
  checkpoint.repeated = repeated;
  return checkpoint;
}

/// A run in time that is recorded, with checkpoints and a display of its progress.
class RecordedRun : private run::Observer {
 public:
  RecordedRun(ReadyRun& ready, results::Repeated repeated, bool may_shorten);
  RunEnd run();

 private:
  using Clock = std::chrono::steady_clock;
  void sample(const integrate::Instant& instant) override;
  bool step(double t, long steps) override;
  void before_step(double t) override;
  void summarise(const std::string& ended);
  void find_errors();
  std::optional<norm::NormCheck> judge_by_norm(std::vector<results::Verdict>& verdicts);
  void print_notes_of_run(bool has_checkpoint) const;
  double wall_seconds() const { return before_ + std::chrono::duration<double>(Clock::now() - begin_).count(); }
  bool prints() const { return ready_.rank == 0; }

  ReadyRun& ready_;
  const scene::Scene& scene_;
  bool may_shorten_;  // whether the run may be repeated with shorter steps after StepTooLong
  run::Simulation& simulation_;
  coupling::System& system_;
  std::optional<run::DeferredSignals> noted_{
      std::in_place};  // signals are delayed from here on, so that the file remains readable
  run::Outputs outputs_;
  results::Recorder recorder_;
  results::Sample sample_;
  run::Checkpoints checkpoints_;
  double before_, reached_;  // s: wall time of the continued run; simulated time reached so far
  results::Progress progress_;
  Clock::time_point begin_ = Clock::now();
  run::Requests asked_;
  bool reaches_end_ = false;
  bool repeated_ = false;            // the run is repeated with shorter steps
  bool finer_ = false;               // the run is repeated with a finer model
  std::vector<std::string> errors_;  // in words, if the run is the last one of its search
  run::Result result_;
};

RecordedRun::RecordedRun(ReadyRun& ready, results::Repeated repeated, bool may_shorten)
    : ready_(ready),
      scene_(ready.scene),
      may_shorten_(may_shorten),
      simulation_(ready.simulation),
      system_(simulation_.system()),
      outputs_(run::outputs_of({scene_, system_.fleet(), ready.job.beam.bridge()})),
      recorder_(recorder_of(ready, outputs_)),
      checkpoints_(ready.job.comm, scene_, simulation_, recorder_, so_far(ready.job, repeated)),
      before_(ready.is_continued() ? ready.job.earlier->wall_seconds : 0.0),
      reached_(ready.is_continued() ? ready.job.earlier->time : 0.0),
      progress_(reached_, simulation_.plan().end_time, scene_.quiet || !prints()) {
  if (ready.job.beam.beam) ready.job.beam.beam->release_matrices();
}

void RecordedRun::sample(const integrate::Instant& instant) {
  if (!is_stored(instant.purpose) || !recorder_.writes()) return;
  sample_.time = instant.time;
  outputs_.fill(simulation_.evaluation().observed(), sample_.values);
  if (instant.purpose == integrate::Purpose::end)
    recorder_.end(sample_);
  else
    recorder_.add(sample_);
}

bool RecordedRun::step(double t, long steps) {
  reached_ = t;
  progress_.update(t, steps);
  results::Stage::advance(t / simulation_.plan().end_time);
  asked_ = run::requests_on_any(ready_.job.comm, checkpoints_.wanted());
  return asked_.signal == 0;
}

void RecordedRun::before_step(double t) {
  if (!asked_.wanted) return;
  checkpoints_.write(t, wall_seconds());
  asked_.wanted = false;
}

void RecordedRun::summarise(const std::string& ended) {
  const double wall = wall_seconds();
  {
    const results::Stage stage("summary");
    result_ = simulation_.result();
  }
  results::Summary& summary = result_.summary;
  summary.end_time = reached_;
  summary.wall_seconds = wall;
  if (ready_.job.open != nullptr) find_errors();
  const std::string unsettled = ready_.accuracy.invalidate_at_end(result_.filter_unsettled);
  summary.expected_errors = ready_.accuracy.expected();
  summary.ended = ended;
  const bool counts =
      !repeated_ && !finer_ && (!reaches_end_ || summary.linearisation_residual <= scene_.model.residual_limit);
  std::vector<results::Verdict> verdicts;
  std::optional<norm::NormCheck> check;
  if (reaches_end_ && counts) {
    verdicts = result_.verdicts;
    check = judge_by_norm(verdicts);
  }
  recorder_.change_beside();
  if (ready_.job.open != nullptr) run::record_notes(ready_.job.notes, recorder_);
  result_.record(recorder_);
  results::record_verdicts(recorder_, verdicts);
  recorder_.finish(summary);
  progress_.done();
  if (prints() && counts) results::print_summary(summary, scene_.output.file);
  for (const std::string& line : errors_)
    if (prints() && counts) fmt::print("  {}\n", line);
  if (prints() && counts && !unsettled.empty()) fmt::print("  note: {}\n", unsettled);
  if (prints() && check) check->print();
  if (prints()) results::print_verdicts(verdicts, scene_.unusual);
}

/// Determines the errors of a run that is the last one of its search, and adds them to the notes.
void RecordedRun::find_errors() {
  Job& job = ready_.job;
  if (reaches_end_ && !simulation_.passage().stopped_at_limit() &&
      result_.summary.linearisation_residual <= scene_.model.residual_limit) {
    scene::NumericalModel model = scene_.model;
    model.step = simulation_.plan().time_step;
    finer_ = !job.open->add(model, {result_.peaks, result_.lost_contact, result_.summary.linearisation_residual, 0.0});
    ready_.accuracy = job.open->choice().accuracy;
    ready_.reject_unfiltered();
    if (!finer_) errors_ = ready_.accuracy.lines();
  }
  job.notes.insert(job.notes.end(), errors_.begin(), errors_.end());
}

/// The comparison with EN 1991-2 if the scene requests it; its verdicts are appended to `verdicts`.
std::optional<norm::NormCheck> RecordedRun::judge_by_norm(std::vector<results::Verdict>& verdicts) {
  if (!scene_.norm) return std::nullopt;
  norm::NormCheck check = run::norm_check(scene_, {run::static_train("train", system_.weights().all())});
  if (run::compares_with_lm71(scene_)) check.compare(run::peaks_of_run(scene_, result_.peaks));
  check.find(verdicts);
  check.record(recorder_);
  return check;
}

/// Prints notes that are not part of the summary.
void RecordedRun::print_notes_of_run(bool has_checkpoint) const {
  if (!prints()) return;
  if (const auto& crowded = system_.fleet().unmodelled_contact(); crowded.contact >= 0) {
    const train::WheelContact& c = system_.fleet().wheels[static_cast<std::size_t>(crowded.contact)];
    fmt::print(
        "  note: {} of vehicle {} overlapped the track's profile at more than {} points (first at x = {:g} m): the {} "
        "deepest carried\n",
        system_.fleet().wheel(c).name, c.vehicle, track::most_points, crowded.x, track::most_points);
  }
  if (asked_.signal != 0 && !checkpoints_.trouble().empty())
    fmt::print("  no checkpoint: {}\n", checkpoints_.trouble());
  if (has_checkpoint && !scene_.quiet)
    fmt::print("  checkpoint at t = {:g} s: -restart {} goes on from there\n", reached_, checkpoints_.path());
}

RunEnd RecordedRun::run() {
  const MPI_Comm comm = ready_.job.comm;
  bool has_checkpoint = false;
  bool at_limit = false;  // of -ts_max_steps
  try {
    {
      const results::Stage stage("time steps");
      simulation_.run({this});
    }
    at_limit = simulation_.passage().stopped_at_limit();
    if (checkpoints_.possible() && (asked_.signal != 0 || at_limit)) {
      checkpoints_.write(reached_, wall_seconds());
      has_checkpoint = true;
    }
    if (system_.linearisation_residual() <= scene_.model.residual_limit) simulation_.evaluation().check_balance();
  } catch (const FileError& error) {
    run::leave_together(comm, error);
  } catch (const StepTooLong& error) {
    repeated_ = may_shorten_;
    summarise(error.what());
    if (!repeated_) throw;
    return {0, Retry::shorter_steps, error.what(), simulation_.plan().time_step};
  } catch (const Error& error) {
    summarise(error.what());
    throw;
  }
  const int signal = asked_.signal;
  reaches_end_ = signal == 0;
  try {
    summarise(signal != 0 ? fmt::format("ended by signal {}", signal)
              : at_limit  ? "ended at the limit of -ts_max_steps"
                          : "reached its end");
  } catch (const FileError& error) {
    run::leave_together(comm, error);
  }
  print_notes_of_run(has_checkpoint);
  if (reaches_end_ && !at_limit) checkpoints_.forget();
  noted_.reset();
  if (reaches_end_ && result_.summary.linearisation_residual > scene_.model.residual_limit)
    return {0, Retry::mechanisms, {}, 0.0};
  if (finer_) return {0, Retry::finer, {}, 0.0};
  run::check_deflection(comm, scene_, result_.summary.deflection.value);
  if (reaches_end_ && scene_.accuracy_report && ready_.accuracy.measured &&
      !error_control::report(comm, scene_, ready_.accuracy, result_.peaks))
    throw SolverError(fmt::format(
        "the error exceeds the accuracy of {:g} (above); use a smaller -accuracy, and please report the scene",
        scene_.accuracy));
  return {reaches_end_ ? 0 : 128 + signal, Retry::none, {}, 0.0};
}

/// Collective. Computes the motion in time, or the static equilibrium under the loads at t = 0, and writes results and
/// summary. Throws InputError, SolverError and FileError, with which the program ends. repeated: stored in checkpoints.
/// may_shorten: StepTooLong is not thrown but returned as shorter_steps.
RunEnd run_once(Job& job, results::Repeated repeated, bool may_shorten) {
  ReadyRun ready(job);
  RecordedRun run(ready, repeated, may_shorten);
  return run.run();
}

/// Gives the scene the mesh and the step of a repeated run.
void refine(scene::Scene& scene, const results::Repeated& repeated) {
  scene::NumericalModel model = scene.model;
  model.elements = repeated.elements;
  model.step = repeated.step;
  scene = error_control::with(std::move(scene), model);
}

}  // namespace

int run_in_time(Job job) {
  const bool is_continued = job.earlier != nullptr;
  scene::Scene scene = job.scene;
  error_control::Accuracy accuracy = job.accuracy;
  results::Repeated repeated = is_continued ? job.earlier->repeated : results::Repeated();
  int halvings = is_continued || !scene.step_open ? 0 : most_halvings;
  std::optional<run::SharedBeam> own;                                              // of a run that is repeated
  if (repeated.with_mechanisms) scene.model.vehicles = scene::VehicleModel::full;  // instead of linear vehicles
  if (repeated.step > 0.0) refine(scene, repeated);
  if (repeated.with_mechanisms || repeated.step > 0.0) {
    std::vector<std::string> ignored;
    own.emplace(job.comm, scene, ignored);
  }
  while (true) {
    Job one{
        job.comm,    scene,      std::move(job.place), accuracy, job.open, own ? *own : job.beam, std::move(job.notes),
        job.earlier, job.waiting};
    const RunEnd end = run_once(one, repeated, halvings > 0);
    if (end.again == Retry::none) return end.status;
    if (end.again == Retry::mechanisms) {
      scene.model.vehicles = scene::VehicleModel::full;
      repeated.with_mechanisms = true;
      job.notes = {fmt::format(
          "the residual of the linearised vehicles exceeded {:.1g} of their weights: the run is repeated with "
          "the mechanisms",
          scene.model.residual_limit)};
    } else if (end.again == Retry::finer) {
      const scene::NumericalModel& finer = job.open->choice().model;
      repeated.elements = finer.elements;
      repeated.step = *finer.step;
      refine(scene, repeated);
      job.notes = {fmt::format(
          "the run is repeated with {}steps of {:.3g} s: its errors were not within the "
          "accuracy of {:g}",
          finer.elements > 0 ? fmt::format("{} elements and ", finer.elements) : "", *finer.step, scene.accuracy)};
    } else {
      --halvings;
      scene.model.step = 0.5 * end.step;
      accuracy.reject_all();
      job.open = nullptr;
      job.notes = {fmt::format("the run is repeated with steps of {:g} s, without error estimates: {}",
                               *scene.model.step, end.why)};
    }
    job.earlier = nullptr;
    own.emplace(job.comm, scene, job.notes);
    job.place = results::claim_place(job.comm, scene.output.file);
  }
}

}  // namespace traverse::app
