// The structure's side of the coupling. Wheels and forces move on the structure's line. The coupling exchanges only
// nodal values of the line's elements, 2*per_node numbers for each element:
//
//   the motion of the elements without contact forces (gather),
//   their displacements under contact forces (ElementCompliance),
//   the computed contact forces (apply_contact_loads).
//
// The state of a structure is v and w = v' of its own unknowns: nodal displacements, or modal coordinates. The kind of
// structure determines the equations of a stage, their solution, and the stored data. A Structure can be observed at a
// state; a LoadedStructure solves stages under forces; a MovingStructure makes steps of stages.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "base/one_step_methods.hpp"
#include "recovery/recovery.hpp"
#include "structure/beam_operator.hpp"
#include "structure/compliance.hpp"
#include "structure/nonlinear_foundation.hpp"
#include "structure/ranges.hpp"
#include "structure/support_motion.hpp"

namespace traverse::structure {

/// Forces of contacts as nodal values of elements: 2*per_node for each element, N and N m.
struct ElementLoads {
  const std::vector<int>& elements;
  const std::vector<double>& values;
};

/// A load on a line as forces on the unknowns of its element, in the order of beam::Line::unknowns (equations 13 to
/// 15). Forces along x have an effect only if there are axial unknowns.
std::array<double, 6> on_unknowns(const beam::Line& line, const recovery::ElementLoad& force);

/// The largest magnitudes of the displacements, m, and rotations, rad, of a state.
struct Extent {
  double displacement = 0.0, rotation = 0.0;
};

/// The extent of `count` unknowns, column by column.
Extent extent_of(const double* v, const beam::Layout& layout, int count);

/// The range of the line in which a wheel or a force is during a step, m.
struct Reach {
  double from = 0.0, to = 0.0;
};

/// Energies of a structure and the integrals of its powers, J.
struct StructureEnergy {
  double kinetic = 0.0, strain = 0.0, potential = 0.0;
  double dissipated = 0.0, work = 0.0;  // since the start of the motion
};

using base::Powers;

/// An accepted instant of a structure, as this rank's nodal values of the beam.
struct NodalMotion {
  const double *v = nullptr, *w = nullptr, *a = nullptr;
  const double* damped_w = nullptr;  // the velocities that damping acts on: w, or relative to moving supports
  std::vector<double> P;             // loads, also on held unknowns, if requested
  std::vector<double> drag;          // acceleration whose inertia forces equal modal damping forces; empty: none
  std::vector<double> coordinates;   // by modes: q of each mode, m kg^(1/2), on every rank
  std::optional<std::vector<Range>>
      moving;  // ranges of columns outside of which the bridge is at rest; none: all moves
  NonlinearForces foundation;
  std::vector<recovery::ElementLoad> foundation_loads;  // loads from the nonlinear foundation
};

/// A structure with n unknowns on this rank. All functions are collective, except those that only return a value.
class Structure {
 public:
  /// gravity: for the self-weight of the beam, m/s2; 0: none. The beam must outlive the structure.
  Structure(const beam::Beam& beam, std::shared_ptr<BeamOperator> statics, double gravity);
  virtual ~Structure() = default;
  Structure(const Structure&) = delete;
  Structure& operator=(const Structure&) = delete;

  const beam::Beam& beam() const { return beam_; }
  const beam::Line& line() const { return line_; }  // line on which wheels and forces move
  int per_node() const { return line_.per_node; }
  int unknowns() const { return n_; }
  /// The beam's matrices, for static problems.
  BeamOperator& statics() const { return *statics_; }
  /// Nodal forces of the self-weight and the strains of the beam, this rank's unknowns of the beam.
  const std::vector<double>& dead_load() const { return dead_load_; }
  /// Whether the deflection of an element between its nodes is included under a wheel. Never by modes; otherwise always
  /// for a rail, which bends there, and for an element with shear, whose deflection has a kink under a wheel but not at
  /// the nodes; otherwise if requested.
  bool uses_local_compliance(bool requested) const {
    return mode_extents_.empty() && (requested || beam_.rail() != nullptr || beam_.model().GA.has_value());
  }
  /// Whether the structure is deformed without vehicles and moving forces.
  bool deformed_without_traffic() const { return gravity_ != 0.0 || beam_.model().strained(); }
  /// Collective. The displacements without traffic, without nonlinear foundations: this rank's unknowns of the beam.
  std::vector<double> displacements_without_traffic();
  /// Sets nodal forces on held unknowns to zero: the supports carry them.
  void release_held(double* nodal) const;
  /// Adds a vertical force (N, upward) inside an element of a line to this rank's nodal forces.
  void add_force(const beam::Line& line, const recovery::ElementLoad& force, double* nodal) const;
  /// Whether the superposition of loads is valid.
  bool linear() const { return !beam_.model().nonlinear(); }

