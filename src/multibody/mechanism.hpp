// The equations of motion of a constrained planar mechanism, reduced by generalized coordinate partitioning (eqs. 42-44
// and section 5 of the paper; Wehage & Haug 1982).
//
//   Phi(q, t) = 0,   N q'' + Phi_q^T lambda = g + Q,   Phi_q q'' = gamma
//
// q contains x, y, phi of every body (n = 3 bodies). A partition divides q into f independent coordinates p and the
// dependent ones. With these, q = q(p, t), q' = B p' + b, q'' = B p'' + d, where B (n x f) has identity rows for the
// independent coordinates. The projected equations of motion are B^T (N (B p'' + d) - g - Q) = 0. Q are external
// generalized forces (wheels on the beam) from the caller.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "base/one_step_methods.hpp"
#include "multibody/augmented_system.hpp"
#include "multibody/force_element.hpp"
#include "multibody/joint.hpp"
#include "multibody/reduction.hpp"
#include "multibody/rope.hpp"
#include "traverse/multibody/frame.hpp"
#include "traverse/multibody/model.hpp"

namespace traverse::multibody {

/// The motion at an accepted instant. Taylor's series from this instant predict positions.
struct Instant {
  double time = 0.0;
  int partition_version = 0;   // 0: none
  Eigen::VectorXd q, qd, qdd;  // n
  Sensitivity sensitivity;     // B
  void keep(base::Bytes& bytes) { bytes(time, partition_version, q, qd, qdd, sensitivity); }
};

/// Columns [first, last) of a matrix.
struct ColumnRange {
  int first = 0, last = 0;
};

/// Friction in the r sliding joints that have friction. f are the forces along their axes, A the gradients of their
/// sliding displacements, and H^T h the normal forces due to a generalized force h on all bodies for given
/// accelerations: f_k = -(mu_k |lambda_k| + F_k) tanh(v_k/v0_k), v = A^T q', and lambda = H^T (g + Q + A f - N q''),
/// which is solved for lambda (friction.cpp).
struct FrictionState {
  Eigen::MatrixXd A;             // n x r
  Eigen::MatrixXd H;             // n x r
  Eigen::VectorXd speed, share;  // r: v (m/s) and tanh(v/v0)
  Eigen::VectorXd force;         // r: f, N, along the axis on the second body
  Eigen::VectorXd normal_force;  // r: lambda, N
  bool jammed = false;           // no solution for lambda, or more than one

  // workspaces
  Eigen::VectorXd unit, work, start;  // a row of Phi; n; r
  Eigen::VectorXd by_lambda;          // r: df = -by_lambda d(lambda)
  Eigen::MatrixXd gain;               // r x r: d(lambda)/df
  Eigen::MatrixXd system, inverse;    // r x r: 1 + gain by_lambda, and its inverse
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;

  void keep(base::Bytes& bytes) {
    bytes(A, H, speed, share, force, normal_force, jammed, by_lambda, gain, system, inverse);
  }
};

/// All time-dependent data of one mechanism; Mechanism::make_state sets the sizes.
struct MechanismState {
  double time = 0.0;
  Eigen::VectorXd q, qd;              // n
  Eigen::MatrixXd B;                  // n x f; with many sensitivities only after Mechanism::compute_B
  Eigen::VectorXd b;                  // n: q' = B p' + b
  Eigen::VectorXd d;                  // n: q'' = B p'' + d
  Eigen::VectorXd g;                  // n: gravity, springs, actuators
  double dissipation = 0.0;           // W, in dampers of springs and in ropes
  Eigen::VectorXd qdd;                // n
  Eigen::VectorXd lambda;             // one per row of Phi; 0 for dropped rows
  Eigen::MatrixXd Phi_q;              // rows of Phi x n, redundant rows included
  Eigen::VectorXd Phi, gamma, Phi_t;  // one per row of Phi

  FrictionState friction;  // from the last accelerations or recover

