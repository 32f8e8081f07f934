// What carries: the structure's side of the coupling. Wheels and forces run on its line; between them and the structure
// pass nodal values of the line's elements and nothing else, 2*per_node numbers an element:
//
//   where the elements would be without the contacts' forces (gather),
//   by how much they yield to such forces (ElementCompliance),
//   the forces that were found (take).
//
// The state of a structure is v and w = v' of its own unknowns: nodal displacements, or coordinates of modes. What a
// stage is, how it is solved and what is kept of it is the structure's own affair.
#pragma once

#include <array>
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
#include "structure/contact_field.hpp"
#include "structure/nonlinear_foundation.hpp"

namespace traverse::structure {

/// Forces of contacts as nodal values of elements: 2*per_node an element, N and N m.
struct ElementLoads {
  const std::vector<int>& elements;
  const std::vector<double>& values;
};

/// A concentrated force on a line as forces on the unknowns of its element, in the order of beam::Line::unknowns. Along
/// x and as a moment it acts where there are axial unknowns.
std::array<double, 6> on_unknowns(const beam::Line& line, const beam::ElementLoad& force);

/// A stretch of the line where a wheel or a force is at some time of a step, m.
struct Reach {
  double from = 0.0, to = 0.0;
};

/// Energies of a structure and the integrals of its powers, J.
struct StructureEnergy {
  double kinetic = 0.0, strain = 0.0, potential = 0.0;
  double dissipated = 0.0, work = 0.0;  // since the motion began
};

/// An accepted instant of a structure, as nodal values of the beam: this rank's.
struct NodalMotion {
  const double *v = nullptr, *w = nullptr, *a = nullptr;
  std::vector<double> P;     // loads, on held unknowns too, where they are asked for
  std::vector<double> drag;  // what damping that acts like inertia adds to the accelerations in all forces; empty: none
  std::vector<double> coordinates;  // of a bridge by its modes: q of each, m kg^(1/2), on every rank
  NonlinearForces foundation;
  std::vector<beam::ElementLoad> foundation_loads;  // of the foundation that is not linear
};

/// A structure with n unknowns on this rank. All functions but those that only return a value are collective.
class Structure {
 public:
  /// gravity: of the beam's own weight, m/s2; 0: it has none. The beam must outlive the structure.
  Structure(const beam::Beam& beam, std::shared_ptr<BeamOperator> statics, double gravity);
  virtual ~Structure() = default;
  Structure(const Structure&) = delete;
  Structure& operator=(const Structure&) = delete;

  const beam::Beam& beam() const { return beam_; }
  const beam::Line& line() const { return line_; }  // that wheels and forces run on
  int per_node() const { return line_.per_node; }
  int unknowns() const { return n_; }
  /// The beam's matrices, for what is at rest.
  BeamOperator& statics() const { return *statics_; }
  /// Nodal forces of the beam's own weight and of its strains, this rank's unknowns of the beam.
  const std::vector<double>& dead_load() const { return dead_load_; }
  /// Whether what an element yields between its nodes counts under a wheel. A rail bends there, and an element that
  /// shears has a kink under a wheel, and none at its nodes; others where that is asked for.
  virtual bool yields_inside(bool asked) const {
    return asked || beam_.rail() != nullptr || beam_.model().GA.has_value();
  }
  /// Whether it is bent or stretched without vehicles and moving forces.
  bool bent_at_rest() const { return gravity_ != 0.0 || beam_.model().strained(); }
  /// Collective. Its displacements then, without foundations that are not linear: this rank's unknowns of the beam.
  std::vector<double> rest();
  /// Sets nodal forces on unknowns that a support holds to zero: they go into the reactions.
  void release_held(double* nodal) const;
  /// Adds a vertical force (N, upward) inside an element of a line to this rank's nodal forces.
  void add_force(const beam::Line& line, const beam::ElementLoad& force, double* nodal) const;
  /// Whether the answer to two loads is the sum of the answers.
  virtual bool linear() const { return true; }
  /// All that will weigh on it, and the greatest single force, N: what forces of a foundation are judged by.
  virtual void expect_weights(double /*sum*/, double /*greatest*/) {}

  // --- at a state --------------------------------------------------------------------------------------------------

  /// The moving forces from here on, as they stand on the line.
  virtual void load(const std::vector<beam::ElementLoad>& forces) = 0;
  /// v and w of elements at a state, on all ranks.
  void gather(const std::vector<int>& elements, const double* v, const double* w, std::vector<double>& v_elements,
              std::vector<double>& w_elements);
  /// w' of a state, of what is asked for: all that acts but contacts, and contacts (null: none).
  virtual void accelerations(const double* v, const double* w, bool own, const ElementLoads* contacts, double* a) = 0;
  /// Power lost in damping, and that of the moving forces, W: this rank's share at the state whose accelerations were
  /// asked for last, or of the stage that was solved last.
  virtual std::array<double, 2> powers(const double* w) = 0;

  // --- a stage -----------------------------------------------------------------------------------------------------

  enum class Verdict { settled, again, failed };

