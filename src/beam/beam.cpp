// Distributes the unknowns over ranks, separates free from held ones (equations 16 and 17 of the paper), assembles M,
// C* and K*, and computes the nodal forces of temperature and of support settlements. The rows of held unknowns are
// eq. 18 with its damping, foundation and load: R_c = M_ca a + C_ca w + K_ca v - P_c. Each rank multiplies the columns
// of its own unknowns and needs no values of other ranks.
#include "beam/beam.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>

#include "assembly.hpp"
#include "layered_track.hpp"
#include "slice.hpp"

namespace traverse::beam {
namespace {

/// First columns of the connected parts: spans between separate joints. A track connects all spans.
std::vector<int> columns_of_parts(const Line& bridge, bool track, int columns) {
  std::vector<int> begins = {0};
  for (int end = 1; end < bridge.mesh.spans() && !track; ++end) {
    const auto [left, right] = bridge.mesh.nodes_at(end);
    if (left != right) begins.push_back(bridge.first_column + right);
  }
  begins.push_back(columns);
  return begins;
}

/// Each rank's first column, and the end. The ranges are contiguous and as even as possible. They end between parts if
/// there are at least as many parts as ranks.
std::vector<int> rank_begins(const std::vector<int>& parts, int ranks) {
  const int columns = parts.back();
  std::vector<int> begins;
  for (int rank = 0; rank <= ranks; ++rank) {
    int begin = static_cast<int>(static_cast<long>(columns) * rank / ranks);
    if (std::ssize(parts) > ranks) {
      const auto part = std::lower_bound(parts.begin(), parts.end(), begin);
      begin = part != parts.begin() && *part - begin > begin - part[-1] ? part[-1] : *part;
    }
    begins.push_back(begin);
  }
  return begins;
}

BeamModel checked(BeamModel model) {
  check(model);
  return model;
}

/// Whether the foundation contains a linear member of a kind with this term.
bool has_linear(const Foundation& foundation, const FoundationKind& kind, Term term) {
  if (kind.bed != nullptr) {
    const std::optional<Bed>& bed = foundation.*kind.bed;
    if (!bed || bed->law.nonlinear()) return false;
    const Distribution& density = term == Term::stiffness ? bed->k : bed->c;
    return density.maximum() > 0.0 || density.minimum() < 0.0;
  }
  const std::vector<PointFoundation>& points = foundation.*kind.points;
  return std::any_of(points.begin(), points.end(), [&](const PointFoundation& p) {
    return !p.law.nonlinear() && (term == Term::stiffness ? p.k : p.c) > 0.0;
  });
}

/// A second owner of the same matrix.
base::Handle<Mat> shared(Mat matrix) {
  base::check(PetscObjectReference(reinterpret_cast<PetscObject>(matrix)));
  return base::Handle<Mat>(matrix);
}

/// The column of the bridge's first node.
int first_column_of(const BeamModel& model) { return model.track ? rail_mesh(model).first_from(model.start) : 0; }

/// Releases the unknowns of a line's nodes.
void release_nodes(const Line& line, Slice& slice) {
  const int from = std::max(0, slice.first - 1 - line.first_column);
  const int past = std::min(line.mesh.nodes(), slice.first + slice.local + 1 - line.first_column);
  for (int node = from; node < past; ++node) {
    for (int component = 0; component < (line.mesh.hinged(node) ? 4 : 3); ++component)
      slice.release(line.unknown(node, component));
    if (line.mesh.has_expansion_device(node)) slice.release(line.unknown(node, 4));
  }
  if (!line.model.torsion) return;
  const auto [first, end] = line.elements_at(slice.first - 1, slice.local + 2);
  for (int e = first; e < end; ++e)
    for (const int unknown : line.twists(e)) slice.release(unknown);
}

/// For every span end, whether its left and its right node are held along x.
std::vector<std::array<bool, 2>> held_along(const BeamModel& model) {
  std::vector<std::array<bool, 2>> held;
  for (const Support s : model.supports) held.push_back({fixes_axial(s), fixes_axial(s)});
  const auto bearings = axial_bearings(model);
  for (std::size_t span = 0; span < bearings.size(); ++span)
    if (bearings[span] != 0) held[span][1] = true;
  return held;
}

void hold_supports(const Line& bridge, Slice& slice) {
  const auto along = held_along(bridge.model);
  for (int end = 0; end <= bridge.mesh.spans(); ++end) {
    const auto [left, right] = bridge.mesh.nodes_at(end);
    const Support s = bridge.model.supports[end];
    if (along[index(end)][0]) slice.hold(bridge.unknown(left, 0));
    if (along[index(end)][1]) slice.hold(bridge.unknown(right, 0));
    for (int node : {left, right}) {
      if (fixes_vertical(s)) slice.hold(bridge.unknown(node, 1));
      if (fixes_rotation(s)) slice.hold(bridge.unknown(node, 2));
      if (fixes_rotation(s)) slice.hold(bridge.unknown(node, 3));
      if (!bridge.model.torsion || bridge.model.torsion->held[index(end)] == 0) continue;
      slice.hold(bridge.unknown(node, 5));
      if (fixes_rotation(s) && bridge.model.torsion->warping) slice.hold(bridge.unknown(node, 6));  // a wall, no fork
    }
  }
}

}  // namespace

std::array<double, 2> bearing_forces(const Torsion& torsion, std::size_t span_end, const Reaction& reaction) {
  const double spacing = torsion.bearing_spacing[span_end], half = 0.5 * reaction[1];
  const double difference = spacing > 0.0 ? (reaction[3] + torsion.shear_centre * reaction[1]) / spacing : 0.0;
  return {half + difference, half - difference};
}

Beam::Beam(MPI_Comm comm, BeamModel model)
    : comm_(comm),
      layout_(checked(model)),
      bridge_(std::move(model), layout_, false, first_column_of(model)),
      support_lines_(bridge_.model) {
  if (bridge_.model.track) rail_.emplace(rail_model(bridge_.model), layout_, true, 0);
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm_, &rank);
  MPI_Comm_size(comm_, &ranks);
  parts_ = columns_of_parts(bridge_, rail_.has_value(), columns());
  rank_begins_ = rank_begins(parts_, ranks);
  first_ = rank_begins_[index(rank)];
  local_ = rank_begins_[index(rank + 1)] - first_;
  assemble(slice());
}

