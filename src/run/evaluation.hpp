// What is evaluated of a run: the responses at every instant, their extremes, energies and limits.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/passage_peaks.hpp"
#include "beam/mesh.hpp"
#include "coupling/system.hpp"
#include "integrate/stepper.hpp"
#include "recovery/load_movement.hpp"
#include "recovery/recovery.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "run/deck_acceleration.hpp"
#include "run/exit_states.hpp"
#include "run/limit_check.hpp"
#include "run/model_record.hpp"
#include "run/moving_probes.hpp"
#include "run/outputs.hpp"
#include "run/plan.hpp"
#include "run/profile_record.hpp"
#include "run/response_extremes.hpp"
#include "run/wheel_unloading.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// The result of a run, as values.
struct Result {
  /// The magnitudes of the peaks at each probe, and the extremes of all wheels.
  base::PassagePeaks passage_peaks() const;

  ResponseExtremes peaks;                        // of each quantity at every probe and wheel
  results::Summary summary;                      // greatest values; energies, residuals and cost of the run
  std::vector<results::Separation> separations;  // losses of contact
  bool lost_contact = false;                     // one of any contact that was closed at the start
  std::vector<results::Verdict> verdicts;        // on the scene's limits, if they were wanted
  bool filter_unsettled = false;                 // the low-passed peak is within the unsettled end of the filter
  // What is stored once, if it was wanted.
  std::vector<results::Recorder::Dataset> datasets;
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>> tables;
  std::optional<results::Shape> shape;

  /// Writes what is stored once.
  void record(results::Recorder& recorder) const;
};

/// What is evaluated of a run beyond its peaks and diagnostics.
struct Wants {
  bool stored = false;         // whatever a results file contains
  bool limits = false;         // the scene's limits
  bool wheel_filter = false;   // low-passed wheel forces, if the scene filters them
  double deck_cutoff = 0.0;    // Hz, of the filter for deck accelerations; 0: they are not filtered
  double deck_spacing = 1.0;   // longest spacing of the filter's instants over longest_spacing_for()
  bool filter_on_all = false;  // all ranks know the filtered peaks, not only the first one
};

class Evaluation {
 public:
  /// Scene, system and beam must outlive this object. The reasons why series are not filtered are appended to `notes`.
  Evaluation(const scene::Scene& scene, coupling::System& system, const beam::Beam* beam, const Plan& plan,
             const Wants& wants, std::vector<std::string>& notes);

  /// Evaluates an instant.
  void sample(const integrate::Instant& instant);
  /// Must be called at the end of every step, also of one that ends at a sample. StepTooLong if the motion diverges.
  void step(double t);
  /// StepTooLong if the energy residual is so large that the result is invalid.
  void check_balance() const;
  /// Collective. After the last instant, once.
  Result finish();

  bool filters_deck() const { return filters_deck_; }
  /// The values at the latest instant.
  const Observed& observed() const { return now_; }
  const train::WheelPaths& paths() const { return paths_; }
  double time() const { return time_; }  // s, of the latest instant

  /// Collective. Writes or reads the state.
  void keep(base::Archive& archive);

 private:
  void drag(const double* drag);
  void subtract_support_motion();
  void set_up_filters(const Plan& plan, std::vector<std::string>& notes);
  void add_wheels(double t);
  void record_separations(Result& result);
  void record_wheels();
  void evaluate_supports();
  void store();
  void record_peaks();
  void record_largest_deflection();
  void record_energy();
  void summarise_peaks();
  bool has_largest_deflection() const;
  void record_once(Result& result);

  const scene::Scene& scene_;
  coupling::System& system_;
  const beam::Beam* beam_;
  Wants wants_;
  std::optional<recovery::Recovery> recovery_, rail_recovery_;
  std::optional<recovery::LoadMovement> movement_;  // on the bridge
  std::optional<recovery::ViscousLag> lag_;
  std::vector<recovery::Response> drag_response_;
  std::vector<double> with_drag_;                 // accelerations including the accelerations of modal damping
  std::vector<beam::SupportLine> support_lines_;  // of each probe, if supports move vertically
  std::vector<double> ground_;                    // m: their displacements now, at every span end
  ResponseExtremes peaks_;
  std::optional<DeckAcceleration> deck_;
  bool filters_deck_ = false;  // on any rank
  std::optional<LimitCheck> limit_check_;
  WheelExtremes wheels_;
  std::optional<FilteredWheels> filtered_wheels_;
  AxleLoadRecords axle_passages_;
  ExitStates exits_;
  ProfileRecord profiles_;
  train::WheelPaths paths_;  // if wheels may change their distances
  MovingProbes moving_probes_;
  std::vector<double> wheel_forces_;
  std::vector<std::size_t> moving_wheels_;  // those of vehicles that are computed
  std::size_t wheel_count_ = 0;
  Observed now_;
  double time_ = 0.0;  // s, of the latest instant
  results::Summary summary_;
  double largest_deflection_value_ = 0.0;  // m
  LargestDeflection largest_deflection_;
  coupling::Energy energy_at_start_;
  bool at_first_sample_ = true;
};

}  // namespace traverse::run
