// Evaluates the quantities of all limits from a run and compares them with the limits. Rotations of the deck and
// accelerations of cars are evaluated for limits only.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/extremum.hpp"
#include "base/passage_peaks.hpp"
#include "beam/beam.hpp"
#include "results/verdict.hpp"
#include "run/response_extremes.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

using base::Extreme;

/// Rotations of the deck at the two ends of the bridge, and the relative rotations of decks at a joint or a hinge over
/// a support.
class DeckRotations {
 public:
  explicit DeckRotations(const beam::Beam& beam);
  /// Collective. v: this rank's displacements.
  void add(double t, const double* v);
  /// Records given rotations, rad, in the order of unknowns().
  void record(double t, std::span<const double> slopes) {
    for (std::size_t i = 0; i < ends; ++i) raise({std::abs(slopes[i]), t, i});
    for (std::size_t i = ends; i < ends + x_.size(); ++i)
      raise({std::abs(slopes[2 * i - 1] - slopes[2 * i - 2]), t, i});
  }
  /// Records a magnitude, rad; its place: the index in differences().
  void raise(const Extreme& one) {
    one.place < ends ? ends_.raise(one.value, one.time, one.place)
                     : joints_.raise(one.value, one.time, one.place - ends);
  }
  /// The unknowns of the ends, then the unknowns of the left and right side of each joint.
  const std::vector<int>& unknowns() const { return unknowns_; }
  /// What is recorded: the unknown of each end, with -1, then both unknowns of each joint.
  std::vector<std::pair<int, int>> differences() const;

  // Magnitudes, rad; below 0: none.
  const Extreme& at_ends() const { return ends_; }      // place: 0 left, 1 right
  const Extreme& at_joints() const { return joints_; }  // place: index in joints()
  const std::vector<double>& joints() const { return x_; }
  void keep(base::Bytes& bytes) { bytes(ends_, joints_); }

 private:
  static constexpr std::size_t ends = 2;

  const beam::Beam& beam_;
  std::vector<int> unknowns_;
  std::vector<double> slopes_;  // rad, of unknowns_
  std::vector<double> x_;       // m, of the joints
  Extreme ends_{-1.0}, joints_{-1.0};
};

/// Vertical accelerations of the heaviest body of each vehicle.
class CarAccelerations {
 public:
  explicit CarAccelerations(const train::Fleet& fleet);
  void add(double t);
  /// Records a magnitude, m/s2; its place: the index in bodies().
  void raise(const Extreme& one) { largest_.raise(one.value, one.time, one.place); }
  /// Index of the vehicle in Fleet::vehicles and of the body there, for each member.
  const std::vector<std::pair<std::size_t, Eigen::Index>>& bodies() const { return bodies_; }

  /// m/s2; place: the vehicle; value below 0: no vehicle.
  const Extreme& largest() const { return largest_; }
  const std::string& body(std::size_t vehicle) const;
  void keep(base::Bytes& bytes) { bytes(largest_); }

 private:
  const train::Fleet& fleet_;
  std::vector<std::pair<std::size_t, Eigen::Index>> bodies_;
  Extreme largest_{-1.0};
};

/// Records the quantities of limits during a run. Scene, fleet and beam must outlive this object.
class LimitCheck {
 public:
  /// beam: null without a bridge.
  LimitCheck(const scene::Scene& scene, const train::Fleet& fleet, const beam::Beam* beam);

  /// Collective. Evaluates an observed instant; v: this rank's displacements of the structure; supports: the reactions,
  /// which only bearing_uplift needs.
  void sample(double t, const double* v, std::span<const beam::Reaction> supports);
  /// Evaluates an instant at which only the rotations at the rotations' unknowns are known, rad.
  void rotations(double t, std::span<const double> slopes) { rotations_->record(t, slopes); }
  /// Evaluates an instant at which only the rates of the twist at the probes are known, rad/m.
  void twist_rates(double t, std::span<const double> rates) {
    for (std::size_t p = 0; p < rates.size(); ++p) twist_.raise(recovery::track_base * std::abs(rates[p]), t, p);
  }
  /// Records the largest magnitudes that are known: DeckRotations::raise, CarAccelerations::raise.
  void rotation(const Extreme& one) { rotations_->raise(one); }
  void car(const Extreme& one) { cars_.raise(one); }

  /// The verdicts, after the last instant.
  std::vector<results::Verdict> verdicts(const results::Summary& summary, const ResponseExtremes& peaks);
  /// What is found for each limit, from the peaks and the static deflection (m) at each probe. The summary has no
  /// values at probes but those of filtered series.
  std::vector<results::EvaluatedQuantity> evaluate(results::Summary summary, std::span<const base::ProbePeaks> peaks,
                                                   std::span<const double> static_deflection) const;

  void keep(base::Bytes& bytes) {
    if (rotations_) rotations_->keep(bytes);
    cars_.keep(bytes);
    bytes(twist_, uplift_);
  }

 private:
  friend struct Quantities;
  /// deflections: the largest deflection at each probe.
  std::vector<results::Verdict> verdicts(const results::Summary& summary, std::span<const Extreme> deflections) const;

  const scene::Scene& scene_;
  const train::Fleet& fleet_;
  const beam::Torsion* torsion_ = nullptr;  // null: the beam does not twist
  std::optional<DeckRotations> rotations_;
  CarAccelerations cars_;
  Extreme twist_{-1.0}, uplift_{-1.0};  // m at a probe; N at a span end; below 0: not known
};

}  // namespace traverse::run
