// Computes the runs of a study by the fastest admissible way: exact modal solutions, vectorised batches by elements, or
// single runs, also with mechanisms if linear vehicles are not accurate enough.
#include "case_runner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>
#include <tuple>

#include "engine/processor.hpp"
#include "engine/speed_class.hpp"
#include "ensemble/greatest_peaks.hpp"
#include "integrate/modal_peaks.hpp"
#include "run/signals.hpp"
#include "run/simulation.hpp"
#include "run/step_cost.hpp"

namespace traverse::app {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// The cost of a single run by the batch kernel, relative to a run in a full batch.
constexpr double single_run_factor = 20.0;
constexpr double seconds_per_sample = 1e-7;  // s, for the check of limits at one sample of a run by modes

}  // namespace

CaseRunner::CaseRunner(const Scene& scene, std::vector<std::string>& notes, std::shared_ptr<SharedBeam> beam,
                       bool checks)
    : scene_(scene), speeds_(scene.sweep->speeds), loads_(scene.sweep->loads), beam_(std::move(beam)) {
  if (speeds_.empty()) speeds_ = {moving_speed(scene)};
  if (loads_.empty()) loads_ = {scene.load};
  if (scene.train.speed > 0.0)
    for (const double x : wheels_at_start(scene)) last_wheel_ = std::min(last_wheel_, x);
  if (beam_ == nullptr) {
    beam_ = std::make_shared<SharedBeam>(PETSC_COMM_SELF, scene_, notes);
    beam_->set_up(scene_, !scene_.model.step || scene_.model.modes > 0, notes);
    if (scene_.exact_in_time())
      beam_->modal->add_probes(scene_.output.probes, scene_.self_weight ? scene_.gravity : 0.0);
  }
  set_up_limits(notes);
  if (scene_.exact_in_time() && scene_.has_run_limits() && !beam_->modal->dampers_couple())
    moving_force_limits_.emplace(scene_, *beam_, cutoff_frequency_);
  std::vector<std::string> ignored;
  for (std::size_t train = 0; checks && train < trains(); ++train) {
    for (const double speed : std::set{speeds_.front(), speeds_.back()})
      const Passage check_of_input(scene_of(train, {speed, {}}), *beam_,
                                   train == 0 && speed == speeds_.front() ? notes : ignored);
  }
  set_up_batches();
}

void CaseRunner::set_up_limits(std::vector<std::string>& notes) {
  if (filters_wheels(scene_)) scene_.sampling_interval = spacing_for(scene_.output.wheel_low_pass);
  if (!scene_.limits_deck_acceleration()) return;
  cutoff_frequency_ = cutoff_frequency(scene_, *beam_, true, notes);
  if (cutoff_frequency_ > 0.0)
    scene_.sampling_interval = std::min(scene_.sampling_interval, spacing_for(cutoff_frequency_));
}

void CaseRunner::set_up_batches() {
  if (scene_.exact_in_time()) return;
  by_batch_kernel_ = CaseBatch::obstacle(scene_, *beam_).empty();
  if (scene_.sweep->lanes == 0)
    lane_obstacle_ = "sweep_lanes is 0";
  else if (scene_.has_run_limits())
    lane_obstacle_ = "the check of limits needs single runs";
  if (!lane_obstacle_.empty()) return;
  scene_of(0, {speeds_.front(), {}});
  double distance = 0.0;
  for (const double speed : speeds_)
    distance = std::max(distance, speed * (duration(0, speed) + scene_.model.step.value_or(0.0)));
  lanes_ = CaseBatch::make(scene_, *beam_, distance, lane_obstacle_);
  if (lanes_) static_deflection_[0] = lanes_->static_deflection();
}

