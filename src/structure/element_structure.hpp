// The structure by elements: the beam, its foundation and the track on it; its nodes are distributed over the ranks.
//
//   v' = w,  M w' = P + contacts - C* w - K* v,   P: its own weight and the moving forces
//
// The unknown of a stage is the change z of v from v~ = v at zero acceleration: v = v~ + z, w = w~ + s z, w' = s2 z. z
// is small, so that w and w' keep the digits that they would lose if v were the unknown. One solution with A = s2 M + s
// C* + K* gives z without contacts; the columns of A^-1 at elements are their compliance. If there are nonlinear
// foundations, this is inside a Newton iteration (NonlinearFoundation).
//
// For a beam without hinges and with linear foundations, the computation of stages is fused with the solver's sweep
// (BeamMotion). With Rayleigh damping only, all stages of a time step are computed at once on separate spans without
// loads, and time steps exclude the ranges at rest (ActiveWindow).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "structure/active_window.hpp"
#include "structure/beam_motion.hpp"
#include "structure/compliance.hpp"
#include "structure/contact_response.hpp"
#include "structure/structure.hpp"

namespace traverse::structure {

class ElementStructure final : public MovingStructure {
 public:
  /// `op`: an existing operator of the beam with its factorisations; null: a new operator is created.
  ElementStructure(const beam::Beam& beam, double gravity, std::shared_ptr<BeamOperator> op = nullptr);

  void set_reference_loads(double sum, double greatest) override;

  void load(const std::vector<recovery::ElementLoad>& forces) override;
  Powers accelerations(const double* v, const double* w, const ElementLoads& contacts, double* a) override;

  void begin_statics(bool loaded) override;
  void begin_stage(double shift, const double* c_v, const double* c_w, const double* w_guess) override;
  void begin_stage(std::size_t i, const double* v, const double* w) override;
  void solve_free() override;
  const ElementCompliance& compliance(const std::vector<int>& elements) override;
  Verdict apply_contact_loads(const std::vector<double>& loads) override;
  Passes begin_passes(const std::vector<int>& elements) override;
  void respond(const std::function<void()>& add_loads, double shift) override;
  Powers end_stage(double* v, double* w) override;
  void end_stage(std::size_t i, const double* v, const double* w) override;

  void set_method(const base::Method& method, double h) override;
  void restart(const std::vector<Reach>& loaded, double* v, double* w, const double* a) override;
  void begin_step(const std::vector<Reach>& loaded, const double* v, const double* w, bool store) override;
  void finish_step(double* v, double* w) override;
  void accept(double* v, double* w, const std::vector<Reach>& loaded) override;
  void reject_step(double* v, double* w) override;
  double error_energy(const double* v, const double* w) override;

  StructureEnergy energy(const double* v, const double* w) override;
  void observe(const double* v, const double* w, const double* a, const ElementLoads& contacts, bool with_loads,
               NodalMotion& out) override;
  void keep(base::Archive& archive) override;

  // Several ranks, each with other trains on a bridge of its own (coupling/train_sharing.hpp). Ranges of columns as
  // merge() returns them.

  /// Whether this is possible: a window on separate parts.
  bool may_share() const { return window_.has_value() && statics_->parts() != nullptr && fused() && !support_motion_; }
  ActiveWindow& window() { return *window_; }
  double longest_span() const { return longest_span_; }  // m
  /// The columns of the parts within a reach; empty beside the bridge.
  Range columns_of(const Reach& reach) const;
  /// Sets ranges to rest.
  void set_to_rest(const std::vector<Range>& columns, double* v, double* w);
  /// Calls use(double*, count) for v, w and w' of the nodes of these ranges.
  template <class Use>
  void exchange(const std::vector<Range>& columns, double* v, double* w, Use use) {
    const auto block = static_cast<std::size_t>(statics_->block());
    for (const Range& r : columns)
      for (double* x : {v, w, motion_->start_acceleration()})
        use(x + block * static_cast<std::size_t>(r.first), block * static_cast<std::size_t>(r.past - r.first));
  }
  /// Takes the last step back, before accept(), so that another one may follow without a restart.
  void step_back(double* v, double* w);
  /// The dissipated power that was measured last: the ranks' trapezoids add up to that of one rank if their powers do,
  /// and if all have been integrated up to the same time.
  BeamMotion::Dissipation& measured() { return measured_; }
  /// Sets what is integrated from now on to zero: this rank's share begins.
  void begin_share() {
    measured_ = {};
    powers_.sum = {};
    statics_->solves = 0;
    window_->forget_energy_left();
    energy_left_ = 0.0;
  }
  /// The integrals of the powers so far, J: dissipation with the energy left, and work.
  Powers integrals() const { return {powers_.sum.dissipation + energy_left_, powers_.sum.work}; }
  template <class Use>
  void exchange_time(Use use) {
    double numbers[3] = {unmeasured_, to_measure_ ? 1.0 : 0.0, stepped_ ? 1.0 : 0.0};
    use(numbers, 3);
    unmeasured_ = numbers[0];
    to_measure_ = numbers[1] != 0.0;
    stepped_ = numbers[2] != 0.0;
  }

