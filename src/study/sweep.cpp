#include "study/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>

#include "accuracy/kept_choice.hpp"
#include "case_runner.hpp"
#include "engine/processor.hpp"
#include "modes_choice.hpp"
#include "results/stage.hpp"
#include "results/sweep.hpp"
#include "results/terminal.hpp"
#include "run/deflection_check.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/signals.hpp"
#include "study/resonances.hpp"
#include "study/sweep_curves.hpp"
#include "study/sweep_runs.hpp"
#include "sweep_choice.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double worth_a_word = 10.0;  // s, from which on quicker ways are looked for
constexpr double quicker_by = 0.2;     // of the time: what modes must do with
constexpr double least_width = 0.01;   // of the speed: no train is so long that a resonance of it is narrower

std::vector<double> span_ends(const beam::BeamModel& beam) {
  std::vector<double> ends = {beam.start};
  for (const double span : beam.spans) ends.push_back(ends.back() + span);
  return ends;
}

/// Static effects and the verdict of EN 1991-2 where the scene wants them, on every rank.
std::optional<norm::NormCheck> check_by_norm(const Scene& scene, const CaseRunner& runner,
                                             const results::Sweep& sweep) {
  if (!scene.norm) return {};
  norm::NormCheck check = norm_check(scene, trains_at_rest(scene, *runner.beam()));
  if (!compares_with_lm71(scene)) return check;
  norm::Passed passed{sweep.speed, sweep.probes, {}};
  const std::size_t size = sweep.speed.size() * sweep.probes.size();
  const auto of_train = [size](const std::vector<double>& all, std::size_t train) {
    const auto from = all.begin() + static_cast<std::ptrdiff_t>(train * size);
    return std::vector<double>(from, from + static_cast<std::ptrdiff_t>(size));
  };
  for (std::size_t train = 0; train < sweep.rows(); ++train)
    passed.trains.push_back({of_train(sweep.deflection.value, train), of_train(sweep.moment.value, train)});
  check.judge(passed);
  return check;
}

/// How many runs, what they will take and what would be quicker.
void announce(const Scene& scene, const CaseRunner& runner, const results::Sweep::Model& model, int ranks,
              std::vector<std::string>& notes) {
  const auto& speeds = runner.speeds();
  const double seconds = runner.cost_of_all() / ranks;
  notes.push_back(fmt::format("sweep of {} runs: {} speed{} from {:g} to {:g} m/s, {} train{}; above for the first one",
                              speeds.size() * runner.trains(), speeds.size(), speeds.size() == 1 ? "" : "s",
                              speeds.front(), speeds.back(), runner.trains(), runner.trains() == 1 ? "" : "s"));
  if (scene.sweep->refine > 0.0)
    notes.push_back(
        fmt::format("speeds are added until the peaks over the speed are known to {:g}", scene.sweep->refine));
  if (scene.sweep->refine < 0.0)
    notes.emplace_back(
        "speeds are added where a limit may be broken between two of them; -sweep_refine 1e-2 finds every peak, 0 adds "
        "none");
  if (runner.has_lanes())
    notes.push_back(fmt::format("up to {} runs go side by side, in the lanes of {} vectors", scene.sweep->lanes,
                                engine::instructions()));
  else if (!scene.vehicles.empty())
    notes.push_back("runs go one by one: " + runner.why_no_lanes());
  const bool known = model.modes > 0 || model.time_step > 0.0;
  notes.push_back(fmt::format("the sweep is {}{}", results::method_of(model),
                              known ? ", which will take about " + results::duration_text(seconds) : ""));
  if (ranks > 1)
    notes.push_back(fmt::format("{} ranks share the runs, each takes the next one when it is free", ranks));
  if (!known || seconds < worth_a_word) return;
  const std::optional<QuickerModes> quicker = quicker_modes(scene);
  if (quicker && quicker->seconds < quicker_by * seconds * ranks)
    notes.push_back(fmt::format("quicker: -model_modes {} (all modes up to {:.3g} Hz) would take about {}{}",
                                quicker->modes, quicker->frequency, results::duration_text(quicker->seconds / ranks),
                                scene.modes_open && model.accuracy == 0.0
                                    ? "; with ts_dt and the elements left open, modes are taken where they do as well"
                                    : ""));
}

/// Those of the scene and, where others are to be added, those at which peaks might stay unseen.
std::vector<double> first_speeds(const CaseRunner& runner, bool refined,
                                 const std::vector<results::Resonance>& resonances) {
  std::vector<double> speeds = runner.speeds();
  if (refined)
    for (const double speed : unseen(resonances, runner.speeds())) speeds.push_back(speed);
  std::sort(speeds.begin(), speeds.end());
  return speeds;
}

/// The damping ratio of the bridge's first mode, by which resonances are as wide as they are.
double first_damping(const SharedBeam& shared, const std::vector<double>& frequencies) {
  if (shared.modal) return shared.modal->sigma().front() / shared.modal->omega().front();
  if (frequencies.empty()) return 0.0;
  const double omega = 2.0 * std::numbers::pi * frequencies.front();
  return 0.5 * (shared.rayleigh.a / omega + shared.rayleigh.b * omega);
}

