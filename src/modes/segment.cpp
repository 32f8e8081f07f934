// Gathers the global matrices, splits them between uncoupled neighbouring columns, groups equal segments, and adds the
// rigid-body motions of each.
#include "segment.hpp"

#include <cmath>
#include <limits>
#include <span>

namespace traverse::modes {
namespace {

using base::check;

/// Calls row(i, columns, values) for each row, columns ascending.
template <class Row>
void for_rows(Mat matrix, int size, Row row) {
  for (PetscInt i = 0; i < size; ++i) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    check(MatGetRow(matrix, i, &count, &columns, &values));
    row(i, std::span(columns, static_cast<std::size_t>(count)), values);
    check(MatRestoreRow(matrix, i, &count, &columns, &values));
  }
}

/// A band with the width of the matrix's pattern of non-zeros, which M, K* and C* share.
Band band_of(Mat matrix, int size) {
  int width = 0;
  for_rows(matrix, size, [&](PetscInt i, std::span<const PetscInt> columns, const PetscScalar*) {
    if (!columns.empty()) width = std::max(width, static_cast<int>(i - columns.front()));
  });
  Band band(size, width);
  for_rows(matrix, size, [&](PetscInt i, std::span<const PetscInt> columns, const PetscScalar* values) {
    for (std::size_t k = 0; k < columns.size() && columns[k] <= i; ++k) band.at(i, columns[k]) = values[k];
  });
  return band;
}

/// Whether bending is coupled with motion along x, because sleepers act on the bridge above its axis.
bool axially_coupled(const beam::BeamModel& model) { return model.track && model.axial && model.surface_height != 0.0; }

/// Whether an unknown belongs to a motion. If bending is coupled with motion along x, both are bending.
bool belongs(beam::Kind kind, Motion motion, const beam::BeamModel& model) {
  if (beam::Layout::axial(kind)) return motion == Motion::along || axially_coupled(model);
  if (beam::Layout::of_twist(kind)) return motion == Motion::twist || motion == Motion::bending_and_twist;
  return motion == Motion::bending || motion == Motion::bending_and_twist;
}

/// The global unknowns of a motion.
std::vector<PetscInt> unknowns_of(const beam::Beam& beam, Motion motion) {
  std::vector<PetscInt> wanted;
  for (int column = 0; column < beam.columns(); ++column)
    for (int i = 0; i < beam.block(); ++i)
      if (belongs(beam.layout().kind[i], motion, beam.model())) wanted.push_back(column * beam.block() + i);
  return wanted;
}

/// The wanted rows of the matrix from all ranks, stored on every rank. Held unknowns have zero rows.
Band gathered(Mat matrix, const std::vector<PetscInt>& wanted) {
  base::Handle<IS> set;
  check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(wanted.size()), wanted.data(), PETSC_COPY_VALUES,
                        set.out()));
  Mat* copies = nullptr;
  const IS raw = set;
  check(MatCreateSubMatrices(matrix, 1, &raw, &raw, MAT_INITIAL_MATRIX, &copies));
  Band band = band_of(copies[0], static_cast<int>(wanted.size()));
  check(MatDestroySubMatrices(1, &copies));
  return band;
}

/// The unknowns `rows` of a matrix; the unknowns between them are held and have no entries.
Band part_of(const Band& whole, const std::vector<int>& rows) {
  Band part(static_cast<int>(rows.size()), whole.width());
  for (int i = 0; i < part.size(); ++i) {
    for (int j = std::max(0, i - part.width()); j <= i; ++j) {
      const int row = rows[static_cast<std::size_t>(i)], column = rows[static_cast<std::size_t>(j)];
      if (row - column <= whole.width()) part.at(i, j) = whole.at(row, column);
    }
  }
  return part;
}

bool equal(const Band& a, const Band& b) {
  if (a.size() != b.size()) return false;
  for (int i = 0; i < a.size(); ++i) {
    for (int j = std::max(0, i - a.width()); j <= i; ++j) {
      const double scale = std::sqrt(a.at(i, i)) * std::sqrt(a.at(j, j));
      if (!(std::abs(a.at(i, j) - b.at(i, j)) <= 1e-9 * scale)) return false;
    }
  }
  return true;
}

