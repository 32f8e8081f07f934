// The nonlinear part of the bridge's foundation as forces on the beam, and Newton's method for it in an implicit stage.
//
// The unknown of a stage is z: v = v~ + z, w = w~ + s z at the shift s. The force of each point, a function of the
// change zeta of the point's displacement, is replaced by its tangent at zeta0,
//   F(zeta) = F0 - T (zeta - zeta0),   T = k_t + s c_t,
// T is added to the beam's matrix and the other terms to its right-hand side. Beam, vehicles and contacts are then
// solved as without nonlinear points, repeatedly until forces and tangents agree. The laws are monotone, and the
// structure responds linearly with G to forces at the points; therefore the solution is the minimum of a convex
// function. If a full step would pass the minimum along its direction, it is shortened. For piecewise linear laws the
// iteration ends after a few steps with the exact solution.
// In statics (s = 0) a point without contact keeps a small stiffness, which supports otherwise unsupported unknowns and
// has no effect on the result.
//
// Sleepers and bearings that slide along x have a history: the force and the displacement of the last accepted state.
// Within a time step their law is the law of a spring between two limits, which is monotone like the others;
// update_slip() sets the history for the next step after the step.
//
// A rank has the points of all elements that touch its columns, so that neighbours compute the same forces from the
// same values.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "beam/nonlinear_points.hpp"
#include "recovery/recovery.hpp"
#include "structure/beam_operator.hpp"

namespace traverse::structure {

/// Forces of the nonlinear foundation on the bridge, N and N m, by the rows of beam::foundation_kinds. Points in the
/// order of the model's lists (zero for linear ones); for beds the resultant of each span. Empty if the model has no
/// such list or bed.
struct NonlinearForces {
  std::array<std::vector<double>, beam::foundation_kind_count> of_kind;
  /// For the sleepers over a gap, from left to right: the upward force on each, N, and the opening of its gap, m. A
  /// negative opening is the compression of the ballast's spring.
  std::vector<double> below_sleepers, open_gaps;
  double of_ground = 0.0;     // N, upward force on all sleepers whose ballast is on the ground without a mass
  double along_ground = 0.0;  // N, force along x on the rail from sleepers that slide on the ground
};

class NonlinearFoundation {
 public:
  /// load: sum of vehicle weights, moving forces and dead load, N, for the start of statics; point_load: the greatest
  /// single weight or force, N, the reference for the tolerance of forces.
  NonlinearFoundation(const beam::Beam& beam, const BeamOperator& op, double load, double point_load);

  // At a state -------------------------------------------------------------------------------------------------------
  /// Collective. Computes the forces at v and w. The next functions return values of this state, or of the last
  /// converged stage.
  void evaluate(const double* v, const double* w);
  /// Nodal forces of this rank's unknowns, held ones included.
  void add_forces(double* nodal) const;
  /// Stored energy, J, and dissipated power, W, this rank's share. Energy lost by sliding is not part of the
  /// dissipation.
  double energy() const;
  double dissipation() const;
  double slip_loss() const { return slip_loss_; }  // J, lost by sliding so far, this rank's share
  /// Collective. Sets the forces, equal on all ranks, and appends the loads on the bridge to `loads`.
  void report(NonlinearForces& forces, std::vector<recovery::ElementLoad>& loads) const;

  // Sliding sleepers and bearings ------------------------------------------------------------------------------------
  /// Sets the range of the trains from now on, m: sleepers between these stations are loaded. Empty range: none are.
  void set_loaded_range(double from, double to);
  /// Collective. Updates the slip history with v: the forces of later states start from those at v.
  void update_slip(const double* v);
  /// For every sliding point of this rank: the force (N) and displacement (m) of its slip history.
  struct History {
    std::vector<double> force, displacement;
  };
  History history() const;
  /// Empty: no slip.
  void set_history(const History& history);

  // Within a stage ---------------------------------------------------------------------------------------------------
  /// Collective. w_guess: initial guess of the rates. Null pointers, shift 0: statics from the undeformed state.
  void begin(double shift, const double* v_predicted, const double* w_predicted, const double* w_guess);
  /// Collective. The tangents for the next solution; stored ones are used while they are accurate enough.
  const AddedSprings& linearise();
  /// Adds the right-hand side of these tangents.
  void add_linearised(double* nodal) const;
  enum class Verdict { converged, again, failed };
  /// Collective. Whether the solution z agrees with the laws.
  Verdict check_stage(const double* z);
  /// Collective. The point with the largest disagreement, for messages.
  std::string worst_point() const;

  /// The tangents of that version; null if they are no longer stored.
  const AddedSprings* tangents(long version) const;
  void keep(base::Bytes& bytes);

 private:
  struct Point {
    beam::NonlinearPoint source;
    std::size_t terms = 4;  // number of terms of the displacement
    /// Index in the local unknowns, then in the left and the right neighbour's column; -1: none.
    std::array<int, beam::NonlinearShape::most> place{};
    std::array<double, beam::NonlinearShape::most> shape{};
    bool counted = false;    // included in this rank's sums
    double reference = 0.0;  // N/m, stiffness for displacements of the order of the displacement under the load
    double predicted = 0.0;  // displacement and rate at z = 0
    double predicted_rate = 0.0;
    double zeta0 = 0.0;
    double force0 = 0.0;
    double zeta = 0.0;            // value of zeta in the last checked solution
    double linear_force = 0.0;    // G at zeta
    double balanced_force = 0.0;  // G at zeta0
    double mismatch = 0.0;        // difference of force and tangent beyond rounding
    beam::FoundationForce state;
    // For a sliding sleeper or bearing: whether it is loaded, and force, displacement and energy of its slip history.
    bool loaded = false;
    double slip_force = 0.0, slip_displacement = 0.0, slip_energy = 0.0;

    bool slides() const { return source.sliding.limit > 0.0; }
    void keep(base::Bytes& bytes) {
      bytes(predicted, predicted_rate, zeta0, force0, zeta, linear_force, balanced_force, mismatch, state);
      bytes(loaded, slip_force, slip_displacement, slip_energy);
    }
  };

  void add_point(const beam::Beam& beam, const beam::NonlinearPoint& source, double load);
  void record_terms(const beam::Beam& beam);
  void gather(const double* x, double Point::*into);
  static beam::FoundationForce force_of(const Point& p, double displacement, double rate);
  beam::FoundationForce force_at(const Point& p, double zeta) const;
  void start_statics(Point& p) const;
  void choose_tangents();
  double slope(double share) const;
  double best_share() const;

  MPI_Comm comm_;
  const BeamOperator& operator_;
  const beam::Foundation& foundation_;
  std::size_t sleepers_ = 0;  // number of sleepers over a gap, on all ranks
  int spans_, n_, block_;
  double point_load_;
  std::vector<Point> points_;
  std::vector<AddedSprings::Term> terms_;
  std::array<AddedSprings, 4> stored_;  // tangents used last
  std::size_t current_ = 0;
  long versions_ = 0;
  std::vector<double> tangent_k_, tangent_c_;
  std::vector<double> borders_;  // columns of the neighbours
  double shift_ = 0.0;
  double slip_loss_ = 0.0;
  int iteration_ = 0;
};

}  // namespace traverse::structure