  // workspaces of the implementation
  std::vector<Frame> frames;         // the ground, then the bodies; see Mechanism
  std::vector<ColumnRange> columns;  // non-zero columns of B in the rows of each body
  DependentBlock dependent_block;
  ReducedMass reduced_mass;
  AugmentedSystem augmented_mass;    // instead of reduced_mass where many_sensitivities()
  Instant accepted;                  // the last accepted instant
  int partition_version = 0;         // partition of the workspaces
  bool factored = false;             // dependent_block has a factorisation of Phi_q near the current q
  bool factors_current = false;      // this factorisation belongs to the present Phi_q
  bool sensitivity_current = false;  // the sensitivity and B, where they are computed, belong to the present Phi_q
  bool velocities_set = false;       // dependent_block has the sensitivity at the last velocities
  bool mass_factored = false;        // reduced_mass belongs to B
  long corrections = 0;              // number of Newton steps on positions
  Eigen::VectorXd work, projected;   // n
  Eigen::VectorXd reduced;           // f
  Eigen::VectorXd change;            // f
  Eigen::VectorXd centre;            // n: q of a nearly singular position
  Eigen::MatrixXd interpolated;      // n x (f + 2): B, b, d at this position

  void keep(base::Bytes& bytes) {
    bytes(time, q, qd, B, b, d, g, dissipation, qdd, lambda, Phi_q, Phi, gamma, Phi_t, friction, frames, columns,
          dependent_block, reduced_mass, augmented_mass, accepted, partition_version, factored, factors_current,
          sensitivity_current, velocities_set, mass_factored, corrections, centre, interpolated);
  }
};

/// Powers and stored energies, J.
struct MechanismEnergy : base::Powers {
  double kinetic = 0.0;
  double strain = 0.0;     // springs, torsion springs, ropes: 1/2 k e^2, or the integral of a law
  double potential = 0.0;  // gravity
};

class Mechanism {
 public:
  /// Checks the model (positive masses and inertias, finite numbers, known bodies); throws InputError if it is invalid.
  explicit Mechanism(MechanismModel model);

  const MechanismModel& model() const { return model_; }
  /// Applies a constant force (N, along x and y) at the centre of mass of a body and a moment (N m). They replace the
  /// force and moment of the last call for that body. Forces must be computed again afterwards.
  void apply(int body, const Eigen::Vector3d& action);
  /// Selects the side at t of jumps in the rates and accelerations of drivers and winches. Returns whether one has
  /// changed.
  bool select_sides(double t);
  int coordinates() const;  // n
  int constraints() const;  // rows of Phi, redundant ones included
  int freedom() const;      // f, after choose_partition
  const Partition& partition() const { return partition_; }
  const Eigen::VectorXd& mass_diagonal() const { return mass_; }  // n: N is diagonal

  /// A state at t = 0 with the bodies at the positions of the model. May be called before or after choose_partition.
  MechanismState make_state() const;

  /// Chooses the partition at s.q, t by full pivoting on Phi_q and makes s consistent: the dependent coordinates are
  /// solved for, and velocities that violate the constraints are projected in the metric of the masses. The caller
  /// reads p and p' from s.q and s.qd. Rows of drivers are kept before rows of joints; redundant rows are dropped.
  /// Throws InputError that names the joints and drivers if rows contradict each other (in position, speed or
  /// acceleration), cannot be satisfied, or depend on each other in this position only (a dead point). Returns the
  /// names of joints and drivers with dropped rows.
  std::vector<std::string> choose_partition(MechanismState& s, double t);

  /// Records s as an accepted instant, from which Newton's method and nearly singular positions are predicted.
  void accept(MechanismState& s) const;

  /// Whether dependent coordinates depend too strongly on the independent ones, or Phi_u is nearly singular.
  bool badly_conditioned(MechanismState& s) const;
  /// Chooses another partition at the consistent state s if the present one is poor and another is better. If all
  /// choices are singular, the present one is kept to pass this position. Returns whether the partition has changed.
  bool renew_partition(MechanismState& s);
  /// Adopts a partition that was chosen elsewhere at the same q and q' as in s, unless it is the present one.
  void adopt_partition(MechanismState& s, const Partition& partition);

  /// The quality of the partition, in (0, 1]: the inverse of the largest change of a dependent coordinate per change of
  /// an independent one (angles are scaled by a typical arm), at most 1; where there are many sensitivities, an
  /// estimate of it. It tends to 0 as Phi_u becomes singular. Velocities must be set.
  double partition_quality(MechanismState& s) const;

