// Influence lines of modes and probes as piecewise cubic functions, by the theorem of Maxwell and Betti.
#include <algorithm>
#include <array>
#include <utility>

#include "beam/shape.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::structure {

std::vector<ModalBridge::Line> ModalBridge::lines_of_modes() const {
  std::vector<Line> lines;
  for (const auto& shape : basis_.shape) {
    lines.emplace_back().nodal = shape;
    for (double& value : lines.back().nodal) value = -value;
  }
  return lines;
}

/// The influence line of a response at a probe, minus the modes' share. By the theorem of Maxwell and Betti it is the
/// deflection of the structure under a load. The nodal forces of this load are the coefficients of the nodal values of
/// the probe's element in the response; `form` is the response to each mode shape.
ModalBridge::Line ModalBridge::correction_of(recovery::Recovery& recovery, std::size_t p,
                                             double recovery::Response::*quantity,
                                             const std::function<double(std::size_t)>& form) {
  const std::vector<double> zero(beam_.local_unknowns(), 0.0);
  std::vector<recovery::Response> responses;
  std::vector<double> load(basis_.shape.front().size(), 0.0);
  const auto add_unit = [&](int unknown) {
    std::vector<double> unit = zero;
    if (beam_.local(unknown) >= 0) unit[static_cast<std::size_t>(beam_.local(unknown))] = 1.0;
    recovery.evaluate(unit.data(), zero.data(), zero.data(), {}, responses);
    load[static_cast<std::size_t>(unknown)] = responses[p].*quantity;
  };
  const int element = beam_.mesh().locate(recovery.stations()[p]).element;
  for (const int unknown : beam_.bridge().transverse(element)) add_unit(unknown);
  if (beam_.model().torsion)
    for (const int unknown : beam_.bridge().twists(element)) add_unit(unknown);
  Line line = line_of(load, form);
  line.probe = p;
  line.direct = quantity;
  return line;
}

/// The influence line of the sum of displacements times `load`, minus the modes' share; `form` is this sum for each
/// mode shape.
ModalBridge::Line ModalBridge::line_of(const std::vector<double>& load,
                                       const std::function<double(std::size_t)>& form) {
  Line line{static_solution(load)};
  for (double& value : line.nodal) value = -value;
  for (std::size_t i = 0; i < modes(); ++i) {
    const double share = form(i) / (basis_.omega[i] * basis_.omega[i]);
    for (std::size_t k = 0; k < line.nodal.size(); ++k) line.nodal[k] += share * basis_.shape[i][k];
  }
  return line;
}

/// The values v1, theta1, v2, theta2 of the track in an element, of values of all unknowns.
std::array<double, 4> ModalBridge::transverse_values(const std::vector<double>& nodal, int element) const {
  const beam::Line& line = beam_.bridge();
  std::array<double, 4> values{};
  line.for_unknowns(element, [&](int k, int unknown, double factor) {
    const int place = k % line.per_node - (line.per_node - 2);
    if (place < 0) return;  // along x
    values[static_cast<std::size_t>(2 * (k / line.per_node) + place)] +=
        factor * nodal[static_cast<std::size_t>(unknown)];
  });
  return values;
}

PiecewiseCubic ModalBridge::influence_of(const std::vector<Line>& lines, const std::vector<double>& stations,
                                         const std::vector<double>& eccentricities) const {
  const beam::Mesh& mesh = beam_.mesh();
  std::vector<recovery::Recovery> recoveries;
  for (std::size_t p = 0; p < stations.size(); ++p)
    recoveries.emplace_back(beam_, std::vector{stations[p]}, 0.0,
                            eccentricities.empty() ? eccentricities : std::vector{eccentricities[p]});
  PiecewiseCubic influence = {{mesh.start()}, lines.size(), {}};
  for (int e = 0; e < mesh.elements(); ++e) {
    const beam::Element& element = mesh.element(e);
    std::vector<double> ends = {element.length};  // right ends of the pieces, from the element's left end
    for (const double x : stations)
      if (x > element.x && x < element.x + element.length) ends.push_back(x - element.x);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    double left = 0.0;
    for (const double right : ends) {
      const std::size_t piece = influence.coefficients.size();
      influence.breaks.push_back(right == element.length ? mesh.x(element.left + 1) : element.x + right);
      influence.coefficients.resize(piece + 4 * lines.size());
      for (std::size_t channel = 0; channel < lines.size(); ++channel) {
        const Line& line = lines[channel];
        const std::array<double, 4> nodal = transverse_values(line.nodal, e);
        beam::Cubic cubic = beam::shifted(beam::hermite_cubic(nodal, element.length, element.shear), left);
        if (line.direct != nullptr && mesh.locate(stations[line.probe]).element == e) {
          const beam::Cubic more = beam::cubic_through(right - left, [&](double x) {
            recovery::ElementLoad unit = {e, (left + x) / element.length, 0.0, -1.0, 0.0};
            unit.move_from(beam_.bridge().action_line(e));
            return recoveries[line.probe].inside_response(0, unit).*line.direct;
          });
          for (std::size_t k = 0; k < 4; ++k) cubic[k] += more[k];
        }
        for (std::size_t k = 0; k < 4; ++k) influence.coefficients[piece + k * lines.size() + channel] = cubic[k];
      }
      left = right;
    }
  }
  return influence;
}
}  // namespace traverse::structure
