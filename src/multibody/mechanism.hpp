// The equations of motion of a constrained planar mechanism, reduced by generalized coordinate partitioning
// (the paper's eqs. 42-44 and section 5; Wehage & Haug 1982).
//
//   Phi(q, t) = 0,   N q'' + Phi_q^T lambda = g + Q,   Phi_q q'' = gamma
//
// q holds x, y, phi of every body (n = 3 bodies). A partition splits q into f independent coordinates p and the
// dependent ones. With them known, q = q(p, t), q' = B p' + b, q'' = B p'' + d, where B (n x f) has identity rows
// for the independent coordinates. The projected equations of motion are B^T (N (B p'' + d) - g - Q) = 0.
// Q are external generalized forces (wheels on the beam) supplied by the caller.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "multibody/force_element.hpp"
#include "multibody/joint.hpp"
#include "multibody/reduction.hpp"
#include "traverse/multibody/frame.hpp"
#include "traverse/multibody/model.hpp"

namespace traverse::multibody {

/// The motion at an accepted instant. Where a guess is needed it is continued from there by Taylor's series.
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

/// Friction in the joints that slide with friction, r of them. With f the forces along their axes, A the gradients of
/// their slidings and H^T r the normal forces that a generalized force r on all bodies causes when the accelerations
/// are given, they are f_k = -(mu_k |lambda_k| + F_k) tanh(v_k/v0_k), v = A^T q', and
/// lambda = H^T (g + Q + A f - N q''), which has to be solved for lambda (friction.cpp).
struct FrictionState {
  Eigen::MatrixXd A;             // n x r
  Eigen::MatrixXd H;             // n x r
  Eigen::VectorXd speed, share;  // r: v (m/s) and tanh(v/v0)
  Eigen::VectorXd force;         // r: f, N, along the axis on the second body
  Eigen::VectorXd normal_force;  // r: lambda, N
  bool jammed = false;           // no lambda, or more than one

  // workspaces
  Eigen::VectorXd unit, work, start;  // a row of Phi; n; r
  Eigen::VectorXd by_lambda;          // r: df = -by_lambda d(lambda)
  Eigen::MatrixXd gain;               // r x r: d(lambda)/df
  Eigen::MatrixXd system, inverse;    // r x r: 1 + gain by_lambda, and its inverse

  void keep(base::Bytes& bytes) {
    bytes(A, H, speed, share, force, normal_force, jammed, by_lambda, gain, system, inverse);
  }
};

/// Everything that changes with time for one mechanism; sized once by Mechanism::make_state.
struct MechanismState {
  double time = 0.0;
  Eigen::VectorXd q, qd;              // n
  Eigen::MatrixXd B;                  // n x f
  Eigen::VectorXd b;                  // n: q' = B p' + b
  Eigen::VectorXd d;                  // n: q'' = B p'' + d
  Eigen::VectorXd g;                  // n: gravity, springs, actuators
  double dissipation = 0.0;           // W: lost in springs' dampers
  Eigen::VectorXd qdd;                // n
  Eigen::VectorXd lambda;             // one a row of Phi; 0 for dropped rows
  Eigen::MatrixXd Phi_q;              // rows of Phi x n, redundant rows included
  Eigen::VectorXd Phi, gamma, Phi_t;  // one a row of Phi

  FrictionState friction;  // as accelerations or recover left it

  // workspaces of the implementation
  std::vector<Frame> frames;         // ground first, then the bodies: see Mechanism
  std::vector<ColumnRange> columns;  // of B that a body's rows reach into; one a body
  DependentBlock dependent_block;
  ReducedMass reduced_mass;
  Instant accepted;                  // the last accepted instant
  int partition_version = 0;         // which partition the workspaces belong to
  bool factored = false;             // dependent_block holds a factorisation of Phi_q near the current q
  bool factors_belong = false;       // that factorisation is of Phi_q as it is
  bool sensitivity_belongs = false;  // the sensitivity and B are those of Phi_q as it is
  bool velocities_set = false;       // dependent_block holds the sensitivity at the last velocities
  bool mass_factored = false;        // reduced_mass belongs to B
  long corrections = 0;              // Newton steps on positions so far
  Eigen::VectorXd work;              // n
  Eigen::VectorXd reduced;           // f
  Eigen::VectorXd change;            // f
  Eigen::VectorXd centre;            // n: q of a nearly singular position
  Eigen::MatrixXd interpolated;      // n x (f + 2): B, b, d there

