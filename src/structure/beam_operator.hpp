// The beam's matrices for time integration: products with nodal vectors, and solutions with A = s^2 M + s C* + K*,
// whose factorisations are stored for the latest shifts s.
#pragma once

#include <algorithm>
#include <functional>
#include <list>
#include <optional>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "beam/internal_forces.hpp"
#include "solve/block_tridiagonal.hpp"
#include "solve/separate_parts.hpp"
#include "structure/block_rows.hpp"

namespace traverse::structure {

/// A factorisation of one of the beam's matrices, split over the ranks: as one chain, or part by part if its spans do
/// not touch.
class BeamFactor {
 public:
  explicit BeamFactor(solve::SubstructuredCholesky whole) : whole_(std::move(whole)) {}
  explicit BeamFactor(solve::SeparateParts parts) : parts_(std::move(parts)) {}

  solve::SubstructuredCholesky& whole() { return *whole_; }
  solve::SeparateParts& parts() { return *parts_; }
  const solve::SeparateParts& parts() const { return *parts_; }

  /// Collective; see SubstructuredCholesky.
  void solve(double* x, int columns = 1) const { parts_ ? parts_->solve(x, columns) : whole_->solve(x, columns); }
  void solve(double* x, solve::RhsCallback& right_side) const {
    parts_ ? parts_->solve(x, right_side) : whole_->solve(x, right_side);
  }
  void solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past, solve::RhsCallback& right_side) const {
    parts_ ? parts_->solve_window(x, first, past, right_side) : whole_->solve_window(x, first, past, right_side);
  }
  void solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const {
    parts_ ? parts_->solve_local(x, columns, first, past) : whole_->solve_local(x, columns, first, past);
  }

 private:
  std::optional<solve::SubstructuredCholesky> whole_;
  std::optional<solve::SeparateParts> parts_;
};

/// Springs and dampers at single stations in addition to the beam's own matrices: a linearised foundation.
struct AddedSprings {
  /// shape*(k + s c) of a point in one of this rank's rows.
  struct Term {
    std::size_t point = 0;
    int row = 0, column = 0;  // local; after this rank's unknowns the left neighbour's column, then the right one's
    bool upper = false;       // in the block above the diagonal, not on it
    int place = -1;           // index in these blocks; -1: below them, given by symmetry
    double shape = 0.0;
  };
  long version = 0;  // changes with every change of the springs, the same on all ranks
  const std::vector<Term>* terms = nullptr;
  std::vector<double> k, c;  // stiffness and damping of every point
};

inline constexpr std::size_t stored_factors = 12;  // factorisations of the latest shifts

class BeamOperator {
 public:
  /// A matrix of this rank's rows, with the block that couples them to the left neighbour rank.
  struct Matrix {
    solve::BlockTridiagonal rows;
    std::vector<double> left;
    BlockRows products;  // for products with vectors
  };

  explicit BeamOperator(const beam::Beam& beam);

  int unknowns() const { return nodes_ * block_; }  // on this rank
  int block() const { return block_; }              // unknowns of a column
  bool shared() const { return ranks_ > 1; }        // by several ranks
  /// This rank's columns as parts that do not touch, if they are solved separately; otherwise null.
  const solve::Parts* parts() const { return parts_ ? &*parts_ : nullptr; }

  /// a if C* = a M + b K*; C* and its products are not stored then.
  std::optional<double> mass_damping() const { return mass_damping_; }
  /// M, K* - K_aa, C* - b K_aa of the beams; null if zero.
  const Matrix& mass() const { return mass_; }
  const Matrix* springs() const { return springs_ ? &*springs_ : nullptr; }
  const Matrix* drag() const { return drag_ ? &*drag_ : nullptr; }
  /// b of the beams' damping b K_aa for each unknown of a column, 0 for undamped ones.
  const std::vector<double>& stiffness_damping() const { return damping_factors_; }

  /// Collective. The neighbours' columns next to this rank's; unchanged if there is no neighbour.
  void borders(const double* x, double* left, double* right) const;
  /// Collective. Exchanges `count` numbers of the first column with the left neighbour rank, and `count` numbers of the
  /// last column with the right neighbour rank.
  void exchange(const double* first, const double* last, int count, double* left, double* right) const;

