// Searches mesh and step by trial runs: each is halved until the changes determine the errors and their orders, and
// small distances are extrapolated.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "error_control/accuracy.hpp"
#include "error_control/error_model.hpp"
#include "error_control/model_choice.hpp"
#include "error_control/search_constants.hpp"
#include "error_control/trial_runs.hpp"
#include "run/shared_beam.hpp"

namespace traverse::error_control {

class ModelSearch {
 public:
  /// The scene must have its Rayleigh damping as a and b. Scene and beam must outlive this object. end: end of the run,
  /// s.
  ModelSearch(MPI_Comm comm, const scene::Scene& scene, const run::SharedBeam& shared, double end);

  /// Collective.
  void run();
  /// Mesh and step of the scene, as far as they are open, with their error estimates.
  Choice choice() const;

  double window() const { return window_; }  // s, duration of a trial run
  std::size_t trials() const { return trials_.count(); }
  double residual_limit() const { return trials_.residual_limit(); }  // limit for linear vehicles

 private:
  using Errors = std::array<ErrorModel, run::quantities>;
  double trimmed_time() const;
  double window_end(const run::SharedBeam& shared);
  void refine();
  void search();
  void accept_damped_vibration();
  [[noreturn]] void throw_too_expensive() const;
  void coarsen();
  void coarsen_mesh();
  void try_cheaper_methods();
  int predicted_mesh() const;
  void check_predicted_mesh();
  void check_step_on(int mesh);
  bool prediction_fails(std::size_t q) const;
  /// The change of the peaks by another mesh, multiplied by its possible growth until the end of the run.
  double change_by_mesh(int other, double step, run::Quantity q, const std::string& integrator = {});
  bool is_cheap() const;
  double change_by_step(double step, double finest, run::Quantity q);
  void measure_shifted_steps();
  void measure();
  void count_agreements();
  double coarsening_limit() const {
    return std::max(search::coarsening_factor * allowed_error_, search::min_coarsening_limit);
  }
  double excess(const Errors& errors, const Errors& finest, const Errors& other) const;
  ErrorModel error_in_time(run::Quantity q);
  ErrorModel error_in_space(run::Quantity q);
  void reject(std::size_t q, std::string why);
  void reject_unconverged();
  void reject_inaccurate();
  void reject_given_model();
  bool has_estimate(std::size_t q) const { return estimates_[q].present && estimates_[q].accepted; }
  bool can_extrapolate(const Errors& errors) const;
  double predicted_ratio(const Errors& errors) const;
  bool is_affordable(double step, int mesh) const;
  double allowed(const Errors& errors, std::size_t q) const;
  double allowed_ratio(const Errors& errors) const;
  double coarsening_ratio(const Errors& errors) const;
  double factor_of_step() const;
  double factor_of_elements() const;
  const char* unit_of_mesh() const { return scene_.beam->track ? "sleeper bay" : "span"; }

  MPI_Comm comm_;
  const scene::Scene& scene_;
  double end_;               // end of the run, s
  std::string not_covered_;  // an event outside the trial runs, in words; empty: none
  double window_;            // duration of trial runs, s
  TrialRuns trials_;
  bool open_mesh_, open_step_, open_integrator_;
  bool undamped_ = false;   // damping does not grow with the frequency
  double allowed_error_;    // relative, for the step and for the mesh each
  std::string integrator_;  // chosen method; empty: the default
  int mesh_, max_elements_;
  double max_coarsening_ = 2.0;  // relative to the measured elements; 1 if coarser ones were measured
  double step_of_period_ = 0.0;  // s, resolves the beam's first period; 0: the first step does
  double first_step_ = 0.0, longest_step_ = 0.0, step_ = 0.0;  // s
  double growth_ = 1.0;  // growth of errors after the trial runs, until free oscillations have decayed
  std::array<ErrorEstimate, run::quantities> estimates_{};
  std::array<bool, run::quantities>
      rejected_by_search_{};  // quantities that the search rejected, with the smallest error that was reached
  std::array<int, run::quantities> stalled_{};  // successive halvings of the step with little change
  int impact_agreement_ = 0;  // successive halvings over which forces and accelerations of impacting wheels agree
  Errors time_{}, space_{};
  std::array<double, run::quantities> predicted_errors_{};  // measured errors of a predicted mesh
  double finest_step_ = 0.0;                                // s, with its errors finest_
  Errors finest_{};
  std::optional<std::pair<double, int>> measured_;  // step and mesh of the errors
  std::string step_reason_;                         // the reason for the shortest time steps, in words
  std::optional<Errors> coarser_;                   // errors of twice the step, if that is too long
};

}  // namespace traverse::error_control
