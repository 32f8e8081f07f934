// The combined system of the paper's section 5 as an ordinary differential equation y' = G(t, y), the GCP-projected
// right-hand side, with y = (v, w, p, p', D, W):
//
//   v' = w,  w' from the structure's equations under P + S f_n + T f_t   the structure (structure.hpp), over all ranks
//   p'' from B^T (N (B p'' + d) - g - Q) = 0                             the vehicles' coordinates, on rank 0
//   D' = power lost in dampers and contacts, W' = power of loads, actuators and drivers
//
// Every rank stores all vehicles. In steps in second-order form it moves and evaluates its share of them
// (VehicleShare), and only observed states are complete on all ranks.
//
// The functions of a step in second-order form, as Stepper calls them:
//
//   step_motion            load_structure, MovingStructure::begin_step
//     stage_of_motion      once for each stage: computes v, w and p at zero acceleration
//       solve_coupled      LoadedStructure::solve_free, stage_of_fleet, LoadedStructure::apply_contact_loads; repeated
//                          until the latter accepts the stage
//         stage_of_fleet   places wheels on elements, gather_free and compliance, ContactNewton::solve
//       LoadedStructure::end_stage
//     (stage_by_passes in place of stage_of_fleet if all vehicles are linear: engine/linear_train.hpp)
//     finish_step          MovingStructure::finish_step, p and p' of all vehicles on all ranks
//   accept                 MovingStructure::accept, contact events, new independent coordinates where necessary
//   observe                forces, accelerations, energies: for samples only
//
// The implicit integrators of PETSc need y with G(t, y) = s y + c: `solve_stage` does the same for one stage.
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
#include "coupling/observation.hpp"
#include "coupling/quasi_static_response.hpp"
#include "coupling/train_sharing.hpp"
#include "engine/linear_trains.hpp"
#include "recovery/recovery.hpp"
#include "structure/structure.hpp"
#include "train/fleet.hpp"
#include "train/separations.hpp"
#include "train/vehicle_share.hpp"
#include "train/wheel_paths.hpp"

namespace traverse::structure {
class ElementStructure;
}

namespace traverse::coupling {

/// The parts of a scene that form a system.
struct SystemInput {
  std::vector<train::Vehicle> types;  // Train::vehicles points into it
  train::Train train;
  train::MovingLoad load;
  track::Profile profile;
  double gravity = 9.81;
  bool self_weight = false;       // gravity acts on the beam too
  int impact_steps = 20;          // least number of steps in an impact; 0: no limit
  bool local_compliance = false;  // whether a bridge's elements deflect between their nodes under wheels
  bool contact_points = false;    // observations of everything contain the contact points
  bool only_on_bridge = false;    // trains in steady motion beside the bridge, or behind it, are not computed
};

/// The structure by elements, with the self-weight of the scene; null without a beam. `shared`: an existing operator of
/// the beam with its factorisations; null: a new operator is created.
std::unique_ptr<structure::MovingStructure> by_elements(const beam::Beam* beam, const SystemInput& input,
                                                        std::shared_ptr<structure::BeamOperator> shared = nullptr);

/// A wheel of a vehicle whose prescribed speed changes. The force that accelerates the wheel's share of the vehicle
/// acts on the track at the wheel.
struct BrakingWheel {
  double x = 0.0;     // m, at t = 0
  double mass = 0.0;  // kg, share of the vehicle's mass in proportion to the wheel load
  base::SpeedLaw law;
  int track = 0;
};

class System {
 public:
  /// structure: null for a mechanism alone or for vehicles on rigid ground. Throws InputError for a wheel that would
  /// touch the profile at more points than the model allows.
  System(MPI_Comm comm, std::unique_ptr<structure::MovingStructure> structure, SystemInput input);
  /// A system whose structure is computed by_elements.
  System(MPI_Comm comm, const beam::Beam* beam, const SystemInput& input)
      : System(comm, by_elements(beam, input), input) {}
  ~System();