  /// The supports move; before the first load. Only for structures by elements.
  void move_supports(std::shared_ptr<SupportMotion> motion) { support_motion_ = std::move(motion); }
  const SupportMotion* support_motion() const { return support_motion_.get(); }
  SupportMotion* support_motion() { return support_motion_.get(); }
  /// Sets the motion of the supports to its values at t, before load and gather.
  void set_time(double t) {
    if (support_motion_) support_motion_->set_time(t);
  }
  /// Collective. The power of forces on these elements, 2 per_node values each, with the velocities that the supports
  /// alone would cause, W.
  double power_with_supports(const ElementLoads& forces) const;
  /// Adds the motion of the supports to an observed state, which so far is that relative to them.
  void add_support_motion(NodalMotion& motion);

  /// v and w of elements at a state, on all ranks.
  void gather(const std::vector<int>& elements, const double* v, const double* w, std::vector<double>& v_elements,
              std::vector<double>& w_elements);
  /// This rank's share; by modes that of the mode that displaces the bridge most.
  Extent extent(const double* v) const;
  /// J, energy lost by setting nodes to rest so far, this rank's share.
  double energy_left() const { return energy_left_; }
  /// This rank's share.
  virtual StructureEnergy energy(const double* v, const double* w) = 0;
  /// A state with its accelerations a (null: those at the end of the last step) as nodal values, under the moving
  /// forces and the contacts' loads; with_loads: whether NodalMotion::P is requested.
  virtual void observe(const double* v, const double* w, const double* a, const ElementLoads& contacts, bool with_loads,
                       NodalMotion& out) = 0;

 protected:
  /// v and w of elements, this rank's part of them; at a state, or with null pointers the free response of the stage.
  /// Both arrays begin as zeros.
  virtual void add_values(const std::vector<int>& elements, const double* v, const double* w, double* v_elements,
                          double* w_elements) const = 0;
  void add_contacts(const ElementLoads& contacts, double* nodal) const;  // to this rank's nodal forces

  const beam::Beam& beam_;
  const beam::Line& line_;
  std::shared_ptr<BeamOperator> statics_;
  std::vector<double> dead_load_;
  double gravity_;
  int n_, ranks_ = 1;
  std::shared_ptr<SupportMotion> support_motion_;  // null: the supports are at rest
  std::vector<Extent> mode_extents_;               // of each mode's shape; empty: by elements
  double energy_left_ = 0.0;

 private:
  std::array<std::vector<double>, 3> absolute_;  // v, w, a with the motion of the supports
  std::vector<double> gathered_;                 // buffer of gather
};

/// A structure under forces in a stage, or at a state.
class LoadedStructure : public Structure {
 public:
  using Structure::Structure;
  using Verdict = NonlinearFoundation::Verdict;
  /// A stage's contacts by passes, and the displacements of each of their elements under forces on itself only.
  struct Passes {
    const ContactField& field;
    const ElementCompliance& own;
  };

  /// Sum of all weights and forces, and the greatest single one, N: the reference for forces of a foundation.
  virtual void set_reference_loads(double /*sum*/, double /*greatest*/) {}
  /// Sets the moving forces with their present positions.
  virtual void load(const std::vector<recovery::ElementLoad>& forces) = 0;
  /// w' of a state due to all loads, with those of contacts. Returns the powers at the state.
  virtual Powers accelerations(const double* v, const double* w, const ElementLoads& contacts, double* a) = 0;

