// The structure by its natural modes, mass-normalised: nodal values v = v_0 + sum phi_i q_i, with v_0 under the
// self-weight only, and
//
//   q_i'' + 2 sigma_i q_i' + sum_k d_ik q_k' + omega_i^2 q_i = phi_i^T (moving forces + contacts)
//
// with the damping d between modes, if there is any (modal_bridge.hpp).
// The contacts move with the modes only. Observed values of the bridge also include the static deflection of all other
// modes (static correction), so that reactions and moments balance the loads exactly. The state is q and q', on the
// first rank; all ranks store the shapes.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <memory>
#include <vector>

#include "structure/modal_bridge.hpp"
#include "structure/structure.hpp"

namespace traverse::structure {

class ModalStructure final : public MovingStructure {
 public:
  /// The bridge must outlive the structure.
  ModalStructure(const ModalBridge& bridge, double gravity, std::shared_ptr<BeamOperator> statics);

  void load(const std::vector<recovery::ElementLoad>& forces) override;
  Powers accelerations(const double* v, const double* w, const ElementLoads& contacts, double* a) override;

  void begin_statics(bool loaded) override;
  void begin_stage(double shift, const double* c_v, const double* c_w, const double* w_guess) override;
  void begin_stage(std::size_t i, const double* v, const double* w) override;
  void solve_free() override;
  const ElementCompliance& compliance(const std::vector<int>& elements) override;
  Verdict apply_contact_loads(const std::vector<double>& loads) override;
  Powers end_stage(double* v, double* w) override;
  void end_stage(std::size_t i, const double* v, const double* w) override;

  void set_method(const base::Method& method, double h) override;
  void restart(const std::vector<Reach>& loaded, double* v, double* w, const double* a) override;
  void begin_step(const std::vector<Reach>& loaded, const double* v, const double* w, bool store) override;
  void finish_step(double* v, double* w) override;
  void reject_step(double* v, double* w) override;
  double error_energy(const double* v, const double* w) override;

  StructureEnergy energy(const double* v, const double* w) override;
  void observe(const double* v, const double* w, const double* a, const ElementLoads& contacts, bool with_loads,
               NodalMotion& out) override;
  void keep(base::Archive& archive) override {
    statics_->keep_static_error(archive);
    archive.cut(accelerations_[0]);
    archive.sum(powers_.at[0].dissipation, powers_.at[0].work, powers_.sum.dissipation, powers_.sum.work);
  }

 private:
  /// phi S^-1 phi^T between elements, with S the stage's matrix.
  class ModalCompliance final : public ElementCompliance {
   public:
    explicit ModalCompliance(const ModalStructure& structure)
        : ElementCompliance(structure.per_node()), structure_(structure) {}
    /// Computes the compliance for the structure's present stage.
    void prepare(const std::vector<int>& elements);

   private:
    void fill(int a, double* to) const;
    const ModalStructure& structure_;
    std::vector<int> elements_, elements_before_, previous_index_;
    double shift_ = -1.0, shift2_ = -1.0;  // shifts of the stage for which the blocks were computed
    std::vector<double> blocks_before_;
    std::vector<double> loaded_shapes_;  // S^-1 times the shapes of the loaded element: [unknown][mode]
  };

  /// Nodal value k of an element of the track in every mode; unknowns: of the element.
  const double* shapes(int element, int k, const std::array<int, 6>& unknowns) const {
    const auto value = 2 * static_cast<std::size_t>(per_node() * element) + static_cast<std::size_t>(k);
    return by_element_.empty() ? shapes(unknowns[static_cast<std::size_t>(k)]) : &by_element_[value * modes_];
  }
  /// The values of an unknown of the beam, counted over all ranks, in every mode.
  const double* shapes(int unknown) const { return &by_unknown_[static_cast<std::size_t>(unknown) * modes_]; }
  void add_values(const std::vector<int>& elements, const double* v, const double* w, double* v_elements,
                  double* w_elements) const override;
  void find_shapes_of_track();
  void add_modal_forces(const ElementLoads& contacts, double* to) const;
  double work_rate(const double* w) const;
  double damping(const double* w) const;
  Powers powers(const double* w) const { return {damping(w), work_rate(w)}; }
  void set_stage(double shift, double shift2);
  void factorise();
  void subtract_cross_damping(const double* w, double* forces) const;
  void divide(const double* force, double* displacement) const;

  const ModalBridge& bridge_;
  std::size_t modes_;
  std::vector<double> by_unknown_;             // [unknown][mode]
  std::vector<double> by_element_;             // [nodal value of each element][mode]; only of a track beside the axis
  std::vector<double> weight_displacement_;    // v_0, of all ranks' unknowns
  std::vector<double> weight_;                 // phi^T of the self-weight, N
  double weight_work_ = 0.0;                   // J, self-weight times v_0
  std::vector<recovery::ElementLoad> forces_;  // the moving forces
  std::vector<double> modal_force_;            // modal forces of the moving forces
  double shift_ = 0.0, shift2_ = 0.0;          // factors of the stage: rates and accelerations over displacements
  // The diagonal of the stage's S = s2 + 2 sigma s + omega^2; for coupled modes S^-1 including the damping between
  // them.
  std::vector<double> stiffness_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd inverse_;
  std::vector<double> v_predicted_, w_predicted_, z_;  // same meaning as in ElementStructure
  std::vector<int> elements_;                          // elements of the last computed compliance
  ModalCompliance compliance_;
  base::Method method_;
  std::array<std::vector<double>, base::most_accelerations>
      accelerations_;            // q'' at the start of the step and at its stages
  base::PowerIntegrals powers_;  // on the first rank
  struct {
    std::vector<double> v, w;
  } before_;
  std::vector<double> q_, displacements_;  // modal forces, and modal displacements due to them
  // Observed nodal values, the static solution; q, q', q'' and the modes' share of the static solution.
  std::vector<double> v_nodal_, w_nodal_, a_nodal_, static_displacement_, observed_, share_;
  Eigen::MatrixXd nodal_;  // [unknown][as observed_]
};

}  // namespace traverse::structure
