// The assembled structure (section 2 of the paper with the foundation of section 3), distributed over ranks by columns.
//
//   M a + C* w + K* v = P        v, w, a: nodal displacements, velocities, accelerations
//
// A column contains the unknowns of one node (line.hpp). The vectors contain all unknowns of the columns. Held and
// unused unknowns remain zero, or at their settlement; their rows and columns are empty in M, C and K ("aa" of eq. 17).
// The rows "c" of eq. 18 are stored separately for the reactions. A foundation with a nonlinear law is a force in P.
// All matrices are AIJ, and each rank assembles its own columns without communication. M, K_aa, K* and C* have the same
// pattern of non-zeros.
#pragma once

#include <mpi.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "base/petsc.hpp"
#include "beam/element.hpp"
#include "beam/line.hpp"

namespace traverse::beam {

/// Rayleigh damping C = a M + b K of the beam itself, eq. 19.
struct Rayleigh {
  double a = 0.0;  // 1/s
  double b = 0.0;  // s
};

/// The forces of a support on the beam: along x and upward, N, and the moment, N m; torque about the line of shear
/// centres, N m, positive as the twist.
using Reaction = std::array<double, 4>;

/// The upward forces of the left and the right bearing of a support at a span end, N: half of its reaction with, at
/// half the spacing on each side of the beam's axis, what its torque needs.
std::array<double, 2> bearing_forces(const Torsion& torsion, std::size_t span_end, const Reaction& reaction);

class Rows;
struct Slice;

class Beam {
 public:
  /// Collective. Checks the model; throws InputError that names the option.
  Beam(MPI_Comm comm, BeamModel model);

  const BeamModel& model() const { return bridge_.model; }
  /// The bridge: the beam of the model.
  const Line& bridge() const { return bridge_; }
  const Mesh& mesh() const { return bridge_.mesh; }
  /// The lines between the supports of the bridge.
  const SupportLines& support_lines() const { return support_lines_; }
  /// The rail of a layered track, or null.
  const Line* rail() const { return rail_ ? &*rail_ : nullptr; }
  /// The line on which wheels run: the rail, or the bridge if there is no rail.
  const Line& running() const { return rail_ ? *rail_ : bridge_; }
  const Layout& layout() const { return layout_; }
  MPI_Comm comm() const { return comm_; }
  int block() const { return layout_.block; }  // unknowns per column
  int columns() const { return rail_ ? rail_->mesh.nodes() : bridge_.mesh.nodes(); }
  int first_column() const { return first_; }  // owned by this rank: [first_column, first_column + local_columns)
  int local_columns() const { return local_; }
  int local_unknowns() const { return local_ * block(); }
  /// First columns of the connected parts (between separate joints), and the end. The ranges of ranks end there if
  /// there are at least as many parts as ranks.
  const std::vector<int>& parts() const { return parts_; }
  /// The rank that owns a column.
  int owner(int column) const;
  /// The index of a global unknown among this rank's unknowns, or -1.
  int local(int unknown) const {
    const int i = unknown - first_ * block();
    return i >= 0 && i < local_unknowns() ? i : -1;
  }
  /// One entry for each local unknown: 1 if it is held or unused, 0 if it is free.
  const std::vector<char>& fixed() const { return fixed_; }

  /// Collective; must be called once before damping() and reactions() are used.
  void set_rayleigh(Rayleigh ab);
  Rayleigh rayleigh() const { return rayleigh_; }

  /// Frees M, K and C, most of the memory of a long beam, after a BeamOperator has read them; they are null afterwards.
  /// The matrices of foundation and track remain. Free memory is returned to the operating system.
  void release_matrices();
  Mat mass() const { return mass_; }                      // M_aa, with the masses of a layered track and of dampers
  Mat beam_stiffness() const { return beam_stiffness_; }  // K_aa, without foundation
  Mat springs() const { return springs_; }  // K* without the beams: foundation, track layers, mass dampers; or null
  Mat dampers() const { return foundation_damping_; }  // damping of the same; null: none
  Mat beam_mass() const { return beam_mass_; }         // mass of the bridge alone
  Mat stiffness() const { return stiffness_; }         // K* = K_aa + K_VC + K_LC + K_VD + K_LD + K_NR
  Mat damping() const { return damping_; }             // C* = a M_aa + b K_aa + C_VC + C_LC + C_VD + ...
  /// Stiffness and damping matrix of each kind of foundation of section 3; null if the scene has no such kind.
  struct FoundationMats {
    using Pair = std::array<base::Handle<Mat>, 2>;  // [0] stiffness, [1] damping
    std::array<Pair, foundation_kind_count> of_kind;
    Pair layered_track;  // rail, pads, ballast, sub-ballast
    const Pair& of(std::string_view kind) const { return of_kind[foundation_kind(kind)]; }
  };
  const FoundationMats& foundation() const { return foundation_; }