std::vector<std::vector<std::size_t>> group_runs(const std::vector<CaseRun>& runs, std::size_t most) {
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    return std::tuple(engine::speed_class(runs[i].speed_of_steps()), runs[i].seed, runs[i].speed);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t i : order) {
    const bool fits = !groups.empty() && groups.back().size() < most &&
                      engine::speed_class(runs[groups.back().front()].speed_of_steps()) ==
                          engine::speed_class(runs[i].speed_of_steps());
    if (!fits) groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

std::size_t CaseRunner::width() const {
  if (by_modes_only() && !beam_->modal->dampers_couple())
    return std::clamp<std::size_t>(scene_.sweep->lanes, 1, engine::best_width());
  return lanes_ ? scene_.sweep->lanes : 1;
}

std::vector<CaseResult> CaseRunner::run_together(std::size_t train, std::span<const Member> members,
                                                 const std::function<void(double)>& reached) {
  CaseRunner& first = *members.front().runner;
  std::vector<CaseResult> results;
  if (first.by_modes_only()) {
    std::vector<CaseRun> runs;
    for (const Member& member : members) runs.push_back(member.run);
    results = first.run_by_modes(train, runs);
  } else if (first.lanes_) {
    results = run_batch(train, members, reached);
  } else {
    for (const auto& [runner, one] : members) results.push_back(runner->run(train, one, reached));
  }
  for (CaseResult& result : results) first.hide_unknown(result);
  return results;
}

std::vector<CaseResult> CaseRunner::run_batch(std::size_t train, std::span<const Member> members,
                                              const std::function<void(double)>& reached) {
  std::vector<CaseBatch::Member> batch;
  for (const auto& [runner, one] : members)
    batch.push_back(
        {&*runner->lanes_, {one.speed, runner->duration(train, one.speed), one.seed, one.speed_of_steps()}});
  std::vector<CaseResult> results;
  for (const engine::BatchResult& batched :
       CaseBatch::ready(std::span<const CaseBatch::Member>(batch), batch.front().lanes->steps()).run()) {
    if (caught_signal() != 0) return std::vector<CaseResult>(members.size());
    const auto& [runner, one] = members[results.size()];
    if (batched.failure != engine::none || runner->lanes_->residual(batched) > runner->scene_.model.residual_limit) {
      ++runner->separate_runs_;
      results.push_back(runner->run(train, one, reached));
    } else {
      results.push_back(runner->result_of(batched, train));
    }
  }
  return results;
}

CaseResult CaseRunner::result_of(const engine::BatchResult& batched, std::size_t train) const {
  CaseResult result;
  static_cast<base::PassagePeaks&>(result) = batched;
  result.static_deflection = static_deflection_.at(train);
  result.outside_trials = batched.contact_losses > 0.0 && !scene_.model.trials_lost_contact;
  result.ended = true;
  return result;
}

const Scene& CaseRunner::scene_of(std::size_t train, const CaseRun& run) {
  scene_.load.forces = loads_[train].forces;
  scene_.load.positions = loads_[train].positions;
  set_speed(scene_, run.speed);
  if (run.seed) scene_.profile = scene_.roughness->profile(*run.seed);
  return scene_;
}

double CaseRunner::duration(std::size_t train, double speed) const {
  if (scene_.end_time) return *scene_.end_time;
  double last = last_wheel_;
  if (scene_.load.speed > 0.0)
    for (const double x : loads_[train].positions) last = std::min(last, x);
  return (scene_.beam->length() - last) / speed + scene_.tail.value_or(0.0);
}

double CaseRunner::cost() const {
  if (scene_.exact_in_time()) {
    const std::vector<double>& omega = beam_->modal->omega();
    const double instants = scene_.sweep->instants * omega.back() / (2.0 * std::numbers::pi);
    const double sampling_interval = moving_force_limits_ && std::isfinite(scene_.sampling_interval)
                                         ? seconds_per_sample / scene_.sampling_interval
                                         : 0.0;
    return instants * modal_instant_seconds(scene_, static_cast<double>(omega.size()), beam_->modal->dampers_couple()) +
           sampling_interval;
  }
  const double step = scene_.model.step.value_or(1.0);
  if (!by_batch_kernel_) return step_seconds(scene_, scene_.model.method) / step;
  return (lanes_ ? 1.0 : single_run_factor) * batch_stage_seconds(scene_, beam_->beam->mesh().elements()) *
         static_cast<double>(method_of(scene_).stages.size()) / step;
}

double CaseRunner::cost_of_all() const {
  double motion = 0.0;
  for (std::size_t train = 0; train < trains(); ++train)
    for (const double speed : speeds_) motion += duration(train, speed);
  return cost() * motion;
}

CaseResult CaseRunner::run(std::size_t train, const CaseRun& run, const std::function<void(double)>& reached) {
  return by_modes_only() ? run_by_modes(train, {&run, 1}).front()
                         : run_by_elements(scene_of(train, run), train, run, reached);
}

CaseResult CaseRunner::run_by_elements(const Scene& scene, std::size_t train, const CaseRun& run,
                                       const std::function<void(double)>& reached) {
  std::vector<std::string> ignored;
  // Stored factorisations of other runs have shifts that are equal except for rounding: results would depend on the
  // earlier runs of this rank.
  beam_->statics->delete_step_factors();
  const double covered_until = run.speed > 0.0 ? scene.model.trial_distance / run.speed : scene.model.trial_distance;
  Simulation simulation(scene, *beam_,
                        {.limits = scene.has_run_limits(),
                         .wheel_filter = true,
                         .deck_cutoff = cutoff_frequency_,
                         .trials_until = covered_until},
                        ignored);
  ObserverBy until_signal({}, [&](double t, long) {
    if (reached) reached(t);
    return caught_signal() == 0;
  });
  simulation.run({&until_signal});
  CaseResult result;
  result.peaks.resize(scene.output.probes.size());
  if (caught_signal() != 0) return result;
  if (simulation.system().linearisation_residual() > scene.model.residual_limit) {
    Scene with_mechanisms = scene;
    with_mechanisms.model.vehicles = VehicleModel::full;
    return run_by_elements(with_mechanisms, train, run, reached);
  }
  simulation.evaluation().check_balance();
  const Result found = simulation.result();
  static_cast<base::PassagePeaks&>(result) = found.passage_peaks();
  for (const results::Verdict& verdict : found.verdicts) result.evaluated.push_back(verdict.found);
  result.outside_trials = found.has_uncovered_event(scene.model.trials_lost_contact ? covered_until : 0.0);
  set_static_deflection(train, simulation);
  result.static_deflection = static_deflection_[train];
  result.ended = caught_signal() == 0;
  return result;
}

// Trains whose wheels keep their distances have the same static deflections in all runs.
void CaseRunner::set_static_deflection(std::size_t train, Simulation& simulation) {
  std::vector<double>& static_deflection = static_deflection_[train];
  if (static_deflection.empty() || !simulation.system().weights().pass_together(simulation.evaluation().paths()))
    static_deflection = simulation.static_deflections();
}

const modal_engine::MovingForcePassages& CaseRunner::passages_of(std::size_t train) {
  auto passage = passages_.find(train);
  if (passage == passages_.end()) {
    const train::MovingLoad& load = scene_of(train, {speeds_.front(), {}}).load;
    passage = passages_.try_emplace(train, *beam_->modal, load, scene_.start == Start::equilibrium).first;
    static_deflection_[train] = passage->second.static_peaks();
  }
  return passage->second;
}

std::vector<CaseResult> CaseRunner::greatest(std::size_t train, std::span<const Member> members) {
  std::vector<CaseRunner*> runners;
  std::vector<const modal_engine::MovingForcePassages*> passages;
  std::vector<ForceRun> runs;
  for (const auto& [runner, one] : members) {
    const auto place = static_cast<std::size_t>(std::find(runners.begin(), runners.end(), runner) - runners.begin());
    if (place == runners.size()) {
      runners.push_back(runner);
      passages.push_back(&runner->passages_of(train));
    }
    runs.push_back({place, one.speed, runner->duration(train, one.speed)});
  }
  const CaseRunner& any = *runners.front();
  const auto peaks =
      greatest_peaks(passages, runs, any.scene_.sweep->instants, any.width(), [] { return caught_signal() == 0; });
  std::vector<CaseResult> results(runners.size());
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    results[i].peaks = peaks[i];
    results[i].static_deflection = runners[i]->static_deflection_[train];
    results[i].ended = true;
    runners[i]->hide_unknown(results[i]);
  }
  return results;
}