  /// Sets the independent coordinates to p and solves Phi = 0 for the others by Newton's method, which starts from a
  /// prediction by the last accepted instant or the last velocities. Returns false if it does not converge (s.q is then
  /// the last iterate), or if a dropped row is violated.
  bool set_positions(MechanismState& s, double t, const double* p) const;
  /// After a failure of set_positions: the joint or driver with the largest residual, and this residual.
  std::string worst_row(const MechanismState& s) const;

  /// Computes q' from p', and b, d and B, the last only where DependentBlock has not many sensitivities. Positions must
  /// be set.
  void set_velocities(MechanismState& s, double t, const double* pd) const;
  /// Computes B if set_velocities has not.
  void compute_B(MechanismState& s) const;

  /// Computes g and the power dissipated in dampers. Positions and velocities must be set.
  void compute_forces(MechanismState& s) const;

  /// Changes p by a small amount and p' by `rate` times that amount. Positions, velocities and g follow to first order;
  /// B, b and d remain unchanged. Positions, velocities and forces must be set.
  void shift(MechanismState& s, const double* change, double rate) const;

  /// Computes p'' from the projected equations with external forces Q (n), and q'' and lambda. Throws SolverError if
  /// friction jams a joint, because the bodies' accelerations are then not determined.
  void accelerations(MechanismState& s, const Eigen::VectorXd& Q, double* pdd) const;

  /// Computes q'' from a given p'', and lambda from the dependent rows of the equations of motion. Sets
  /// s.friction.jammed if friction jams a joint.
  void recover(MechanismState& s, const Eigen::VectorXd& Q, const double* pdd) const;

  /// Whether joints have friction.
  bool has_friction() const { return !friction_joints_.empty(); }
  /// After recover: the matrix (n x f) that replaces B in the projection B^T r of a change r of the equations' residual
  /// at fixed lambda. It eliminates the resulting changes of lambda together with their friction.
  void friction_projector(const MechanismState& s, Eigen::MatrixXd& projector) const;
  /// The reason, in words, why s.friction.jammed is set.
  std::string describe_jam(const MechanismState& s) const;

  /// product (n x f) = (by_q dg/dq + by_qd dg/dq' + by_lambda d(Phi_q^T lambda)/dq) B, at fixed lambda. Here g includes
  /// friction. B must be computed.
  void multiply_tangent(const MechanismState& s, double by_q, double by_qd, double by_lambda,
                        Eigen::MatrixXd& product) const;
  /// The sparse form of the projected equations for the present partition.
  AugmentedPattern augmented_pattern() const;
  /// Sets a system with this pattern to by_mass N + by_q dg/dq + by_qd dg/dq' + by_lambda d(Phi_q^T lambda)/dq, without
  /// friction, and to Phi_q.
  void assemble_augmented(const MechanismState& s, double by_mass, double by_q, double by_qd, double by_lambda,
                          AugmentedSystem& system) const;

  /// Reaction of joint j on its second body, including friction: fx, fy, moment about the joint's point on that body
  /// (for `distance`: about `to`). The reactions of redundant rows are zero.
  Eigen::Vector3d joint_reaction(const MechanismState& s, int j) const;
  /// Generalized force of driver k on its coordinate.
  double driver_force(const MechanismState& s, int k) const;
  /// Tension of spring k, N, including the damper.
  double spring_tension(const MechanismState& s, int k) const;
  /// Tension of rope k, N, including the damping.
  double rope_tension(const MechanismState& s, int k) const;
  /// Moment of torsion spring k on its second body, N m.
  double torsion_spring_moment(const MechanismState& s, int k) const;

  /// The powers in state s. Call after compute_forces; with drivers or friction also after accelerations or recover.
  base::Powers powers(const MechanismState& s) const;
  MechanismEnergy energy(const MechanismState& s) const;

  /// The numbers of a state that observers, powers and energies use, observed_size() in total. A state that has read
  /// them needs a new start before it can be continued.
  int observed_size() const;
  void write_observed(const MechanismState& s, double* to) const;
  void read_observed(MechanismState& s, const double* from) const;

  /// The effective mass (kg) for a generalized force along `direction` (n): the force over the acceleration along it.
  /// Infinite if the force causes no motion. Velocities must be set.
  double effective_mass(MechanismState& s, const Eigen::VectorXd& direction) const;

