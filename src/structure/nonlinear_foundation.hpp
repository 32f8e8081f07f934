// The part of the bridge's foundation that obeys a law which is not linear, as forces on the beam, and Newton's method
// for it within an implicit stage.
//
// A stage's unknown is z: v = v~ + z, w = w~ + s z at the shift s. Each point's force, as a function of the change
// zeta of its own displacement, is replaced by its tangent at zeta0,
//   F(zeta) = F0 - T (zeta - zeta0),   T = k_t + s c_t,
// T goes into the beam's matrix and the rest to its right-hand side; beam, vehicles and contacts are then solved as
// without, and once more until forces and tangents agree. The laws are monotone, so that the structure's answer G to
// forces at the points makes the solution the minimum of a convex function: where a full step would pass the minimum
// along its direction, a shorter one is taken. Laws of straight pieces end after a few steps, exactly.
// In statics (s = 0) a point that does not touch keeps a small stiffness, which holds what nothing else holds and has
// no effect on the answer.
//
// Sleepers and bearings that slide along x remember the force and the place that they have settled at. Within a step
// their law is that of a spring between two limits, which is monotone like the others; settle() after the step makes
// the next start from there.
//
// A rank has the points of all elements that touch its columns, so that neighbours compute the same from the same.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "beam/nonlinear_points.hpp"
#include "recovery/recovery.hpp"
#include "structure/beam_operator.hpp"

namespace traverse::structure {

/// Forces on the bridge of the foundation that is not linear, N and N m, by the rows of beam::foundation_kinds. Points
/// in the order of the model's lists (zero for linear ones), of beds the resultant a span; empty where the model has no
/// such list or bed.
struct NonlinearForces {
  std::array<std::vector<double>, beam::foundation_kind_count> of_kind;
  /// Of the sleepers over a gap, from left to right: what pushes each up, N, and how far its gap is open, m; below zero
  /// it is closed and the ballast's spring is pressed by so much.
  std::vector<double> below_sleepers, open_gaps;
  double of_ground = 0.0;     // of all that on sleepers whose ballast stands on the ground without a mass, N
  double along_ground = 0.0;  // of sleepers that slide on the ground, on the rail along x, N
};

class NonlinearFoundation {
 public:
  /// load: of vehicles, moving forces and dead weight together, N, to begin statics with; point_load: the greatest
  /// single one of the first two, which forces are judged against.
  NonlinearFoundation(const beam::Beam& beam, const BeamOperator& op, double load, double point_load);

  // At a state -------------------------------------------------------------------------------------------------------
  /// Collective. The forces at v and w; what follows is of the last call, or of the last stage that settled.
  void evaluate(const double* v, const double* w);
  /// Nodal forces of this rank's unknowns, held ones included.
  void add_forces(double* nodal) const;
  /// This rank's share, J and W. What has been lost by sliding is no part of the dissipation.
  double energy() const;
  double dissipation() const;
  double slid() const { return slid_; }  // J, lost by sliding so far, this rank's share
  /// Collective. The same on all ranks; `loads` of the bridge are appended.
  void report(NonlinearForces& forces, std::vector<beam::ElementLoad>& loads) const;

  // Sleepers and bearings that slide ---------------------------------------------------------------------------------
  /// Where trains stand from here on, m: between these stations sleepers are loaded. An empty stretch: none are.
  void stand(double from, double to);
  /// Collective. What has slid by v stays where it is: the forces of what follows start from those at v.
  void update_slip(const double* v);
  /// Of every point that slides, on this rank: the force that it has settled at (N), and where (m).
  struct History {
    std::vector<double> force, displacement;
  };
  History history() const;
  /// Empty: nothing has slid.
  void set_history(const History& history);

  // Within a stage ---------------------------------------------------------------------------------------------------
  /// Collective. w_guess: rates to begin from. Null pointers, shift 0: statics from scratch.
  void begin(double shift, const double* v_predicted, const double* w_predicted, const double* w_guess);
  /// Collective. The tangents to solve with; kept as long as they are near enough.
  const AddedSprings& linearise();
  /// The right-hand side that belongs to them.
  void add_linearised(double* nodal) const;
  enum class Verdict { settled, again, failed };
  /// Collective. Whether the solution z agrees with the laws.
  Verdict judge(const double* z);
  /// Collective. The point that agrees least, for messages.
  std::string worst_point() const;

  /// The tangents of that version; null where they are kept no longer.
  const AddedSprings* tangents(long version) const;
  void keep(base::Bytes& bytes);

 private:
  struct Point {
    beam::NonlinearPoint its;
    std::size_t terms = 4;  // of the displacement
    /// In the local unknowns, then the left and the right neighbour's column; -1: none.
    std::array<int, beam::NonlinearShape::most> place{};
    std::array<double, beam::NonlinearShape::most> shape{};
    bool counted = false;    // by this rank, in sums
    double reference = 0.0;  // N/m, at a displacement of the order of that under the load
    double predicted = 0.0;  // displacement and rate at z = 0
    double predicted_rate = 0.0;
    double zeta0 = 0.0;
    double force0 = 0.0;
    double zeta = 0.0;            // the solution last judged
    double linear_force = 0.0;    // G there
    double balanced_force = 0.0;  // G at zeta0
    double misfit = 0.0;          // of force and tangent, beyond rounding
    beam::FoundationForce state;
    // Of a sleeper or a bearing that slides: whether it is loaded, what it has settled at, and the energy that it held
    // then.
    bool loaded = false;
    double settled_force = 0.0, settled = 0.0, settled_energy = 0.0;

    bool slides() const { return its.sliding.limit > 0.0; }
    void keep(base::Bytes& bytes) {
      bytes(predicted, predicted_rate, zeta0, force0, zeta, linear_force, balanced_force, misfit, state);
      bytes(loaded, settled_force, settled, settled_energy);
    }
  };

  void add_point(const beam::Beam& beam, const beam::NonlinearPoint& its, double load);
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
  std::size_t sleepers_ = 0;  // over a gap, on all ranks
  int spans_, n_, block_;
  double point_load_;
  std::vector<Point> points_;
  std::vector<AddedSprings::Term> terms_;
  std::array<AddedSprings, 4> kept_;  // tangents used lately
  std::size_t current_ = 0;
  long versions_ = 0;
  std::vector<double> wanted_k_, wanted_c_;
  std::vector<double> borders_;  // the neighbours' columns
  double shift_ = 0.0;
  double slid_ = 0.0;
  int iteration_ = 0;
};

}  // namespace traverse::structure
