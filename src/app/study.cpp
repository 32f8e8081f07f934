#include "traverse/app/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include "case_runner.hpp"
#include "deal.hpp"
#include "modes_choice.hpp"
#include "process.hpp"
#include "signals.hpp"
#include "traverse/app/accuracy.hpp"
#include "traverse/options/input.hpp"
#include "traverse/results/stage.hpp"
#include "traverse/results/sweep.hpp"
#include "traverse/results/terminal.hpp"
#include "trials.hpp"

namespace traverse::app {
namespace {

constexpr int nobody = std::numeric_limits<int>::max();

/// One run of the sweep.
struct Case {
  std::size_t train = 0, speed = 0;  // indices
};

/// Longest first, so that no rank ends long after the others.
std::vector<Case> cases_of(const CaseRunner& runner) {
  std::vector<Case> cases;
  for (std::size_t train = 0; train < runner.trains(); ++train)
    for (std::size_t speed = 0; speed < runner.speeds().size(); ++speed) cases.push_back({train, speed});
  std::stable_sort(cases.begin(), cases.end(), [&](const Case& a, const Case& b) {
    return runner.duration(a.train, runner.speeds()[a.speed]) > runner.duration(b.train, runner.speeds()[b.speed]);
  });
  return cases;
}

results::Sweep empty_sweep(const Scene& scene, const CaseRunner& runner) {
  results::Sweep sweep;
  sweep.speed = runner.speeds();
  sweep.trains = scene.sweep->trains;
  sweep.probes = scene.output.probes;
  const std::size_t runs = sweep.rows() * sweep.speed.size();
  const std::vector<double> none(runs * sweep.probes.size(), results::Sweep::not_run);
  sweep.deflection = sweep.acceleration = sweep.moment = {none, none};
  sweep.amplification = none;
  const auto rolls = [](const Vehicle& v) { return !v.wheels.empty(); };
  if (std::any_of(scene.vehicles.begin(), scene.vehicles.end(), rolls))
    sweep.least_wheel_force.assign(runs, results::Sweep::not_run);
  return sweep;
}

void store(const CaseResult& result, const Case& c, results::Sweep& sweep) {
  const std::size_t run = c.train * sweep.speed.size() + c.speed;
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
  }
  if (!sweep.least_wheel_force.empty()) sweep.least_wheel_force[run] = result.least_wheel_force;
}

/// What went wrong on this rank, if anything.
struct Failure {
  int run = nobody;  // in the order of dealing
  int status = 0;
  std::string message;
};

/// Collective. The failure of the earliest run, the same on every rank.
Failure first_of(MPI_Comm comm, Failure mine) {
  int ranks = 1, rank = 0;
  MPI_Comm_size(comm, &ranks);
  MPI_Comm_rank(comm, &rank);
  int place[2] = {mine.run, rank};
  MPI_Allreduce(MPI_IN_PLACE, place, 1, MPI_2INT, MPI_MINLOC, comm);
  if (place[0] == nobody) return {};
  int sizes[2] = {static_cast<int>(mine.message.size()), mine.status};
  MPI_Bcast(sizes, 2, MPI_INT, place[1], comm);
  mine.message.resize(static_cast<std::size_t>(sizes[0]));
  MPI_Bcast(mine.message.data(), sizes[0], MPI_CHAR, place[1], comm);
  return {place[0], sizes[1], mine.message};
}

/// Collective. Each run's numbers from the rank that has them.
void gather(MPI_Comm comm, results::Sweep& sweep) {
  for (std::vector<double>* values :
       {&sweep.deflection.value, &sweep.deflection.time, &sweep.acceleration.value, &sweep.acceleration.time,
        &sweep.moment.value, &sweep.moment.time, &sweep.amplification, &sweep.least_wheel_force}) {
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
  const double speed = sweep.speed[c.speed];
  const std::string train = sweep.trains.empty() ? "" : fmt::format(" of train A{}", sweep.trains[c.train]);
  return fmt::format("the run{} at {:g} m/s ({:g} km/h)", train, speed, 3.6 * speed);
}

/// This rank's share of the runs.
Failure run_share(const std::vector<Case>& cases, CaseRunner& runner, Deal& deal, results::Progress& progress,
                  results::Sweep& sweep, long& runs) {
  Failure failure;
  while (const auto piece = deal.next()) {
    const Case& c = cases[*piece];
    const auto fail = [&](int status, const std::string& why) {
      failure = {static_cast<int>(*piece), status, name_of(c, sweep) + " failed: " + why};
      deal.stop();
    };
    try {
      const CaseResult result = runner.run(c.train, runner.speeds()[c.speed]);
      if (result.ended) {
        store(result, c, sweep);
        ++runs;
      }
    } catch (const Error& error) {
      fail(error.status(), error.what());
    } catch (const std::exception& failed) {
      const Error error = as_error(failed);
      fail(error.status(), error.what());
    }
    if (caught_signal() != 0) deal.stop();
    progress.runs(deal.taken());
    results::Stage::advance(static_cast<double>(deal.taken()) / static_cast<double>(cases.size()));
  }
  return failure;
}

/// The scene of one run.
Scene at_speed(const Scene& sweep, double speed) {
  Scene scene = sweep;
  if (!sweep.sweep->loads.empty()) scene.load = sweep.sweep->loads.front();
  scene.train.speed = scene.vehicles.empty() ? 0.0 : speed;
  scene.load.speed = scene.load.forces.empty() ? 0.0 : speed;
  return scene;
}

/// With the finest mesh and step that the slowest, a middle and the fastest run need, or modes; the same on every rank.
Scene chosen(Scene scene, std::vector<std::string>& notes) {
  const std::vector<double>& speeds = scene.sweep->speeds;
  if (speeds.empty()) {
    const Accuracy accuracy = choose(PETSC_COMM_SELF, scene, notes);
    scene.model_modes = modes_that_do(scene, accuracy, notes);
    return scene;
  }
  std::optional<Accuracy> all;
  const Scene given = scene;
  for (const double speed : std::set{speeds.front(), speeds[speeds.size() / 2], speeds.back()}) {
    Scene one = at_speed(given, speed);
    std::vector<std::string> own;
    const Accuracy accuracy = choose(PETSC_COMM_SELF, one, own);
    if (!accuracy.measured) return given;
    notes.push_back(fmt::format("at {:g} m/s:", speed));
    notes.insert(notes.end(), own.begin(), own.end());
    const int mesh = all ? std::max(mesh_of(scene), mesh_of(one)) : mesh_of(one);
    if (!all || *one.time_step < *scene.time_step) scene.time_step = one.time_step;
    set_mesh(scene, mesh);
    scene.rest_tolerance = one.rest_tolerance;
    scene.step_probes = one.step_probes;
    if (!all) all = accuracy;
    for (std::size_t q = 0; q < quantities; ++q) all->promises[q].kept &= accuracy.promises[q].kept;
  }
  notes.push_back(fmt::format("all runs: {} elements a {}, steps of {:g} s", mesh_of(scene),
                              scene.beam->track ? "sleeper bay" : "span", *scene.time_step));
  scene.model_modes = modes_that_do(scene, *all, notes);
  return scene;
}

}  // namespace

int run_sweep(MPI_Comm comm, const Scene& given) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<std::string> notes;
  const Scene scene = chosen(given, notes);
  CaseRunner runner(scene, notes);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  for (const std::string& note : options::check_all_used(options::in_force())) notes.push_back(note);
  const std::vector<Case> cases = cases_of(runner);
  const auto& speeds = runner.speeds();
  notes.push_back(fmt::format("sweep of {} runs: {} speed{} from {:g} to {:g} m/s, {} train{}; above for the first one",
                              cases.size(), speeds.size(), speeds.size() == 1 ? "" : "s", speeds.front(), speeds.back(),
                              runner.trains(), runner.trains() == 1 ? "" : "s"));
  if (ranks > 1)
    notes.push_back(fmt::format("{} ranks share the runs, each takes the next one when it is free", ranks));
  print_notes(comm, notes);