  /// Collective. r = sign*(M m + C* c + K* k); a null pointer omits its term. Arrays of this rank's unknowns; the rows
  /// of held unknowns are meaningless.
  void multiply(double sign, const double* m, const double* c, const double* k, double* r) const;

  /// Collective. Solves with M. x: nodal forces, then accelerations. Held unknowns must be zero.
  void solve_mass(double* x) const;

  /// Collective. Solves K* v = P, with the added springs. x: nodal forces, then displacements; held unknowns must be
  /// zero. Iterative refinement with residuals in long double is used if the first solution has lost digits: a chain of
  /// n elements without supports between them loses about 0.02 eps n^4. SolverError if no digits remain.
  void solve_static(double* x, const AddedSprings* added = nullptr);
  /// From now on the flexibility consists of these modes only, with all ranks' unknowns of each and phi^T M phi = 1 kg:
  /// solve_static computes sum phi phi^T P/omega^2.
  void set_modal_flexibility(const std::vector<std::vector<double>>& shapes, const std::vector<double>& omega,
                             int first_unknown);
  /// The largest relative error of all results of solve_static, estimated from the last corrections.
  double static_error() const { return static_error_; }

  /// The factorisation of shift2 M + shift C* + K* with added springs, if any; with the shifts 0, 0 it is the static
  /// one. The factorisations for the last few shifts are stored. Shifts are compared with a tolerance, since time
  /// integrators compute the same shift with rounding errors.
  const BeamFactor& factored(double shift, double shift2, const AddedSprings* added = nullptr);
  /// Deletes the factorisations of time steps, so that later results do not depend on earlier steps.
  void delete_step_factors() {
    factors_.remove_if([](const Factor& f) { return f.shift != 0.0; });
  }
  /// Changes whenever `factored` returns another factorisation.
  long factor_stamp() const { return stamp_; }
  /// Whether the factorisation with that stamp is stored.
  bool is_stored(long stamp) const {
    return std::any_of(factors_.begin(), factors_.end(), [&](const Factor& f) { return f.stamp == stamp; });
  }
  long factorisations() const { return factorisations_; }  // so far
  bool damped() const { return damped_; }
  mutable long solves = 0;  // beam solves so far, for the summary
  /// Collective. Writes or reads which factorisations are stored; they are computed again after reading. springs:
  /// returns the springs of a version that may be used again, otherwise null.
  void keep(base::Archive& archive, const std::function<const AddedSprings*(long)>& springs);
  /// Collective. Writes or reads the largest relative error of the static solutions so far only.
  void keep_static_error(base::Archive& archive) { archive.cache(static_error_); }

 private:
  struct Factor {
    double shift, shift2;
    long added;  // version of the springs; 0: none
    long stamp;
    BeamFactor beam;
  };
  /// The matrices for factorisations of all this rank's columns (their mass is stored separately) or of one kind of its
  /// parts. They include the damping only if it is not pure Rayleigh damping.
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
  std::optional<Matrix> springs_, drag_;  // C* = drag + b K_aa; none if zero
  std::optional<solve::Parts> parts_;
  std::vector<Shifted> shifted_;  // one, or one for each kind of part
  beam::InternalForces internal_;
  double stiffness_damping_;             // b of eq. 19, s
  std::vector<double> damping_factors_;  // b for the bridge's unknowns, 0 for others of a column
  mutable std::vector<double> relative_;
  std::vector<double> load_, residual_;  // work arrays of solve_static
  double static_error_ = 0.0;
  bool damped_ = false;
  mutable std::vector<double> halo_;  // values of the columns on the left and on the right
  std::optional<BeamFactor> mass_factor_;
  std::list<Factor> factors_;  // most recent first
  std::vector<std::vector<double>>
      flexibility_modes_;  // set by set_modal_flexibility: each shape divided by its omega, this rank's unknowns
  long stamp_ = 0;
  long factorisations_ = 0;
};

}  // namespace traverse::structure
