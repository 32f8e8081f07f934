// How a beam is divided: between span ends, hinges and steps of EI and mass, and under a layered track.
#include <algorithm>
#include <cmath>

#include "base/whole.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

constexpr double rounding = 1e-9;  // of an element's length: closer stations are one

constexpr double least_piece = 0.2;  // of an element's length: steps closer to what divides the beam do not

/// Stations within the stretch at which EI or the mass steps and which nodes can meet: few, and not too close to
/// others.
std::vector<double> steps_between(const BeamModel& model, double left, double right, double element) {
  std::vector<double> steps = model.EI.steps(left, right), kept;
  const std::vector<double> of_mass = model.mass.steps(left, right);
  steps.insert(steps.end(), of_mass.begin(), of_mass.end());
  std::sort(steps.begin(), steps.end());
  for (const double x : steps)
    if (std::min(x - (kept.empty() ? left : kept.back()), right - x) >= least_piece * element) kept.push_back(x);
  return 2.0 * static_cast<double>(kept.size()) * element <= right - left ? kept : std::vector<double>();
}

/// Divides the last piece where EI or the mass steps: bending has a kink there, which no element can follow.
void divide_at_steps(const BeamModel& model, std::vector<Piece>& pieces) {
  const Piece whole = pieces.back();
  const double element = model.spans[whole.span] / model.elements[whole.span];
  for (const double x : steps_between(model, whole.left, whole.right, element)) {
    Piece& rest = pieces.back();
    rest.right = x;
    rest.next = Joint::continuous;
    rest.ends_span = false;
    pieces.push_back(whole);
    pieces.back().left = x;
  }
}

/// Where a beam is divided besides its span ends, and what joins it there.
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
  std::stable_sort(divisions.begin(), divisions.end(), [](const Division& a, const Division& b) { return a.x < b.x; });
  const auto same = [](const Division& a, const Division& b) { return a.x == b.x; };
  divisions.erase(std::unique(divisions.begin(), divisions.end(), same), divisions.end());
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

/// The bridge under a layered track has one node for each of the rail's, so that both are numbered together: as many
/// elements as there are rail nodes from the piece's left end on, less one where no node is shared with the next piece.
/// Every sleeper then stands on an element beside its own rail node.
void follow_rail(const RailMesh& rail, std::vector<Piece>& pieces) {
  for (Piece& piece : pieces) {
    const int nodes = rail.first_from(piece.right) - rail.first_from(piece.left);
    piece.elements = nodes - (piece.next == Joint::separate ? 1 : 0);
  }
}

/// One element between two stations of given modes.
std::vector<Piece> pieces_between(const std::vector<double>& x) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) pieces.push_back({0, x[i], x[i + 1], 1, Joint::continuous, false});
  pieces.back().next = Joint::separate;
  pieces.back().ends_span = true;
  return pieces;
}

/// The mass that a sleeper brings onto the bridge, its ballast's or where there is none its own: the mean of those on
/// the bridge.
double riding_mass(const BeamModel& model, const LayeredTrack& track) {
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
  return base::whole(std::ceil((station - start) / element - rounding));
}

RailMesh rail_mesh(const BeamModel& model) {
  const LayeredTrack& track = *model.track;
  const auto bays = [&](double x) { return (x - track.offset) / track.spacing; };
  const double first = std::floor(bays(model.start - track.approach) + rounding);
  const double last = std::ceil(bays(model.end() + track.approach) - rounding);
  return {track.offset + first * track.spacing, track.spacing / track.elements_per_bay,
          base::whole((last - first) * track.elements_per_bay)};
}

BeamModel bridge_alone(const BeamModel& model) {
  BeamModel bridge = model;
  if (!model.track) return bridge;
  const LayeredTrack& track = *model.track;
  bridge.mass = model.mass.plus(riding_mass(model, track) / track.spacing);
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
    follow_rail(rail_mesh(model), pieces);
    return pieces;
  }
  // A span's elements are shared among its pieces by length, at least one each.
  for (Piece& piece : pieces) {
    const double share = (piece.right - piece.left) / model.spans[piece.span];
    piece.elements = std::max(1, base::whole(std::round(model.elements[piece.span] * share)));
  }
  return pieces;
}

}  // namespace traverse::beam
