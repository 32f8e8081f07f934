// Computes the axle distance of a train, its resonance speeds v = f d/i, the cancellation speeds v = 2 f L/m of a
// simply supported span, their peaks in the table of a sweep, and the comparison with the rules of EN 1991-2.
#include "study/sweep_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "modes/modes.hpp"
#include "run/deck_acceleration.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"

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

constexpr double same_position = 0.005;  // m: two axles are at the same position below this difference
constexpr double repeated_share = 0.55;  // share of the train's weight that the axle distance has to repeat
constexpr int highest_multiple = 4;      // largest i
constexpr double largest_offset =
    0.5;  // largest distance between a resonance speed and its computed peak, in resonance widths
constexpr double resolved_offset =
    0.25;  // largest distance of a resonance speed to a computed speed that resolves the peak, in resonance widths
constexpr std::size_t max_axles = 400;  // number of leading axles from which the axle distance is computed
constexpr double rounding = 1e-9;
constexpr int max_nodes = 1000;  // nodes of the largest bridge whose frequencies are computed for predictions only

struct Axles {
  std::vector<double> x, forces;
  double length() const {
    if (x.empty()) return 0.0;
    const auto [rear, front] = std::minmax_element(x.begin(), x.end());
    return *front - *rear;
  }
};

/// The axles of train number `train` of the sweep. All wheels have the same weight here.
Axles axles_of(const scene::Scene& scene, std::size_t train) {
  if (!scene.vehicles.empty()) {
    const std::vector<double> x = scene::wheels_at_start(scene);
    return {x, std::vector<double>(x.size(), 1.0)};
  }
  const train::MovingLoad& load = scene.sweep->loads.empty() ? scene.load : scene.sweep->loads[train];
  return {load.positions, load.forces};
}

std::size_t trains_of(const scene::Scene& scene) { return std::max<std::size_t>(1, scene.sweep->loads.size()); }

bool simple_spans(const beam::BeamModel& beam) {
  const auto simple_support = [](beam::Support s) { return beam::fixes_vertical(s) && !beam::fixes_rotation(s); };
  const bool foundation =
      std::any_of(beam::foundation_kinds.begin(), beam::foundation_kinds.end(), [&](const beam::FoundationKind& kind) {
        return beam::acts(kind, beam) && (kind.bed != nullptr ? (beam.foundation.*kind.bed).has_value()
                                                              : !(beam.foundation.*kind.points).empty());
      });
  return std::all_of(beam.supports.begin(), beam.supports.end(), simple_support) && beam.EI.uniform() &&
         beam.mass.uniform() && !beam.track && beam.hinges.empty() && beam.cracks.empty() && !foundation &&
         (beam.spans.size() == 1 || beam.all_separate()) &&
         std::all_of(beam.spans.begin(), beam.spans.end(), [&](double span) { return span == beam.spans.front(); });
}

/// The largest value over the probes at each speed; NaN where the run has not ended.
std::vector<double> largest_over_probes(const results::StudyTable& sweep, const char* column, std::size_t train) {
  const std::vector<double>& values = sweep.find(column)->values;
  const std::size_t speeds = results::speeds_of_sweep(sweep.study()).size(), probes = sweep.probes();
  std::vector<double> worst;
  for (std::size_t i = 0; i < speeds; ++i) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>((train * speeds + i) * probes);
    worst.push_back(*std::max_element(begin, begin + static_cast<std::ptrdiff_t>(probes)));
  }
  return worst;
}

