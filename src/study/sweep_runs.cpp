#include "study/sweep_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::app {
namespace {

/// Runs of the sweep that one rank takes together.
struct Case {
  std::size_t train = 0;  // indices
  std::vector<std::size_t> speeds;
};

/// s of motion, of all its runs.
double duration_of(const Case& c, const CaseRunner& runner, const std::vector<double>& speeds) {
  double sum = 0.0;
  for (const std::size_t i : c.speeds) sum += runner.duration(c.train, speeds[i]);
  return sum;
}

/// Longest first, so that no rank ends long after the others.
std::vector<Case> cases_of(const CaseRunner& runner, const std::vector<double>& at) {
  std::vector<Case> cases;
  std::vector<CaseRun> runs;
  for (const double speed : at) runs.push_back({speed, {}});
  for (std::size_t train = 0; train < runner.trains(); ++train)
    for (const std::vector<std::size_t>& speeds : group_runs(runs, runner.width())) cases.push_back({train, speeds});
  std::stable_sort(cases.begin(), cases.end(), [&](const Case& a, const Case& b) {
    return duration_of(a, runner, at) > duration_of(b, runner, at);
  });
  return cases;
}

results::Sweep empty_sweep(const Scene& scene, const std::vector<double>& speeds) {
  results::Sweep sweep;
  sweep.speed = speeds;
  sweep.trains = scene.sweep->trains;
  sweep.probes = scene.output.probes;
  const std::size_t runs = sweep.rows() * sweep.speed.size();
  const std::vector<double> none(runs * sweep.probes.size(), results::Sweep::not_run);
  sweep.deflection = sweep.acceleration = sweep.moment = {none, none};
  sweep.amplification = none;
  sweep.unseen.assign(runs, results::Sweep::not_run);
  sweep.static_deflection.assign(sweep.rows() * sweep.probes.size(), results::Sweep::not_run);
  const auto rolls = [](const Vehicle& v) { return !v.wheels.empty(); };
  sweep.judged = results::Judged(scene.limits, runs);
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
    const auto put = [&](const base::Extreme& peak, results::Sweep::Peaks& into) {
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
  for (std::size_t l = 0; l < result.findings.size(); ++l) {
    const std::size_t at = run * result.findings.size() + l;
    sweep.judged.value[at] = result.findings[l].value;
    sweep.judged.x[at] = result.findings[l].x;
    if (std::isnan(result.findings[l].value)) sweep.judged.why[l] = result.findings[l].why;
  }
  sweep.unseen[run] = result.unseen ? 1.0 : 0.0;
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
        &sweep.least_wheel_force, &sweep.greatest_wheel_force, &sweep.contact_losses, &sweep.longest_loss,
        &sweep.unseen, &sweep.judged.value, &sweep.judged.x}) {
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
  for (const Case& c : cases) work.pieces.push_back({c.speeds.size(), duration_of(c, runner, sweep.speed)});
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

}  // namespace

SweepRuns run_all_trains(MPI_Comm comm, const Scene& scene, CaseRunner& runner, const std::vector<double>& speeds) {
  SweepRuns runs{empty_sweep(scene, speeds), 0, {}};
  const std::vector<Case> cases = cases_of(runner, speeds);
  runs.failure = first_of(comm, share_runs(comm, work_of(cases, runner, runs.sweep, runs.ended), scene.quiet));
  MPI_Allreduce(MPI_IN_PLACE, &runs.ended, 1, MPI_LONG, MPI_SUM, comm);
  gather(comm, runs.sweep);
  return runs;
}

}  // namespace traverse::app
