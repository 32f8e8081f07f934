// Computes resonance speeds for a sweep, their peaks in its table, and the comparison with the rules of EN 1991-2.
#include "study/sweep_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "modes/modes.hpp"
#include "results/sweep.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"
#include "study/resonances.hpp"

namespace traverse::study {
namespace {

constexpr double least_width = 0.01;  // relative to the speed: the smallest resonance width that is considered

/// Static effects and the verdict of EN 1991-2, if the scene has a norm.
std::optional<norm::NormCheck> check_by_norm(const scene::Scene& scene, const ensemble::CaseRunner& runner,
                                             const results::StudyTable& table) {
  if (!scene.norm) return {};
  norm::NormCheck check = run::norm_check(scene, run::static_trains(scene, *runner.beam()));
  if (!run::compares_with_lm71(scene)) return check;
  const std::vector<double>& speeds = results::speeds_of_sweep(table.study());
  norm::ComputedPeaks computed{speeds, runner.probes(), {}};
  const std::size_t trains = results::trains_of(table.study()), size = speeds.size() * table.probes();
  for (std::size_t train = 0; train < trains; ++train) {
    const auto of_train = [&](const char* column) {
      const auto from = table.find(column)->values.begin() + static_cast<std::ptrdiff_t>(train * size);
      return std::vector<double>(from, from + static_cast<std::ptrdiff_t>(size));
    };
    computed.trains.push_back({of_train("peak_deflection"), of_train("peak_moment")});
  }
  check.compare(computed);
  return check;
}

}  // namespace

SweepFindings::SweepFindings(const scene::Scene& scene, const ensemble::CaseRunner& runner)
    : scene_(scene), runner_(runner), frequencies_(resonant_frequencies(*runner.beam())) {
  const double slowest = runner.speeds().front(), fastest = runner.speeds().back();
  resonances_ = resonances_of(scene, frequencies_, slowest, fastest);
  cancellations_ = cancellations_of(*scene.beam, frequencies_, slowest, fastest);
}

std::vector<double> SweepFindings::unresolved_speeds() const { return unresolved(resonances_, runner_.speeds()); }

double SweepFindings::width_of_resonance() const {
  const run::SharedBeam& shared = *runner_.beam();
  const auto ratios = shared.damping_ratios();
  double damping = 0.0;  // ratio
  if (!ratios.empty())
    damping = ratios.front().beam + ratios.front().dampers;
  else if (!frequencies_.empty())
    damping = modes::BendingMode{2.0 * std::numbers::pi * frequencies_.front()}.ratio(shared.rayleigh);
  return std::max(2.0 * damping, least_width);
}

void SweepFindings::finish(const results::StudyTable& table) {
  find_peaks(table, resonances_);
  if (table.finished_runs() == table.runs()) check_ = check_by_norm(scene_, runner_, table);
}

void SweepFindings::add_to(std::vector<results::Verdict>& verdicts) const {
  if (check_) check_->find(verdicts);
}

void SweepFindings::record(results::Recorder& recorder) const {
  run::record_modes(*runner_.beam(), recorder);
  results::record(scene_.sweep->trains, resonances_, cancellations_, recorder);
  if (check_) check_->record(recorder);
}

void SweepFindings::print() const {
  const bool many = scene_.sweep->trains.size() > 1 && !scene_.verbose;
  if (many && !resonances_.empty()) fmt::print("resonance speeds: printed with -verbose, stored under /resonances\n");
  results::print(scene_.sweep->trains, many ? std::vector<results::Resonance>() : resonances_, cancellations_);
  if (check_) check_->print();
}

}  // namespace traverse::study
