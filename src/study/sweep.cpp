#include "study/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "case_runner.hpp"
#include "modes_choice.hpp"
#include "results/stage.hpp"
#include "results/sweep.hpp"
#include "results/terminal.hpp"
#include "run/deflection_check.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/signals.hpp"
#include "share_runs.hpp"
#include "sweep_choice.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double worth_a_word = 10.0;  // s, from which on quicker ways are looked for
constexpr double quicker_by = 0.2;     // of the time: what modes must do with

/// Runs of the sweep that one rank takes together.
struct Case {
  std::size_t train = 0;  // indices
  std::vector<std::size_t> speeds;
};

/// s of motion, of all its runs.
double duration_of(const Case& c, const CaseRunner& runner) {
  double sum = 0.0;
  for (const std::size_t i : c.speeds) sum += runner.duration(c.train, runner.speeds()[i]);
  return sum;
}

/// Longest first, so that no rank ends long after the others.
std::vector<Case> cases_of(const CaseRunner& runner) {
  std::vector<Case> cases;
  std::vector<CaseRun> runs;
  for (const double speed : runner.speeds()) runs.push_back({speed, {}});
  for (std::size_t train = 0; train < runner.trains(); ++train)
    for (const std::vector<std::size_t>& speeds : group_runs(runs, runner.width())) cases.push_back({train, speeds});
  std::stable_sort(cases.begin(), cases.end(),
                   [&](const Case& a, const Case& b) { return duration_of(a, runner) > duration_of(b, runner); });
  return cases;
}

std::vector<double> span_ends(const beam::BeamModel& beam) {
  std::vector<double> ends = {beam.start};
  for (const double span : beam.spans) ends.push_back(ends.back() + span);
  return ends;
}

results::Sweep empty_sweep(const Scene& scene, const CaseRunner& runner, const results::Sweep::Model& model) {
  results::Sweep sweep;
  sweep.model = model;
  sweep.speed = runner.speeds();
  sweep.trains = scene.sweep->trains;
  sweep.probes = scene.output.probes;
  const std::size_t runs = sweep.rows() * sweep.speed.size();
  const std::vector<double> none(runs * sweep.probes.size(), results::Sweep::not_run);
  sweep.deflection = sweep.acceleration = sweep.moment = {none, none};
  sweep.amplification = none;
  sweep.static_deflection.assign(sweep.rows() * sweep.probes.size(), results::Sweep::not_run);
  const auto rolls = [](const Vehicle& v) { return !v.wheels.empty(); };
  if (std::any_of(scene.vehicles.begin(), scene.vehicles.end(), rolls))
    for (std::vector<double>* values :
         {&sweep.least_wheel_force, &sweep.greatest_wheel_force, &sweep.contact_losses, &sweep.longest_loss})
      values->assign(runs, results::Sweep::not_run);
  return sweep;
}

void store(const CaseResult& result, std::size_t train, std::size_t speed, results::Sweep& sweep) {
  const std::size_t run = train * sweep.speed.size() + speed;
  for (std::size_t p = 0; p < sweep.probes.size(); ++p) {
    const std::size_t at = run * sweep.probes.size() + p;
    const auto put = [&](const integrate::Peak& peak, results::Sweep::Peaks& into) {
      into.value[at] = peak.value;
      into.time[at] = peak.time;
    };
    put(result.peaks[p].deflection, sweep.deflection);
    put(result.peaks[p].acceleration, sweep.acceleration);
    put(result.peaks[p].moment, sweep.moment);
    const double rest = result.static_deflection[p];
    sweep.amplification[at] = rest > 0.0 ? result.peaks[p].deflection.value / rest : 0.0;
    if (rest > 0.0) sweep.static_deflection[train * sweep.probes.size() + p] = rest;
  }
  if (sweep.least_wheel_force.empty()) return;
  sweep.least_wheel_force[run] = result.least_wheel_force;
  sweep.greatest_wheel_force[run] = result.greatest_wheel_force;
  sweep.contact_losses[run] = result.contact_losses;
  sweep.longest_loss[run] = result.longest_loss;
}

/// Collective. Each run's numbers from the rank that has them.
void gather(MPI_Comm comm, results::Sweep& sweep) {
  for (std::vector<double>* values :
       {&sweep.deflection.value, &sweep.deflection.time, &sweep.acceleration.value, &sweep.acceleration.time,
        &sweep.moment.value, &sweep.moment.time, &sweep.amplification, &sweep.static_deflection,
        &sweep.least_wheel_force, &sweep.greatest_wheel_force, &sweep.contact_losses, &sweep.longest_loss}) {
    std::vector<double> known(*values);
    for (double& value : known)
      if (value != value) value = -std::numeric_limits<double>::infinity();
    MPI_Allreduce(MPI_IN_PLACE, known.data(), static_cast<int>(known.size()), MPI_DOUBLE, MPI_MAX, comm);
    std::transform(known.begin(), known.end(), values->begin(), [](double value) {
      return value == -std::numeric_limits<double>::infinity() ? results::Sweep::not_run : value;
    });
  }
}

