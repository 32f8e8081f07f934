#include "timed_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "accuracy/mechanism_step.hpp"
#include "accuracy/trials.hpp"
#include "modes/modes.hpp"
#include "prepare.hpp"
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
#include "run/signals.hpp"
#include "run/watch.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

/// The natural frequencies that the run is made of: those of its modes, or the pair that damping was taken from.
void store_modes(const SharedBeam& shared, results::Recorder& recorder) {
  if (!shared.omega) return;
  const auto [omega1, omega2] = *shared.omega;
  modes::Modes modes;
  modes.omega = {omega1, omega2};
  if (shared.modal)
    modes = modes::as_stored(*shared.beam, shared.modal->basis(), beam::ShapePoints(shared.beam->mesh()));
  if (shared.modal && !shared.modal->dampers_couple())
    for (std::size_t i = 0; i < shared.modal->modes(); ++i)
      modes.ratio.push_back(shared.modal->sigma()[i] / shared.modal->omega()[i]);
  recorder.modes(modes, shared.rayleigh.a, shared.rayleigh.b, omega1, omega2);
}

double total(MPI_Comm comm, double share) {
  MPI_Allreduce(MPI_IN_PLACE, &share, 1, MPI_DOUBLE, MPI_SUM, comm);
  return share;
}

/// The promise against what a refined run gives. False where it is broken.
bool report(MPI_Comm comm, const Scene& scene, const Accuracy& accuracy, const Peaks& peaks) {
  if (!scene.beam) return report_alone(comm, scene, accuracy);
  const Scene fine = refined(scene);
  const Peaks truth = [&] {
    const results::Stage stage("the refined run of -accuracy_report");
    const options::WithoutMonitors without_monitors;
    return peaks_of(comm, fine).peaks;
  }();
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  bool all_kept = true;
  if (rank == 0) report_head("half the step and elements half as long", "peak of");
  for (std::size_t i = 0; i < quantities; ++i) {
    const auto q = static_cast<Quantity>(i);
    if (truth.largest(q).value == 0.0) continue;
    const double error = peak_difference(peaks, truth, q);
    all_kept = report_row(quantity_names[i], accuracy.promises[i], scene.accuracy, error, rank == 0) && all_kept;
  }
  return all_kept;
}

/// Creates the results file, or takes up that of the run that this one goes on from.
results::Recorder recorder_of(Job& job, const Scene& scene, const results::Layout& layout,
                              const std::vector<std::string>& notes) {
  if (job.earlier != nullptr) return {job.comm, std::move(job.place), layout, job.earlier->results};
  results::Recorder recorder(job.comm, std::move(job.place), layout, attributes(job.comm, scene), scene.options);
  record_model(scene, notes, recorder);
  store_modes(job.beam, recorder);
  return recorder;
}

/// Where the run stands that this one goes on from, or that it is at its start. repeated: with the mechanisms.
results::Checkpoint so_far(const Job& job, bool repeated) {
  results::Checkpoint checkpoint;
  if (job.earlier != nullptr) checkpoint = *job.earlier;
  MPI_Comm_size(PETSC_COMM_WORLD, &checkpoint.given_ranks);
  checkpoint.repeated = repeated;
  return checkpoint;
}

/// What was asked for by a signal is said to have been done.
void say_written(MPI_Comm comm, const Scene& scene, const Checkpoints& checkpoints, double time) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0 && !scene.quiet)
    fmt::print("  checkpoint at t = {:g} s: -restart {} goes on from there\n", time, checkpoints.path());
}

}  // namespace