 private:
  enum class Kind { statics, state, step, fused };  // kind of the present stage
  struct Stage {
    Kind kind = Kind::statics;
    double shift = 0.0, shift2 = 0.0;
    std::size_t number = 0;  // index of the stage in the step
    bool loaded = false;
    bool by_response = false;  // passes use response_ instead of the columns of compliance_
    const AddedSprings* added = nullptr;
    const double *v = nullptr, *w = nullptr;  // at the start of the step
  };
  bool fused() const { return motion_ && motion_->fused(); }
  void add_values(const std::vector<int>& elements, const double* v, const double* w, double* v_elements,
                  double* w_elements) const override;
  void external_load(double* nodal) const;
  void add_support_inertia(double* nodal) const;
  /// The moving forces, and the inertia forces of the motion of the supports.
  const std::vector<NodalLoad>& driving_forces() const { return support_motion_ ? with_inertia_ : nodal_forces_; }
  void load_at_zero_acceleration();
  void update_loaded_range(const std::vector<Reach>& loaded);
  double dissipation(const double* w);
  double power_of_forces(const double* w) const;
  Powers powers(const double* w) { return {dissipation(w), power_of_forces(w)}; }
  Verdict check_stage();
  void begin_motion();
  int local_node(int column) const;
  bool measured_between_steps() const;
  void start_with(const double* a);
  void measure_dissipation(const double* v, const double* w);
  void add_dissipation(const BeamMotion::Dissipation& now);
  const std::vector<Range>& find_loaded(const std::vector<Reach>& loaded);
  void make_local(std::vector<Range>& columns) const;
  const std::vector<Range>& active_nodes();
  void set_ranges(const std::vector<Reach>& loaded);

  Compliance compliance_;
  ContactResponse response_;
  std::optional<NonlinearFoundation> nonlinear_;  // only for a nonlinear foundation
  std::vector<NodalLoad> nodal_forces_;           // moving forces, unknowns ascending
  std::vector<NodalLoad> with_inertia_;           // with those of the motion of the supports, if they move
  Stage stage_;
  // Vectors of this rank's unknowns: z, v~ and w~ of the present stage, and the load of the stage for a Newton
  // iteration.
  std::vector<double> z_, v_predicted_, w_predicted_, stage_load_, work_;
  std::vector<double> element_work_;

  // Steps
  base::Method method_;
  double length_ = 0.0;  // s, of a step
  std::optional<BeamMotion> motion_;
  std::optional<ActiveWindow> window_;
  double longest_span_ = 0.0;                 // m
  std::vector<double> static_displacements_;  // deflections under the dead load only; empty: none
  base::PowerIntegrals powers_;
  /// Integrals of this rank's powers, J. The measured dissipation is integrated up to `unmeasured_` s ago, when it was
  /// `measured_`.
  double unmeasured_ = 0.0;
  BeamMotion::Dissipation measured_;
  bool measuring_ = false, to_measure_ = true;
  struct {
    std::vector<double> numbers;  // v, w and w' of the active ranges of the motion
    Powers powers;
    bool stepped = false;
  } before_;                 // state at the start of a step that may be rejected
  std::vector<Range> free_;  // nodes of parts without loads in the step
  std::vector<Range> loaded_, active_, all_;
  std::vector<Reach> reaches_;
  bool stepped_ = false;     // since the last restart
  bool incomplete_ = false;  // the nodes of free_ still have their state at the start of the last step
};

}  // namespace traverse::structure
