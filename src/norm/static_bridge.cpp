// Influence lines as deflection curves: under nodal forces for deflection, moment, shear and rotation (Maxwell and
// Betti), under a unit support displacement for reactions (Mueller-Breslau).
#include "norm/static_bridge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "modes/modes.hpp"
#include "traverse/base/error.hpp"

namespace traverse::norm {
namespace {

// With uniform spans on supports only the nodal displacements are exact for any mesh; the first frequency has an error
// of 1e-5.
constexpr int elements_of_uniform_span = 8, min_elements = 64, max_elements = 4000;  // a span
constexpr double elements_per_decay_length = 8.0;                // elements in the decay length 1/lambda
constexpr int deflection = 1, rotation = 2, rotation_right = 3;  // unknowns of a node

beam::BeamModel model_for_statics(const beam::BeamModel& given) {
  beam::BeamModel model = given.track ? bridge_alone(given) : given;
  model.axial = false;
  model.temperature.reset();
  model.settlement.clear();
  if (const std::string floating = floating_motion(model); !floating.empty())
    throw InputError("support_types: the beam can float away (" + floating +
                     "); static effects require a supported beam");
  const beam::Foundation& f = model.foundation;
  const bool uniform = model.EI.uniform() && (!model.GA || model.GA->uniform()) && model.cracks.empty() &&
                       f.vertical.empty() && f.rotational.empty() && !f.vertical_bed && !f.rotational_bed &&
                       model.hinges.empty();
  double decay = 0.0;
  beam::for_beds(f, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    decay = std::max(decay, beam::bending_decay_rate(kind.direction, bed.k.maximum(), model.EI.minimum()));
  });
  model.elements.clear();
  for (const double span : model.spans)
    model.elements.push_back(
        uniform ? elements_of_uniform_span
                : static_cast<int>(std::clamp<double>(std::ceil(elements_per_decay_length * decay * span), min_elements,
                                                      max_elements)));
  return model;
}

}  // namespace

StaticBridge::StaticBridge(const beam::BeamModel& model)
    : beam_(PETSC_COMM_SELF, model_for_statics(model)), statics_((beam_.set_rayleigh({}), beam_)) {
  const std::vector<double>& ends = beam_.mesh().span_ends();
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (beam::fixes_vertical(beam_.model().supports[i])) bearings_.push_back({ends[i], static_cast<int>(i), 0.0});
  for (const beam::PointFoundation& p : beam_.model().foundation.vertical) bearings_.push_back({p.x, -1, p.k});
  std::stable_sort(bearings_.begin(), bearings_.end(), [](const Bearing& a, const Bearing& b) { return a.x < b.x; });
}

double StaticBridge::first_frequency() const {
  return modes::distinct_frequencies(beam_, 1).front() / (2.0 * std::numbers::pi);
}

/// The line with these nodal values, plus the direct effect of a force on the element of the recovery's station.
InfluenceLine StaticBridge::line_of(std::vector<double> nodal, const recovery::Recovery* recovery,
                                    double recovery::Response::*direct) {
  const beam::Mesh& mesh = beam_.mesh();
  const std::size_t count = static_cast<std::size_t>(mesh.elements());
  const double section = recovery != nullptr ? recovery->stations().front() : 0.0;
  const int loaded_element = recovery != nullptr ? mesh.locate(section).element : -1;
  std::vector<double> breaks = {mesh.start()};
  std::vector<beam::Cubic> pieces;
  breaks.reserve(count + 2);
  pieces.reserve(count + 1);
  for (int e = 0; e < mesh.elements(); ++e) {
    const beam::Element& element = mesh.element(e);
    const auto unknowns = beam_.bridge().transverse(e);
    std::array<double, 4> ends{};
    for (std::size_t k = 0; k < 4; ++k) ends[k] = nodal[static_cast<std::size_t>(unknowns[k])];
    const beam::Cubic cubic = beam::hermite_cubic(ends, element.length, element.shear);
    double start = 0.0;
    const auto add_piece = [&](double end) {
      beam::Cubic piece = beam::shifted(cubic, start);
      if (e == loaded_element) {
        const beam::Cubic more = beam::cubic_through(end - start, [&](double x) {
          return recovery->inside_response(0, {e, (start + x) / element.length, 0.0, -1.0, 0.0}).*direct;
        });
        for (std::size_t k = 0; k < 4; ++k) piece[k] += more[k];
      }
      pieces.push_back(piece);
      breaks.push_back(end == element.length ? mesh.x(element.left + 1) : element.x + end);
      start = end;
    };
    if (e == loaded_element && section > element.x && section < element.x + element.length)
      add_piece(section - element.x);
    add_piece(element.length);
  }
  return {std::move(breaks), std::move(pieces)};
}

