// The combined system of the paper's section 5 as an ordinary differential equation y' = G(t, y), the
// GCP-projected right-hand side, with y = (v, w, p, p', D, W):
//
//   v' = w,  w' from the structure's equations under P + S f_n + T f_t   the structure (structure.hpp), cut over ranks
//   p'' from B^T (N (B p'' + d) - g - Q) = 0                             the vehicles' coordinates, on rank 0
//   D' = power lost in dampers and contacts, W' = power of loads, actuators and drivers
//
// Every rank holds all vehicles; in steps in second-order form it moves and evaluates its share of them (VehicleShare),
// and only what is observed is complete.
//
// A step in second-order form, as Stepper has it taken:
//
//   step_motion            load_structure, Structure::begin_step
//     stage_of_motion      once a stage: what v, w and p would be at zero acceleration
//       solve_coupled      Structure::solve_free, stage_of_fleet, Structure::take; again until Structure::judge agrees
//         stage_of_fleet   wheels placed on elements, Structure::gather_free and compliance, ContactNewton::solve
//       Structure::end_stage
//     (stage_by_passes in place of stage_of_fleet where all vehicles are linear: engine/linear_train.hpp)
//     finish_step          Structure::finish_step, p and p' of all vehicles on all ranks
//   accept                 Structure::complete_step, contacts lost and gained, worn coordinates chosen anew
//   observe                forces, accelerations, energies: of samples alone
//
// PETSc's own implicit integrators ask for y with G(t, y) = s y + c: `solve_stage` does the same once.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/one_step_methods.hpp"
#include "coupling/contact_events.hpp"
#include "coupling/contact_newton.hpp"
#include "coupling/kink_events.hpp"
#include "coupling/quasi_static_response.hpp"
#include "recovery/recovery.hpp"
#include "structure/structure.hpp"
#include "train/fleet.hpp"
#include "train/separations.hpp"
#include "train/vehicle_share.hpp"
#include "train/wheel_paths.hpp"

namespace traverse::engine {
class LinearTrain;
}

namespace traverse::coupling {

/// What a scene puts together.
struct SystemInput {
  std::vector<train::Vehicle> types;  // Train::vehicles points into it
  train::Train train;
  train::MovingLoad load;
  track::Profile profile;
  double gravity = 9.81;
  bool self_weight = false;  // gravity acts on the beam too
  int impact_steps = 20;     // of an impact, at least; 0: as the step is
  bool seats = false;        // a bridge's elements bend between their nodes under wheels
};

/// Which terms of G are meant: all; or, for implicit-explicit integrators, the beam with the moving forces
/// (implicit), or vehicles and contacts (explicit).
enum class Terms { all, beam, contact };

/// Stored energies and the integrals of the powers, J.
struct Energy {
  double kinetic = 0.0, strain = 0.0, potential = 0.0, dissipated = 0.0, work = 0.0;
  double structure = 0.0;  // kinetic and strain energy of the structure alone
};

/// An accepted instant; complete on every rank except the nodal values.
struct Observation {
  structure::NodalMotion beam;
  std::vector<beam::ElementLoad> loads;  // of wheels and forces, on the line that they run on
  /// All concentrated loads on the bridge: these where they run on it, and the foundation that is not linear. Inside an
  /// element a bed counts by its points of integration.
  std::vector<beam::ElementLoad> bridge_loads;
  Energy energy;
};

/// The structure by its elements, carrying what the scene says; null without a beam. `shared`: the beam's operator
/// where there is one already, with its factorisations.
std::unique_ptr<structure::Structure> by_elements(const beam::Beam* beam, const SystemInput& input,
                                                  std::shared_ptr<structure::BeamOperator> shared = nullptr);

/// A wheel of a vehicle whose prescribed speed changes: the force that accelerates its share of the vehicle acts on the
/// track there.
struct BrakingWheel {
  double x = 0.0;     // m, at t = 0
  double mass = 0.0;  // kg, of the vehicle, shared as the weight is
  base::SpeedLaw law;
};

class System {
 public:
  /// structure may be null: a mechanism on its own, or vehicles on rigid ground. Throws InputError for a wheel that
  /// would touch the profile at more points than are modelled.
  System(MPI_Comm comm, std::unique_ptr<structure::Structure> structure, SystemInput input);
  /// The same with a structure by_elements.
  System(MPI_Comm comm, const beam::Beam* beam, const SystemInput& input)
      : System(comm, by_elements(beam, input), input) {}
  ~System();

