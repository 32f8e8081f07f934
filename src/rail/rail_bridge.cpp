// Nodal forces of loads on the rail, nonlinear statics by repeated linearisation of the sleepers' force laws, and rail
// stresses, relative displacements and bearing forces of the equilibrium.
#include "rail/rail_bridge.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "beam/element.hpp"
#include "beam/layered_track.hpp"
#include "beam/shape.hpp"
#include "traverse/base/error.hpp"

namespace traverse::rail {
namespace {

using beam::Distribution;

/// The value between two stations, 0 elsewhere.
Distribution between(double from, double to, double value) {
  if (!(to > from)) return 0.0;
  return {{from, from, to, to}, {0.0, value, value, 0.0}, "load"};
}

}  // namespace

RailBridge::RailBridge(const beam::BeamModel& model, double rail_area, double greatest_load)
    : beam_(PETSC_COMM_SELF, model),
      op_((beam_.set_rayleigh({}), beam_)),
      nonlinear_(beam_, op_, greatest_load, greatest_load),
      ground_(beam_),
      devices_(beam_),
      area_(rail_area) {
  record_stations();
}

void RailBridge::record_stations() {
  const beam::Line& rail = *beam_.rail();
  const double strain = rail.model.temperature ? rail.model.temperature->strain() : 0.0;
  for (int e = 0; e < rail.mesh.elements(); ++e) {
    const beam::Element& element = rail.mesh.element(e);
    elements_.push_back(element.x + 0.5 * element.length);
    restrained_stress_.push_back(-rail.model.EA.at(elements_.back(), element.x) / area_ * strain);
  }
  for (const beam::Sleeper& s : beam::sleepers_of(beam_.bridge(), 0, beam_.columns())) sleepers_.push_back(s.x);
  const beam::Mesh& bridge = beam_.mesh();
  const beam::BeamModel& model = beam_.model();
  const std::vector<char> given = beam::axial_bearings(model);
  for (int end = 0; end <= bridge.spans(); ++end) {
    const double x = bridge.span_ends()[static_cast<std::size_t>(end)];
    if (beam::fixes_axial(model.supports[static_cast<std::size_t>(end)]) ||
        (end < bridge.spans() && given[static_cast<std::size_t>(end)] != 0)) {
      held_ends_.push_back(end);
      bearings_.push_back(x);
    }
    if (end > 0) end_stations_.push_back(bridge.locate(x, true));
    if (end < bridge.spans()) end_stations_.push_back(bridge.locate(x));
    for (int side = 0; side < (end > 0 && end < bridge.spans() ? 2 : 1); ++side) ends_.push_back(x);
  }
  for (const beam::PointFoundation& p : model.foundation.longitudinal) bearings_.push_back(p.x);
}

std::vector<double> RailBridge::nodal_forces(const Loads& loads) const {
  std::vector<double> P(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  if (loads.strains && !beam_.strain_forces().empty()) P = beam_.strain_forces();
  const beam::Line& rail = *beam_.rail();
  const Distribution weight = between(loads.from, loads.to, -loads.weight);
  const Distribution along = between(loads.along_from, loads.along_to, loads.along);
  for (int e = 0; e < rail.mesh.elements(); ++e) {
    const beam::Element& element = rail.mesh.element(e);
    const auto down = beam::transverse_load(weight, element);
    const auto push = beam::axial_load(along, element);
    for (std::size_t i = 0; i < 4; ++i) P[static_cast<std::size_t>(rail.transverse(e)[i])] += down[i];
    for (std::size_t i = 0; i < 2; ++i) P[static_cast<std::size_t>(rail.axial(e)[i])] += push[i];
  }
  return P;
}

State RailBridge::equilibrium(const Loads& loads, const State* earlier) {
  const std::vector<double> P = nodal_forces(loads);
  const std::vector<double>& imposed = beam_.imposed();
  const bool has_settlement = loads.strains && !imposed.empty();
  std::vector<double> prescribed(P.size(), 0.0), free = P;
  if (has_settlement) {
    prescribed = imposed;
    op_.multiply(-1.0, nullptr, nullptr, prescribed.data(), free.data());
    for (std::size_t i = 0; i < P.size(); ++i) free[i] += P[i];
  }
  nonlinear_.set_history(earlier != nullptr ? earlier->slid : structure::NonlinearFoundation::History{});
  nonlinear_.set_loaded_range(loads.from, loads.to > loads.from ? loads.to : -HUGE_VAL);
  nonlinear_.begin(0.0, prescribed.data(), nullptr, nullptr);
  using Verdict = structure::NonlinearFoundation::Verdict;
  State state;
  Verdict verdict = Verdict::again;
  while (verdict == Verdict::again) {
    const structure::AddedSprings& added = nonlinear_.linearise();
    state.v = free;
    nonlinear_.add_linearised(state.v.data());
    for (std::size_t i = 0; i < P.size(); ++i)
      if (beam_.fixed()[i] != 0) state.v[i] = 0.0;
    op_.solve_static(state.v.data(), &added);
    verdict = nonlinear_.check_stage(state.v.data());
  }
  if (verdict == Verdict::failed)
    throw SolverError(
        fmt::format("no equilibrium of rail and bridge, worst {}: the track possibly slides as a whole; check "
                    "track_longitudinal_limit and uic774_braking",
                    nonlinear_.worst_point()));
  for (std::size_t i = 0; i < P.size(); ++i) state.v[i] += prescribed[i];
  nonlinear_.update_slip(state.v.data());
  state.slid = nonlinear_.history();
  recover(P, state);
  return state;
}

/// The displacement u - e theta of the deck's surface.
double RailBridge::surface(const std::vector<double>& v, const beam::Station& at) const {
  const beam::Line& bridge = beam_.bridge();
  const beam::Element& element = bridge.mesh.element(at.element);
  const auto phi = beam::linear(at.xi);
  const auto rotation = beam::rotation(at.xi, element.length, element.shear);
  double u = 0.0;
  for (std::size_t i = 0; i < 2; ++i) u += phi[i] * v[static_cast<std::size_t>(bridge.axial(at.element)[i])];
  for (std::size_t i = 0; i < 4; ++i)
    u -= bridge.model.surface_height * rotation[i] * v[static_cast<std::size_t>(bridge.transverse(at.element)[i])];
  return u;
}

void RailBridge::recover(const std::vector<double>& P, State& state) {
  const std::vector<double>& v = state.v;
  const beam::Line& rail = *beam_.rail();
  for (int e = 0; e < rail.mesh.elements(); ++e) {
    const auto [left, right] = rail.axial(e);
    const beam::Element& element = rail.mesh.element(e);
    const double EA = rail.model.EA.at(element.x + 0.5 * element.length, element.x);
    state.stress.push_back(EA / area_ * (v[static_cast<std::size_t>(right)] - v[static_cast<std::size_t>(left)]) /
                           element.length);
  }
  for (const beam::Sleeper& s : beam::sleepers_of(beam_.bridge(), 0, beam_.columns())) {
    const double u = v[static_cast<std::size_t>(rail.unknown(s.rail_node, 0))];
    state.displacement.push_back(s.on_bridge ? u - surface(v, s.at) : u);
  }
  for (const beam::Station& end : end_stations_) state.ends.push_back(surface(v, end));
  devices_.evaluate(v.data());
  state.openings = devices_.openings();
  const std::vector<double> zero(v.size(), 0.0);
  std::vector<beam::Reaction> reactions;
  beam_.reactions(v.data(), zero.data(), zero.data(), P.data(), reactions);
  if (reactions.size() > beam_.mesh().span_ends().size()) state.rail_ends = reactions.back()[0];
  for (const int end : held_ends_) state.bearings.push_back(reactions[static_cast<std::size_t>(end)][0]);
  structure::NonlinearForces other;
  std::vector<recovery::ElementLoad> loads;
  nonlinear_.evaluate(v.data(), zero.data());
  nonlinear_.report(other, loads);
  ground_.evaluate(v.data(), zero.data(), zero.data());
  const std::size_t kind = beam::foundation_kind("longitudinal");
  for (std::size_t i = 0; i < other.of_kind[kind].size(); ++i)
    state.bearings.push_back(ground_.of_kind(kind)[i] + other.of_kind[kind][i]);
}

double RailBridge::residual(const Loads& loads, const State& state) {
  const std::vector<double> zero(state.v.size(), 0.0);
  structure::NonlinearForces other;
  std::vector<recovery::ElementLoad> on_bridge;
  nonlinear_.set_history(state.slid);
  nonlinear_.set_loaded_range(loads.from, loads.to > loads.from ? loads.to : -HUGE_VAL);
  nonlinear_.evaluate(state.v.data(), zero.data());
  nonlinear_.report(other, on_bridge);
  ground_.evaluate(state.v.data(), zero.data(), zero.data());
  const double supports = std::accumulate(state.bearings.begin(),
                                          state.bearings.begin() + static_cast<std::ptrdiff_t>(held_ends_.size()), 0.0);
  const std::size_t kind = beam::foundation_kind("longitudinal");
  const double springs = std::accumulate(other.of_kind[kind].begin(), other.of_kind[kind].end(), 0.0);
  return loads.along * (loads.along_to - loads.along_from) + supports + springs + ground_.foundation()[0] +
         other.along_ground + state.rail_ends;
}

}  // namespace traverse::rail