std::array<InfluenceLine, 3> StaticBridge::lines_at(double x) {
  recovery::Recovery recovery(beam_, {x}, 0.0);
  const auto unknowns = beam_.bridge().transverse(beam_.mesh().locate(x).element);
  const std::vector<double> zero(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  std::vector<double> unit = zero;
  std::array<recovery::Response, 4> forms;
  std::vector<recovery::Response> responses;
  for (std::size_t k = 0; k < 4; ++k) {
    unit[static_cast<std::size_t>(unknowns[k])] = 1.0;
    recovery.evaluate(unit.data(), zero.data(), zero.data(), {}, responses);
    unit[static_cast<std::size_t>(unknowns[k])] = 0.0;
    forms[k] = responses.front();
  }
  std::array<InfluenceLine, 3> lines;
  constexpr double recovery::Response::*quantities[] = {&recovery::Response::deflection, &recovery::Response::moment,
                                                        &recovery::Response::shear};
  for (std::size_t q = 0; q < lines.size(); ++q) {
    std::vector<double> nodal = zero;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto unknown = static_cast<std::size_t>(unknowns[k]);
      if (beam_.fixed()[unknown] == 0) nodal[unknown] = -(forms[k].*quantities[q]);
    }
    statics_.solve_static(nodal.data());
    lines[q] = line_of(std::move(nodal), &recovery, quantities[q]);
  }
  return lines;
}

// The deflection of the bridge under a unit displacement of the support (Mueller-Breslau).
InfluenceLine StaticBridge::reaction(const Bearing& bearing) {
  if (bearing.span_end < 0) return lines_at(bearing.x)[0].times(-bearing.stiffness);
  std::vector<double> nodal(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  beam_.add_reaction_form(bearing.span_end, deflection, -1.0, nodal.data());
  statics_.solve_static(nodal.data());
  const auto [left, right] = beam_.mesh().nodes_at(bearing.span_end);
  for (int node = left; node <= right; ++node)
    nodal[static_cast<std::size_t>(beam_.bridge().unknown(node, deflection))] = 1.0;
  return line_of(std::move(nodal), nullptr, nullptr);
}

/// The influence line of a sum of rotations: unknowns and factors.
InfluenceLine StaticBridge::rotation_of(const std::vector<std::pair<int, double>>& form) {
  std::vector<double> nodal(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  for (const auto& [unknown, factor] : form)
    if (beam_.fixed()[static_cast<std::size_t>(unknown)] == 0) nodal[static_cast<std::size_t>(unknown)] = -factor;
  statics_.solve_static(nodal.data());
  return line_of(std::move(nodal), nullptr, nullptr);
}

InfluenceLine StaticBridge::end_rotation(bool right) {
  return rotation_of({{beam_.bridge().unknown(right ? beam_.mesh().nodes() - 1 : 0, rotation), 1.0}});
}

std::vector<int> StaticBridge::joints() const {
  std::vector<int> joint_ends;
  for (int i = 1; i < beam_.mesh().spans(); ++i)
    if (const auto [left, right] = beam_.mesh().nodes_at(i); left != right || beam_.mesh().hinged(left))
      joint_ends.push_back(i);
  return joint_ends;
}

InfluenceLine StaticBridge::joint_rotation(int span_end) {
  const auto [left, right] = beam_.mesh().nodes_at(span_end);
  return rotation_of({{beam_.bridge().unknown(left, rotation), -1.0},
                      {beam_.bridge().unknown(right, left == right ? rotation_right : rotation), 1.0}});
}

}  // namespace traverse::norm
