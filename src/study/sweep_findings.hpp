// Results of a sweep in addition to the table of its runs: resonance speeds of trains with a regular axle distance,
// cancellation speeds of simply supported spans, and the verdict of EN 1991-2.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ensemble/case_runner.hpp"
#include "norm/dynamic_verdict.hpp"
#include "results/study_table.hpp"
#include "results/sweep.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::study {

/// The regular axle distance (m): the shift of a train after which most of its weight is at positions of axles of the
/// unshifted train. Each pair of axles contributes the lesser of its forces. Of equal shifts the shortest is returned;
/// 0 if no shift repeats more than about half of the weight. x in m.
double regular_distance(std::span<const double> x, std::span<const double> forces);

/// At most the first three distinct bending frequencies, Hz, ascending. Empty for a bridge with so many nodes that
/// computing them would be expensive.
std::vector<double> resonant_frequencies(const run::SharedBeam& shared);

/// The speeds v = f d/i for i = 1 to 4 within the given range (m/s), sorted by train, frequency and i.
std::vector<results::Resonance> resonances_of(const scene::Scene& scene, std::span<const double> frequencies,
                                              double slowest, double fastest);

/// For equal, uniform, simply supported spans L without foundations: the speeds v = 2 f_n L/(n + 2 k), at which a
/// constant force leaves no free vibration in the undamped mode n. The force excites the mode by sin(n pi v t/L). The
/// vibration after it is proportional to cos(n pi) - cos(omega L/v) and to sin(omega L/v); both are zero if omega L/v =
/// (n + 2 k) pi. For k = 0 the excitation itself is resonant.
std::vector<results::Cancellation> cancellations_of(const beam::BeamModel& beam, std::span<const double> frequencies,
                                                    double slowest, double fastest);

/// Sets the peaks of the computed curves near each resonance.
void find_peaks(const results::StudyTable& sweep, std::vector<results::Resonance>& resonances);

/// The resonance speeds whose peaks may not be resolved by `speeds` (ascending), because all of these are too far away.
std::vector<double> unresolved(std::span<const results::Resonance> resonances, std::span<const double> speeds);

class SweepFindings {
 public:
  /// Scene and runner must outlive this object.
  SweepFindings(const scene::Scene& scene, const ensemble::CaseRunner& runner);

  /// Resonance speeds (m/s) whose peaks are not resolved by the runner's speeds.
  std::vector<double> unresolved_speeds() const;
  /// The width of the first mode's resonances at half power, relative to the speed.
  double width_of_resonance() const;
  /// Computes the peaks near resonances and, if all runs have ended, the verdict of EN 1991-2.
  void finish(const results::StudyTable& table);
  /// Appends the results of EN 1991-2 to the verdicts on limits.
  void add_to(std::vector<results::Verdict>& verdicts) const;
  void record(results::Recorder& recorder) const;
  void print() const;

 private:
  const scene::Scene& scene_;
  const ensemble::CaseRunner& runner_;
  std::vector<double> frequencies_;  // Hz
  std::vector<results::Resonance> resonances_;
  std::vector<results::Cancellation> cancellations_;
  std::optional<norm::NormCheck> check_;
};

}  // namespace traverse::study
