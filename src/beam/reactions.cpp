// The rows of held unknowns, eq. 18 with its damping, foundation and load: R_c = M_ca a + C_ca w + K_ca v - P_c. Each
// rank multiplies the columns of its own unknowns and needs no values of other ranks.
#include <algorithm>

#include "beam/beam.hpp"
#include "slice.hpp"

namespace traverse::beam {

void Beam::record_reactions(const Slice& slice, const Rows& beams, const Rows& mass, const Rows& beam_mass,
                            const Rows& beam_stiffness, const Rows& stiffness, const Rows& foundation_damping) {
  // By symmetry, the entry of the held row in a free column equals the entry of the free row in the held column.
  const auto record_column = [&](std::size_t slot, int unknown, int held) {
    if (!slice.owns(unknown) || slice.held(unknown)) return;
    const ReactionTerm term{slot,
                            index(local(unknown)),
                            mass.at(unknown, held),
                            beam_mass.at(unknown, held),
                            beam_stiffness.at(unknown, held),
                            stiffness.at(unknown, held),
                            foundation_damping.at(unknown, held),
                            0.0};
    if (term.mass != 0.0 || term.stiffness != 0.0 || term.foundation_damping != 0.0) reaction_terms_.push_back(term);
  };
  const int b = block();
  const auto record = [&](int held, std::size_t slot) {
    if (held < 0 || !slice.reaches(held) || !slice.held(held)) return;
    if (slice.owns(held)) {
      held_loads_.push_back({slot, index(local(held))});
      if (!settlements_.empty()) {
        held_loads_.back().by_settlement = beams.times(held, [&](int j) { return settlement_of(j); });
        held_loads_.back().by_acceleration = mass.times(held, [&](int j) { return settlement_of(j); });
      }
    }
    for (int i = (held / b - 1) * b; i < (held / b + 2) * b; ++i) record_column(slot, i, held);
  };
  for (int end = 0; end <= mesh().spans(); ++end) {
    const auto [left, right] = mesh().nodes_at(end);
    for (int node = left; node <= right; ++node) {
      for (int component = 0; component < (mesh().hinged(node) ? 4 : 3); ++component) {
        record(bridge_.unknown(node, component), index(3 * end + std::min(component, 2)));
      }
    }
  }
  for (const int node : held_rail_ends()) record(rail_->unknown(node, 0), index(3 * (mesh().spans() + 1)));
}

void Beam::add_reaction_form(int span_end, int component, double factor, double* forces) const {
  const std::size_t slot = index(3 * span_end + component);
  for (const ReactionTerm& t : reaction_terms_)
    if (t.slot == slot) forces[t.unknown] += factor * t.stiffness;
}

void Beam::reactions(const double* v, const double* w, const double* a, const double* P,
                     std::vector<std::array<double, 3>>& out) const {
  out.resize(mesh().span_ends().size() + (held_rail_ends().empty() ? 0 : 1));
  double* sums = out.front().data();
  const std::size_t count = 3 * out.size();
  std::fill(sums, sums + count, 0.0);
  for (const ReactionTerm& t : reaction_terms_) {
    sums[t.slot] += t.mass * a[t.unknown] + t.damping * w[t.unknown] + t.stiffness * v[t.unknown];
  }
  for (const HeldLoad& load : held_loads_) sums[load.slot] += load.by_settlement - P[load.unknown];
  MPI_Allreduce(MPI_IN_PLACE, sums, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, comm_);
}

void Beam::reactions_of_imposed_acceleration(std::vector<std::array<double, 3>>& out) const {
  out.assign(mesh().span_ends().size() + (held_rail_ends().empty() ? 0 : 1), {});
  double* sums = out.front().data();
  for (const HeldLoad& load : held_loads_) sums[load.slot] += load.by_acceleration;
  MPI_Allreduce(MPI_IN_PLACE, sums, static_cast<int>(3 * out.size()), MPI_DOUBLE, MPI_SUM, comm_);
}

}  // namespace traverse::beam