std::string name_of(const Case& c, const results::Sweep& sweep) {
  const double from = sweep.speed[c.speeds.front()], to = sweep.speed[c.speeds.back()];
  const std::string train = sweep.trains.empty() ? "" : fmt::format(" of train A{}", sweep.trains[c.train]);
  if (c.speeds.size() > 1)
    return fmt::format("one of the runs{} at {:g} to {:g} m/s ({:g} to {:g} km/h)", train, from, to, 3.6 * from,
                       3.6 * to);
  return fmt::format("the run{} at {:g} m/s ({:g} km/h)", train, from, 3.6 * from);
}

SharedWork work_of(const std::vector<Case>& cases, CaseRunner& runner, results::Sweep& sweep, long& ended) {
  SharedWork work;
  for (const Case& c : cases) work.pieces.push_back({c.speeds.size(), duration_of(c, runner)});
  work.take = [&](std::size_t piece, const std::function<void(double)>& reached) {
    const Case& c = cases[piece];
    std::vector<CaseRunner::Member> runs;
    for (const std::size_t i : c.speeds) runs.push_back({&runner, {sweep.speed[i], {}}});
    const std::vector<CaseResult> results = CaseRunner::run_together(c.train, runs, reached);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!results[i].ended) continue;
      store(results[i], c.train, c.speeds[i], sweep);
      ++ended;
    }
  };
  work.name = [&](std::size_t piece) { return name_of(cases[piece], sweep); };
  return work;
}

/// How many runs, what they will take and what would be quicker.
void announce(const Scene& scene, const CaseRunner& runner, const results::Sweep::Model& model, int ranks,
              std::vector<std::string>& notes) {
  const auto& speeds = runner.speeds();
  const double seconds = runner.cost_of_all() / ranks;
  notes.push_back(fmt::format("sweep of {} runs: {} speed{} from {:g} to {:g} m/s, {} train{}; above for the first one",
                              speeds.size() * runner.trains(), speeds.size(), speeds.size() == 1 ? "" : "s",
                              speeds.front(), speeds.back(), runner.trains(), runner.trains() == 1 ? "" : "s"));
  if (runner.has_lanes())
    notes.push_back(fmt::format("up to {} runs go side by side, in the lanes of {} vectors", scene.sweep->lanes,
                                lanes::instructions()));
  else if (!scene.vehicles.empty() && scene.model_modes > 0)
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

}  // namespace

int run_sweep(MPI_Comm comm, const Scene& given, results::Place place) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<std::string> notes;
  const SweepChoice choice = choose_for_sweep(given, notes);
  const Scene& scene = choice.scene;
  CaseRunner runner(scene, notes);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  for (const std::string& note : options::check_all_used(options::in_force())) notes.push_back(note);
  const std::vector<Case> cases = cases_of(runner);
  announce(scene, runner, choice.model, ranks, notes);
  print_notes(comm, notes);

  const SignalsNoted noted;
  results::Layout layout;
  layout.constants = stations(scene.output.probes, span_ends(*scene.beam));
  results::Recorder recorder(comm, std::move(place), layout, attributes(comm, scene), scene.options);
  results::Sweep sweep = empty_sweep(scene, runner, choice.model);
  const auto begin = std::chrono::steady_clock::now();
  long done[3] = {0, 0, 0};  // runs, the signal that came, runs that left their group
  RunFailure failure;
  {
    const results::Stage stage("runs of the sweep");
    failure = share_runs(comm, work_of(cases, runner, sweep, done[0]), scene.quiet);
    done[1] = caught_signal();
    done[2] = runner.alone();
  }
  failure = first_of(comm, std::move(failure));
  MPI_Allreduce(MPI_IN_PLACE, &done[0], 1, MPI_LONG, MPI_SUM, comm);
  MPI_Allreduce(MPI_IN_PLACE, &done[1], 1, MPI_LONG, MPI_MAX, comm);
  MPI_Allreduce(MPI_IN_PLACE, &done[2], 1, MPI_LONG, MPI_SUM, comm);
  gather(comm, sweep);

  const results::SweepCourse whole = {done[0], static_cast<long>(runner.speeds().size() * runner.trains()),
                                      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                                      failure.failed() ? failure.message
                                      : done[1] != 0   ? fmt::format("ended by signal {}", done[1])
                                                       : "reached its end"};
  try {
    results::record(sweep, recorder);
    recorder.finish_with(results::summary_of(sweep, whole), {"runs", "wall_seconds"});
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  if (rank == 0) {
    if (done[0] > 0) results::print_sweep(sweep);
    if (done[2] > 0)
      fmt::print("  {} of the runs left the others beside them, where wheels lost contact, and were taken alone\n",
                 done[2]);
    fmt::print("  {} of {} runs {} in {:.3g} s, {:.3g} ms each\n  {:<22}{}\nresults  {}\n", done[0], whole.planned,
               results::method_of(choice.model), whole.wall_seconds,
               1e3 * whole.wall_seconds / static_cast<double>(std::max(done[0], 1L)), "the sweep", whole.ended,
               scene.output.file.empty() ? "none" : scene.output.file);
  }
  if (failure.failed()) throw Error(failure.message, failure.status);
  const std::vector<double>& peaks = sweep.deflection.value;  // std::fmax passes over runs without one
  check_deflection(comm, scene, std::accumulate(peaks.begin(), peaks.end(), 0.0, [](double a, double b) {
                     return std::fmax(a, b);
                   }));
  return done[1] == 0 ? 0 : 128 + static_cast<int>(done[1]);
}

}  // namespace traverse::app