  void keep(base::Bytes& bytes) {
    bytes(time, q, qd, B, b, d, g, dissipation, qdd, lambda, Phi_q, Phi, gamma, Phi_t, friction, frames, columns,
          dependent_block, reduced_mass, accepted, partition_version, factored, factors_belong, sensitivity_belongs,
          velocities_set, mass_factored, corrections, centre, interpolated);
  }
};

/// Powers of a mechanism in a state, W.
struct MechanismPowers {
  double dissipation = 0.0;  // lost in dampers and in friction, >= 0
  double work = 0.0;         // of actuators, of what is applied and of rheonomic constraints (drivers)
};
/// And its stored energies, J.
struct MechanismEnergy : MechanismPowers {
  double kinetic = 0.0;
  double strain = 0.0;     // springs, torsion springs: 1/2 k e^2, or the integral of a law
  double potential = 0.0;  // gravity
};

class Mechanism {
 public:
  /// Checks the model (positive masses and inertias, finite numbers, known bodies): InputError otherwise.
  explicit Mechanism(MechanismModel model);

  const MechanismModel& model() const { return model_; }
  /// Lets a constant force (N, along x and y) at the centre of mass of a body and a moment (N m) act besides all else,
  /// instead of those of the last call for that body. Forces have to be computed anew.
  void apply(int body, const Eigen::Vector3d& action);
  /// Drivers whose acceleration jumps go on by the piece that holds t. True when it is another one than before.
  bool take_pieces(double t);
  int coordinates() const;  // n
  int constraints() const;  // rows of Phi, redundant ones included
  int freedom() const;      // f, after choose_partition
  const Partition& partition() const { return partition_; }
  const Eigen::VectorXd& mass_diagonal() const { return mass_; }  // n: N is diagonal

  /// A state at t = 0 with the bodies where the model puts them. May be called before or after choose_partition.
  MechanismState make_state() const;

  /// Chooses the partition at s.q, t by full pivoting on Phi_q and makes s consistent: the dependent coordinates are
  /// solved for, velocities that do not fit the constraints are projected in the metric of the masses. The caller reads
  /// p and p' from s.q and s.qd. Rows of drivers are kept before rows of joints; redundant rows are dropped.
  /// Throws InputError naming the joints and drivers when rows contradict each other (in position, speed or
  /// acceleration), cannot be met, or depend on each other in this position only (a dead point). Returns the names of
  /// joints and drivers with dropped rows.
  std::vector<std::string> choose_partition(MechanismState& s, double t);

  /// Notes that s is an accepted instant: Newton and nearly singular positions start from its continuation.
  void accept(MechanismState& s) const;

  /// Whether coordinates have come to depend strongly on the independent ones, or Phi_u is nearly singular.
  bool worn(const MechanismState& s) const;
  /// Chooses another partition at the consistent state s where the present one has become poor and another is better.
  /// Where all choices are singular the present one is kept to pass that position. False when it is kept.
  bool renew_partition(MechanismState& s);
  /// Takes a partition that was chosen elsewhere at the same q and q', which s holds, unless it is the one there.
  void adopt_partition(MechanismState& s, const Partition& partition);

  /// The quality of the partition, in (0, 1]: one over the largest ratio in which a dependent coordinate moves with an
  /// independent one (angles count by a typical arm), at most 1. It tends to 0 where Phi_u becomes singular. Velocities
  /// must be set.
  double partition_quality(const MechanismState& s) const;

  /// Sets the independent coordinates to p and solves Phi = 0 for the others by Newton, from where the last accepted
  /// instant or the last velocities would take them. Returns false when it does not converge (s.q then holds the last
  /// iterate), or when a dropped row is not met.
  bool set_positions(MechanismState& s, double t, const double* p) const;
  /// After set_positions has failed: which joint or driver is not met, and by how much.
  std::string worst_row(const MechanismState& s) const;

  /// Computes q' from p', and B, b, d. Positions must be set.
  void set_velocities(MechanismState& s, double t, const double* pd) const;

  /// Computes g and the power that dampers take. Positions and velocities must be set.
  void compute_forces(MechanismState& s) const;

  /// Changes p by a small amount and p' by `rate` times that. Positions, velocities and g follow to first order; B, b
  /// and d stay as they are. Positions, velocities and forces must be set.
  void shift(MechanismState& s, const double* change, double rate) const;

