// One Simulation for each run.
#include "ensemble/single_cases.hpp"

#include <limits>

#include "ensemble/case_batch.hpp"
#include "run/process.hpp"
#include "run/rank_choice.hpp"
#include "run/simulation.hpp"

namespace traverse::ensemble {
namespace {

// The cost of a single run by the batch kernel, relative to a run in a full batch.
constexpr double single_run_factor = 20.0;

}  // namespace

SingleEngine::SingleEngine(CaseSet& cases)
    : cases_(cases),
      by_batch_kernel_(!cases.scene().exact_in_time() && CaseBatch::obstacle(cases.scene(), cases.shared()).empty()) {}

double SingleEngine::cost() const {
  const scene::Scene& scene = cases_.scene();
  if (scene.exact_in_time()) return cases_.seconds_by_modes();
  if (by_batch_kernel_) return single_run_factor * cases_.seconds_in_batches();
  return run::step_seconds(scene, scene.model.method) /
         scene.model.step.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::vector<CaseResult> SingleEngine::run(std::size_t train, std::span<const Member> members,
                                          const std::function<void(double)>& reached) {
  std::vector<CaseResult> results;
  for (const auto& [engine, one] : members) {
    const auto& own = static_cast<const SingleEngine&>(*engine);
    results.push_back(own.run(own.cases_.of(train, one), train, one, reached));
  }
  return results;
}

CaseResult SingleEngine::run(const scene::Scene& scene, std::size_t train, const CaseRun& run,
                             const std::function<void(double)>& reached) const {
  std::vector<std::string> ignored;
  // Stored factorisations of other runs have shifts that are equal except for rounding: results would depend on the
  // earlier runs of this rank.
  cases_.shared().statics->delete_step_factors();
  run::Simulation simulation(
      scene, cases_.shared(),
      {.limits = scene.has_run_limits(), .wheel_filter = true, .deck_cutoff = cases_.cutoff_frequency()}, ignored);
  run::ObserverBy until_signal({}, [&](double t, long) {
    if (reached) reached(t);
    return run::caught_signal() == 0;
  });
  simulation.run({&until_signal});
  CaseResult result;
  result.peaks.resize(scene.output.probes.size());
  if (run::caught_signal() != 0) return result;
  if (simulation.system().linearisation_residual() > scene.model.residual_limit) {
    scene::Scene with_mechanisms = scene;
    with_mechanisms.model.vehicles = scene::VehicleModel::full;
    return this->run(with_mechanisms, train, run, reached);
  }
  simulation.evaluation().check_balance();
  const run::Result found = simulation.result();
  static_cast<base::PassagePeaks&>(result) = found.passage_peaks();
  for (const results::Verdict& verdict : found.verdicts) result.evaluated.push_back(verdict.found);
  result.outside_trials = found.lost_contact && !scene.model.trials_lost_contact;
  // Trains whose wheels keep their distances have the same static deflections in all runs.
  std::vector<double>& statics = static_deflection_[train];
  if (statics.empty() || !simulation.system().weights().pass_together(simulation.evaluation().paths()))
    statics = simulation.static_deflections();
  result.static_deflection = statics;
  result.ended = run::caught_signal() == 0;
  return result;
}

std::unique_ptr<Engine> single_engine_for(CaseSet& cases, std::string& /*why*/) {
  return std::make_unique<SingleEngine>(cases);
}

}  // namespace traverse::ensemble
