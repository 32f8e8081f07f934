// A bridge under moving forces by its first natural modes, mass-normalised:
//
//   v(x, t) = sum phi_i(x) q_i(t) + static deflection in all other modes (static correction)
//   q_i'' + 2 sigma_i q_i' + sum_k d_ik q_k' + omega_i^2 q_i = -sum_j F_j phi_i(x_j)          F_j downward
//
// The damping d between modes is zero if C* is diagonal in the modes, as Rayleigh damping is. Single dampers, and
// springs that Rayleigh's b does not damp, couple the modes; the response of the other modes to these forces is static
// too.
//
// On an element phi_i is a cubic polynomial of x, and so is the influence line of any static response. The effects of a
// unit force are therefore a list of cubic polynomials, one for each piece between nodes and probes.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "modes/modes.hpp"
#include "recovery/recovery.hpp"
#include "structure/beam_operator.hpp"

namespace traverse::structure {

/// The free oscillations of natural modes that damping couples,
///
///   u'' + C u' + Omega^2 u = 0,   Omega diagonal, C symmetric,
///
/// by the complex modes of this small system, each of which decays and oscillates independently:
///
///   (Omega u, u') = Re sum_j s_j y_j e^(lambda_j t)
///
/// One member of each conjugate pair represents both; overdamped modes are real. With critical damping two modes
/// coincide, and there is no basis of complex modes: then C is increased by a factor from 1 + 1e-10 on.
struct ComplexModes {
  /// SolverError if no modes are found. omega in rad/s, all positive; sigma: half of C's diagonal, 1/s; cross_damping:
  /// C without its diagonal, 1/s.
  ComplexModes(const std::vector<double>& omega, const std::vector<double>& sigma,
               const Eigen::MatrixXd& cross_damping);

  Eigen::VectorXcd lambda;      // 1/s
  Eigen::MatrixXd state;        // matrix from (Re y, Im y) to (Omega u, u')
  Eigen::MatrixXd coordinates;  // matrix from (Omega u, u') to (Re y, Im y)

 private:
  void solve(const Eigen::MatrixXd& rates);
  double residual(const Eigen::MatrixXd& rates) const;
};

/// Several quantities along x, each a cubic polynomial between neighbouring breaks.
struct PiecewiseCubic {
  std::vector<double> breaks;  // m, ascending
  std::size_t channels = 0;
  std::vector<double> coefficients;  // [piece][power][channel] of x - breaks[piece]

  std::size_t pieces() const { return breaks.size() - 1; }
};

/// The response at stations as linear combinations of the modes' coordinates, rates and accelerations. The members are
/// the coefficients: [mode][station].
struct ModalProbes {
  std::size_t count = 0;
  std::vector<double> deflection;          // coefficients of q; with q'' they give the acceleration
  std::vector<double> deflection_by_rate;  // empty if damping forces act on no other modes
  std::vector<double> moment, moment_by_rate, moment_by_acceleration;
  std::vector<double> weight_deflection, weight_moment;  // m, N m at each station: due to the beam's own weight
};

/// Rotations at nodes, rad, then rates of the twist at stations, rad/m, as linear combinations of the modes'
/// coordinates.
struct ModalSlopes {
  std::size_t count = 0;
  std::vector<double> of_q;    // [mode][slope]
  std::vector<double> weight;  // due to the beam's own weight
  /// Same layout as ModalBridge::influence: first the modal forces, then the slopes.
  PiecewiseCubic influence;
};

class ModalBridge {
 public:
  /// Collective. A bridge with these modes of bending. `ratios`: damping ratios of each mode, the last one for all
  /// further modes; empty: the beam's Rayleigh damping. InputError if the beam is not supported. The operator may be
  /// used by others; the beam must outlive this object.
  ModalBridge(const beam::Beam& beam, BeamOperator& statics, modes::Basis basis, const std::vector<double>& ratios);
  /// Collective. A bridge with the `count` lowest modes, and all further modes with the last frequency.
  ModalBridge(const beam::Beam& beam, BeamOperator& statics, int count, const std::vector<double>& ratios)
      : ModalBridge(beam, statics, modes::bending_basis(beam, count), ratios) {}

  /// Collective. A bridge with the `count` lowest modes that the beam's model gives. There are no other modes that
  /// could deflect statically, and moments are unknown. From then on the operator's statics use these modes.
  ModalBridge(const beam::Beam& beam, BeamOperator& statics, int count);

  /// Collective. Adds the response at stations to probes(), and its static correction to influence(). gravity: 0
  /// without self-weight; eccentricities: as of recovery::Recovery.
  void add_probes(const std::vector<double>& stations, double gravity, const std::vector<double>& eccentricities = {});