/// Collective. Further rounds of runs until the peaks are known well enough or, where only limits ask, none of these
/// may be broken between two speeds; each round's speeds follow from the results of those before, which all ranks know.
void add_speeds(MPI_Comm comm, const Scene& scene, CaseRunner& runner, double damping, SweepRuns& runs) {
  const std::vector<double>& given = runner.speeds();
  const bool for_limits = scene.sweep->refine < 0.0;
  const std::size_t most = for_limits ? most_speeds_unasked(given.size()) : most_speeds(given.size());
  results::Refined refined;
  refined.wanted = for_limits ? 0.0 : scene.sweep->refine;
  while (!runs.failure.failed() && signal_on_any(comm) == 0) {
    const Refinement next = for_limits ? refine_for_limits(runs.sweep.speed, curves_in_doubt(runs.sweep),
                                                           std::max(2.0 * damping, least_width))
                                       : refine(runs.sweep.speed, curves_of(runs.sweep), refined.wanted);
    refined.uncertainty = next.uncertainty;
    refined.curve = next.curve;
    if (next.speeds.empty() || runs.sweep.speed.size() + next.speeds.size() > most) break;
    SweepRuns more = run_all_trains(comm, scene, runner, next.speeds);
    runs.sweep = results::joined(runs.sweep, more.sweep);
    runs.ended += more.ended;
    runs.failure = std::move(more.failure);
  }
  for (const double speed : runs.sweep.speed)
    refined.added.push_back(std::binary_search(given.begin(), given.end(), speed) ? 0.0 : 1.0);
  runs.sweep.refined = std::move(refined);
}

}  // namespace

int run_sweep(MPI_Comm comm, const Scene& given, results::Place place) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<std::string> notes;
  Choice choice;
  KeptChoice kept(comm, given);
  if (!kept.read(given, notes, choice)) {
    choice = choose_for_sweep(given, notes);
    if (choice.accuracy.measured) kept.write(notes, choice);
  }
  const Scene scene = with(given, choice.model);
  const results::Sweep::Model model = stored_model(scene, choice.accuracy);
  CaseRunner runner(scene, notes);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  for (const std::string& note : options::notes_on_unused(options::in_force())) notes.push_back(note);
  announce(scene, runner, model, ranks, notes);
  print_notes(comm, notes);

  const double slowest = runner.speeds().front(), fastest = runner.speeds().back();
  const std::vector<double> frequencies = resonant_frequencies(*runner.beam());
  std::vector<results::Resonance> resonances = resonances_of(scene, frequencies, slowest, fastest);
  const std::vector<results::Cancellation> cancellations = cancellations_of(*scene.beam, frequencies, slowest, fastest);
  const SignalsNoted noted;
  results::Layout layout;
  layout.constants = stations(scene.output.probes, span_ends(*scene.beam));
  results::Recorder recorder(comm, std::move(place), layout, attributes(comm, scene), scene.options);
  record_model(scene, notes, recorder);
  const auto begin = std::chrono::steady_clock::now();
  SweepRuns runs;
  {
    const results::Stage stage("runs of the sweep");
    runs = run_all_trains(comm, scene, runner, first_speeds(runner, scene.sweep->refine > 0.0, resonances));
    if (scene.sweep->refine != 0.0) add_speeds(comm, scene, runner, first_damping(*runner.beam(), frequencies), runs);
  }
  results::Sweep& sweep = runs.sweep;
  sweep.model = model;
  find_peaks(sweep, resonances);
  const RunFailure& failure = runs.failure;
  const int signal = signal_on_any(comm);
  long alone = runner.alone();
  MPI_Allreduce(MPI_IN_PLACE, &alone, 1, MPI_LONG, MPI_SUM, comm);

  const results::SweepCourse whole = {runs.ended, static_cast<long>(sweep.speed.size() * runner.trains()),
                                      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                                      failure.failed() ? failure.message
                                      : signal != 0    ? fmt::format("ended by signal {}", signal)
                                                       : "reached its end"};
  std::vector<results::Verdict> verdicts = results::verdicts_of(sweep);
  const std::optional<norm::NormCheck> check =
      runs.ended == whole.planned ? check_by_norm(scene, runner, sweep) : std::optional<norm::NormCheck>();
  if (check) check->find(verdicts);
  try {
    results::record(sweep, recorder);
    results::record(sweep, resonances, cancellations, recorder);
    if (check) check->record(recorder);
    results::record_verdicts(recorder, verdicts);
    recorder.finish_with(results::summary_of(sweep, whole), {"runs", "wall_seconds"});
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  if (rank == 0) {
    if (runs.ended > 0) results::print_sweep(sweep);
    if (runs.ended > 0) results::print(sweep, resonances, cancellations);
    if (check) check->print();
    if (runs.ended > 0) results::print_verdicts(verdicts, scene.unusual);
    if (const std::string said = sweep.model.not_promised(sweep.unseen); !said.empty())
      fmt::print("  note: {}\n", said);
    fmt::print("{}", results::computed_alone(alone));
    fmt::print("  {} of {} runs {} in {:.3g} s, {:.3g} ms each\n  {:<22}{}\nresults  {}\n", runs.ended, whole.planned,
               results::method_of(model), whole.wall_seconds,
               1e3 * whole.wall_seconds / static_cast<double>(std::max(runs.ended, 1L)), "the sweep", whole.ended,
               scene.output.file.empty() ? "none" : scene.output.file);
  }
  if (failure.failed()) throw Error(failure.message, failure.status);
  const std::vector<double>& peaks = sweep.deflection.value;  // std::fmax passes over runs without one
  check_deflection(comm, scene, std::accumulate(peaks.begin(), peaks.end(), 0.0, [](double a, double b) {
                     return std::fmax(a, b);
                   }));
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace traverse::app