/// The moment of given modes is unknown, and limits that were not evaluated.
void CaseRunner::hide_unknown(CaseResult& result) const {
  if (scene_.by_given_modes())
    for (base::ProbePeaks& peak : result.peaks) peak.moment = {unknown, unknown};
  result.evaluated.resize(scene_.limits.size());
}

std::vector<CaseResult> CaseRunner::run_by_modes(std::size_t train, std::span<const CaseRun> runs) {
  const modal_engine::MovingForcePassages& passages = passages_of(train);
  std::vector<double> speeds, ends;
  for (const CaseRun& one : runs) {
    speeds.push_back(one.speed);
    ends.push_back(duration(train, one.speed));
  }
  std::vector<CaseResult> results(speeds.size());
  const auto no_signal = [] { return caught_signal() == 0; };
  std::vector<std::vector<base::ProbePeaks>> peaks;
  if (beam_->modal->dampers_couple())
    for (std::size_t i = 0; i < speeds.size(); ++i)
      peaks.push_back(integrate::modal_peaks(*beam_->modal, passages.history(), speeds[i],
                                             scene_.start == Start::equilibrium, ends[i], scene_.sweep->instants,
                                             no_signal));
  else
    peaks = passages.peaks(speeds, ends, scene_.sweep->instants, no_signal);
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    results[i].peaks = peaks[i];
    results[i].static_deflection = static_deflection_[train];
    results[i].ended = caught_signal() == 0;
    if (!moving_force_limits_ || !results[i].ended) continue;
    scene_of(train, runs[i]);
    results[i].evaluated =
        moving_force_limits_->evaluate(train, ends[i], results[i].peaks, results[i].static_deflection);
  }
  return results;
}

}  // namespace traverse::app