  MPI_Comm comm() const { return comm_; }
  const structure::Structure* structure() const { return structure_.get(); }  // null: none
  const beam::Beam* beam() const { return structure_ ? &structure_->beam() : nullptr; }
  const train::Fleet& fleet() const { return fleet_; }
  /// Whether a vehicle of the fleet is computed in the present step; otherwise its wheels are not on the bridge.
  bool is_present(int vehicle) const { return !trains_ || trains_->is_present(vehicle); }
  int local_size() const;                        // entries of y on this rank
  int structure_unknowns() const { return n_; }  // on this rank: v at y, w behind it
  int freedom() const { return fleet_.freedom(); }
  /// Collective. The extent of the structure at a state; none without a structure.
  structure::Extent extent(const double* y) const;

  /// Computes the initial state: static equilibrium at t = 0 with the drives at rest (the beam deflected under the
  /// train), then the train's speed; or the given positions and velocities, made consistent with the constraints.
  /// Throws SolverError if there is no equilibrium. Returns one line for each joint with redundant equations. stays: no
  /// motion follows, and the rail has no initial velocity.
  std::vector<std::string> start(bool equilibrium, double* y, bool stays = false);

  /// Collective. After start: linearises vehicles about the initial state if possible. Returns Fleet::linearise's
  /// lines. At a changing speed the coordinates in y are measured from another steady motion afterwards.
  std::vector<std::string> linearise_vehicles(double* y) {
    evaluate_fleet(0.0, y);
    std::vector<std::string> lines = fleet_.linearise();
    if (rank_ == 0) fleet_.coordinates_of_state(0.0, y + 2 * n_, y + 2 * n_ + fleet_.freedom());
    return lines;
  }
  /// Collective. The largest linearisation residual of the linear vehicles in the observed states, over their weights.
  double linearisation_residual() const {
    double largest = fleet_.linearisation_residual();
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, comm_);
    return largest;
  }

  /// Collective. ydot = G(t, y).
  void rate(double t, const double* y, double* ydot);

  /// Collective. y with G(t, y) = shift*y + c; the input y is the initial guess. False if no solution is found.
  bool solve_stage(double t, double shift, const double* c, double* y);

  // Second-order form without a PETSc stage: the steps of the program's own integrators.

  /// MovingStructure::limit_to_active_window, before begin_motion.
  void limit_to_active_window(const structure::WindowTolerance& tolerance, const std::vector<double>& probes) {
    if (structure_) structure_->limit_to_active_window(tolerance, probes);
  }
  /// Collective. The method of all following steps, for steps of 1 s.
  void begin_motion(const base::Method& method);
  /// Whether reject_step may follow a step.
  void store_steps(bool store) { store_steps_ = store; }
  /// Collective. Call before the first step from a state, and after a change of the state from outside, with the length
  /// h of the next step.
  void restart_motion(double t, double h, double* y);
  /// Collective. One step of h from t. If a stage has no solution, y is unchanged and the result is false. Spans that
  /// do not touch those under the loads are computed in accept(). `good_enough` is called after all stages are solved;
  /// if it returns false, the step is treated as not solved.
  bool step_motion(double t, double h, double* y, const std::function<bool()>& good_enough = {});
  /// Collective. Call before the first step if the errors of steps will be requested. InputError if there is no scale
  /// for the errors.
  void measure_errors();
  /// Collective. The dimensionless error of the step from y whose stages are solved, estimated by its embedded method.
  /// It is the larger of two values. For the structure: the square root of the ratio of the error's energy to the
  /// energy of the static deflection under the weights. For the worst vehicle: the root mean square of the errors of
  /// its masses' accelerations, relative to gravity plus these accelerations.
  double step_error(const double* y);
  /// Whether the structure's w' at the end of a step is that of the method: false if it differs from that of the state.
  bool provides_acceleration() const {
    return motion_ && motion_->unit.step.a_next[static_cast<std::size_t>(motion_->unit.step.known) - 1] == 1.0;
  }
  /// Sets y to the start of the last step; restart_motion has to follow.
  void reject_step(double* y);

