// Runs of a scene with several meshes and steps, to measure discretisation errors.
#pragma once

#include <mpi.h>

#include <deque>
#include <span>
#include <utility>

#include "error_control/companion_search.hpp"
#include "error_control/linearisation_error.hpp"
#include "error_control/model_choice.hpp"
#include "run/response_extremes.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::error_control {

/// Output interval of trial runs in steps, for the energies; peaks are evaluated at every step.
inline constexpr double trial_steps_per_sample = 32.0;

/// The result of a run of which only the peaks are needed.
struct RunPeaks {
  run::ResponseExtremes peaks;
  bool lost_contact = false;
  double residual = 0.0;        // residual of linear vehicles, coupling::System::linearisation_residual
  double energy_missing = 0.0;  // relative to the change of the energies
  double amplification = 1.0;   // largest deflection over the largest static one

  void keep(base::Bytes& bytes) { bytes(peaks, lost_contact, residual, energy_missing, amplification); }
};

/// Collective. A run of the scene, whose step is given, sampled at every step. Its accelerations are low-passed if the
/// scene defines the frequency. The run ends if the linearisation residual exceeds its limit.
RunPeaks peaks_of(MPI_Comm comm, const scene::Scene& scene);

/// The linearisation residual of a trial run exceeds its limit.
struct ResidualTooLarge {
  double residual = 0.0;  // coupling::System::linearisation_residual
};

class TrialRuns : public Companions {
 public:
  /// The scene must have its Rayleigh damping as a and b. end: of the run, s.
  TrialRuns(MPI_Comm comm, scene::Scene scene, double end);

  /// Collective. If the scene leaves the vehicle model open, it is linear; then ResidualTooLarge if the linearisation
  /// residual is too large.
  bool run(const Discretisation& model) override { return !stored(model).peaks.failed(); }
  PeakErrors change(const Discretisation& coarse, const Discretisation& fine) override;
  /// Impacts are pulses that two runs may show alike by chance. A force that enters a beam excites all modes, the nth
  /// with an acceleration proportional to 1/n; moments of an undamped bridge are such a sum, too.
  double weight(std::size_t q) const override;
  double seconds(const Discretisation& model) override;
  int mesh_of_at_least(int elements) const override;

  /// Collective. The run with its peaks.
  const RunPeaks& stored(const Discretisation& model);
  /// Stores a run that was computed elsewhere.
  void store(const Discretisation& model, RunPeaks run) { stored_.push_back({model, std::move(run)}); }
  /// Writes or reads the runs of these models, with the other results of all runs.
  void keep(base::Bytes& bytes, std::span<const Discretisation> models);
  std::size_t count() const { return stored_.size(); }
  double end() const { return *scene_.end_time; }  // s
  /// The limit of the linearisation residual.
  double residual_limit() const { return residual_limit_; }
  bool lost_contact() const { return lost_contact_; }  // wheels lost contact in one of them

 private:
  struct StoredRun {
    Discretisation model;
    RunPeaks run;
  };
  scene::Scene with_model(const Discretisation& model) const;
  RunPeaks computed(const Discretisation& model);
  void measure_linearisation(const Discretisation& model);

  MPI_Comm comm_;
  scene::Scene scene_;
  std::deque<StoredRun> stored_;  // a deque, because references to entries must remain valid
  double residual_limit_;
  bool measured_linearisation_ = false;  // the limit was measured by comparison with the mechanisms
  bool lost_contact_ = false;
};

}  // namespace traverse::error_control