  /// p'' from the projected equations with external forces Q (n); also q'' and lambda. Throws SolverError where
  /// friction jams a joint: the bodies' accelerations are then not determined.
  void accelerations(MechanismState& s, const Eigen::VectorXd& Q, double* pdd) const;

  /// q'' from a given p'', and lambda from the dependent rows of the equations of motion. Where friction jams a joint
  /// s.friction.jammed is set.
  void recover(MechanismState& s, const Eigen::VectorXd& Q, const double* pdd) const;

  /// Whether joints slide with friction.
  bool rubs() const { return !rubbing_.empty(); }
  /// After recover: which matrix takes the place of B in the projection B^T r of a change r of the equations' residual
  /// at fixed lambda, so that the changes of lambda it causes drop out where friction goes with them (n x f).
  void friction_projector(const MechanismState& s, Eigen::MatrixXd& projector) const;
  /// Says in words why s.friction.jammed is set.
  std::string jam(const MechanismState& s) const;

  /// (by_q dg/dq + by_qd dg/dq' + by_lambda d(Phi_q^T lambda)/dq) B into product (n x f), at fixed lambda. Here g
  /// includes friction.
  void multiply_tangent(const MechanismState& s, double by_q, double by_qd, double by_lambda,
                        Eigen::MatrixXd& product) const;

  /// Reaction of joint j on its second body, friction included: fx, fy, moment about the joint's point as it moves with
  /// that body (for `distance`: about `to`). Rows dropped as redundant carry nothing.
  Eigen::Vector3d joint_reaction(const MechanismState& s, int j) const;
  /// Generalized force that driver k exerts on its coordinate.
  double driver_force(const MechanismState& s, int k) const;
  /// Tension of spring k, N, damper included.
  double spring_force(const MechanismState& s, int k) const;
  /// Moment of torsion spring k on its second body, N m.
  double torsion_spring_moment(const MechanismState& s, int k) const;

  /// With forces computed; where drivers move or joints rub also after accelerations or recover.
  MechanismPowers powers(const MechanismState& s) const;
  MechanismEnergy energy(const MechanismState& s) const;

  /// What a state shows, observed or asked for its powers and energies: seen_numbers() numbers. One that has read them
  /// moves on only after another start.
  int seen_numbers() const;
  void write_seen(const MechanismState& s, double* to) const;
  void read_seen(MechanismState& s, const double* from) const;

  /// The mass (kg) that a generalized force along `direction` (n) meets when it sets the mechanism in motion: the force
  /// over the acceleration along it. Infinite where it moves nothing. With velocities set.
  double effective_mass(MechanismState& s, const Eigen::VectorXd& direction) const;

  /// The partition, which changes with time.
  void keep(base::Bytes& bytes) { bytes(partition_, partition_version_, chosen_quality_); }

 private:
  const Frame& frame(const MechanismState& s, int body) const { return s.frames[body + 1]; }
  int driver_row(int k) const { return joint_row_count_ + k; }
  const std::string& part_name(int row) const;  // of the joint or driver that a row of Phi belongs to
  std::string row_name(int row) const;          // the same for a message: joint 'x'
  const char* row_unit(int row) const;
  void find_scaling();
  void find_pattern();

  void fit(MechanismState& s) const;
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
  void spread(MechanismState& s, const double* pdd) const;
  void place_friction(MechanismState& s) const;
  void friction_in_motion(MechanismState& s) const;
  void friction_in_given_motion(MechanismState& s) const;
  void add_level(MechanismState& s) const;
  void add_friction(MechanismState& s) const;
  void settle(MechanismState& s) const;
  void force_of_normals(MechanismState& s) const;
  void respond(MechanismState& s, const Eigen::Ref<const Eigen::VectorXd>& force) const;
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
  int partition_version_ = 0;    // 0: none chosen
  double chosen_quality_ = 1.0;  // of the partition when it was chosen
  Eigen::VectorXd mass_;
  Eigen::VectorXd applied_;  // n, or of size 0 as long as nothing is
  std::vector<JointGeometry> joints_;
  std::vector<int> rubbing_;  // joints that slide with friction
  bool presses_ = false;      // one of them rubs in proportion to its normal force
  std::vector<SpringGeometry> springs_;
  std::vector<TorsionGeometry> torsion_springs_;
  int joint_row_count_ = 0;    // rows of Phi: first the joints', then one a driver
  std::vector<char> pattern_;  // where Phi_q can be non-zero, by columns
  Scaling scaling_;
  double length_ = 1.0;  // m, the arm at which angles are compared with lengths
};

}  // namespace traverse::multibody
