// A transient run: time integration with everything that is recorded on the way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "integrate/stepper.hpp"
#include "recovery/recovery.hpp"
#include "recovery/viscous_lag.hpp"
#include "results/recorder.hpp"
#include "results/terminal.hpp"
#include "run/axle_load_records.hpp"
#include "run/deck_acceleration.hpp"
#include "run/deflected_shape.hpp"
#include "run/extrapolation_check.hpp"
#include "run/limit_check.hpp"
#include "run/outputs.hpp"
#include "run/plan.hpp"
#include "run/response_extremes.hpp"
#include "run/wheel_extremes.hpp"
#include "run/wheel_unloading.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Watches stored instants and steps: samples for the recorder, extremes for the summary.
class RunObserver {
 public:
  /// outputs: what the recorder's layout is of; null: no samples are recorded.
  RunObserver(const Scene& scene, coupling::System& system, const beam::Beam* beam, results::Recorder& recorder,
              const Outputs* outputs = nullptr);

  /// The deck's accelerations are filtered when the run has ended.
  void keep_accelerations(DeckAcceleration deck) { deck_ = std::move(deck); }

  /// After finish. Whether the peak of the filtered accelerations is within their unsettled end.
  bool ends_unsettled() const { return deck_ && deck_->ends_unsettled(); }

  /// The wheels' forces are filtered when the run has ended.
  void keep_wheel_forces(FilteredWheels wheels) { filtered_wheels_ = std::move(wheels); }

  /// The passages of wheels over places of the track are noted.
  void record_axle_passages(AxleLoadRecords passages) { axle_passages_ = std::move(passages); }

  /// The run is judged by the scene's limits when it has ended.
  void judge() { judge_.emplace(scene_, system_.fleet(), beam_); }

  void sample(const integrate::Instant& instant);
  /// To be called at the end of every step, also of one that ends at a sample.
  void step(double t);
  /// Collective. The summary so far, and the shape at the worst instant into the recorder.
  results::Summary finish();
  /// After finish, which gave this summary.
  std::vector<results::Verdict> verdicts(const results::Summary& summary) const;
  /// Of the latest instant that was seen, s.
  double last_time() const { return sample_.time; }
  const results::Summary& extremes() const { return summary_; }
  /// The peaks, those of wheels and contacts included; after the last sample.
  const results::Summary& finished_extremes();
  /// Trial runs have seen the run until then, s.
  void tell_beyond_trials(double until);
  const ExtrapolationCheck& beyond_trials() const { return beyond_trials_; }
  /// ExtrapolationCheck::bends, after finish.
  double bends_beyond_trials() const { return beyond_trials_.roughness(peaks_); }
  /// After finish. Whether anything was unlike what trial runs have seen, wheels that lost contact after some time (s)
  /// among it.
  bool met_unseen(double losses_seen_until) const;
  /// When wheels have lost contact, s.
  std::vector<double> losses() const;
  /// What was seen at the latest sample.
  const Observed& seen() const { return now_; }
  const train::WheelPaths& paths() const { return paths_; }
  /// The extremes so far, after the last sample.
  const ResponseExtremes& finished_peaks();

  /// Collective. What has been seen so far, written or read back.
  void keep(base::Archive& archive);

 private:
  void drag(const double* drag);
  void record_separations();
  void record_wheels();
  void store(bool end);
  void record_peaks();
  void record_worst();
  void record_energy();
  void record_static_deflections();

  const Scene& scene_;
  coupling::System& system_;
  const beam::Beam* beam_;
  results::Recorder& recorder_;
  std::optional<beam::Recovery> recovery_, rail_recovery_;
  std::optional<beam::ViscousLag> lag_;
  const Outputs* outputs_;  // null where this rank writes no file
  bool recorded_;           // whether some rank stores samples
  std::vector<beam::Response> dragged_;
  std::vector<double> with_drag_;  // accelerations with what damping by modes adds to them
  ResponseExtremes peaks_;
  ExtrapolationCheck beyond_trials_;
  std::optional<DeckAcceleration> deck_;
  std::optional<LimitCheck> judge_;
  WheelExtremes wheels_;
  std::optional<FilteredWheels> filtered_wheels_;
  AxleLoadRecords axle_passages_;
  train::WheelPaths paths_;  // where wheels are free to change their distances
  std::vector<double> wheel_forces_;
  std::size_t wheel_count_ = 0;
  bool finished_ = false;
  Observed now_;
  results::Sample sample_;
  results::Summary summary_;
  double most_deflected_ = 0.0;  // m
  LargestDeflection worst_;
  coupling::Energy energy_at_start_;
  bool first_ = true;
};

/// SolverError where so much energy does not balance that the result is meaningless.
void check_balance(const Scene& scene, const results::Summary& summary);

}  // namespace traverse::app
