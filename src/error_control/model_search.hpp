// The search for mesh and step by trial runs: each is halved until what that changes tells the errors and how fast they
// fall; what lies near enough is extrapolated.
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

namespace traverse::app {

class ModelSearch {
 public:
  /// The scene with its Rayleigh damping as a and b; both must outlive it. end: of the run, s.
  ModelSearch(MPI_Comm comm, const Scene& scene, const SharedBeam& shared, double end);

  /// Collective.
  void run();
  /// Mesh and step of the scene, where they are open, and what they promise.
  Choice choice() const;

  double horizon() const { return horizon_; }  // s, of a trial run
  std::size_t trials() const { return trials_.count(); }
  double most_residual() const { return trials_.most_residual(); }  // of linear vehicles

 private:
  using Errors = std::array<ErrorModel, quantities>;
  double moved_by() const;
  double until_all_is_met(const SharedBeam& shared);
  void refine();
  void search();
  void accept_damped_vibration();
  [[noreturn]] void refuse_scene() const;
  void coarsen();
  void coarsen_mesh();
  void try_cheaper_methods();
  int predicted_mesh() const;
  void check_predicted_mesh();
  void check_step_on(int mesh);
  bool misses_when_predicted(std::size_t q) const;
  /// Between the mesh that is tried and another one, as large as it may have grown by the end of the run.
  double changed_by_mesh(int other, double step, Quantity q, const std::string& integrator = {});
  bool costs_next_to_nothing() const;
  double changed_by_step(double step, double finest, Quantity q);
  void measure_elsewhere();
  void measure();
  void count_alike();
  double effort() const { return std::max(search::refusal * wanted_, search::least_refusal); }
  double excess(const Errors& errors, const Errors& finest, const Errors& other) const;
  ErrorModel error_in_time(Quantity q);
  ErrorModel error_in_space(Quantity q);
  void refuse(std::size_t q, std::string why);
  void refuse_what_does_not_settle();
  void refuse_what_is_far();
  void refuse_what_is_given();
  bool promised(std::size_t q) const { return promises_[q].present && promises_[q].kept; }
  bool within_reach(const Errors& errors) const;
  double guess(const Errors& errors) const;
  bool worth_it(double step, int mesh) const;
  double allowed(const Errors& errors, std::size_t q) const;
  double room(const Errors& errors) const;
  double room_to_coarsen(const Errors& errors) const;
  double factor_of_step() const;
  double factor_of_elements() const;
  const char* unit_of_mesh() const { return scene_.beam->track ? "sleeper bay" : "span"; }

  MPI_Comm comm_;
  const Scene& scene_;
  double end_;               // of the run, s
  std::string not_covered_;  // what no trial run sees, in words; empty: nothing
  double horizon_;           // of trial runs, s
  TrialRuns trials_;
  bool open_mesh_, open_step_, open_integrator_;
  bool undamped_ = false;   // no damping grows with the frequency
  double wanted_;           // error of the step, and of the mesh
  std::string integrator_;  // chosen; empty: the default
  int mesh_, most_elements_;
  double most_coarsening_ = 2.0;  // times the measured elements; 1 where coarser ones have been measured
  double step_of_period_ = 0.0;   // s, that follows the beam's first period; 0: the first step does
  double first_step_ = 0.0, longest_step_ = 0.0, step_ = 0.0;  // s
  double growth_ = 1.0;  // of errors in free oscillations until these have died away, for runs longer than the trials
  std::array<ErrorEstimate, quantities> promises_{};
  std::array<bool, quantities> tried_{};   // refused by the search, with an error as small as it could be made
  std::array<int, quantities> stalled_{};  // halvings of the step in a row that have changed little
  int impact_agreement_ = 0;  // halvings in a row over which forces and accelerations agree, where wheels strike
  Errors time_{}, space_{};
  std::array<double, quantities> predicted_errors_{};  // errors of a mesh that was foreseen, measured
  double finest_step_ = 0.0;                           // s, tried, with its errors
  Errors finest_{};
  std::optional<std::pair<double, int>> measured_;  // step and mesh that the errors belong to
  std::string shortest_;                            // what asks for the shortest steps, in words
  std::optional<Errors> coarser_;                   // in time, of twice the step, where that is too long
};

}  // namespace traverse::app