  /// Collective. Rotations of nodes given by their unknowns, and rates of the twist at stations, if dampers do not
  /// couple modes. gravity, eccentricities: as of add_probes.
  ModalSlopes slopes(const std::vector<int>& unknowns, const std::vector<double>& stations, double gravity,
                     const std::vector<double>& eccentricities);

  /// Whether the modes were given, and are complete.
  bool given() const { return beam_.model().given.has_value(); }
  std::size_t modes() const { return basis_.omega.size(); }
  const modes::Basis& basis() const { return basis_; }
  const std::vector<double>& omega() const { return basis_.omega; }  // rad/s
  /// Half of the diagonal of the modes' damping phi^T C* phi, given ratios included, 1/s: decay rates unless coupled.
  const std::vector<double>& sigma() const { return sigma_; }
  /// The highest frequency of free oscillations, rad/s; overdamped modes do not oscillate.
  double fastest_oscillation() const;
  /// The part of it by dampers, 1/s.
  const std::vector<double>& damper_sigma() const { return damper_sigma_; }
  /// Damping between modes, 1/s: phi^T C* phi with zeros on its diagonal, symmetric; 0 x 0 if it is diagonal.
  const Eigen::MatrixXd& cross_damping() const { return cross_damping_; }
  bool coupled() const { return cross_damping_.size() > 0; }
  /// Whether dampers couple modes with each other, or with the other modes (after add_probes).
  bool dampers_couple() const { return coupled() || !probes_.deflection_by_rate.empty(); }
  /// Adds to this rank's nodal forces the damping forces on the other modes, at the modes' rates q': -C* phi q' minus
  /// the modes' share of it.
  void add_forces_on_others(const double* rates, double* nodal) const;
  /// The free oscillations of coupled modes, computed at the first call.
  const ComplexModes& complex_modes() const;
  /// Damping from given ratios, 1/s: its forces are the mass times an acceleration own_drag q'.
  const std::vector<double>& own_drag() const { return own_drag_; }
  const ModalProbes& probes() const { return probes_; }
  /// The effects of a unit downward force at x: the modal forces; then the deflections of all probes, then their
  /// moments, minus the modes' static share.
  const PiecewiseCubic& influence() const { return influence_; }
  const beam::Beam& beam() const { return beam_; }
  /// phi_i, this rank's unknowns.
  const double* shape(std::size_t mode) const;

 private:
  /// Values of a response under a unit downward force along x: the nodal values of an influence line, and the direct
  /// response if the force is inside the probe's element.
  struct Line {
    std::vector<double> nodal;  // all ranks' unknowns
    std::size_t probe = 0;
    double recovery::Response::*direct = nullptr;  // null: none
  };
  Eigen::MatrixXd on_shapes(Mat matrix) const;
  Eigen::MatrixXd share_of_modes(const Eigen::MatrixXd& forces) const;
  void set_damping(const std::vector<double>& ratios);
  void set_forces_on_others(const Eigen::MatrixXd& forces, const Eigen::MatrixXd& share);
  void add_given_probes(const std::vector<double>& stations);
  void record_forms(recovery::Recovery& recovery);
  void record_others(recovery::Recovery& recovery);
  void record_weight(recovery::Recovery& recovery, double gravity);
  Line correction_of(recovery::Recovery& recovery, std::size_t probe, double recovery::Response::*quantity,
                     const std::function<double(std::size_t)>& form);
  std::vector<Line> lines_of_modes() const;
  std::array<double, 4> transverse_values(const std::vector<double>& nodal, int element) const;
  Line line_of(const std::vector<double>& load, const std::function<double(std::size_t)>& form);
  PiecewiseCubic influence_of(const std::vector<Line>& lines, const std::vector<double>& stations,
                              const std::vector<double>& eccentricities = {}) const;
  std::vector<double> static_solution(const std::vector<double>& load);
  std::vector<double> weight_displacements(double gravity);

  const beam::Beam& beam_;
  BeamOperator& statics_;
  modes::Basis basis_;
  std::vector<double> sigma_, damper_sigma_, own_drag_;
  Eigen::MatrixXd cross_damping_;
  beam::Rayleigh ab_;                 // zero if ratios damp the modes
  Eigen::MatrixXd forces_on_others_;  // per rate of each mode, this rank's unknowns; no columns: none
  mutable std::optional<ComplexModes> complex_modes_;
  ModalProbes probes_;
  PiecewiseCubic influence_;
};

}  // namespace traverse::structure
