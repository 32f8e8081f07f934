// Division of a beam into pieces at span ends, hinges and jumps of EI and mass, and below a layered track.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/numbers.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

constexpr double same_station = 1e-9;  // relative to an element's length: closer stations are equal

constexpr double min_piece = 0.2;  // relative to an element's length: jumps closer to another division are ignored

/// The jumps of EI, mass or GJ between `left` and `right` at which the beam is divided; none if there are too many for
/// the elements.
std::vector<double> steps_between(const BeamModel& model, double left, double right, double element) {
  std::vector<double> steps = model.EI.steps(left, right), selected;
  const auto add = [&](const Distribution& d) { std::ranges::copy(d.steps(left, right), std::back_inserter(steps)); };
  add(model.mass);
  if (model.torsion) add(model.torsion->GJ);
  std::sort(steps.begin(), steps.end());
  for (const double x : steps)
    if (std::min(x - (selected.empty() ? left : selected.back()), right - x) >= min_piece * element)
      selected.push_back(x);
  return 2.0 * static_cast<double>(selected.size()) * element <= right - left ? selected : std::vector<double>();
}

/// Divides the last piece at jumps of EI, mass or GJ, where the curvature jumps too, or the rate of twist.
void divide_at_steps(const BeamModel& model, std::vector<Piece>& pieces) {
  const Piece whole = pieces.back();
  const double element = model.spans[whole.span] / model.elements[whole.span];
  for (const double x : steps_between(model, whole.left, whole.right, element)) {
    Piece& left_piece = pieces.back();
    left_piece.right = x;
    left_piece.next = Joint::continuous;
    left_piece.ends_span = false;
    pieces.push_back(whole);
    pieces.back().left = x;
  }
}

/// A division of the beam that is not a span end, with the joint there.
struct Division {
  double x = 0.0;
  Joint joint = Joint::hinge;
};

std::vector<Division> divisions_of(const BeamModel& model) {
  std::vector<Division> divisions;
  for (const double x : model.hinges) divisions.push_back({x, Joint::hinge});
  for (const Crack& crack : model.cracks) divisions.push_back({crack.x, Joint::cracked});
  for (const double x : model.expansion_devices) divisions.push_back({x, Joint::expansion});
  for (const double x : model.cuts) divisions.push_back({x, Joint::continuous});
  if (!model.track) {
    for (const PointMass& mass : model.point_masses) divisions.push_back({mass.x, Joint::continuous});
    for (const MassDamper& damper : model.dampers) divisions.push_back({damper.x, Joint::continuous});
  }
  std::stable_sort(divisions.begin(), divisions.end(), [](const Division& a, const Division& b) { return a.x < b.x; });
  const auto same = [](const Division& a, const Division& b) { return a.x == b.x; };
  divisions.erase(std::unique(divisions.begin(), divisions.end(), same), divisions.end());
  std::erase_if(divisions, [&](const Division& one) { return one.x == model.start; });
  return divisions;
}

/// The pieces without their numbers of elements.
std::vector<Piece> divided(const BeamModel& model) {
  std::vector<Piece> pieces;
  const std::vector<Division> divisions = divisions_of(model);
  auto division = divisions.begin();
  double left = model.start, end = model.start;
  const int spans = static_cast<int>(model.spans.size());
  const bool at_steps = model.nodes_at_steps && !model.track;
  for (int span = 0; span < spans; ++span) {
    end += model.spans[span];
    for (; division != divisions.end() && division->x < end; ++division) {
      pieces.push_back({span, left, division->x, 0, division->joint, false});
      if (at_steps) divide_at_steps(model, pieces);
      left = division->x;
    }
    Joint next = span + 1 < spans ? model.joint(span + 1) : Joint::separate;
    if (division != divisions.end() && division->x == end) {
      if (next == Joint::continuous) next = division->joint;
      ++division;
    }
    pieces.push_back({span, left, end, 0, next, true});
    if (at_steps) divide_at_steps(model, pieces);
    left = end;
  }
  return pieces;
}

