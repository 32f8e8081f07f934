// The order of the unknowns within a column, and the unknowns of each element, the vector {v}_e of equation 11 of the
// paper.
#include "beam/line.hpp"

#include <algorithm>
#include <utility>

namespace traverse::beam {

Layout::Layout(const BeamModel& model) {
  place.fill(-1);
  const auto pieces = pieces_of(model);
  const bool hinges = std::any_of(pieces.begin(), pieces.end(),
                                  [](const Piece& p) { return p.next == Joint::hinge || p.next == Joint::cracked; });
  const auto add = [&](Kind k) {
    kind[block] = k;
    place[k] = block++;
  };
  if (model.track) {
    if (model.axial) add(rail_u);
    if (model.axial && !model.track->expansion_devices.empty()) add(rail_u_right);
    add(rail_v);
    add(rail_theta);
    if (!model.track->rail_hinges.empty()) add(rail_theta_right);
    add(sleeper);
    if (model.track->own_mass) add(Kind::ballast);
  }
  if (model.axial) add(Kind::u);
  add(Kind::v);
  add(Kind::theta);
  if (hinges) add(Kind::theta_right);
  if (model.torsion) {
    add(Kind::twist);
    add(twist_rate);
    if (!model.torsion->warping) add(twist_rate_right);
  }
  if (!model.dampers.empty()) add(Kind::damper);
}

Line::Line(BeamModel its_model, const Layout& layout, bool rail, int its_first_column)
    : model(std::move(its_model)),
      mesh(model),
      first_column(its_first_column),
      block(layout.block),
      per_node(model.axial ? 3 : 2) {
  const auto& places = layout.place;
  if (rail) {
    place = {
        places[rail_u], places[rail_v], places[rail_theta], places[rail_theta_right], places[rail_u_right], -1, -1, -1};
  } else {
    place = {places[Kind::u],     places[Kind::v],    places[Kind::theta],     places[Kind::theta_right], -1,
             places[Kind::twist], places[twist_rate], places[twist_rate_right]};
  }
}

std::pair<int, int> Line::elements_at(int first, int count) const {
  // Elements are sorted by their left node.
  const auto first_from = [&](int node) {
    int low = 0, high = mesh.elements();
    while (low < high) {
      const int middle = low + (high - low) / 2;
      if (mesh.element(middle).left < node) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  };
  if (count == 0) return {0, 0};
  return {first_from(first - first_column - 1), first_from(first - first_column + count)};
}

std::array<int, 4> Line::transverse(int element) const {
  const int left = mesh.element(element).left;
  return {unknown(left, 1), unknown(left, mesh.hinged(left) ? 3 : 2), unknown(left + 1, 1), unknown(left + 1, 2)};
}

std::array<int, 4> Line::twists(int element) const {
  const int left = mesh.element(element).left;
  return {unknown(left, 5), unknown(left, place[7] >= 0 ? 7 : 6), unknown(left + 1, 5), unknown(left + 1, 6)};
}

std::array<int, 2> Line::axial(int element) const {
  const int left = mesh.element(element).left;
  return {unknown(left, mesh.has_expansion_device(left) ? 4 : 0), unknown(left + 1, 0)};
}

std::array<int, 6> Line::unknowns(int element) const {
  const auto [v1, theta1, v2, theta2] = transverse(element);
  if (per_node == 2) return {v1, theta1, v2, theta2, -1, -1};
  const auto [u1, u2] = axial(element);
  return {u1, v1, theta1, u2, v2, theta2};
}

}  // namespace traverse::beam
