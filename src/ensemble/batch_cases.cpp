// Batches of linear vehicles in the lanes of vectors; what does not converge there, or needs mechanisms, is run by
// itself.
#include <algorithm>
#include <optional>
#include <utility>

#include "ensemble/batch_limits.hpp"
#include "ensemble/case_batch.hpp"
#include "ensemble/engines.hpp"
#include "ensemble/single_cases.hpp"
#include "run/process.hpp"

namespace traverse::ensemble {
namespace {

class BatchEngine : public Engine {
 public:
  BatchEngine(CaseSet& cases, std::unique_ptr<CaseBatch> lanes)
      : cases_(cases), lanes_(std::move(lanes)), static_deflection_(lanes_->static_deflection()), single_(cases) {
    if (cases.scene().has_run_limits()) limits_.emplace(cases.scene(), *lanes_, cases.cutoff_frequency());
  }

  std::vector<CaseResult> run(std::size_t train, std::span<const Member> members,
                              const std::function<void(double)>& reached) override;
  std::size_t width() const override { return cases_.scene().sweep->lanes; }
  double cost() const override { return cases_.seconds_in_batches(); }
  bool merge(const Engine& other) override {
    const auto* batch = dynamic_cast<const BatchEngine*>(&other);
    return batch != nullptr && steps().stored_each == batch->steps().stored_each && lanes_->merge(*batch->lanes_);
  }
  long separate_runs() const override { return separate_runs_; }

 private:
  CaseBatch::Steps steps() const { return limits_ ? limits_->steps() : lanes_->steps(); }

  CaseSet& cases_;
  std::unique_ptr<CaseBatch> lanes_;
  std::optional<BatchLimits> limits_;
  std::vector<double> static_deflection_;  // m
  SingleEngine single_;
  long separate_runs_ = 0;
};

std::vector<CaseResult> BatchEngine::run(std::size_t train, std::span<const Member> members,
                                         const std::function<void(double)>& reached) {
  std::vector<CaseBatch::Member> batch;
  for (const auto& [engine, one] : members) {
    const auto& own = static_cast<const BatchEngine&>(*engine);
    batch.push_back(
        {own.lanes_.get(), {one.speed, own.cases_.duration(train, one.speed), one.seed, one.speed_of_steps()}});
  }
  std::vector<CaseResult> results;
  const CaseBatch::Steps steps = static_cast<const BatchEngine&>(*members.front().engine).steps();
  for (const engine::BatchResult& batched : CaseBatch::ready(std::span<const CaseBatch::Member>(batch), steps).run()) {
    if (run::caught_signal() != 0) return std::vector<CaseResult>(members.size());
    const Member& member = members[results.size()];
    auto& own = static_cast<BatchEngine&>(*member.engine);
    const scene::NumericalModel& model = own.cases_.scene().model;
    if (batched.failure != engine::none || own.lanes_->residual(batched) > model.residual_limit) {
      ++own.separate_runs_;
      const Member alone{&own.single_, member.run};
      results.push_back(own.single_.run(train, {&alone, 1}, reached).front());
      continue;
    }
    CaseResult& result = results.emplace_back();
    static_cast<base::PassagePeaks&>(result) = batched;
    result.static_deflection = own.static_deflection_;
    if (own.limits_)
      result.evaluated = own.limits_->evaluate(batch[results.size() - 1].run, batched, own.static_deflection_);
    result.outside_trials = batched.contact_losses > 0.0 && !model.trials_lost_contact;
    result.ended = true;
  }
  return results;
}

}  // namespace

std::unique_ptr<Engine> batch_engine_for(CaseSet& cases, std::string& why) {
  const scene::Scene& scene = cases.of(0, {cases.speeds().front(), {}});
  if (scene.sweep->lanes == 0) why = "sweep_lanes is 0";
  if (!why.empty()) return nullptr;
  double distance = 0.0;
  for (const double speed : cases.speeds())
    distance = std::max(distance, speed * (cases.duration(0, speed) + scene.model.step.value_or(0.0)));
  std::unique_ptr<CaseBatch> lanes = CaseBatch::make(scene, cases.shared(), distance, why);
  return lanes ? std::make_unique<BatchEngine>(cases, std::move(lanes)) : nullptr;
}

}  // namespace traverse::ensemble