  MPI_Comm comm() const { return comm_; }
  const structure::Structure* structure() const { return structure_.get(); }  // null: none
  const beam::Beam* beam() const { return structure_ ? &structure_->beam() : nullptr; }
  const train::Fleet& fleet() const { return fleet_; }
  int local_size() const;                        // entries of y on this rank
  int structure_unknowns() const { return n_; }  // on this rank: v at y, w behind it
  int freedom() const { return fleet_.freedom(); }

  /// Writes the start: static equilibrium at t = 0 with the drives at rest (the beam deflected under the train),
  /// then the train's speed; or positions and velocities as given, made consistent with the constraints.
  /// SolverError when there is no equilibrium. Returns one line a joint with redundant equations.
  /// stays: no motion follows, and the deflection of a rail does not go along with the wheels.
  std::vector<std::string> start(bool equilibrium, double* y, bool stays = false);

  /// Collective. After start: takes vehicles as linear about it, those that can be. Returns Fleet::linearise's lines.
  std::vector<std::string> linearise_vehicles(const double* y) {
    evaluate_fleet(0.0, y);
    return fleet_.linearise();
  }
  /// Collective. How far the mechanisms have been from equilibrium in what was observed, over their weights: what
  /// linear vehicles leave out.
  double defect() const {
    double largest = fleet_.defect();
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, comm_);
    return largest;
  }

  /// Collective. ydot = G(t, y), or a part of it.
  void rate(double t, const double* y, double* ydot, Terms terms);

  /// Collective. y with G(t, y) = shift*y + c; y comes in as a guess. False where no solution is found.
  bool solve_stage(double t, double shift, const double* c, double* y, Terms terms);

  // In second-order form, without a PETSc stage: what an own integrator takes steps with.

  /// Structure::limit_to_active_window, before begin_motion.
  void limit_to_active_window(double tolerance, const std::vector<double>& probes) {
    if (structure_) structure_->limit_to_active_window(tolerance, probes);
  }
  /// Collective. The method of the steps to come, for steps of 1 s.
  void begin_motion(const structure::Method& method);
  /// Whether the last step can be taken back.
  void keep_steps(bool keep) { keep_steps_ = keep; }
  /// Collective. Before the first step from a state, and where it was changed from outside.
  void restart_motion(double t, double* y);
  /// Collective. One step of h from t; y is left as it is, and the result false, where a stage has no solution. Spans
  /// that do not touch those under the loads follow in accept(). `good_enough` is asked once all stages are solved;
  /// where it says no, it is as if they were not.
  bool step_motion(double t, double h, double* y, const std::function<bool()>& good_enough = {});
  /// Collective. Before the first step: steps are to be asked for their errors. InputError where there is no scale for
  /// those.
  void measure_errors();
  /// Collective. Of the step from y whose stages are solved, as its embedded method estimates it, without dimension:
  /// the larger of the structure's, whose energy's root is measured by that of the deflection under the weights at
  /// rest, and of the worst vehicle's, as a root of the mean of its masses' accelerations, measured by gravity and what
  /// they are.
  double step_error(const double* y);
  /// Whether acceleration() serves: not where a method's own acceleration is another one than the state's.
  bool knows_acceleration() const {
    return motion_ && motion_->unit.step.a_next[static_cast<std::size_t>(motion_->unit.step.known) - 1] == 1.0;
  }
  /// w' of the structure in the state that the last step led to; null without a structure.
  const double* acceleration() const { return structure_ ? structure_->acceleration() : nullptr; }
  /// Puts y back to where the last step began; a restart has to follow.
  void reject_step(double* y);

  /// Collective. Fills `out` for a state with the structure's w' = a, and the fleet with accelerations, reactions,
  /// wheel forces; where not all is wanted, the fleet only with its wheels' places and forces where that is quicker,
  /// and neither energies nor nodal loads.
  void observe(double t, const double* y, const double* a, Observation& out, bool all = true);

