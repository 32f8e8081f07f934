// Influence lines as deflection curves: under nodal forces for deflection, moment, shear and rotation (Maxwell and
// Betti), under a unit support displacement for reactions (Mueller-Breslau). Sections are distributed along every span;
// every load has its least and greatest effect from each influence line and its negative.
#include "norm/static_bridge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

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
                       model.hinges.empty() &&
                       (!model.torsion || (model.torsion->GJ.uniform() && !model.torsion->warping));
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

constexpr double parts_of_span = 20.0,
                 support_offset = 1e-6;  // relative to the span: distance of sections from a support
constexpr std::size_t max_springs = 200;

Place place_of(const beam::BeamModel& model, double x) {
  Place place{x, 0.0, 0};
  double start = 0.0;
  for (std::size_t i = 0; i < model.spans.size(); start += model.spans[i++]) {
    const double slack = support_offset * model.spans[i];
    if (x < start - slack || x > start + model.spans[i] + slack) continue;
    if (place.span == 0.0 || model.spans[i] < place.span) place = {x, model.spans[i], i};
  }
  return place;
}

std::vector<Place> sections_of(const beam::BeamModel& model, double spacing,
                               const std::vector<double>& given_stations) {
  std::vector<double> x = given_stations;
  const auto add = [&](double station, double slack) {  // unless it is one of the given stations, but for rounding
    if (std::none_of(given_stations.begin(), given_stations.end(),
                     [&](double given) { return std::abs(given - station) < slack; }))
      x.push_back(station);
  };
  double start = 0.0;
  for (const double span : model.spans) {
    const double parts = spacing > 0.0 ? std::max(1.0, std::ceil(span / spacing - support_offset)) : parts_of_span;
    for (double i = 0.0; i <= parts; ++i)
      add(start + span * std::clamp(i / parts, support_offset, 1.0 - support_offset), 0.1 * support_offset * span);
    start += span;
  }
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  std::vector<Place> places;
  for (const double one : x) places.push_back(place_of(model, one));
  return places;
}

}  // namespace

StaticBridge::StaticBridge(const beam::BeamModel& model)
    : beam_(PETSC_COMM_SELF, model_for_statics(model)), statics_((beam_.set_rayleigh({}), beam_)) {
  const std::vector<double>& ends = beam_.mesh().span_ends();
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (beam::fixes_vertical(beam_.model().supports[i])) bearings_.push_back({ends[i], static_cast<int>(i), 0.0});
  for (const beam::PointFoundation& p : beam_.model().foundation.vertical)
    bearings_.push_back({p.x, -1, p.k, p.eccentricity});
  std::stable_sort(bearings_.begin(), bearings_.end(), [](const Bearing& a, const Bearing& b) { return a.x < b.x; });
}

double StaticBridge::first_frequency() const {
  return modes::distinct_frequencies(beam_, 1).front() / (2.0 * std::numbers::pi);
}

