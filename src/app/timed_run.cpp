// One run in time from its first step to its summary: steps with recording, checkpoints and signals, then the energy
// check, the verdicts on limits and the comparison with EN 1991-2.
#include "timed_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "error_control/multibody_step_search.hpp"
#include "error_control/trial_runs.hpp"
#include "ready_run.hpp"
#include "results/recorder.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/checkpoints.hpp"
#include "run/deflection_check.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"
#include "run/outputs.hpp"
#include "run/passage.hpp"
#include "run/process.hpp"
#include "run/run_observer.hpp"
#include "run/signals.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

double total(MPI_Comm comm, double share) {
  MPI_Allreduce(MPI_IN_PLACE, &share, 1, MPI_DOUBLE, MPI_SUM, comm);
  return share;
}

/// Compares the error estimates with the results of a refined run. Returns false if an estimate is exceeded.
bool report(MPI_Comm comm, const Scene& scene, const Accuracy& accuracy, const ResponseExtremes& peaks) {
  if (!scene.beam) return report_multibody(comm, scene, accuracy);
  const Scene fine = refined(scene);
  const ResponseExtremes truth = [&] {
    const results::Stage stage("the refined run of -accuracy_report");
    const options::WithoutMonitors without_monitors;
    return peaks_of(comm, fine).peaks;
  }();
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  int all_kept = 1;
  if (rank == 0) report_head("half the step and elements half as long", "peak of");
  for (std::size_t i = 0; i < quantities; ++i) {
    const auto q = static_cast<Quantity>(i);
    if (truth.largest(q).value == 0.0) continue;
    const double error = peak_difference(peaks, truth, q);
    const bool kept = report_row(quantity_names[i], accuracy.estimates[i], scene.accuracy, error, rank == 0);
    all_kept = kept ? all_kept : 0;
  }
  MPI_Bcast(&all_kept, 1, MPI_INT, 0, comm);  // only the first rank has the low-passed accelerations
  return all_kept != 0;
}