  /// Before begin_motion, with a communicator of one rank and a bridge by elements: ranks share the trains of this
  /// scene, as far as possible. The first of them takes the steps, the others serve(), until it ends.
  void share_trains(std::unique_ptr<TrainSharing> sharing) { sharing_ = std::move(sharing); }
  void serve(double* y);
  /// Between observe and the next step: completes the observed nodal values by those of other ranks.
  void complete_motion() {
    if (!is_shared()) return;
    sharing_->request(TrainSharing::motion);
    receive_motion(accepted_, false);
  }

  /// Collective. Computes `out` for a state with the structure's w' = a (null: that at the end of the last step), and
  /// accelerations, reactions and wheel forces of the fleet. If `all` is false, the fleet has only the wheels'
  /// positions and forces if that is faster, and energies and nodal loads are not computed.
  void observe(double t, const double* y, const double* a, Observation& out, bool all = true);

  /// Applies constant forces from now on, in addition to the forces of the scene. Call between two steps.
  /// apply_to_body: see Fleet::apply. apply_to_beam: a vertical force (N, upward) at a station (m) of the beam on which
  /// wheels run; it replaces an earlier force there. InputError if there is no such beam or station.
  void apply_to_body(int member, int body, const Eigen::Vector3d& action);
  void apply_to_beam(double x, double force);
  /// Determines which moving forces are on the beam during the next step, which ends at known events. The middle of the
  /// step decides, so that a force that jumps at an event has the value of the correct side. True if this has changed.
  bool begin_step(double from, double to);

  /// Called before a step is computed, also before it is repeated.
  void begin_trial();
  /// Collective. Sets the vehicles to y at t, the end of a step, unless they are at this state.
  void set_vehicles(double t, const double* y);
  /// Collective. Accepts y at t, and selects new independent coordinates for badly conditioned ones. True if y was
  /// rewritten for that.
  bool accept(double t, double* y);
  /// Collective. The reason why the last stage could not be solved, with advice.
  std::string failure_reason() const;

  /// Times in (0, end) at which a force, a moment or an end of a line load enters or leaves the beam, a table of loads
  /// or of the supports' motion has a row, or a prescribed motion jumps in rate or acceleration. With `kinks`, for a
  /// prescribed speed, also the times at which a wheel or load passes a kink of the running surface, a moment a node,
  /// or at which a wheel's flat begins or ends to touch.
  std::vector<double> known_events(double end, bool kinks = true) const;
  /// Ascending stations at which the running surface may have a kink: kinks of the profile, and span ends.
  std::vector<double> surface_kinks() const { return surface_kinks(input_.profile); }
  std::vector<double> surface_kinks(const track::Profile& profile) const;
  /// The time at which the last wheel or force has left the beam or remains at rest (or, without a beam, infinity).
  /// Infinite if nothing ever moves and a wheel or force is on the beam.
  double leaving_time() const;
  /// Contact events, at which steps have to end.
  const ContactEvents& contacts() const { return events_; }
  /// Lists the kinks of the running surface that wheels with a prescribed speed pass until `end`. Call before the first
  /// step. step: the longest time step.
  void list_kinks(double end, double step) {
    std::vector<base::SpeedLaw> laws(fleet_.wheels.size());
    for (std::size_t i = 0; i < laws.size(); ++i)
      if (is_driven(static_cast<int>(i))) laws[i] = law_of_wheel(static_cast<int>(i));
    kink_events_.list_kinks(laws, end, step);
  }
  double kink_passages() const { return static_cast<double>(kink_events_.passages()); }
  /// KinkEvents::next and KinkEvents::time_of at the state y.
  std::optional<KinkEvents::KinkEvent> next_kink(double t, double h, const double* y) {
    return kink_events_.next(t, h, y, y + n_);
  }
  double time_of(const KinkEvents::KinkEvent& event, double t, const double* y) {
    return kink_events_.time_of(event, t, y, y + n_);
  }