  /// Lets constant forces act from here on, between two steps, besides all that the scene has: Fleet::apply, and a
  /// vertical force (N, upward) at a station (m) of the beam that wheels run on, instead of the last one there.
  /// InputError where there is no such beam or station.
  void apply_to_body(int member, int body, const Eigen::Vector3d& action);
  void apply_to_beam(double x, double force);
  /// Settles which moving forces are on the beam during the coming step, which ends at known events: by its middle, so
  /// that a force that jumps at an event has its value of either side there. True when that has changed.
  bool begin_step(double from, double to);

  /// A step is about to be taken, or taken again.
  void begin_trial();
  /// Collective. Sets the vehicles to y at t, the end of a step, unless they are there.
  void arrive(double t, const double* y);
  /// Collective. Notes y as accepted at t and chooses new independent coordinates where the old ones have worn out.
  /// True when y was rewritten for that.
  bool accept(double t, double* y);
  /// Collective. Why the last stage could not be solved, and what to do about it.
  std::string trouble() const;

  /// Times in (0, end) at which a force comes onto the beam or leaves it, an actuator's table has a kink or a
  /// prescribed acceleration jumps; with `kinks`, for a prescribed speed, also those at which a wheel or force passes a
  /// kink of the running surface or the end of its own flat.
  std::vector<double> known_events(double end, bool kinks = true) const;
  /// Ascending stations at which the running surface may have a corner: of the profile, and span ends.
  std::vector<double> corners() const { return corners(input_.profile); }
  std::vector<double> corners(const track::Profile& profile) const;
  /// When the last wheel or force has left the beam or stands for good (or, without a beam, infinity); infinite when
  /// nothing ever moves and something stands on the beam.
  double leaving_time() const;
  /// What steps have to end at: contacts lost and gained, corners of the surface.
  const ContactEvents& contacts() const { return events_; }
  /// Before the first step, the longest one, those until `end`: where the speed is prescribed.
  void expect_corners(double end, double step) {
    std::vector<base::SpeedLaw> laws(fleet_.wheels.size());
    for (std::size_t i = 0; i < laws.size(); ++i)
      if (is_driven(static_cast<int>(i))) laws[i] = law_of_wheel(static_cast<int>(i));
    corners_.expect(laws, end, step);
  }
  /// KinkEvents::next and time_of at a state y.
  std::optional<KinkEvents::KinkPassage> next_kink(double t, double h, const double* y) {
    return corners_.next(t, h, y, y + n_);
  }
  double time_of(const KinkEvents::KinkPassage& turn, double t, const double* y) {
    return corners_.time_of(turn, t, y, y + n_);
  }

  /// The weights of wheels, as the start has found them, and moving forces.
  QuasiStaticResponse& weights() { return weights_; }

  /// Estimated relative error of static solutions so far, from rounding.
  double static_error() const { return structure_ ? structure_->statics().static_error() : 0.0; }
  long beam_solves() const { return structure_ ? structure_->statics().solves : 0; }
  long factorisations() const { return structure_ ? structure_->statics().factorisations() : 0; }

  /// Collective. The state between two steps, y and all that the next ones depend on, written or read back. When it is
  /// read, the same system has been started, and begin_motion called where it is. FileError where steps were taken
  /// apart then and cannot be now.
  void keep(base::Archive& archive, double* y);

 private:
  struct Powers {  // W; this rank's share
    double dissipation = 0.0, work = 0.0;
  };
  /// A second-order integration under way: of the vehicles.
  struct Motion {
    structure::Method unit, method;  // for steps of 1, for steps of `length`
    double length = 0.0;
    std::array<std::vector<double>, structure::most_accelerations> pdd;  // p'' at the stages
    std::vector<double> p, pd;                                           // at the start of the step
    std::array<Powers, structure::most_accelerations> powers;            // at the stages
    double dissipated = 0.0, worked = 0.0;                               // J, this rank's share
    struct {
      double dissipated = 0.0, worked = 0.0;
      std::vector<double> p;  // y behind the structure's
    } before;
    double energy_scale = 0.0;  // J, of the structure's errors
    std::vector<double> rate;   // of restarts
  };
  /// Shifts of a stage: w = shift*v + ..., w' = shift2*v + ...; shift 0: statics, where shift2 ties masses to where
  /// they are.
  struct StageTime {
    double t = 0.0, shift = 0.0, shift2 = 0.0;
  };

