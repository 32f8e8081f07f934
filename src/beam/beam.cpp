#include "traverse/beam/beam.hpp"

#include <algorithm>
#include <utility>

#include "assembly.hpp"
#include "slice.hpp"

namespace traverse::beam {
namespace {

struct Range {
  int first = 0, count = 0;
};

/// Nodes of one rank: contiguous, as even as possible.
Range nodes_of(int rank, int ranks, int nodes) {
  const int each = nodes / ranks, more = nodes % ranks;
  return {rank * each + std::min(rank, more), each + (rank < more ? 1 : 0)};
}

BeamModel checked(BeamModel model) {
  check(model);
  return model;
}

bool any(const std::vector<PointFoundation>& points, Term term) {
  return std::any_of(points.begin(), points.end(),
                     [&](const PointFoundation& p) { return (term == Term::stiffness ? p.k : p.c) > 0.0; });
}

bool any(const std::optional<Bed>& bed, Term term) {
  return bed && (term == Term::stiffness ? bed->k : bed->c).maximum() > 0.0;
}

bool any_damping(const BeamModel& model) {
  const Foundation& f = model.foundation;
  return any(f.vertical, Term::damping) || any(f.vertical_bed, Term::damping) || any(f.rotational, Term::damping) ||
         (model.axial && (any(f.longitudinal, Term::damping) || any(f.longitudinal_bed, Term::damping)));
}

/// A second owner of the same object.
base::Handle<Mat> shared(Mat matrix) {
  base::check(PetscObjectReference(reinterpret_cast<PetscObject>(matrix)));
  return base::Handle<Mat>(matrix);
}

}  // namespace

Beam::Beam(MPI_Comm comm, BeamModel model) : comm_(comm), model_(checked(std::move(model))), mesh_(model_) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm_, &rank);
  MPI_Comm_size(comm_, &ranks);
  const Range mine = nodes_of(rank, ranks, mesh_.nodes());
  first_ = mine.first;
  local_ = mine.count;
  assemble(Slice(model_, mesh_, first_, local_));
}

int Beam::owner(int node) const {
  int ranks = 1;
  MPI_Comm_size(comm_, &ranks);
  const int each = mesh_.nodes() / ranks, more = mesh_.nodes() % ranks, bigger = more * (each + 1);
  return node < bigger ? node / (each + 1) : more + (node - bigger) / each;
}

void Beam::assemble(const Slice& slice) {
  for (int node = first_; node < first_ + local_; ++node) {
    for (int kind = slice.kinds_from(); kind < 3; ++kind) fixed_.push_back(slice.held(node, kind) ? 1 : 0);
  }
  const BeamRows rows = beam_rows(model_, mesh_, slice);
  mass_ = rows.mass.matrix(comm_, slice, false);
  beam_stiffness_ = rows.stiffness.matrix(comm_, slice, false);

  Rows foundation_stiffness(slice), foundation_damping(slice);
  add_foundation(slice, foundation_stiffness, foundation_damping);
  note_reactions(slice, rows.mass, rows.stiffness, foundation_stiffness, foundation_damping);

  foundation_stiffness.add(rows.stiffness);
  const FoundationMats& f = foundation_;
  const bool stiff = f.vertical_discrete[0] || f.vertical_continuous[0] || f.longitudinal_discrete[0] ||
                     f.longitudinal_continuous[0] || f.rotational_discrete[0];
  stiffness_ = stiff ? foundation_stiffness.matrix(comm_, slice, false) : shared(beam_stiffness_);
  if (any_damping(model_)) foundation_damping_ = foundation_damping.matrix(comm_, slice, false);
}

void Beam::add_foundation(const Slice& slice, Rows& stiffness, Rows& damping) {
  const Foundation& f = model_.foundation;
  // One kind of section 3: into a matrix of its own, and into the sum.
  const auto add = [&](const auto& description, auto rows_of, base::Handle<Mat>(&matrices)[2]) {
    for (Term term : {Term::stiffness, Term::damping}) {
      if (!any(description, term)) continue;
      const Rows rows = rows_of(model_, mesh_, slice, term);
      matrices[term == Term::stiffness ? 0 : 1] = rows.matrix(comm_, slice, true);
      (term == Term::stiffness ? stiffness : damping).add(rows);
    }
  };
  add(f.vertical, vertical_points, foundation_.vertical_discrete);
  add(f.vertical_bed, vertical_bed, foundation_.vertical_continuous);
  add(f.rotational, rotational_points, foundation_.rotational_discrete);
  if (!model_.axial) return;
  add(f.longitudinal, longitudinal_points, foundation_.longitudinal_discrete);
  add(f.longitudinal_bed, longitudinal_bed, foundation_.longitudinal_continuous);
}

void Beam::set_rayleigh(Rayleigh ab) {
  rayleigh_ = ab;
  Mat damping = nullptr;
  base::check(MatDuplicate(mass_, MAT_COPY_VALUES, &damping));
  damping_ = base::Handle<Mat>(damping);
  base::check(MatScale(damping, ab.a));
  base::check(MatAXPY(damping, ab.b, beam_stiffness_, SAME_NONZERO_PATTERN));
  if (foundation_damping_) base::check(MatAXPY(damping, 1.0, foundation_damping_, SAME_NONZERO_PATTERN));
  for (ReactionTerm& t : reaction_terms_) {
    t.damping = ab.a * t.mass + ab.b * t.beam_stiffness + t.foundation_damping;
  }
}

void Beam::add_self_weight(double gravity, double* P) const {
  const int from = block() - 2;  // of v within a node
  double length = 0.0;
  std::array<double, 4> load{};
  const Slice slice(model_, mesh_, first_, local_);
  for (int e = slice.first_element; e < slice.past_element; ++e) {
    const Element& element = mesh_.element(e);
    if (!model_.mass.uniform() || element.length != length) load = transverse_load(model_.mass, element);
    length = element.length;
    for (int end = 0; end < 2; ++end) {
      const int node = element.left + end;
      if (!slice.owns(node)) continue;
      double* p = P + static_cast<std::ptrdiff_t>(node - first_) * block() + from;
      p[0] -= gravity * load[index(2 * end)];
      p[1] -= gravity * load[index(2 * end + 1)];
    }
  }
}

}  // namespace traverse::beam