/// Compares D to 1e-9 of its largest entry, independent of the magnitude of b K*, which would hide a weak damper.
bool equal_damping(const Segment& a, const Segment& b) {
  double largest = 0.0, difference = 0.0;
  for (int i = 0; i < a.D.size(); ++i) {
    for (int j = std::max(0, i - a.D.width()); j <= i; ++j) {
      largest = std::max({largest, std::abs(a.D.at(i, j)), std::abs(b.D.at(i, j))});
      difference = std::max(difference, std::abs(a.D.at(i, j) - b.D.at(i, j)));
    }
  }
  return difference <= 1e-9 * largest;
}

/// C - a M - b K, with 0 for entries that do not exceed the rounding error of C.
Band nonproportional_damping(const Band& C, const Band& M, const Band& K, const beam::Rayleigh& ab) {
  Band D(C.size(), C.width());
  for (int i = 0; i < D.size(); ++i) {
    for (int j = std::max(0, i - D.width()); j <= i; ++j) {
      const double mass_part = ab.a * M.at(i, j), stiffness_part = ab.b * K.at(i, j);
      const double rounding =
          4.0 * std::numeric_limits<double>::epsilon() * (std::abs(mass_part) + std::abs(stiffness_part));
      const double difference = C.at(i, j) - mass_part - stiffness_part;
      if (std::abs(difference) > rounding) D.at(i, j) = difference;
    }
  }
  return D;
}

bool equal(const Segment& a, const Segment& b) {
  if (a.motion != b.motion || a.size() != b.size() || a.slope != b.slope || a.rigid.size() != b.rigid.size())
    return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    if (a.nodes[i] - a.nodes[0] != b.nodes[i] - b.nodes[0]) return false;
  }
  return equal(a.M, b.M) && equal(a.K, b.K) && equal_damping(a, b);
}

/// Whether springs or a layered track beside the shear centre couple bending and twist.
bool has_eccentric_springs(const beam::BeamModel& model) {
  if (model.track && model.torsion->tracks.front().lever != 0.0) return true;
  return std::ranges::any_of(model.foundation.vertical,
                             [](const beam::PointFoundation& p) { return p.eccentricity != 0.0; });
}

class Splitter {
 public:
  Splitter(const beam::Beam& beam, Motion motion, Damping damping)
      : beam_(beam),
        motion_(motion),
        unknowns_(unknowns_of(beam, motion)),
        K_(gathered(beam.stiffness(), unknowns_)),
        M_(gathered(beam.mass(), unknowns_)),
        motions_(beam::rigid_motions(beam.model())) {
    if (damping == Damping::included)
      D_ = nonproportional_damping(gathered(beam.damping(), unknowns_), M_, K_, beam.rayleigh());
  }

  std::vector<Segment> split() {
    std::vector<int> rows;
    for (int first = 0; first < M_.size();) {
      int past = first;
      while (past < M_.size() && column(past) == column(first)) ++past;
      if (!coupled_to_left(first, past)) add_segment(rows);
      for (int i = first; i < past; ++i) {
        if (M_.at(i, i) != 0.0) rows.push_back(i);
      }
      first = past;
    }
    add_segment(rows);
    return std::move(segments_);
  }

 private:
  int column(int row) const { return static_cast<int>(unknowns_[static_cast<std::size_t>(row)]) / beam_.block(); }
  beam::Kind kind(int row) const {
    return beam_.layout().kind[unknowns_[static_cast<std::size_t>(row)] % beam_.block()];
  }

  /// Whether an unknown of the column [first, past) is coupled to an unknown of the previous column.
  bool coupled_to_left(int first, int past) const {
    for (int i = first; i < past; ++i) {
      for (int j = std::max(0, i - M_.width()); j < first; ++j) {
        if (M_.at(i, j) != 0.0 || K_.at(i, j) != 0.0) return true;
      }
    }
    return false;
  }

