#include "traverse/app/run.hpp"

#include <fmt/format.h>
#include <petscversion.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "traverse/app/transient.hpp"
#include "traverse/modes/modes.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr double unbalanced = 0.1;  // of the largest energy: no answer then, whatever it looks like

std::atomic<int> caught{0};  // the signal that asks the run to end
void catch_signal(int signal) { caught = signal; }

using Attributes = std::vector<std::pair<std::string, std::string>>;

Attributes attributes(MPI_Comm comm, const Scene& scene) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  return {{"program", "traverse"},
          {"version", TRAVERSE_VERSION},
          {"petsc_version", fmt::format("{}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR)},
          {"ranks", std::to_string(ranks)},
          {"scene", scene.name}};
}

// Damping of the beam and the frequencies that it was taken from.
struct Dynamics {
  std::optional<std::pair<double, double>> omega;  // rad/s
  beam::Rayleigh rayleigh;
};

Dynamics damp(beam::Beam& beam, const Scene& scene, bool frequencies_wanted, std::vector<std::string>& notes) {
  Dynamics d;
  const Damping& damping = scene.damping;
  if (damping.frequencies)
    d.omega = {2.0 * std::numbers::pi * damping.frequencies->first,
               2.0 * std::numbers::pi * damping.frequencies->second};
  else if (damping.ratios || frequencies_wanted)
    d.omega = beam.rail() == nullptr && !beam.model().foundation.nonlinear()
                  ? modes::distinct_pair(beam)
                  : modes::distinct_pair(beam::Beam(beam.comm(), linearised(bridge_alone(beam.model()))));
  if (damping.rayleigh) d.rayleigh = {damping.rayleigh->first, damping.rayleigh->second};
  if (damping.ratios)
    d.rayleigh = modes::rayleigh(d.omega->first, d.omega->second, damping.ratios->first, damping.ratios->second);
  beam.set_rayleigh(d.rayleigh);
  if (d.omega)
    notes.push_back(
        fmt::format("first distinct frequencies {:.6g} and {:.6g} Hz; Rayleigh a = {:.6g} 1/s, b = {:.6g} s",
                    d.omega->first / (2.0 * std::numbers::pi), d.omega->second / (2.0 * std::numbers::pi), d.rayleigh.a,
                    d.rayleigh.b));
  return d;
}

coupling::SystemInput system_input(const Scene& scene) {
  return {scene.vehicles, scene.train, scene.load, scene.profile, scene.gravity, scene.self_weight, scene.impact_steps};
}

std::string what_track(const beam::Beam& beam) {
  const beam::LayeredTrack& t = *beam.model().track;
  return fmt::format(
      "layered track from {:g} to {:g} m: rail with {} elements, sleepers every {:g} m{}{}, {} unknowns a column",
      beam.rail()->mesh.start(), beam.rail()->mesh.end(), beam.rail()->mesh.elements(), t.spacing,
      t.ballast ? ", ballast" : "", t.subballast ? ", sub-ballast on the ground" : "", beam.block());
}

std::string what_beam(const beam::Beam& beam) {
  const beam::BeamModel& m = beam.model();
  return fmt::format("beam of {:g} m, {} span{}{}, {} elements, {} unknowns a node ({})", m.length(), m.spans.size(),
                     m.spans.size() == 1 ? "" : "s", m.all_separate() ? " (each of its own)" : "",
                     beam.mesh().elements(), m.axial ? 3 : 2,
                     m.axial ? "axial, deflection, rotation" : "deflection, rotation");
}

void print_notes(MPI_Comm comm, std::vector<std::string> notes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) results::print_modelled(notes);
}

// A file that cannot grow, which the writing rank alone knows: the others are not to wait for it.
[[noreturn]] void leave_together(MPI_Comm comm, const FileError& error) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  fmt::print(stderr, "traverse: {}\n", error.what());
  if (ranks > 1) MPI_Abort(comm, error.status());
  std::fflush(nullptr);
  std::_Exit(error.status());  // HDF5 may not survive closing what it could not write
}

int run_modes(MPI_Comm comm, const Scene& scene, beam::Beam& beam, std::vector<std::string> notes) {
  const Dynamics d = damp(beam, scene, true, notes);
  options::check_all_used(options::in_force());
  print_notes(comm, notes);
  const modes::Modes found = modes::natural_modes(beam, scene.mode_count, true);
  const bool damping = modes::damped(beam);
  const modes::DampedModes damped = damping ? modes::damped_modes(beam, scene.mode_count, true) : modes::DampedModes();
  results::Layout layout;
  layout.supports = beam.mesh().span_ends();
  for (int i = 0; i < beam.mesh().nodes(); ++i) layout.nodes.push_back(beam.mesh().x(i));
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) results::print_modes(found, d.omega->first, d.omega->second, d.rayleigh.a, d.rayleigh.b, damped);
  if (rank == 0 && d.rayleigh.b != 0.0 && damped.size() < found.omega.size())
    fmt::print(
        "  damped modes are listed below |lambda| = 1/b = {:.6g} rad/s: above it the elements decide, not the beam\n",
        1.0 / std::abs(d.rayleigh.b));
  if (scene.output.file.empty()) return 0;
  results::Recorder recorder(comm, scene.output.file, layout, attributes(comm, scene), scene.options);
  recorder.modes(found, d.rayleigh.a, d.rayleigh.b, d.omega->first, d.omega->second);
  if (damping) recorder.damped_modes(damped);
  results::Summary summary;
  summary.ended = "reached its end";
  recorder.finish(summary);
  if (rank == 0) fmt::print("results  {}\n", scene.output.file);
  return 0;
}