  enum class Solution { found, fleet_unsettled, structure_unsettled };

  int per_node() const { return structure_ ? structure_->per_node() : 2; }
  void expect_weights();
  void find_equilibrium(double* y);
  bool static_wheel_loads();
  void stand_still(const train::Train& train);
  void go_with_the_train(double* w);
  void follow_surface(const double* y);
  void go_on_from(std::vector<double> p);
  [[noreturn]] void refuse_start(Solution found) const;
  void add_flats(const train::WheelContact& c, const base::SpeedLaw& law, double end,
                 std::vector<double>& events) const;
  base::SpeedLaw law_of_wheel(int wheel) const;
  bool is_driven(int wheel) const;
  double surface_height() const;
  double moment_about_axis(const train::WheelContact& c) const;
  bool yields_inside() const;
  void record_weights();
  void share_coordinates(const double* y);
  Solution solve_statics(Terms terms, double tie = 0.0);
  Solution solve_statics_slowly();
  Solution solve_coupled(const StageTime& at, Terms terms);
  bool stage_of_fleet(const StageTime& at);
  bool stage_by_passes(const StageTime& at);
  bool take_stages(double t, const double* v, const double* w);
  void make_linear_train();
  void finish_passes();
  bool stage_of_motion(double t, std::size_t stage, const double* v, const double* w);
  const std::vector<structure::Reach>& loaded(double t, double h);
  void set_step(double h);
  void finish_step(double* y);
  double structure_error(const double* y);
  void load_structure(double t);
  void record_braking();
  bool brakes_track(int wheel) const;
  bool take_braking(double t);
  structure::ElementLoads contact_loads();
  void evaluate_fleet(double t, const double* y);
  void share_step();
  void record_touched();
  bool contacts_are_known(double t) const;
  void powers(const double* w, Terms terms, double& dissipation, double& work);
  Powers fleet_powers() const;
  Energy energy(const double* y);

  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  std::unique_ptr<structure::Structure> structure_;  // null: none
  const beam::Line* line_;                           // that wheels and forces run on; null without a structure
  int n_;                                            // the structure's unknowns on this rank
  SystemInput input_;
  train::Fleet fleet_;
  train::VehicleShare share_;
  ContactEvents events_;
  KinkEvents corners_;
  QuasiStaticResponse weights_;
  ContactNewton newton_;

  std::vector<beam::ElementLoad> loads_;                // of the moving forces now on the beam
  std::vector<BrakingWheel> braking_;                   // of trains whose speed is prescribed and changes
  std::vector<double> braking_force_;                   // N along x on the line, during the step under way
  std::map<double, double> applied_;                    // N by the station, m: the forces of apply_to_beam
  bool applied_anew_ = false;                           // since the last step
  std::vector<char> on_beam_;                           // of each moving force, during the step under way
  std::string nothing_holds_;                           // why there is no static equilibrium, where that is known
  std::vector<double> p_, c_p_, pdd_;                   // p, p' and their c, p'', the same on all ranks
  std::vector<double> pd_;                              // p' that a stage begins its Newton iteration with
  std::vector<double> p_predicted_, pd_predicted_, x_;  // p and p' at zero acceleration, and the stage's change of p
  std::vector<double> evaluated_;                       // p of the state that the fleet was last set to
  double evaluated_time_ = 0.0;
  unsigned signs_ = 0;         // VehicleShare's of that state or, after a step, of its end
  std::vector<double> v_, w_;  // of elements, 2*per_node each
  std::vector<double> element_loads_;
  std::vector<structure::Reach> reaches_;
  std::unique_ptr<Motion> motion_;              // null before begin_motion
  std::unique_ptr<engine::LinearTrain> train_;  // null: vehicles are not all linear, or their contacts not plain
  bool by_passes_ = false;                      // the step under way is taken with it
  std::size_t stage_ = 0;                       // of the step, that is under way
  bool keep_steps_ = false;
};

}  // namespace traverse::coupling