int Beam::owner(int column) const {
  return static_cast<int>(std::upper_bound(rank_begins_.begin(), rank_begins_.end(), column) - rank_begins_.begin()) -
         1;
}

Slice Beam::slice() const {
  Slice slice(block(), first_, local_);
  release_nodes(bridge_, slice);
  if (rail_) {
    release_nodes(*rail_, slice);
    for (const Sleeper& s : sleepers_of(bridge_, first_ - 1, first_ + local_ + 1)) release_sleeper(s, layout_, slice);
    release_links(bridge_, layout_, slice);
  }
  hold_supports(bridge_, slice);
  for (const DamperPlace& place : places_of_dampers(bridge_, layout_)) slice.release(place.unknown);
  for (const int node : held_rail_ends()) slice.hold(rail_->unknown(node, 0));
  return slice;
}

std::vector<int> Beam::held_rail_ends() const {
  if (!rail_ || !model().axial || !model().track->rail_ends_held) return {};
  return {0, rail_->mesh.nodes() - 1};
}

void Beam::assemble(const Slice& slice) {
  const int begin = first_ * block(), end = begin + local_unknowns();
  for (int i = begin; i < end; ++i) fixed_.push_back(slice.held(i) ? 1 : 0);

  Rows beam_mass(slice), beam_stiffness(slice), stiffness(slice), damping(slice);
  add_beam(bridge_, slice, beam_mass, beam_stiffness);
  std::vector<std::pair<base::Handle<Mat>*, Rows>> own;  // matrices of the foundation's kinds
  add_foundation(slice, stiffness, damping, own);
  Rows mass = beam_mass, beams = beam_stiffness;
  if (rail_) {
    add_beam(*rail_, slice, mass, beams);
    Rows track_stiffness(slice), track_damping(slice);
    add_track(bridge_, layout_, slice, mass, track_stiffness, track_damping);
    add_shear(bridge_, layout_, slice, mass, track_stiffness, track_damping);
    own.emplace_back(&foundation_.layered_track[0], track_stiffness);
    own.emplace_back(&foundation_.layered_track[1], track_damping);
    stiffness.add(1.0, track_stiffness);
    damping.add(1.0, track_damping);
  }
  add_cracks(bridge_, slice, stiffness);
  const std::vector<DamperPlace> dampers = places_of_dampers(bridge_, layout_);
  add_dampers(dampers, mass, stiffness, damping);
  const bool damped = !own.empty() || !dampers.empty(), sprung = damped || !model().cracks.empty();
  for (auto& [handle, rows] : own) *handle = rows.matrix(comm_, rows);
  const Rows springs = stiffness;
  stiffness.add(1.0, beams);
  if (model().strained()) record_strains(slice, springs, mass);
  record_reactions(slice, beams, mass, beam_mass, beam_stiffness, stiffness, damping);
  const auto direction_of_weight = [&](int unknown) {
    const Kind kind = layout_.kind[index(unknown % block())];
    if (kind == Kind::damper) return 0.0;  // at rest its spring is balanced
    return Layout::is_vertical(kind) ? -1.0 : Layout::axial(kind) ? -model().gradient : 0.0;
  };
  for (int i = begin; i < end; ++i) weight_.push_back(mass.times(i, direction_of_weight));
  for (const auto& [damper, beam, unknown] : dampers)
    for (std::size_t i = 0; i < beam.unknown.size(); ++i)
      if (local(beam.unknown[i]) >= 0) weight_[index(local(beam.unknown[i]))] -= damper->mass * beam.shape[i];

  Rows pattern(slice);
  for (const Rows* rows : {&mass, &beam_stiffness, &stiffness, &damping}) pattern.add_pattern(*rows);
  mass_ = mass.matrix(comm_, pattern);
  beam_mass_ = rail_ || !dampers.empty() ? beam_mass.matrix(comm_, pattern) : shared(mass_);
  beam_stiffness_ = beam_stiffness.matrix(comm_, pattern);
  stiffness_ = sprung ? stiffness.matrix(comm_, pattern) : shared(beam_stiffness_);
  if (sprung) springs_ = springs.matrix(comm_, springs);
  if (!damped) return;
  foundation_damping_ = damping.matrix(comm_, pattern);
  PetscReal norm = 0.0;
  base::check(MatNorm(foundation_damping_, NORM_INFINITY, &norm));
  if (norm == 0.0) foundation_damping_ = base::Handle<Mat>();  // springs alone
}

