// The rows of held unknowns, eq. 18 with its damping, foundation and load: R_c = M_ca a + C_ca w + K_ca v - P_c.
// Each rank multiplies the columns of the unknowns it owns, so that neighbours on another rank are not needed.
#include <algorithm>

#include "slice.hpp"
#include "traverse/beam/beam.hpp"

namespace traverse::beam {

void Beam::note_reactions(const Slice& slice, const Rows& mass, const Rows& beam_stiffness,
                          const Rows& foundation_stiffness, const Rows& foundation_damping) {
  const int from = slice.kinds_from();
  const auto unknown = [&](int node, int kind) { return index(node - first_) * index(block()) + index(kind - from); };
  // By symmetry the entry of the held row in a free column is that of the free row in the held column.
  const auto note_column = [&](std::size_t slot, int node, int kind, int offset, int held_kind) {
    if (slice.held(node, kind)) return;
    const double k = beam_stiffness.at(node, kind, offset, held_kind);
    reaction_terms_.push_back({slot, unknown(node, kind), mass.at(node, kind, offset, held_kind), k,
                               k + foundation_stiffness.at(node, kind, offset, held_kind),
                               foundation_damping.at(node, kind, offset, held_kind), 0.0});
  };
  const auto note_row = [&](std::size_t slot, int node, int kind) {
    if (slice.owns(node)) held_loads_.push_back({slot, unknown(node, kind)});
    for (int other = node - 1; other <= node + 1; ++other) {
      if (!slice.owns(other) || (other != node && !slice.linked(std::min(node, other)))) continue;
      for (int k = from; k < 3; ++k) {
        if (coupled(kind, k)) note_column(slot, other, k, node - other, kind);
      }
    }
  };
  for (int end = 0; end <= mesh_.spans() && local_ > 0; ++end) {
    const auto [left, right] = mesh_.nodes_at(end);
    for (int node = left; node <= right; ++node) {
      if (node < first_ - 1 || node > first_ + local_) continue;
      for (int kind = from; kind < 3; ++kind) {
        if (slice.held(node, kind)) note_row(index(3 * end + kind), node, kind);
      }
    }
  }
}

void Beam::reactions(const double* v, const double* w, const double* a, const double* P,
                     std::vector<std::array<double, 3>>& out) const {
  out.resize(mesh_.span_ends().size());
  double* sums = out.front().data();
  const std::size_t count = 3 * out.size();
  std::fill(sums, sums + count, 0.0);
  for (const ReactionTerm& t : reaction_terms_) {
    sums[t.slot] += t.mass * a[t.unknown] + t.damping * w[t.unknown] + t.stiffness * v[t.unknown];
  }
  for (const HeldLoad& load : held_loads_) sums[load.slot] -= P[load.unknown];
  MPI_Allreduce(MPI_IN_PLACE, sums, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, comm_);
}

}  // namespace traverse::beam