/// The line with these nodal values, plus the direct effect of a force on the element of the recovery's station.
InfluenceLine StaticBridge::line_of(const std::vector<double>& nodal, int track, const recovery::Recovery* recovery,
                                    double recovery::Response::*direct) {
  const beam::Line& bridge = beam_.bridge();
  const beam::Mesh& mesh = bridge.mesh;
  const std::size_t count = static_cast<std::size_t>(mesh.elements());
  const double section = recovery != nullptr ? recovery->stations().front() : 0.0;
  const int loaded_element = recovery != nullptr ? mesh.locate(section).element : -1;
  std::vector<double> breaks = {mesh.start()};
  std::vector<beam::Cubic> pieces;
  breaks.reserve(count + 2);
  pieces.reserve(count + 1);
  for (int e = 0; e < mesh.elements(); ++e) {
    const beam::Element& element = mesh.element(e);
    const int number = mesh.on_track({e, 0.0}, track).element;
    std::array<double, 4> ends{};
    bridge.for_unknowns(number, [&](int k, int unknown, double factor) {
      ends[static_cast<std::size_t>(k)] += factor * nodal[static_cast<std::size_t>(unknown)];
    });
    const beam::Cubic cubic = beam::hermite_cubic(ends, element.length, element.shear);
    double start = 0.0;
    const auto add_piece = [&](double end) {
      beam::Cubic piece = beam::shifted(cubic, start);
      if (e == loaded_element) {
        const beam::Cubic more = beam::cubic_through(end - start, [&](double x) {
          recovery::ElementLoad unit{e, (start + x) / element.length, 0.0, -1.0};
          unit.move_from(bridge.action_line(number));
          return recovery->inside_response(0, unit).*direct;
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

std::vector<StaticBridge::Lines> StaticBridge::lines_at(double x, double eccentricity) {
  recovery::Recovery recovery(beam_, {x}, 0.0, {eccentricity});
  const int element = beam_.mesh().locate(x).element;
  const auto transverse = beam_.bridge().transverse(element);
  std::vector<int> unknowns(transverse.begin(), transverse.end());
  if (beam_.model().torsion) std::ranges::copy(beam_.bridge().twists(element), std::back_inserter(unknowns));
  const std::vector<double> zero(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  std::vector<double> unit = zero;
  std::vector<recovery::Response> forms, responses;
  for (const int unknown : unknowns) {
    unit[static_cast<std::size_t>(unknown)] = 1.0;
    recovery.evaluate(unit.data(), zero.data(), zero.data(), {}, responses);
    unit[static_cast<std::size_t>(unknown)] = 0.0;
    forms.push_back(responses.front());
  }
  std::vector<Lines> lines(static_cast<std::size_t>(tracks()));
  using recovery::Response;
  for (const auto quantity : {&Response::deflection, &Response::moment, &Response::shear, &Response::twist_along}) {
    if (quantity == &Response::twist_along && !beam_.model().torsion) continue;
    std::vector<double> nodal = zero;
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      const auto unknown = static_cast<std::size_t>(unknowns[k]);
      if (beam_.fixed()[unknown] == 0) nodal[unknown] = -(forms[k].*quantity);
    }
    statics_.solve_static(nodal.data());
    for (int track = 0; track < tracks(); ++track)
      lines[static_cast<std::size_t>(track)].push_back(line_of(nodal, track, &recovery, quantity));
  }
  return lines;
}

std::vector<InfluenceLine> StaticBridge::lines_of(const std::vector<double>& nodal) {
  std::vector<InfluenceLine> lines;
  for (int track = 0; track < tracks(); ++track) lines.push_back(line_of(nodal, track, nullptr, nullptr));
  return lines;
}

// The deflection of the bridge under a unit displacement of the support (Mueller-Breslau).
std::vector<InfluenceLine> StaticBridge::reaction(const Bearing& bearing) {
  if (bearing.span_end < 0) {
    std::vector<InfluenceLine> lines;
    for (const auto& line : lines_at(bearing.x, bearing.eccentricity))
      lines.push_back(line[0].times(-bearing.stiffness));
    return lines;
  }
  std::vector<double> nodal(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  beam_.add_reaction_form(bearing.span_end, deflection, -1.0, nodal.data());
  statics_.solve_static(nodal.data());
  const auto [left, right] = beam_.mesh().nodes_at(bearing.span_end);
  for (int node = left; node <= right; ++node)
    nodal[static_cast<std::size_t>(beam_.bridge().unknown(node, deflection))] = 1.0;
  return lines_of(nodal);
}

/// The influence line of a sum of rotations: unknowns and factors.
std::vector<InfluenceLine> StaticBridge::rotation_of(const std::vector<std::pair<int, double>>& form) {
  std::vector<double> nodal(static_cast<std::size_t>(beam_.local_unknowns()), 0.0);
  for (const auto& [unknown, factor] : form)
    if (beam_.fixed()[static_cast<std::size_t>(unknown)] == 0) nodal[static_cast<std::size_t>(unknown)] = -factor;
  statics_.solve_static(nodal.data());
  return lines_of(nodal);
}

std::vector<InfluenceLine> StaticBridge::end_rotation(bool right) {
  return rotation_of({{beam_.bridge().unknown(right ? beam_.mesh().nodes() - 1 : 0, rotation), 1.0}});
}

std::vector<int> StaticBridge::joints() const {
  std::vector<int> joint_ends;
  for (int i = 1; i < beam_.mesh().spans(); ++i)
    if (const auto [left, right] = beam_.mesh().nodes_at(i); left != right || beam_.mesh().hinged(left))
      joint_ends.push_back(i);
  return joint_ends;
}

std::vector<InfluenceLine> StaticBridge::joint_rotation(int span_end) {
  const auto [left, right] = beam_.mesh().nodes_at(span_end);
  return rotation_of({{beam_.bridge().unknown(left, rotation), -1.0},
                      {beam_.bridge().unknown(right, left == right ? rotation_right : rotation), 1.0}});
}

StaticEffects static_effects(StaticBridge& bridge, std::vector<LoadModel> loads, double spacing,
                             const std::vector<double>& given_stations) {
  StaticEffects result;
  result.loads = std::move(loads);
  const beam::BeamModel& model = bridge.model();
  std::vector<StaticBridge::Bearing> bearings = bridge.bearings();
  const auto is_spring = [](const StaticBridge::Bearing& b) { return b.span_end < 0; };
  if (bearings.size() > max_springs) std::erase_if(bearings, is_spring);
  const auto places = [&](Effect effect) -> std::vector<Place>& {
    return result.places[static_cast<std::size_t>(effect)];
  };
  std::vector<Effect> at_sections = {Effect::deflection, Effect::moment, Effect::shear};
  if (model.torsion) at_sections.push_back(Effect::track_twist);
  for (const Effect effect : at_sections) places(effect) = sections_of(model, spacing, given_stations);
  for (const StaticBridge::Bearing& b : bearings) places(Effect::reaction).push_back(place_of(model, b.x));
  places(Effect::end_rotation) = {place_of(model, 0.0), place_of(model, model.length())};
  const std::vector<int> joints = bridge.joints();
  for (const int i : joints)
    places(Effect::joint_rotation)
        .push_back(place_of(model, std::accumulate(model.spans.begin(), model.spans.begin() + i, 0.0)));
  for (std::size_t e = 0; e < effect_count; ++e) result.values[e].resize(result.loads.size() * result.places[e].size());

  // Load models are on all tracks, a train of the user on the first one.
  const auto store = [&](Effect effect, std::size_t place, const std::vector<InfluenceLine>& lines) {
    const auto e = static_cast<std::size_t>(effect);
    for (std::size_t load = 0; load < result.loads.size(); ++load) {
      Extremes& extremes = result.values[e][load * result.places[e].size() + place];
      const std::size_t tracks = result.loads[load].clause.empty() ? 1 : lines.size();
      for (std::size_t track = 0; track < tracks; ++track) {
        const Placed least = greatest(lines[track].times(-1.0), result.loads[load]),
                     most = greatest(lines[track], result.loads[load]);
        extremes.least = {extremes.least.value - least.value, track == 0 ? least.x : extremes.least.x};
        extremes.greatest = {extremes.greatest.value + most.value, track == 0 ? most.x : extremes.greatest.x};
      }
    }
  };
  const double eccentricity = model.torsion ? model.torsion->tracks.front().lever : 0.0;
  for (std::size_t i = 0; i < places(Effect::deflection).size(); ++i) {
    const auto on_tracks = bridge.lines_at(places(Effect::deflection)[i].x, eccentricity);
    for (std::size_t q = 0; q < at_sections.size(); ++q) {
      const double factor = at_sections[q] == Effect::track_twist ? recovery::track_base : 1.0;
      std::vector<InfluenceLine> lines;
      for (const auto& line : on_tracks) lines.push_back(line[q].times(factor));
      store(at_sections[q], i, lines);
    }
  }
  for (std::size_t i = 0; i < bearings.size(); ++i) store(Effect::reaction, i, bridge.reaction(bearings[i]));
  store(Effect::end_rotation, 0, bridge.end_rotation(false));
  store(Effect::end_rotation, 1, bridge.end_rotation(true));
  for (std::size_t i = 0; i < joints.size(); ++i) store(Effect::joint_rotation, i, bridge.joint_rotation(joints[i]));
  return result;
}

}  // namespace traverse::norm
