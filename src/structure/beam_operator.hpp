// The beam's matrices as they are used in time: products with nodal vectors, and solves with A = s^2 M + s C* + K*
// whose factorisations are kept per shift s.
#pragma once

#include <algorithm>
#include <functional>
#include <list>
#include <optional>
#include <vector>

#include "base/archive.hpp"
#include "beam/internal_forces.hpp"
#include "solve/block_tridiagonal.hpp"
#include "structure/beam_factor.hpp"
#include "structure/block_rows.hpp"

namespace traverse::structure {

/// Springs and dampers at single stations on top of the beam's own matrices: a foundation linearised.
struct AddedSprings {
  /// shape*(k + s c) of a point in a row of this rank's.
  struct Term {
    std::size_t point = 0;
    int row = 0, column = 0;  // local; beyond this rank's unknowns the left neighbour's column, then the right one's
    bool upper = false;       // of the block above the diagonal, or of that on it
    int place = -1;           // in these blocks; -1: below them, known by symmetry
    double shape = 0.0;
  };
  long version = 0;  // another one with every change, the same on all ranks
  const std::vector<Term>* terms = nullptr;
  std::vector<double> k, c;  // of every point
};

class BeamOperator {
 public:
  /// A matrix of this rank's rows, with the block that couples them to the rank on the left.
  struct Matrix {
    solve::BlockTridiagonal rows;
    std::vector<double> left;
    BlockRows products;  // of these with vectors
  };

  explicit BeamOperator(const beam::Beam& beam);

  int unknowns() const { return nodes_ * block_; }  // on this rank
  int block() const { return block_; }              // unknowns a column
  bool shared() const { return ranks_ > 1; }        // by several ranks
  /// This rank's columns as parts that do not touch, where they are solved so; else null.
  const solve::Parts* parts() const { return parts_ ? &*parts_ : nullptr; }

  /// a where C* = a M + b K*, so that neither C* nor what follows of it is kept.
  std::optional<double> mass_damping() const { return mass_damping_; }
  /// M, K* less K_aa, C* less the beams' b K_aa; null where there is none.
  const Matrix& mass() const { return mass_; }
  const Matrix* springs() const { return springs_ ? &*springs_ : nullptr; }
  const Matrix* drag() const { return drag_ ? &*drag_ : nullptr; }
  /// b of the beams' damping b K_aa for each unknown of a column, 0 for those without.
  const std::vector<double>& stiffness_damping() const { return damped_part_; }

  /// Collective. The neighbours' columns at the borders of this rank's; left as they are where there is none.
  void borders(const double* x, double* left, double* right) const;
  /// Collective. `count` numbers of the first column to the left neighbour and of the last column to the right one,
  /// against theirs.
  void exchange(const double* first, const double* last, int count, double* left, double* right) const;

  /// Collective. r = sign*(M m + C* c + K* k); a null pointer leaves its term out. Arrays of this rank's unknowns;
  /// the rows of held ones mean nothing.
  void multiply(double sign, const double* m, const double* c, const double* k, double* r) const;

  /// Collective. Forces the M-solve: x in: nodal forces, out: accelerations. Held unknowns must be zero.
  void solve_mass(double* x) const;

  /// Collective. K* v = P, with the springs added, x in: nodal forces, out: displacements; held unknowns must be zero.
  /// Refined with residuals that are exact to long double where the first solution has lost digits: on a chain of n
  /// elements without supports between them about 0.02 eps n^4 of it is rounding. SolverError where nothing is left to
  /// trust.
  void solve_static(double* x, const AddedSprings* added = nullptr);
  /// The structure yields by these modes alone from here on, all ranks' unknowns of each with phi^T M phi = 1 kg:
  /// solve_static gives sum phi phi^T P/omega^2.
  void yield_by(const std::vector<std::vector<double>>& shapes, const std::vector<double>& omega, int first_unknown);
  /// The largest relative error that solve_static has left so far, estimated from its last corrections.
  double static_error() const { return static_error_; }

  /// Factorisation of shift2 M + shift C* + K*, with springs added where there are some; 0, 0 is the static one. Kept
  /// for the last few shifts, which are compared relatively (time integrators compute the same shift with rounding
  /// noise).
  const BeamFactor& factored(double shift, double shift2, const AddedSprings* added = nullptr);
  /// Drops the factorisations of time steps: what comes does not depend on which there were.
  void forget_steps() {
    factors_.remove_if([](const Factor& f) { return f.shift != 0.0; });
  }
  /// Changes whenever `factored` hands out another factorisation.
  long factor_stamp() const { return stamp_; }
  /// Whether the factorisation of that stamp may be handed out again.
  bool keeps(long stamp) const {
    return std::any_of(factors_.begin(), factors_.end(), [&](const Factor& f) { return f.stamp == stamp; });
  }
  long factorisations() const { return factorisations_; }  // so far
  bool damped() const { return damped_; }
  mutable long solves = 0;  // beam solves so far, for the summary
  /// Collective. Which factorisations are kept; they are computed again when it is read. springs: those of a version
  /// that may be asked for again, else null.
  void keep(base::Archive& archive, const std::function<const AddedSprings*(long)>& springs);

 private:
  struct Factor {
    double shift, shift2;
    long added;  // version of the springs; 0: none
    long stamp;
    BeamFactor beam;
  };
  /// The matrices that factorisations are made of: of all this rank's columns, whose mass is kept apart, or of one kind
  /// of its parts; the damping where it is not Rayleigh's alone.
  struct Shifted {
    solve::BlockTridiagonal mass, damping, stiffness;
  };
  void find_parts(const beam::Beam& beam, const Shifted& all);
  BeamFactor new_factor() const;
  solve::BlockTridiagonal shifted(std::size_t kind, double shift, double shift2) const;
  void factor(BeamFactor& to, double shift, double shift2, const AddedSprings* added);
  Matrix with_neighbour(solve::BlockTridiagonal rows) const;
  void solve_by_modes(double* x) const;
  void add_damped_part(const double* c, const double* k) const;
  void product(const Matrix& A, double sign, const double* x, double* r) const;

  MPI_Comm comm_;
  int ranks_ = 1, block_, nodes_;
  int left_rank_, right_rank_;  // neighbours with nodes, or MPI_PROC_NULL
  std::vector<char> fixed_;
  Matrix mass_;
  std::optional<double> mass_damping_;
  std::optional<Matrix> springs_, drag_;  // C* = drag + b K_aa; null where there are none
  std::optional<solve::Parts> parts_;
  std::vector<Shifted> shifted_;  // one, or one a kind of part
  beam::InternalForces internal_;
  double stiffness_damping_;         // b of eq. 19, s
  std::vector<double> damped_part_;  // b for the bridge's unknowns, 0 for others of a column
  mutable std::vector<double> relative_;
  std::vector<double> load_, residual_;  // of solve_static
  double static_error_ = 0.0;
  bool damped_ = false;
  mutable std::vector<double> halo_;  // values of the columns on the left and on the right
  std::optional<BeamFactor> mass_factor_;
  std::list<Factor> factors_;                  // most recent first
  std::vector<std::vector<double>> flexible_;  // of yield_by: each shape over its omega, this rank's unknowns
  long stamp_ = 0;
  long factorisations_ = 0;
};

}  // namespace traverse::structure