/// Sets the elements of the bridge below a layered track. The bridge has one node for each node of the rail, so that
/// both share one numbering: the number of elements is the number of rail nodes from the piece's left end to its right
/// end, minus one if the piece shares no node with the next one. Every sleeper is then on an element next to its own
/// rail node.
void match_rail_nodes(const RailMesh& rail, std::vector<Piece>& pieces) {
  for (Piece& piece : pieces) {
    const int nodes = rail.first_from(piece.right) - rail.first_from(piece.left);
    piece.elements = nodes - (piece.next == Joint::separate ? 1 : 0);
  }
}

/// One element between neighbouring stations of given modes.
std::vector<Piece> pieces_between(const std::vector<double>& x) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) pieces.push_back({0, x[i], x[i + 1], 1, Joint::continuous, false});
  pieces.back().next = Joint::separate;
  pieces.back().ends_span = true;
  return pieces;
}

/// The mass per sleeper that moves with the bridge: the mass of its ballast, or without ballast the mass of the
/// sleeper. It is the mean of all sleepers on the bridge.
double mass_on_bridge(const BeamModel& model, const LayeredTrack& track) {
  const auto mass = [&](double x) {
    const TrackValues values = track.at(x);
    return track.ballast ? values.ballast_mass : values.sleeper_mass;
  };
  if (track.uniform()) return mass(model.start);
  const int first = base::whole(std::ceil((model.start - track.offset) / track.spacing));
  const int last = base::whole(std::floor((model.end() - track.offset) / track.spacing));
  double sum = 0.0;
  for (int i = first; i <= last; ++i) sum += mass(track.offset + i * track.spacing);
  return last < first ? 0.0 : sum / (last - first + 1);
}

}  // namespace

int RailMesh::first_from(double station) const {
  return base::whole(std::ceil((station - start) / element - same_station));
}

RailMesh rail_mesh(const BeamModel& model) {
  const LayeredTrack& track = *model.track;
  const auto bays = [&](double x) { return (x - track.offset) / track.spacing; };
  const double first = std::floor(bays(model.start - track.approach) + same_station);
  const double last = std::ceil(bays(model.end() + track.approach) - same_station);
  return {track.offset + first * track.spacing, track.spacing / track.elements_per_bay,
          base::whole((last - first) * track.elements_per_bay)};
}

BeamModel bridge_alone(const BeamModel& model) {
  BeamModel bridge = model;
  bridge.dampers.clear();
  if (!model.track) return bridge;
  const LayeredTrack& track = *model.track;
  bridge.mass = model.mass.plus(mass_on_bridge(model, track) / track.spacing);
  bridge.track.reset();
  return bridge;
}

BeamModel rail_model(const BeamModel& model) {
  const RailMesh mesh = rail_mesh(model);
  BeamModel rail;
  rail.spans = {mesh.elements * mesh.element};
  rail.elements = {mesh.elements};
  rail.EI = model.track->rail_EI;
  rail.EA = model.track->rail_EA;
  if (model.track->rail_GA) rail.GA = *model.track->rail_GA;
  rail.mass = model.track->rail_mass;
  const Support end = model.track->rail_ends_held ? Support::along : Support::free;
  rail.supports = {end, end};
  rail.axial = model.axial;
  if (model.track->rail_temperature != 0.0)
    rail.temperature = Temperature{model.track->rail_temperature, 0.0, model.track->rail_expansion, 1.0};
  rail.start = mesh.start;
  rail.hinges = model.track->rail_hinges;
  rail.expansion_devices = model.track->expansion_devices;
  rail.nodes_at_steps = false;
  return rail;
}

std::vector<Piece> pieces_of(const BeamModel& model) {
  if (model.given) return pieces_between(model.given->x);
  std::vector<Piece> pieces = divided(model);
  if (model.track) {
    match_rail_nodes(rail_mesh(model), pieces);
    return pieces;
  }
  // A span's elements are distributed over its pieces in proportion to their length, at least one each.
  for (Piece& piece : pieces) {
    const double share = (piece.right - piece.left) / model.spans[piece.span];
    piece.elements = std::max(1, base::whole(std::round(model.elements[piece.span] * share)));
  }
  return pieces;
}

}  // namespace traverse::beam