  const SignalsNoted noted;
  results::Layout layout;
  layout.probes = scene.output.probes;
  results::Recorder recorder(comm, scene.output.file, layout, attributes(comm, scene), scene.options);
  results::Sweep sweep = empty_sweep(scene, runner);
  results::Progress progress(0.0, static_cast<double>(cases.size()), scene.quiet || rank != 0);
  const auto begin = std::chrono::steady_clock::now();
  long done[2] = {0, 0};  // runs, the signal that came
  Failure failure;
  {
    const results::Stage stage("runs of the sweep");
    Deal deal(comm, cases.size());
    failure = run_share(cases, runner, deal, progress, sweep, done[0]);
    done[1] = caught_signal();
  }
  progress.done();
  failure = first_of(comm, std::move(failure));
  MPI_Allreduce(MPI_IN_PLACE, &done[0], 1, MPI_LONG, MPI_SUM, comm);
  MPI_Allreduce(MPI_IN_PLACE, &done[1], 1, MPI_LONG, MPI_MAX, comm);
  gather(comm, sweep);

  results::Summary summary = results::extremes(sweep);
  summary.steps = done[0];
  summary.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  summary.ended = failure.run != nobody ? failure.message
                  : done[1] != 0        ? fmt::format("ended by signal {}", done[1])
                                        : "reached its end";
  try {
    results::record(sweep, recorder);
    recorder.finish(summary);
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  if (rank == 0) {
    if (done[0] > 0) results::print_sweep(sweep);
    fmt::print("  {} of {} runs in {:.3g} s, {:.3g} ms each\n  {:<22}{}\nresults  {}\n", done[0], cases.size(),
               summary.wall_seconds, 1e3 * summary.wall_seconds / static_cast<double>(std::max(done[0], 1L)),
               "the sweep", summary.ended, scene.output.file.empty() ? "none" : scene.output.file);
  }
  if (failure.run != nobody) throw Error(failure.message, failure.status);
  return done[1] == 0 ? 0 : 128 + static_cast<int>(done[1]);
}

}  // namespace traverse::app