/// Creates the results file, or opens the file of the run that this run continues.
results::Recorder recorder_of(ReadyRun& ready, const Outputs& outputs) {
  Job& job = ready.job;
  results::Layout layout = outputs.layout();
  const Plan& plan = ready.passage.plan();
  if (ready.moves()) {
    layout.interval = plan.interval * static_cast<double>(plan.stored);
    layout.rows = static_cast<std::size_t>(plan.end_time / layout.interval) + 2;
  }
  if (ready.goes_on()) return {job.comm, std::move(job.place), layout, job.earlier->results};
  results::Recorder recorder(job.comm, std::move(job.place), layout, attributes(job.comm, ready.scene),
                             ready.scene.options);
  recorder.of_scene(digest_of(ready.scene));
  record_model(ready.scene, job.notes, recorder);
  record_modes(job.beam, recorder);
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

/// A run in time with its observer, recorder, checkpoints and progress display.
class WatchedRun {
 public:
  WatchedRun(ReadyRun& ready, results::Repeated repeated, bool may_shorten);
  RunEnd take();

 private:
  using Clock = std::chrono::steady_clock;

  void step_through();
  results::Summary summarise(const std::string& ended);
  std::vector<std::string> withdraw();
  std::optional<norm::NormCheck> judge_by_norm(std::vector<results::Verdict>& verdicts);
  void say_what_happened(bool by_signal) const;
  double wall_seconds() const { return before_ + std::chrono::duration<double>(Clock::now() - begin_).count(); }
  bool prints() const { return ready_.rank == 0; }

  ReadyRun& ready_;
  const Scene& scene_;
  bool may_shorten_;  // whether the run may be repeated with shorter steps after StepTooLong
  Passage& passage_;
  coupling::System& system_;
  std::optional<DeferredSignals> noted_{
      std::in_place};  // signals are delayed from here on, so that the file remains readable
  Outputs outputs_;
  results::Recorder recorder_;
  RunObserver watch_;
  Checkpoints checkpoints_;
  double before_, reached_;  // s: wall time of the continued run; simulated time reached so far
  results::Progress progress_;
  Clock::time_point begin_ = Clock::now();
  Requests asked_;
  bool reaches_end_ = false;
  bool repeated_ = false;  // the run is repeated
};

WatchedRun::WatchedRun(ReadyRun& ready, results::Repeated repeated, bool may_shorten)
    : ready_(ready),
      scene_(ready.scene),
      may_shorten_(may_shorten),
      passage_(ready.passage),
      system_(passage_.system()),
      outputs_(outputs_of({scene_, system_.fleet(), ready.job.beam.bridge()})),
      recorder_(recorder_of(ready, outputs_)),
      watch_(scene_, system_, ready.job.beam.bridge(), recorder_, &outputs_),
      checkpoints_(ready.job.comm, scene_, passage_, watch_, recorder_, so_far(ready.job, repeated)),
      before_(ready.goes_on() ? ready.job.earlier->wall_seconds : 0.0),
      reached_(ready.goes_on() ? ready.job.earlier->time : 0.0),
      progress_(reached_, passage_.plan().end_time, scene_.quiet || !prints()) {
  if (ready.job.beam.beam) ready.job.beam.beam->release_matrices();
  const Plan& plan = passage_.plan();
  if (ready.filters_deck && prints()) watch_.keep_accelerations({ready.counting, plan, scene_.output.probes});
  if (ready.filters_forces && prints())
    watch_.keep_wheel_forces({scene_.output.wheel_low_pass, scene_.output.unloading_level, plan, ready.wheels});
  if (!scene_.output.passages.empty()) watch_.record_axle_passages({scene_, plan.time_step});
  if (!scene_.limits.empty()) watch_.check_limits();
  watch_.check_extrapolation(ready.accuracy.covered_until);
  if (ready.archive) watch_.keep(*ready.archive);
  ready.archive.reset();
}

void WatchedRun::step_through() {
  const results::Stage stage("time steps");
  passage_.run([&](const integrate::Instant& instant) { watch_.sample(instant); },
               [&](double t, long steps) {
                 watch_.step(t);
                 reached_ = t;
                 progress_.update(t, steps);
                 results::Stage::advance(t / passage_.plan().end_time);
                 asked_ = requests_on_any(ready_.job.comm, checkpoints_.wanted());
                 return asked_.signal == 0;
               },
               [&](double t) {
                 if (!asked_.wanted) return;
                 checkpoints_.write(t, wall_seconds());
                 asked_.wanted = false;
               });
}

results::Summary WatchedRun::summarise(const std::string& ended) {
  const double wall = wall_seconds();
  results::Summary summary = [&] {
    const results::Stage stage("summary");
    return watch_.finish();
  }();
  summary.end_time = reached_;
  summary.steps = passage_.steps();
  summary.rejected_steps = passage_.rejected();
  summary.solves = system_.beam_solves();
  summary.factorisations = system_.factorisations();
  summary.wall_seconds = wall;
  summary.linear_defect = system_.linearisation_residual();
  if (system_.structure() != nullptr && system_.structure()->energy_left())
    summary.energy_left = total(ready_.job.comm, *system_.structure()->energy_left());
  summary.static_error = system_.static_error();
  const std::vector<std::string> withdrawn = withdraw();
  summary.expected_errors = ready_.accuracy.expected();
  summary.ended = ended;
  const bool counts = !repeated_ && (!reaches_end_ || summary.linear_defect <= scene_.model.residual_limit);
  std::vector<results::Verdict> verdicts;
  std::optional<norm::NormCheck> check;
  if (reaches_end_ && counts) {
    verdicts = watch_.verdicts(summary);
    check = judge_by_norm(verdicts);
  }
  results::record_verdicts(recorder_, verdicts);
  recorder_.finish(summary);
  progress_.done();
  if (prints() && counts) results::print_summary(summary, scene_.output.file);
  for (const std::string& note : withdrawn)
    if (prints() && counts && !note.empty()) fmt::print("  note: {}\n", note);
  if (prints() && check) check->print();
  if (prints()) results::print_verdicts(verdicts, scene_.unusual);
  return summary;
}

/// The error estimates that are invalid, in words.
std::vector<std::string> WatchedRun::withdraw() {
  Accuracy& accuracy = ready_.accuracy;
  return {accuracy.invalidate_by_contact_loss(watch_.losses()),
          accuracy.invalidate_by_new_event(watch_.extrapolation_check().new_event()),
          accuracy.invalidate_if_rougher(watch_.roughness_ratio(), scene_.accuracy),
          accuracy.invalidate_at_end(watch_.ends_unsettled())};
}

/// The comparison with EN 1991-2 if the scene requests it; its verdicts are appended to `verdicts`.
std::optional<norm::NormCheck> WatchedRun::judge_by_norm(std::vector<results::Verdict>& verdicts) {
  if (!scene_.norm) return std::nullopt;
  norm::NormCheck check = norm_check(scene_, {static_train("train", system_.weights().all())});
  if (compares_with_lm71(scene_)) check.compare(peaks_of_run(scene_, watch_.finished_peaks()));
  check.find(verdicts);
  check.record(recorder_);
  return check;
}

/// Prints notes that are not part of the summary.
void WatchedRun::say_what_happened(bool by_signal) const {
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
  if (by_signal && !scene_.quiet)
    fmt::print("  checkpoint at t = {:g} s: -restart {} goes on from there\n", reached_, checkpoints_.path());
}

RunEnd WatchedRun::take() {
  const MPI_Comm comm = ready_.job.comm;
  bool by_signal = false;
  try {
    step_through();
    if (checkpoints_.possible() && (asked_.signal != 0 || passage_.stopped_at_limit())) {
      checkpoints_.write(reached_, wall_seconds());
      by_signal = true;
    }
    if (system_.linearisation_residual() <= scene_.model.residual_limit) check_balance(scene_, watch_.extremes());
  } catch (const FileError& error) {
    leave_together(comm, error);
  } catch (const StepTooLong& error) {
    repeated_ = may_shorten_;
    summarise(error.what());
    if (!repeated_) throw;
    return {0, Retry::shorter_steps, error.what(), passage_.plan().time_step};
  } catch (const Error& error) {
    summarise(error.what());
    throw;
  }
  const int signal = asked_.signal;
  reaches_end_ = signal == 0;
  results::Summary summary;
  try {
    summary = summarise(signal != 0                   ? fmt::format("ended by signal {}", signal)
                        : passage_.stopped_at_limit() ? "ended at the limit of -ts_max_steps"
                                                      : "reached its end");
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  say_what_happened(by_signal);
  if (reaches_end_ && !passage_.stopped_at_limit()) checkpoints_.forget();
  noted_.reset();
  if (reaches_end_ && summary.linear_defect > scene_.model.residual_limit) return {0, Retry::mechanisms, {}, 0.0};
  check_deflection(comm, scene_, summary.deflection.value);
  if (reaches_end_ && scene_.accuracy_report && ready_.accuracy.measured &&
      !report(comm, scene_, ready_.accuracy, watch_.finished_peaks()))
    throw SolverError(fmt::format(
        "the error exceeds the accuracy of {:g} (above); use a smaller -accuracy, and please report the scene",
        scene_.accuracy));
  return {reaches_end_ ? 0 : 128 + signal, Retry::none, {}, 0.0};
}

}  // namespace

RunEnd run_once(Job& job, results::Repeated repeated, bool may_shorten) {
  ReadyRun ready(job);
  WatchedRun run(ready, repeated, may_shorten);
  return run.take();
}

}  // namespace traverse::app