  /// Serialises the partition, which changes with time.
  void keep(base::Bytes& bytes) { bytes(partition_, partition_version_, chosen_quality_); }

 private:
  const Frame& frame(const MechanismState& s, int body) const { return s.frames[body + 1]; }
  int driver_row(int k) const { return joint_row_count_ + k; }
  const std::string& part_name(int row) const;  // name of the joint or driver of a row of Phi
  std::string row_name(int row) const;          // name of the row for a message: joint 'x'
  const char* row_unit(int row) const;
  void find_scaling();
  void find_pattern();

  void prepare_workspaces(MechanismState& s) const;
  void plan_elimination(MechanismState& s) const;
  void find_columns(MechanismState& s) const;
  void place_frames(MechanismState& s) const;
  void move_frames(MechanismState& s) const;
  void compute_Phi(MechanismState& s) const;
  void compute_Phi_q(MechanismState& s) const;
  void compute_gamma(MechanismState& s) const;
  void factor(MechanismState& s) const;
  double kept_residual(const MechanismState& s) const;
  bool correct_dependent(MechanismState& s) const;
  bool solve_dependent(MechanismState& s, double t) const;
  void predict(MechanismState& s, double t, const double* p) const;
  void velocities_at(MechanismState& s, double t, const double* pd) const;
  bool interpolate_velocities(MechanismState& s, double t, const double* pd) const;
  void expand_accelerations(MechanismState& s, const double* pdd) const;
  void factor_mass(MechanismState& s) const;
  void solve_mass(MechanismState& s) const;
  double probed_sensitivity(MechanismState& s) const;
  void add_sensitivity(MechanismState& s) const;
  template <class Add>
  void each_tangent(const MechanismState& s, double by_q, double by_qd, double by_lambda, Add add) const;
  void compute_friction_kinematics(MechanismState& s) const;
  void friction_in_motion(MechanismState& s) const;
  void friction_in_given_motion(MechanismState& s) const;
  void add_constant_friction(MechanismState& s) const;
  void add_friction(MechanismState& s) const;
  void solve_normal_forces(MechanismState& s) const;
  void add_normal_friction(MechanismState& s) const;
  void compute_response(MechanismState& s, const Eigen::Ref<const Eigen::VectorXd>& force) const;
  void multiply_friction_tangent(const MechanismState& s, double by_q, double by_qd, Eigen::MatrixXd& product) const;

  struct Choice {
    Partition partition;
    double least_pivot;
  };
  Choice pivot(const MechanismState& s) const;
  void assemble(MechanismState& s, double t);
  void check_dropped_positions(MechanismState& s) const;
  void check_dropped_rates(MechanismState& s) const;
  void check_dropped_accelerations(MechanismState& s) const;
  void check_dropped_friction() const;
  void check_dead_point(MechanismState& s) const;
  void fit_velocities(MechanismState& s) const;
  std::vector<int> dropped_rows() const;
  std::string conflict(MechanismState& s, int row, const std::string& verb) const;

  MechanismModel model_;
  Partition partition_;
  int partition_version_ = 0;    // 0: none
  double chosen_quality_ = 1.0;  // quality of the partition when it was chosen
  Eigen::VectorXd mass_;
  Eigen::VectorXd applied_;  // n, or empty without applied forces
  std::vector<JointGeometry> joints_;
  std::vector<int> friction_joints_;  // joints with friction
  bool has_normal_friction_ = false;  // whether one of these joints has friction in proportion to its normal force
  std::vector<SpringGeometry> springs_;
  std::vector<TorsionGeometry> torsion_springs_;
  std::vector<RopeGeometry> ropes_;
  int joint_row_count_ = 0;    // rows of Phi of the joints; one row per driver follows
  std::vector<char> pattern_;  // non-zero for entries of Phi_q that can be non-zero, by columns
  Scaling scaling_;
  double length_ = 1.0;  // m, the arm that scales angles to lengths
};

/// product += K B for the matrix K of a pair of bodies.
void add_pair_times_B(int first, int second, const PairMatrix& K, const MechanismState& s, Eigen::MatrixXd& product);

}  // namespace traverse::multibody