  /// The weights of the wheels in the initial state, and the moving forces.
  QuasiStaticResponse& weights() { return weights_; }

  /// Largest estimated relative rounding error of static solutions so far.
  double static_error() const { return structure_ ? structure_->statics().static_error() : 0.0; }
  long beam_solves() const {
    return (structure_ ? structure_->statics().solves : 0) + static_cast<long>(sums_of_others().solves);
  }
  /// Collective. Energy lost so far by setting nodes to rest, J.
  double energy_left() const;
  long factorisations() const { return structure_ ? structure_->statics().factorisations() : 0; }

  /// Collective. Writes or reads the state between two steps, y and all data that the next steps depend on. Before
  /// reading, the same system has been started, and begin_motion called if it is used. FileError if the archive does
  /// not fit the system.
  void keep(base::Archive& archive, double* y);

 private:
  using Powers = structure::Powers;
  /// The vehicles' part of a second-order integration.
  struct Motion {
    base::Method unit, method;  // for steps of 1 s, for steps of `length`
    double length = 0.0;
    std::array<std::vector<double>, base::most_accelerations> pdd;  // p'' at the stages
    std::vector<double> p, pd;                                      // at the start of the step
    base::PowerIntegrals powers;                                    // this rank's share
    std::vector<double> before;                                     // y without the structure's part, before the step
    double energy_scale = 0.0;                                      // J, scale of the structure's errors
    std::vector<double> rate;                                       // for restarts
  };
  /// Shifts of a stage: w = shift*v + ..., w' = shift2*v + ...; shift 0: statics, where shift2 is the stiffness per
  /// mass of springs that tie masses to their positions.
  struct StageTime {
    double t = 0.0, shift = 0.0, shift2 = 0.0;
  };

  enum class Solution { found, fleet_failed, structure_failed };

  int per_node() const { return structure_ ? structure_->per_node() : 2; }
  void set_reference_loads();
  void find_equilibrium(double* y);
  bool static_wheel_loads();
  void freeze_fleet(const train::Train& train);
  void set_rail_velocity(double* w);
  void follow_surface(const double* y);
  void restart_from(std::vector<double> p);
  [[noreturn]] void throw_no_equilibrium(Solution found) const;
  void add_flats(const train::WheelContact& c, const base::SpeedLaw& law, double end,
                 std::vector<double>& events) const;
  base::SpeedLaw law_of_wheel(int wheel) const;
  bool is_driven(int wheel) const;
  double surface_height() const;
  double moment_about_axis(const train::WheelContact& c) const;
  void find_contact_points(const double* y, Observation& out);
  std::vector<double> values_on(const std::vector<int>& elements, const double* nodal) const;
  bool uses_local_compliance() const;
  void record_weights();
  void share_coordinates(const double* y);
  Solution solve_statics(double tie = 0.0, bool with_fleet = true);
  Solution solve_statics_slowly();
  Solution solve_coupled(const StageTime& at, bool with_fleet = true);
  bool stage_of_fleet(const StageTime& at);
  bool stage_by_passes(const StageTime& at);
  bool solve_stages(double t, const double* v, const double* w);
  bool solve_by_passes(double t, const double* y);
  bool is_length(double h) const;
  void make_linear_train();
  std::vector<base::Interval> presence_on_bridge() const;
  void place_entering(double t, double end);
  bool select_sides();
  void finish_passes();
  bool stage_of_motion(double t, std::size_t stage, const double* v, const double* w);
  const std::vector<structure::Reach>& loaded(double t, double h);
  void set_step(double h);
  void finish_step(double* y);
  double structure_error(const double* y);
  void load_structure(double t);
  beam::Station station_in_step(double x, double middle) const;
  void load_line(std::size_t i, double t);
  void turn_beam(recovery::ElementLoad load, int track, double speed);
  void record_shifted();
  std::size_t turning_source() const { return input_.load.forces.size() + braking_.size() + fleet_.wheels.size(); }
  double gradient() const;
  void record_braking();
  bool brakes_track(int wheel) const;
  bool update_braking(double t);
  structure::ElementLoads contact_loads();
  void evaluate_fleet(double t, const double* y);
  void share_step();
  void record_touched();
  bool contacts_are_known(double t) const;
  Powers powers(Powers of_structure);
  Powers fleet_powers();
  void move_supports(double t);
  Energy energy(const double* y);
  bool is_shared() const { return sharing_ && sharing_->divided_now; }
  bool may_share();
  structure::ElementStructure& elements();
  std::vector<TrainReach> reaches_of_trains(double t, double end);
  void begin_shared_step(double t, double h, double* y);
  void divide_trains(double t, double h, double* y);
  void recall(double* y, bool rejected = false);
  void receive_motion(double* y, bool kept);
  bool receive_trains(bool solved);
  SharedSums sums_of_others() const;
  void take_portion(double* y);
  void step_ahead(const TrainSharing::Command& step, double* y);
  void step_back(double* y);
  void send_trains();
  void send_motion(const std::vector<structure::Range>& columns, double* y);
  double force_sum_ = 0.0, moment_sum_ = 0.0;  // magnitudes of all loads, N and N m

  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
  std::unique_ptr<structure::MovingStructure> structure_;  // null: none
  const beam::Line* line_;  // line on which wheels and forces move; null without a structure
  int n_;                   // the structure's unknowns on this rank
  SystemInput input_;
  train::Fleet fleet_;
  train::VehicleShare share_;
  ContactEvents events_;
  KinkEvents kink_events_;
  QuasiStaticResponse weights_;
  ContactNewton newton_;

