// Moving forces on modes, exact in time, several runs at a time, with limits and with bounds of the peaks of many runs.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/processor.hpp"
#include "ensemble/engines.hpp"
#include "ensemble/moving_force_limits.hpp"
#include "integrate/modal_peaks.hpp"
#include "modal_engine/greatest_peaks.hpp"
#include "modal_engine/moving_force_batch.hpp"
#include "run/process.hpp"

namespace traverse::ensemble {
namespace {

constexpr double seconds_per_sample = 1e-7;  // s, for the check of limits at one sample

bool no_signal() { return run::caught_signal() == 0; }

class ModalEngine : public Engine {
 public:
  explicit ModalEngine(CaseSet& cases) : cases_(cases) {
    if (scene().has_run_limits()) limits_.emplace(scene(), cases.shared(), cases.cutoff_frequency());
  }

  std::vector<CaseResult> run(std::size_t train, std::span<const Member> members,
                              const std::function<void(double)>& reached) override;
  std::size_t width() const override {
    return cases_.dampers_couple_modes() ? 1 : std::clamp<std::size_t>(scene().sweep->lanes, 1, engine::best_width());
  }
  double cost() const override {
    const double samples =
        limits_ && std::isfinite(scene().sampling_interval) ? seconds_per_sample / scene().sampling_interval : 0.0;
    return cases_.seconds_by_modes() + samples;
  }
  bool has_bounds() const override { return !scene().has_run_limits() && !cases_.dampers_couple_modes(); }
  std::vector<CaseResult> greatest(std::size_t train, std::span<const Member> members) override;

 private:
  const scene::Scene& scene() const { return cases_.scene(); }
  const modal_engine::MovingForcePassages& passages_of(std::size_t train);

  CaseSet& cases_;
  std::map<std::size_t, std::vector<double>> static_deflection_;       // m, for each train
  std::map<std::size_t, modal_engine::MovingForcePassages> passages_;  // for each train
  std::optional<MovingForceLimits> limits_;
};

const modal_engine::MovingForcePassages& ModalEngine::passages_of(std::size_t train) {
  auto passage = passages_.find(train);
  if (passage == passages_.end()) {
    const train::MovingLoad& load = cases_.of(train, {cases_.speeds().front(), {}}).load;
    passage =
        passages_.try_emplace(train, *cases_.shared().modal, load, scene().start == scene::Start::equilibrium).first;
    static_deflection_[train] = passage->second.static_peaks();
  }
  return passage->second;
}

std::vector<CaseResult> ModalEngine::run(std::size_t train, std::span<const Member> members,
                                         const std::function<void(double)>& /*reached*/) {
  const modal_engine::MovingForcePassages& passages = passages_of(train);
  std::vector<double> speeds, ends;
  for (const Member& member : members) {
    speeds.push_back(member.run.speed);
    ends.push_back(cases_.duration(train, member.run.speed));
  }
  std::vector<CaseResult> results(speeds.size());
  std::vector<std::vector<base::ProbePeaks>> peaks;
  if (cases_.dampers_couple_modes())
    for (std::size_t i = 0; i < speeds.size(); ++i)
      peaks.push_back(integrate::modal_peaks(*cases_.shared().modal, passages.history(), speeds[i],
                                             scene().start == scene::Start::equilibrium, ends[i],
                                             scene().sweep->instants, no_signal));
  else
    peaks = passages.peaks(speeds, ends, scene().sweep->instants, no_signal);
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    results[i].peaks = peaks[i];
    results[i].static_deflection = static_deflection_[train];
    results[i].ended = no_signal();
    if (!limits_ || !results[i].ended) continue;
    cases_.of(train, members[i].run);
    results[i].evaluated = limits_->evaluate(train, ends[i], results[i].peaks, results[i].static_deflection);
  }
  return results;
}

std::vector<CaseResult> ModalEngine::greatest(std::size_t train, std::span<const Member> members) {
  std::vector<ModalEngine*> all;
  std::vector<const modal_engine::MovingForcePassages*> passages;
  std::vector<modal_engine::ForceRun> runs;
  for (const Member& member : members) {
    auto* one = static_cast<ModalEngine*>(member.engine);
    const auto place = static_cast<std::size_t>(std::find(all.begin(), all.end(), one) - all.begin());
    if (place == all.size()) {
      all.push_back(one);
      passages.push_back(&one->passages_of(train));
    }
    runs.push_back({place, member.run.speed, one->cases_.duration(train, member.run.speed)});
  }
  const auto peaks = modal_engine::greatest_peaks(passages, runs, scene().sweep->instants, width(), no_signal);
  std::vector<CaseResult> results(all.size());
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    results[i].peaks = peaks[i];
    results[i].static_deflection = all[i]->static_deflection_[train];
    results[i].ended = true;
  }
  return results;
}

}  // namespace

std::unique_ptr<Engine> modal_engine_for(CaseSet& cases, std::string& why) {
  if (!cases.scene().exact_in_time())
    why = "the motion is not that of modes under moving forces alone";
  else if (cases.scene().has_run_limits() && cases.dampers_couple_modes())
    why = "dampers couple the modes, and limits are checked";
  else if (cases.scene().limits_quantity("bearing_uplift"))
    why = "limits of bearings are checked run by run";
  return why.empty() ? std::make_unique<ModalEngine>(cases) : nullptr;
}

}  // namespace traverse::ensemble