int run_transient(MPI_Comm comm, const Scene& scene, beam::Beam* beam, std::vector<std::string> notes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  Dynamics dynamics;
  const bool still = scene.analysis == Analysis::static_response;
  if (beam != nullptr) dynamics = damp(*beam, scene, !scene.time_step && !still, notes);
  coupling::SystemInput input = system_input(scene);
  if (still) input.train.speed = input.load.speed = 0.0;
  coupling::System system(comm, beam, std::move(input));

  // Everything is checked before anything is computed: the plan needs the train's place only.
  const double period = dynamics.omega ? 2.0 * std::numbers::pi / dynamics.omega->first : 0.0;
  Plan plan{0.0, 1.0, 1.0};
  if (!still) plan = make_plan(scene, system, period, notes);
  integrate::Stepper stepper(system, {plan.end_time, plan.time_step, plan.interval, system.known_events(plan.end_time),
                                      scene.contact_tolerance.value_or(1e-3 * plan.time_step)});
  for (const std::string& note : options::check_all_used(options::in_force())) notes.push_back(note);
  notes.push_back(fmt::format("vehicles {}, their degrees of freedom {}, moving forces {}",
                              system.fleet().members.size(), system.freedom(), scene.load.forces.size()));
  if (!still)
    notes.push_back(fmt::format("integrator {}, steps of at most {:g} s to {:g} s, samples every {:g} s",
                                stepper.method(), plan.time_step, plan.end_time, plan.interval));

  double* y = stepper.state();
  for (const std::string& line : system.start(still || scene.start == Start::equilibrium, y)) notes.push_back(line);
  stepper.restore_state(&y);
  if (system.static_error() > 1e-9)
    notes.push_back(
        fmt::format("static deflections: relative error about {:.1g}, by rounding in the many elements "
                    "between supports",
                    system.static_error()));
  print_notes(comm, notes);

  results::Recorder recorder(comm, scene.output.file, layout_of(scene, system, beam), attributes(comm, scene),
                             scene.options);
  if (dynamics.omega) {
    modes::Modes pair;
    pair.omega = {dynamics.omega->first, dynamics.omega->second};
    recorder.modes(pair, dynamics.rayleigh.a, dynamics.rayleigh.b, dynamics.omega->first, dynamics.omega->second);
  }
  Watch watch(scene, system, beam, recorder);
  results::Progress progress(0.0, plan.end_time, scene.quiet || rank != 0);
  const auto begin = std::chrono::steady_clock::now();
  auto summarise = [&](const std::string& ended) {
    results::Summary summary = watch.finish();
    summary.steps = stepper.steps();
    summary.solves = system.beam_solves();
    summary.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    summary.static_error = system.static_error();
    summary.ended = ended;
    recorder.finish(summary);
    progress.done();
    if (rank == 0) results::print_summary(summary, scene.output.file);
    return summary;
  };
  int stopped = 0;
  try {
    stepper.run([&](const integrate::Instant& instant) { watch.sample(instant); },
                [&](double t, long steps) {
                  watch.step(t);
                  progress.update(t, steps);
                  int signal = caught;
                  MPI_Allreduce(MPI_IN_PLACE, &signal, 1, MPI_INT, MPI_MAX, comm);
                  stopped = signal;
                  return signal == 0;
                });
  } catch (const FileError& error) {
    leave_together(comm, error);
  } catch (const Error& error) {
    summarise(error.what());
    throw;
  }
  results::Summary summary;
  try {
    summary = summarise(stopped != 0                 ? fmt::format("ended by signal {}", stopped)
                        : stepper.stopped_at_limit() ? "ended at the limit of -ts_max_steps"
                                                     : "reached its end");
  } catch (const FileError& error) {
    leave_together(comm, error);
  }
  if (const auto& crowded = system.fleet().crowded(); crowded.contact >= 0 && rank == 0) {
    const coupling::WheelContact& c = system.fleet().wheels[static_cast<std::size_t>(crowded.contact)];
    fmt::print(
        "  note: {} of vehicle {} overlapped the track's profile at more than {} points (first at x = {:g} m): the {} "
        "deepest carried\n",
        system.fleet().wheel(c).name, c.vehicle, track::most_points, crowded.x, track::most_points);
  }
  if (summary.energy_residual > unbalanced * summary.energy_scale)
    throw SolverError(
        fmt::format("the energy does not balance: {:g} J of {:g} J are missing; the step is too long for "
                    "this integrator, take a smaller -ts_dt or an implicit -ts_type",
                    summary.energy_residual, summary.energy_scale));
  return stopped == 0 ? 0 : 128 + stopped;
}

}  // namespace

int run(MPI_Comm comm, const Scene& scene) {
  std::signal(SIGINT, catch_signal);
  std::signal(SIGTERM, catch_signal);
  std::vector<std::string> notes;
  std::optional<beam::Beam> beam;
  if (scene.beam) {
    const std::string floating = scene.analysis == Analysis::modes ? "" : beam::floating_motion(*scene.beam);
    if (!floating.empty())
      throw InputError("support_types: the beam can float away (" + floating +
                       "); hold it with supports or a foundation");
    const bool nonlinear = scene.beam->foundation.nonlinear();
    if (nonlinear)
      notes.emplace_back(
          "one-sided foundations and those with a gap or a cubic term are forces; frequencies are those of "
          "small motions: what has no gap with its k, what has one without");
    beam.emplace(comm, nonlinear && scene.analysis == Analysis::modes ? linearised(*scene.beam) : *scene.beam);
    notes.push_back(what_beam(*beam));
    if (beam->rail() != nullptr) notes.push_back(what_track(*beam));
  }
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  if (scene.analysis == Analysis::modes) return run_modes(comm, scene, *beam, std::move(notes));
  return run_transient(comm, scene, beam ? &*beam : nullptr, std::move(notes));
}

}  // namespace traverse::app