  /// Adds the nodal forces of the structure's weight for this rank's unknowns to P. They are consistent with psi: the
  /// mass matrix times a uniform downward acceleration of all masses. gravity > 0 acts downward.
  void add_self_weight(double gravity, double* P) const;

  /// Displacements of held unknowns by settlements for this rank, 0 elsewhere; empty if there are none. The matrices do
  /// not contain these unknowns, but InternalForces includes them in the elements' forces.
  const std::vector<double>& imposed() const { return imposed_; }
  /// Whether a held unknown of the whole beam is displaced.
  bool has_imposed() const { return !settlements_.empty(); }
  /// Nodal forces of the beam's temperature and of springs that a settlement deforms, for this rank; or empty.
  const std::vector<double>& strain_forces() const { return strain_forces_; }
  /// The product of the mass matrix with the settlements, held unknowns included: inertia forces if these were
  /// accelerations, for this rank; or empty.
  const std::vector<double>& inertia_of_imposed() const { return inertia_of_imposed_; }
  /// Collective. The reactions (as `reactions`) that accelerate the mass at the held unknowns if the settlements were
  /// accelerations, m/s2.
  void reactions_of_imposed_acceleration(std::vector<Reaction>& out) const;

  /// Collective. The reactions of the supports at every span end, followed by {fx, 0, 0, 0} of both ends of the rail if
  /// they are held along x; on all ranks. They are eq. 18 as corrected in
  /// doc/theory.md, M_ca a + C_ca w + K_ca v - P_c, from this rank's slices of the nodal vectors. P must contain the
  /// load on held unknowns too. At separate spans the reactions of both spans are added.
  void reactions(const double* v, const double* w, const double* a, const double* P, std::vector<Reaction>& out) const;
  /// Adds the coefficients of this rank's nodal displacements in `factor` times a static reaction (component 0 fx, 1
  /// fy, 2 moment) to `forces`. Loads on the held unknowns are not included.
  void add_reaction_form(int span_end, int component, double factor, double* forces) const;

 private:
  /// Coefficients of one free local unknown in the row of one held unknown, eq. 18.
  struct ReactionTerm {
    std::size_t slot;     // in the reactions, 4 per span end
    std::size_t unknown;  // local
    double mass, beam_mass, beam_stiffness, stiffness, foundation_damping, damping;
  };
  /// The load on a held unknown, and the effect of settlements on the elements' forces there.
  struct HeldLoad {
    std::size_t slot, unknown;
    double by_settlement = 0.0, by_acceleration = 0.0;  // of the settlements: displacements, or accelerations
  };

  Slice slice() const;
  std::vector<int> held_rail_ends() const;  // nodes
  void assemble(const Slice& slice);
  void add_foundation(const Slice& slice, Rows& stiffness, Rows& damping,
                      std::vector<std::pair<base::Handle<Mat>*, Rows>>& own);
  double settlement_of(int unknown) const;
  void record_strains(const Slice& slice, const Rows& springs, const Rows& mass);
  void record_temperature(const Slice& slice, const Line& line);
  void record_reactions(const Slice& slice, const Rows& beams, const Rows& mass, const Rows& beam_mass,
                        const Rows& beam_stiffness, const Rows& stiffness, const Rows& foundation_damping);

  MPI_Comm comm_;
  Layout layout_;
  Line bridge_;
  SupportLines support_lines_;
  std::optional<Line> rail_;
  std::vector<int> parts_, rank_begins_;
  int first_ = 0, local_ = 0;  // columns
  std::vector<char> fixed_;
  Rayleigh rayleigh_;
  base::Handle<Mat> mass_, beam_mass_, beam_stiffness_, springs_, stiffness_, damping_;
  base::Handle<Mat> foundation_damping_;             // sum of all kinds, with the pattern of the mass; or null
  std::vector<double> weight_;                       // nodal forces of self-weight for a gravity of 1 m/s2, this rank
  std::vector<std::pair<int, double>> settlements_;  // settlements of held unknowns of the whole beam, ascending
  std::vector<double> imposed_, strain_forces_, inertia_of_imposed_;
  FoundationMats foundation_;
  std::vector<ReactionTerm> reaction_terms_;
  std::vector<HeldLoad> held_loads_;
};

}  // namespace traverse::beam
