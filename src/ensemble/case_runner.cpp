// Asks the engines of the table in turn, checks the input of the extreme runs, and groups runs for batches.
#include "ensemble/case_runner.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "engine/speed_class.hpp"
#include "run/passage.hpp"

namespace traverse::ensemble {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

CaseRunner::CaseRunner(const scene::Scene& scene, std::vector<std::string>& notes,
                       std::shared_ptr<run::SharedBeam> beam, bool checks)
    : cases_(scene, notes, std::move(beam)) {
  std::vector<std::string> ignored;
  for (std::size_t train = 0; checks && train < trains(); ++train)
    for (const double speed : std::set{speeds().front(), speeds().back()})
      const run::Passage check_of_input(cases_.of(train, {speed, {}}), *cases_.beam(),
                                        train == 0 && speed == speeds().front() ? notes : ignored);
  while (!(engine_ = engines[row_].serve(cases_, why_not_[row_]))) ++row_;
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

std::vector<Engine::Member> CaseRunner::by_engines(std::span<const Member> members) {
  std::vector<Engine::Member> all;
  for (const auto& [runner, one] : members) all.push_back({runner->engine_.get(), one});
  return all;
}

std::vector<CaseResult> CaseRunner::run_together(std::size_t train, std::span<const Member> members,
                                                 const std::function<void(double)>& reached) {
  const CaseRunner& first = *members.front().runner;
  std::vector<CaseResult> results = first.engine_->run(train, by_engines(members), reached);
  for (CaseResult& result : results) first.hide_unknown(result);
  return results;
}

CaseResult CaseRunner::run(std::size_t train, const CaseRun& run) {
  const Member alone{this, run};
  return run_together(train, {&alone, 1}).front();
}

std::vector<CaseResult> CaseRunner::greatest(std::size_t train, std::span<const Member> members) {
  const CaseRunner& first = *members.front().runner;
  std::vector<CaseResult> results = first.engine_->greatest(train, by_engines(members));
  for (CaseResult& result : results) first.hide_unknown(result);
  return results;
}

double CaseRunner::cost_of_all() const {
  double motion = 0.0;
  for (std::size_t train = 0; train < trains(); ++train)
    for (const double speed : speeds()) motion += duration(train, speed);
  return cost() * motion;
}

/// The moment of given modes is unknown, and limits that were not evaluated.
void CaseRunner::hide_unknown(CaseResult& result) const {
  if (cases_.scene().by_given_modes())
    for (base::ProbePeaks& peak : result.peaks) peak.moment = {unknown, unknown};
  result.evaluated.resize(cases_.scene().limits.size());
}

}  // namespace traverse::ensemble