RunEnd run_once(Job& job, bool with_mechanisms, bool may_shorten) {
  const MPI_Comm comm = job.comm;
  Scene scene = job.scene;
  Accuracy accuracy = job.accuracy;
  SharedBeam& shared = job.beam;
  std::vector<std::string>& notes = job.notes;
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const bool still = scene.analysis == Analysis::static_response;
  const beam::Beam* beam = shared.bridge();
  const double counting = prepare(scene, accuracy, shared, notes);
  const bool wheels = filters_wheels(scene);
  std::optional<Plan> plan;
  if (job.earlier != nullptr) plan = Plan{0.0, job.earlier->time_step, job.earlier->interval, job.earlier->stored};
  if (plan && scene.time_step && plan->time_step < *scene.time_step) accuracy.promise_nothing();
  Passage passage(scene, shared, notes, plan ? &*plan : nullptr);  // everything is checked before anything is computed
  if (job.earlier != nullptr && !(passage.plan().end_time > job.earlier->time))
    throw InputError(fmt::format("restart: the run has come to {:g} s already, its end is at {:g} s", job.earlier->time,
                                 passage.plan().end_time));
  coupling::System& system = passage.system();
  for (const std::string& note : options::check_all_used(options::in_force())) notes.push_back(note);
  passage.start(notes);
  if (system.static_error() > 1e-9)
    notes.push_back(
        fmt::format("static deflections: relative error about {:.1g}, by rounding in the many elements "
                    "between supports",
                    system.static_error()));
  const std::string trouble =
      counting > 0.0 ? no_filter(counting, passage.plan(), scene.output.probes.size()) : std::string();
  const bool filtered = counting > 0.0 && trouble.empty();
  if (!trouble.empty()) notes.push_back("deck accelerations are not low-passed: " + trouble);
  const std::size_t wheel_count = wheels_at_start(scene).size();
  const std::string no_wheels =
      wheels ? no_filter(scene.output.wheel_low_pass, passage.plan(), wheel_count, "wheels") : std::string();
  if (!no_wheels.empty()) notes.push_back("wheel forces are not low-passed: " + no_wheels);
  std::optional<base::Archive> archive;
  if (job.earlier != nullptr) {
    archive.emplace(comm, job.earlier->of_ranks);
    passage.keep(*archive);
    notes.push_back(fmt::format("goes on from t = {:g} s", job.earlier->time));
  }
  print_notes(comm, notes);

  std::optional<SignalsNoted> noted(std::in_place);  // from here on what is stored is to stay readable
  const Outputs outputs = outputs_of({scene, system.fleet(), beam});
  results::Layout layout = outputs.layout();
  if (!still) layout.interval = passage.plan().interval * static_cast<double>(passage.plan().stored);
  results::Recorder recorder = recorder_of(job, scene, layout, notes);
  if (shared.beam) shared.beam->release_matrices();
  Watch watch(scene, system, beam, recorder, &outputs);
  if (filtered && rank == 0) watch.keep_accelerations({counting, passage.plan(), scene.output.probes});
  if (wheels && no_wheels.empty() && rank == 0)
    watch.keep_wheel_forces({scene.output.wheel_low_pass, scene.output.unloading_level, passage.plan(), wheel_count});
  if (!scene.output.passages.empty()) watch.note_axle_passages({scene, passage.plan().time_step});
  if (!scene.limits.empty()) watch.judge();
  if (archive) watch.keep(*archive);
  archive.reset();
  Checkpoints checkpoints(comm, scene, passage, watch, recorder, so_far(job, with_mechanisms));
  const double before = job.earlier != nullptr ? job.earlier->wall_seconds : 0.0;
  results::Progress progress(job.earlier != nullptr ? job.earlier->time : 0.0, passage.plan().end_time,
                             scene.quiet || rank != 0);
  const auto begin = std::chrono::steady_clock::now();
  const auto wall_now = [&] {
    return before + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  double reached = job.earlier != nullptr ? job.earlier->time : 0.0;
  bool reaches_end = false, repeated = false;
  auto summarise = [&](const std::string& ended) {
    const double wall = wall_now();
    results::Summary summary = [&] {
      const results::Stage stage("summary");
      return watch.finish();
    }();
    summary.end_time = reached;
    summary.steps = passage.steps();
    summary.rejected_steps = passage.rejected();
    summary.solves = system.beam_solves();
    summary.factorisations = system.factorisations();
    summary.wall_seconds = wall;
    summary.linear_defect = system.defect();
    if (system.structure() != nullptr && system.structure()->energy_left())
      summary.energy_left = total(comm, *system.structure()->energy_left());
    summary.static_error = system.static_error();
    const std::string withdrawn = accuracy.withdrawn(summary.contact_losses);
    summary.expected_errors = accuracy.expected();
    summary.ended = ended;
    const bool counts = !repeated && (!reaches_end || summary.linear_defect <= scene.most_defect);
    const bool judged = reaches_end && counts;
    std::vector<results::Verdict> verdicts = judged ? watch.verdicts(summary) : std::vector<results::Verdict>();
    std::optional<norm::NormCheck> check;
    if (judged && scene.norm) {
      check.emplace(norm_check(scene, {train_at_rest("train", system.weights().all())}));
      if (compares_with_lm71(scene)) check->judge(passed_once(scene, watch.finished_peaks()));
      check->find(verdicts);
      check->record(recorder);
    }
    results::record_verdicts(recorder, verdicts);
    recorder.finish(summary);
    progress.done();
    if (rank == 0 && counts) results::print_summary(summary, scene.output.file);
    if (rank == 0 && counts && !withdrawn.empty()) fmt::print("  note: {}\n", withdrawn);
    if (rank == 0 && check) check->print();
    if (rank == 0) results::print_verdicts(verdicts);
    return summary;
  };
  Asked asked;
  bool by_signal = false;
  const int& stopped = asked.signal;
  try {
    const results::Stage stage("time steps");
    passage.run([&](const integrate::Instant& instant) { watch.sample(instant); },
                [&](double t, long steps) {
                  watch.step(t);
                  reached = t;
                  progress.update(t, steps);
                  results::Stage::advance(t / passage.plan().end_time);
                  asked = asked_on_any(comm, checkpoints.wanted());
                  return stopped == 0;
                },
                [&](double t) {
                  if (!asked.wanted) return;
                  checkpoints.write(t, wall_now());
                  asked.wanted = false;
                });
    if (checkpoints.possible() && (stopped != 0 || passage.stopped_at_limit())) {
      checkpoints.write(reached, wall_now());
      by_signal = true;
    }
    if (system.defect() <= scene.most_defect) check_balance(scene, watch.extremes());
  } catch (const FileError& error) {
    leave_together(comm, error);
  } catch (const StepTooLong& error) {
    repeated = may_shorten;
    summarise(error.what());
    if (!repeated) throw;
    return {0, Retry::shorter_steps, error.what(), passage.plan().time_step};
  } catch (const Error& error) {
    summarise(error.what());
    throw;
  }
  reaches_end = stopped == 0;
  results::Summary summary;
  try {
    summary = summarise(stopped != 0                 ? fmt::format("ended by signal {}", stopped)
                        : passage.stopped_at_limit() ? "ended at the limit of -ts_max_steps"
                                                     : "reached its end");
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  if (const auto& crowded = system.fleet().crowded(); crowded.contact >= 0 && rank == 0) {
    const train::WheelContact& c = system.fleet().wheels[static_cast<std::size_t>(crowded.contact)];
    fmt::print(
        "  note: {} of vehicle {} overlapped the track's profile at more than {} points (first at x = {:g} m): the {} "
        "deepest carried\n",
        system.fleet().wheel(c).name, c.vehicle, track::most_points, crowded.x, track::most_points);
  }
  if (stopped != 0 && !checkpoints.trouble().empty() && rank == 0)
    fmt::print("  no checkpoint: {}\n", checkpoints.trouble());
  if (by_signal) say_written(comm, scene, checkpoints, reached);
  if (reaches_end && !passage.stopped_at_limit()) checkpoints.forget();
  noted.reset();
  if (reaches_end && summary.linear_defect > scene.most_defect) return {0, Retry::mechanisms, {}, 0.0};
  check_deflection(comm, scene, summary.deflection.value);
  if (stopped == 0 && scene.accuracy_report && accuracy.measured &&
      !report(comm, scene, accuracy, watch.finished_peaks()))
    throw SolverError(
        fmt::format("the accuracy of {:g} was not kept (above); take a smaller -accuracy, and please report the scene",
                    scene.accuracy));
  return {stopped == 0 ? 0 : 128 + stopped, Retry::none, {}, 0.0};
}

}  // namespace traverse::app