void Beam::add_foundation(const Slice& slice, Rows& stiffness, Rows& damping,
                          std::vector<std::pair<base::Handle<Mat>*, Rows>>& own) {
  for (std::size_t i = 0; i < foundation_kind_count; ++i) {
    const FoundationKind& kind = foundation_kinds[i];
    if (!acts(kind, model())) continue;
    for (Term term : {Term::stiffness, Term::damping}) {
      if (!has_linear(model().foundation, kind, term)) continue;
      own.emplace_back(&foundation_.of_kind[i][term == Term::stiffness ? 0 : 1],
                       (kind.bed != nullptr ? bed_of : points_of)(kind, bridge_, slice, term));
      (term == Term::stiffness ? stiffness : damping).add(1.0, own.back().second);
    }
  }
}

double Beam::settlement_of(int unknown) const {
  const auto found = std::lower_bound(settlements_.begin(), settlements_.end(), std::pair(unknown, -HUGE_VAL));
  return found != settlements_.end() && found->first == unknown ? found->second : 0.0;
}

void Beam::record_strains(const Slice& slice, const Rows& springs, const Rows& mass) {
  strain_forces_.assign(index(local_unknowns()), 0.0);
  const std::vector<double>&settlement = model().settlement, &shift = model().shift;
  const auto along = held_along(model());
  for (std::size_t end = 0; end < model().supports.size(); ++end) {
    const auto [left, right] = mesh().nodes_at(static_cast<int>(end));
    for (int node = left; node <= right; ++node) {
      if (!shift.empty() && shift[end] != 0.0 && along[end][node == left ? 0 : 1])
        settlements_.emplace_back(bridge_.unknown(node, 0), shift[end]);
      if (!settlement.empty() && settlement[end] != 0.0)
        settlements_.emplace_back(bridge_.unknown(node, 1), settlement[end]);
    }
  }
  for (int i = 0; i < local_unknowns() && !settlements_.empty(); ++i) {
    const int unknown = first_ * block() + i;
    imposed_.push_back(settlement_of(unknown));
    strain_forces_[index(i)] -= springs.times(unknown, [&](int j) { return settlement_of(j); });
    inertia_of_imposed_.push_back(mass.times(unknown, [&](int j) { return settlement_of(j); }));
  }
  record_temperature(slice, bridge_);
  if (rail_) record_temperature(slice, *rail_);
}