/// The speed of the highest local maximum near a resonance; Resonance::none if there is none.
double peak_near(const std::vector<double>& speed, const std::vector<double>& value, const results::Resonance& r) {
  double found = results::Resonance::none, highest = 0.0;
  for (std::size_t i = 1; i + 1 < speed.size(); ++i) {
    const bool close =
        std::abs(speed[i] - r.speed) <= largest_offset * r.width || (speed[i - 1] < r.speed && r.speed < speed[i + 1]);
    if (!close || !(value[i] > highest && value[i] >= value[i - 1] && value[i] >= value[i + 1])) continue;
    highest = value[i];
    found = speed[i];
  }
  return found;
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

double regular_distance(std::span<const double> x, std::span<const double> forces) {
  const std::size_t count = std::min(x.size(), max_axles);
  std::vector<std::pair<double, double>> pairs;  // distance, lesser force
  double weight = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    weight += forces[i];
    for (std::size_t j = 0; j < count; ++j)
      if (x[j] - x[i] > same_position) pairs.emplace_back(x[j] - x[i], std::min(forces[i], forces[j]));
  }
  std::sort(pairs.begin(), pairs.end());
  double best = 0.0, distance = 0.0;
  for (std::size_t from = 0, group_end = 0; from < pairs.size(); from = group_end) {
    double matched = 0.0, moment = 0.0;
    for (; group_end < pairs.size() && pairs[group_end].first - pairs[from].first < same_position; ++group_end) {
      matched += pairs[group_end].second;
      moment += pairs[group_end].second * pairs[group_end].first;
    }
    if (matched <= best * (1.0 + rounding)) continue;
    best = matched;
    distance = moment / matched;
  }
  return best > repeated_share * weight ? distance : 0.0;
}

std::vector<double> resonant_frequencies(const run::SharedBeam& shared) {
  if (!shared.modal && shared.beam->mesh().nodes() > max_nodes) return {};
  return run::first_frequencies(shared);
}

std::vector<results::Resonance> resonances_of(const scene::Scene& scene, std::span<const double> frequencies,
                                              double slowest, double fastest) {
  std::vector<results::Resonance> found;
  for (std::size_t train = 0; train < trains_of(scene); ++train) {
    const Axles axles = axles_of(scene, train);
    const double d = regular_distance(axles.x, axles.forces);
    for (std::size_t n = 0; d > 0.0 && n < frequencies.size(); ++n)
      for (int i = 1; i <= highest_multiple; ++i) {
        const double speed = frequencies[n] * d / i;
        if (speed < slowest || speed > fastest) continue;
        found.push_back(
            {train, static_cast<int>(n) + 1, i, frequencies[n], d, speed, speed * d / (i * axles.length())});
      }
  }
  return found;
}

std::vector<results::Cancellation> cancellations_of(const beam::BeamModel& beam, std::span<const double> frequencies,
                                                    double slowest, double fastest) {
  std::vector<results::Cancellation> found;
  if (!simple_spans(beam)) return found;
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const int mode = static_cast<int>(i) + 1;
    for (int half_waves = mode % 2 == 0 ? 2 : 1;; half_waves += 2) {
      const double speed = 2.0 * frequencies[i] * beam.spans.front() / half_waves;
      if (speed < slowest) break;
      if (half_waves != mode && speed <= fastest) found.push_back({mode, half_waves, speed});
    }
  }
  return found;
}

void find_peaks(const results::StudyTable& sweep, std::vector<results::Resonance>& resonances) {
  if (sweep.probes() == 0) return;
  const std::vector<double>& speeds = results::speeds_of_sweep(sweep.study());
  for (results::Resonance& r : resonances) {
    r.of_deflection = peak_near(speeds, largest_over_probes(sweep, "peak_deflection", r.train), r);
    r.of_acceleration = peak_near(speeds, largest_over_probes(sweep, "peak_acceleration", r.train), r);
  }
}

std::vector<double> unresolved(std::span<const results::Resonance> resonances, std::span<const double> speeds) {
  std::vector<double> found;
  for (const results::Resonance& r : resonances) {
    const auto next = std::lower_bound(speeds.begin(), speeds.end(), r.speed);
    const double above = next == speeds.end() ? r.width : *next - r.speed;
    const double below = next == speeds.begin() ? r.width : r.speed - *(next - 1);
    if (std::min(above, below) > resolved_offset * r.width) found.push_back(r.speed);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace traverse::study