  /// Whether an unknown is a displacement of the bridge in this motion.
  bool moves(beam::Kind kind) const {
    if (motion_ == Motion::along) return kind == beam::Kind::u;
    if (motion_ == Motion::twist) return kind == beam::Kind::twist;
    return kind == beam::Kind::v || kind == beam::damper;
  }

  void add_segment(std::vector<int>& rows) {
    if (rows.empty()) return;
    Segment s;
    s.motion = motion_;
    for (int row : rows) {
      s.nodes.push_back(column(row) - beam_.bridge().first_column);
      s.unknowns.push_back(static_cast<int>(unknowns_[static_cast<std::size_t>(row)]));
      // On the ground the ballast of a layered track uses the place of the bridge's deflection.
      const bool bridge = s.nodes.back() >= 0 && s.nodes.back() < beam_.mesh().nodes();
      s.slope.push_back(bridge && moves(kind(row)) ? 0 : 1);
    }
    s.K = part_of(K_, rows);
    s.M = part_of(M_, rows);
    if (D_.size() > 0) s.D = part_of(D_, rows);
    s.offsets = {0};
    add_rigid_motions(s, rows);
    rows.clear();
    for (Segment& existing : segments_) {
      if (!equal(existing, s)) continue;
      existing.offsets.push_back(s.nodes[0] - existing.nodes[0]);
      return;
    }
    segments_.push_back(std::move(s));
  }

  /// Adds the rigid motions of the segment's part of the beam. (A segment that is only a piece of its part ends at a
  /// completely held node, and its part has no rigid motion.)
  void add_rigid_motions(Segment& s, const std::vector<int>& rows) const {
    for (const beam::RigidMotion& motion : motions_) {
      const double left = beam_.mesh().x(s.nodes.front()), right = beam_.mesh().x(s.nodes.back());
      const bool twists = motion.twist != 0.0;
      if ((twists && s.motion == Motion::bending) || (!twists && s.motion == Motion::twist)) continue;
      if (motion.axial != (s.motion == Motion::along) || left < motion.left || right > motion.right) continue;
      s.rigid.emplace_back();
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const double x = beam_.mesh().x(s.nodes[i]);
        const beam::Kind of = kind(rows[i]);
        s.rigid.back().push_back(beam::Layout::of_twist(of) ? (of == beam::Kind::twist ? motion.twist : 0.0)
                                 : s.slope[i] == 0          ? motion.value(x)
                                                            : motion.slope(x, of != beam::Kind::theta_right));
      }
    }
  }

  const beam::Beam& beam_;
  Motion motion_;
  std::vector<PetscInt> unknowns_;
  Band K_, M_, D_;
  std::vector<beam::RigidMotion> motions_;
  std::vector<Segment> segments_;
};

}  // namespace

Band part_of(Mat matrix, const Segment& segment) {
  if (matrix == nullptr) return {segment.size(), 0};
  return gathered(matrix, {segment.unknowns.begin(), segment.unknowns.end()});
}

std::vector<Segment> bending_segments(const beam::Beam& beam) {
  return Splitter(beam, Motion::bending, Damping::ignored).split();
}

std::vector<Segment> segments_of(const beam::Beam& beam, bool all, Damping damping) {
  const beam::BeamModel& model = beam.model();
  std::vector<Motion> motions = {Motion::bending};
  if (model.torsion && (model.torsion->mass_centre != 0.0 || has_eccentric_springs(model)))
    motions = {Motion::bending_and_twist};
  else if (model.torsion)
    motions.push_back(Motion::twist);
  if (all && model.axial && !axially_coupled(model)) motions.push_back(Motion::along);
  std::vector<Segment> segments;
  for (const Motion motion : motions)
    for (Segment& s : Splitter(beam, motion, damping).split()) segments.push_back(std::move(s));
  return segments;
}

}  // namespace traverse::modes