void Beam::record_temperature(const Slice& slice, const Line& line) {
  if (!line.model.temperature) return;
  const auto [first, past] = line.elements_at(slice.first, slice.local);
  const auto add = [&](int unknown, double force) {
    if (unknown >= 0 && local(unknown) >= 0) strain_forces_[index(local(unknown))] += force;
  };
  for (int e = first; e < past; ++e) {
    const auto bending = strain_load(line.model, line.mesh.element(e));
    const auto axial = axial_strain_load(line.model, line.mesh.element(e));
    for (std::size_t i = 0; i < 4; ++i) add(line.transverse(e)[i], bending[i]);
    for (std::size_t i = 0; i < 2; ++i) add(line.axial(e)[i], axial[i]);
  }
}

void Beam::set_rayleigh(Rayleigh ab) {
  rayleigh_ = ab;
  Mat damping = nullptr;
  base::check(MatDuplicate(beam_mass_, MAT_COPY_VALUES, &damping));
  damping_ = base::Handle<Mat>(damping);
  base::check(MatScale(damping, ab.a));
  base::check(MatAXPY(damping, ab.b, beam_stiffness_, SAME_NONZERO_PATTERN));
  if (foundation_damping_) base::check(MatAXPY(damping, 1.0, foundation_damping_, SAME_NONZERO_PATTERN));
  for (ReactionTerm& t : reaction_terms_) {
    t.damping = ab.a * t.beam_mass + ab.b * t.beam_stiffness + t.foundation_damping;
  }
}

void Beam::release_matrices() {
  for (base::Handle<Mat>* matrix : {&mass_, &beam_mass_, &beam_stiffness_, &stiffness_, &damping_})
    *matrix = base::Handle<Mat>();
  malloc_trim(0);
}

void Beam::add_self_weight(double gravity, double* P) const {
  for (int i = 0; i < local_unknowns(); ++i) P[i] += gravity * weight_[i];
}

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
        record(bridge_.unknown(node, component), index(4 * end + std::min(component, 2)));
      }
      record(bridge_.unknown(node, 5), index(4 * end + 3));
    }
  }
  for (const int node : held_rail_ends()) record(rail_->unknown(node, 0), index(4 * (mesh().spans() + 1)));
}

void Beam::add_reaction_form(int span_end, int component, double factor, double* forces) const {
  const std::size_t slot = index(4 * span_end + component);
  for (const ReactionTerm& t : reaction_terms_)
    if (t.slot == slot) forces[t.unknown] += factor * t.stiffness;
}

void Beam::reactions(const double* v, const double* w, const double* a, const double* P,
                     std::vector<Reaction>& out) const {
  out.resize(mesh().span_ends().size() + (held_rail_ends().empty() ? 0 : 1));
  double* sums = out.front().data();
  const std::size_t count = 4 * out.size();
  std::fill(sums, sums + count, 0.0);
  for (const ReactionTerm& t : reaction_terms_) {
    sums[t.slot] += t.mass * a[t.unknown] + t.damping * w[t.unknown] + t.stiffness * v[t.unknown];
  }
  for (const HeldLoad& load : held_loads_) sums[load.slot] += load.by_settlement - P[load.unknown];
  MPI_Allreduce(MPI_IN_PLACE, sums, static_cast<int>(count), MPI_DOUBLE, MPI_SUM, comm_);
}

void Beam::reactions_of_imposed_acceleration(std::vector<Reaction>& out) const {
  out.assign(mesh().span_ends().size() + (held_rail_ends().empty() ? 0 : 1), {});
  double* sums = out.front().data();
  for (const HeldLoad& load : held_loads_) sums[load.slot] += load.by_acceleration;
  MPI_Allreduce(MPI_IN_PLACE, sums, static_cast<int>(4 * out.size()), MPI_DOUBLE, MPI_SUM, comm_);
}

}  // namespace traverse::beam
