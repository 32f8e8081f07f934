// Observes a transient run: samples, extremes, energies and limits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "beam/support_line.hpp"
#include "coupling/system.hpp"
#include "integrate/stepper.hpp"
#include "recovery/load_movement.hpp"
#include "recovery/recovery.hpp"
#include "recovery/viscous_lag.hpp"
#include "results/recorder.hpp"
#include "results/terminal.hpp"
#include "run/axle_load_records.hpp"
#include "run/deck_acceleration.hpp"
#include "run/deflected_shape.hpp"
#include "run/exit_states.hpp"
#include "run/extrapolation_check.hpp"
#include "run/limit_check.hpp"
#include "run/outputs.hpp"
#include "run/plan.hpp"
#include "run/response_extremes.hpp"
#include "run/wheel_extremes.hpp"
#include "run/wheel_unloading.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Evaluates stored instants and steps: samples for the recorder, extremes for the summary.
class RunObserver {
 public:
  /// outputs: the datasets of the recorder; null: no samples are recorded.
  RunObserver(const Scene& scene, coupling::System& system, const beam::Beam* beam, results::Recorder& recorder,
              const Outputs* outputs = nullptr);

  /// Stores the deck's accelerations, which are filtered at the end of the run.
  void keep_accelerations(DeckAcceleration deck) { deck_ = std::move(deck); }

  /// After finish. Whether the peak of the filtered accelerations is within their unsettled end.
  bool ends_unsettled() const { return deck_ && deck_->ends_unsettled(); }

  /// Stores the wheels' forces, which are filtered at the end of the run.
  void keep_wheel_forces(FilteredWheels wheels) { filtered_wheels_ = std::move(wheels); }

  /// Records the forces of wheels as they pass given places of the track.
  void record_axle_passages(AxleLoadRecords passages) { axle_passages_ = std::move(passages); }

  /// Compares the run with the scene's limits at its end.
  void check_limits() { limit_check_.emplace(scene_, system_.fleet(), beam_); }

  void sample(const integrate::Instant& instant);
  /// Must be called at the end of every step, also of one that ends at a sample.
  void step(double t);
  /// Collective. Returns the summary, and stores the shape at the largest deflection in the recorder.
  results::Summary finish();
  /// After finish, which returned this summary.
  std::vector<results::Verdict> verdicts(const results::Summary& summary) const;
  /// Time of the latest instant, s.
  double last_time() const { return sample_.time; }
  const results::Summary& extremes() const { return summary_; }
  /// The summary with the extremes, also of wheels and contacts. Call after the last sample.
  const results::Summary& finished_extremes();
  /// Compares the run with its trial runs, which ended at `until`, s.
  void check_extrapolation(double until);
  const ExtrapolationCheck& extrapolation_check() const { return extrapolation_check_; }
  /// ExtrapolationCheck::roughness, after finish.
  double roughness_ratio() const { return extrapolation_check_.roughness(peaks_); }
  /// After finish. Whether the run had an event or roughness that trial runs did not cover, or a contact loss after
  /// losses_covered_until (s).
  bool has_uncovered_event(double losses_covered_until) const;
  /// Times at which wheels have lost contact, s.
  std::vector<double> losses() const;
  /// The values at the latest sample.
  const Observed& observed() const { return now_; }
  const train::WheelPaths& paths() const { return paths_; }
  /// The extremes, after the last sample.
  const ResponseExtremes& finished_peaks();

  /// Collective. Writes or reads the state of the observer.
  void keep(base::Archive& archive);

 private:
  void drag(const double* drag);
  void subtract_support_motion();
  void record_separations();
  void record_wheels();
  void store(bool end);
  void record_peaks();
  void record_largest_deflection();
  void record_energy();
  void record_static_deflections();

  const Scene& scene_;
  coupling::System& system_;
  const beam::Beam* beam_;
  results::Recorder& recorder_;
  std::optional<beam::Recovery> recovery_, rail_recovery_;
  std::optional<beam::LoadMovement> movement_;  // on the bridge
  std::optional<beam::ViscousLag> lag_;
  const Outputs* outputs_;  // null if this rank writes no file
  bool recorded_;           // whether any rank stores samples
  std::vector<beam::Response> drag_response_;
  std::vector<double> with_drag_;                 // accelerations including the accelerations of modal damping
  std::vector<beam::SupportLine> support_lines_;  // of each probe, if supports move vertically
  std::vector<double> ground_;                    // m: their displacements now, at every span end
  ResponseExtremes peaks_;
  ExtrapolationCheck extrapolation_check_;
  std::optional<DeckAcceleration> deck_;
  std::optional<LimitCheck> limit_check_;
  WheelExtremes wheels_;
  std::optional<FilteredWheels> filtered_wheels_;
  AxleLoadRecords axle_passages_;
  ExitStates exits_;
  train::WheelPaths paths_;  // if wheels may change their distances
  std::vector<double> wheel_forces_;
  std::size_t wheel_count_ = 0;
  bool finished_ = false;
  Observed now_;
  results::Sample sample_;
  results::Summary summary_;
  double largest_deflection_value_ = 0.0;  // m
  LargestDeflection largest_deflection_;
  coupling::Energy energy_at_start_;
  bool at_first_sample_ = true;
};

/// SolverError if the energy residual is so large that the result is invalid.
void check_balance(const Scene& scene, const results::Summary& summary);

}  // namespace traverse::app