  /// Statics under self-weight and moving forces; `loaded`: whether there are any.
  virtual void begin_statics(bool loaded) = 0;
  /// v and w with v' = w = shift*v + c_v, w' = shift*w + c_w; w_guess: an approximation of w.
  virtual void begin_stage(double shift, const double* c_v, const double* c_w, const double* w_guess) = 0;
  /// Computes the stage without contact forces.
  virtual void solve_free() = 0;
  /// v and w of elements in that solution, on all ranks.
  void gather_free(const std::vector<int>& elements, std::vector<double>& v, std::vector<double>& w);
  /// Displacements of these elements under forces on them in this stage.
  virtual const ElementCompliance& compliance(const std::vector<int>& elements) = 0;
  /// Adds the response to contact forces on these elements, 2 per_node values each, N and N m; none: without contacts.
  /// After passes the loads are pass_loads(). Returns whether the stage is solved, or has to be solved again from
  /// solve_free on.
  virtual Verdict apply_contact_loads(const std::vector<double>& loads) = 0;

  // The contacts of a stage by passes, in place of gather_free and compliance: passes are made until the contact forces
  // no longer change. Then the loads are applied.

  /// Begins the passes with contacts on these elements, ascending. Call after solve_free.
  virtual Passes begin_passes(const std::vector<int>& elements);
  /// A pass: add_loads adds loads to the field, whose loads are zero before, then its v is computed under them. shift
  /// (1/s): its w too, whose change is `shift` times the change of v; 0: not.
  virtual void respond(const std::function<void()>& add_loads, double shift);
  /// The loads of the last pass, 2 per_node values for each element of begin_passes; ElementStructure::observe needs
  /// none.
  const std::vector<double>& pass_loads() const { return loads_; }

  /// v and w of a stage that does not belong to a step. Returns the powers there.
  virtual Powers end_stage(double* v, double* w) = 0;
  /// The reason why the last stage has no solution, for messages.
  const std::string& failure_reason() const { return failure_reason_; }

 protected:
  std::string failure_reason_;

 private:
  // Data of the contacts' passes
  ContactField field_;
  const ElementCompliance* own_ = nullptr;
  std::vector<double> v_free_, w_free_, v_pass_, w_pass_, loads_;
};

/// A structure in steps of a one-step method, each of several stages.
class MovingStructure : public LoadedStructure {
 public:
  using LoadedStructure::LoadedStructure;
  /// Excludes motion below the tolerance from the steps (active_window.hpp); before set_method. probes: stations, m.
  void limit_to_active_window(const WindowTolerance& tolerance, const std::vector<double>& probes) {
    window_tolerance_ = tolerance;
    window_probes_ = probes;
  }
  /// The errors of all steps will be requested.
  void measure_errors() { measures_errors_ = true; }
  /// The method of all following steps, for steps of h, s. The first call begins the motion by steps.
  virtual void set_method(const base::Method& method, double h) = 0;
  /// Before the first step from a state with the accelerations a, and after a change of the state from outside; v and w
  /// may be set to rest where they are negligible.
  virtual void restart(const std::vector<Reach>& loaded, double* v, double* w, const double* a) = 0;
  /// `loaded`: ranges of wheels and forces in the step; store: the step may be rejected.
  virtual void begin_step(const std::vector<Reach>& loaded, const double* v, const double* w, bool store) = 0;
  using LoadedStructure::begin_stage;
  using LoadedStructure::end_stage;
  /// Stage i, counted from 0, of the step from v, w.
  virtual void begin_stage(std::size_t i, const double* v, const double* w) = 0;
  /// Stores the data of stage i that the step needs.
  virtual void end_stage(std::size_t i, const double* v, const double* w) = 0;
  virtual void finish_step(double* v, double* w) = 0;
  /// The computations for which a state must be final; the motion continues with wheels and forces in these ranges.
  virtual void accept(double* /*v*/, double* /*w*/, const std::vector<Reach>& /*loaded*/) {}
  virtual void reject_step(double* v, double* w) = 0;
  /// Energy of the step's error as the embedded method estimates it, J: this rank's share. After all stages are solved.
  virtual double error_energy(const double* v, const double* w) = 0;
  /// Writes or reads the state between steps except v and w. Before reading, the method has been set.
  virtual void keep(base::Archive& archive) = 0;

 protected:
  WindowTolerance window_tolerance_;
  std::vector<double> window_probes_;  // m
  bool measures_errors_ = false;
};

}  // namespace traverse::structure