  std::vector<recovery::ElementLoad> loads_;            // loads of the moving forces on the beam
  std::vector<BrakingWheel> braking_;                   // wheels of trains whose speed is prescribed and changes
  std::vector<double> braking_force_;                   // N along x on the line, during the step
  std::vector<std::pair<StaticLoad, char>> shifted_;    // wheels in curves or on cant; whether they are on the line
  int unit_lever_ = 0;                                  // the line of action of their torques
  std::map<double, double> applied_;                    // N by station, m: the forces of apply_to_beam
  bool applied_changed_ = false;                        // since the last step
  std::vector<char> on_beam_;                           // whether each moving force is on the beam during the step
  double step_middle_ = 0.0;                            // s, middle of the step
  std::vector<double> middle_;                          // m, x of each moving force in the middle of the step
  std::string unsupported_;                             // known reason why there is no static equilibrium
  std::vector<double> p_, c_p_, pdd_;                   // p, p' and their c, p'', the same on all ranks
  std::vector<double> pd_;                              // initial p' of a stage's Newton iteration
  std::vector<double> p_predicted_, pd_predicted_, x_;  // p and p' at zero acceleration, and the stage's change of p
  std::vector<double> evaluated_;                       // p of the last state of the fleet
  double evaluated_time_ = 0.0;
  bool is_evaluated_ = false;  // evaluate_fleet() has set the fleet to this time, and no stage has changed it since
  unsigned flags_ = 0;         // flags of VehicleShare for that state or for the end of a step
  std::vector<double> v_, w_;  // displacements and rates of elements, 2*per_node each
  std::vector<double> element_loads_;
  std::vector<structure::Reach> reaches_;
  std::unique_ptr<Motion> motion_;                // null before begin_motion
  std::unique_ptr<engine::LinearTrains> trains_;  // null unless all vehicles are linear with plain contacts
  std::vector<double> wheels_at_start_;           // m, x of each wheel at t = 0, if trains are not always computed
  bool by_passes_ = false;                        // the step is computed with trains_
  std::unique_ptr<TrainSharing> sharing_;         // null: this rank moves all trains
  SharedSums returned_;                           // what other ranks have given back
  structure::StructureEnergy energy_;             // of this rank's spans, where it serves
  double* accepted_ = nullptr;                    // y of the last accept, to which the motion of other ranks is added
  std::size_t stage_ = 0;                         // number of the present stage in the step
  bool store_steps_ = false;
};

}  // namespace traverse::coupling