  /// Statics under its own weight and the moving forces; `loaded`: whether there is anything of that.
  virtual void begin_statics(bool loaded) = 0;
  /// v and w with v' = w = shift*v + c_v, w' = shift*w + c_w; w_guess: about what w will be.
  virtual void begin_stage(double shift, const double* c_v, const double* c_w, const double* w_guess) = 0;
  /// Stage i, counted from 0, of the step from v, w.
  virtual void begin_stage(std::size_t i, const double* v, const double* w) = 0;
  /// Where it is without contacts.
  virtual void solve_free() = 0;
  /// v and w of elements there, on all ranks.
  void gather_free(const std::vector<int>& elements, std::vector<double>& v, std::vector<double>& w);
  /// How these elements yield to forces on them in this stage.
  virtual const ElementCompliance& compliance(const std::vector<int>& elements) = 0;
  /// The contacts' forces on these elements, 2 per_node values each, N and N m.
  virtual void take(const std::vector<double>& loads) = 0;
  /// Whether the stage is solved, or has to be solved once more from solve_free on.
  virtual Verdict judge() { return Verdict::settled; }

  // The contacts of a stage by passes, in place of gather_free, compliance and take: loads are cleared, added to the
  // field and responded to until the contacts' forces no longer change, and taken then.

  /// From solve_free on, with contacts on these elements, ascending.
  virtual const ContactField& begin_passes(const std::vector<int>& elements);
  /// How each of them yields to forces on itself alone.
  virtual const ElementCompliance& own_compliance() const { return *own_; }
  virtual void clear_loads();
  /// The field's v under its loads.
  virtual void respond();
  /// The field's w, which follows its v by `shift` (1/s).
  virtual void find_rates(double shift);
  virtual void take_loads() {
    if (!loads_.empty()) take(loads_);
  }
  /// The loads of the last pass, 2 per_node values an element of begin_passes; ElementStructure::observe asks for none.
  const std::vector<double>& pass_loads() const { return loads_; }

  /// v and w of a stage that is not one of a step.
  virtual void end_stage(double* v, double* w) = 0;
  /// What slides has slid to v, from which the motion goes on with wheels and forces there.
  virtual void update_slip(const double* /*v*/, const std::vector<Reach>& /*loaded*/) {}
  /// Keeps what the step needs of its stage i.
  virtual void end_stage(std::size_t i, const double* v, const double* w) = 0;
  /// Why a stage has no solution, for messages.
  virtual std::string trouble() const { return {}; }

  // --- steps -------------------------------------------------------------------------------------------------------

  /// Leaves out of the steps what moves less than `tolerance` of the largest motion (active_window.hpp); before
  /// begin_motion. Probes' stations rest only when really quiet.
  virtual void limit_to_active_window(double /*tolerance*/, const std::vector<double>& /*probes*/) {}
  /// J, put to rest so far, this rank's share; none where everything is stepped.
  virtual std::optional<double> energy_left() const { return std::nullopt; }
  /// The method of all steps to come, for steps of 1 s.
  virtual void begin_motion(const Method& method) = 0;
  /// The same for steps of h.
  virtual void set_method(const Method& method, double h) = 0;
  /// Every step is to be asked for its error.
  virtual void measure_errors() {}
  /// Before the first step from a state with the accelerations a, and where the state was changed from outside; v and w
  /// may be put to rest where they hardly move.
  virtual void restart(const std::vector<Reach>& loaded, double* v, double* w, const double* a) = 0;
  /// `loaded`: where wheels and forces will be; keep: the step may be taken back.
  virtual void begin_step(const std::vector<Reach>& loaded, const double* v, const double* w, bool keep) = 0;
  virtual void finish_step(double* v, double* w) = 0;
  /// What may be done once no step will be taken back.
  virtual void complete_step(double* /*v*/, double* /*w*/) {}
  virtual void reject_step(double* v, double* w) = 0;
  /// w' at the state that the last step led to.
  virtual const double* acceleration() const = 0;
  /// Energy of the step's error as the method's embedded one estimates it, J: this rank's share. Once all stages are
  /// solved.
  virtual double error_energy(const double* v, const double* w) = 0;

  // --- what is seen ------------------------------------------------------------------------------------------------

  /// This rank's share.
  virtual StructureEnergy energy(const double* v, const double* w) = 0;
  /// A state with its accelerations as nodal values, under the moving forces and the contacts' loads; with_loads:
  /// whether NodalMotion::P is asked for.
  virtual void observe(const double* v, const double* w, const double* a, const ElementLoads& contacts, bool with_loads,
                       NodalMotion& out) = 0;

  /// Between steps: what changes with time but v and w. When it is read the method has been set.
  virtual void keep(base::Archive& archive) = 0;

 protected:
  /// v and w of elements, this rank's part of them; at a state, or, with null pointers, at the free response of the
  /// stage. Both begin as zeros.
  virtual void add_values(const std::vector<int>& elements, const double* v, const double* w, double* v_elements,
                          double* w_elements) const = 0;
  void add_contacts(const ElementLoads& contacts, double* nodal) const;  // to this rank's nodal forces

  const beam::Beam& beam_;
  const beam::Line& line_;
  std::shared_ptr<BeamOperator> statics_;
  std::vector<double> dead_load_;
  double gravity_;
  int n_, ranks_ = 1;

 private:
  std::vector<double> both_;  // of gather
  // Of the contacts' passes
  ContactField field_;
  const ElementCompliance* own_ = nullptr;
  std::vector<double> v_free_, w_free_, v_passed_, w_passed_, loads_;
};

}  // namespace traverse::structure
