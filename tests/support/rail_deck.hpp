// Decks under a track whose sleepers slide, as models of the program and for the computation by hand, in statics and
// while two forces cross.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "rail/rail_bridge.hpp"
#include "support/hand_rail.hpp"

namespace traverse::test {

using rail::Loads;

inline constexpr double area = 0.0153389, rail_EA = 3.2212e9, expansion = 1e-5;

/// A deck under a track on ballast. The longitudinal resistance is 20 kN/m at 2 mm, 60 kN/m under a train.
inline beam::BeamModel deck_of(double span, double spacing, double approach) {
  beam::BeamModel model;
  model.spans = {span};
  model.elements = {1};
  model.EI = 5.439e11;
  model.EA = 1.554e11;
  model.mass = 1e4;
  model.surface_height = 1.21;
  model.temperature = beam::Temperature{35.0, 0.0, expansion, 1.0};
  model.supports = {beam::Support::roller, beam::Support::roller};
  beam::PointFoundation bearing;
  bearing.k = 6e8;
  bearing.depth = 4.79;
  model.foundation.longitudinal = {bearing};
  beam::LayeredTrack t;
  t.rail_EI = 1.28e7;
  t.rail_EA = rail_EA;
  t.rail_mass = 120.0;
  t.spacing = spacing;
  t.pad.k = 1e8;
  t.longitudinal.k = 1e7 * spacing;
  t.slides_at = 2e4 * spacing;
  t.loaded_k = 3e7 * spacing;
  t.loaded_slides_at = 6e4 * spacing;
  t.rail_temperature = 50.0;
  t.rail_expansion = expansion;
  t.rail_ends_held = true;
  t.approach = approach;
  model.track = t;
  return model;
}

/// The data of the model above for the computation by hand.
inline HandRail by_hand(const beam::BeamModel& model) {
  const beam::LayeredTrack& t = *model.track;
  const beam::RailMesh mesh = beam::rail_mesh(model);
  HandRail hand;
  hand.rail_EA = rail_EA;
  hand.rail_EI = 1.28e7;
  hand.rail_strain = 50.0 * expansion;
  hand.start = mesh.start;
  hand.element = mesh.element;
  hand.elements = mesh.elements;
  hand.each = t.elements_per_bay;
  hand.EA = 1.554e11;
  hand.EI = 5.439e11;
  hand.strain = 35.0 * expansion;
  hand.length = model.length();
  hand.deck = beam::pieces_of(model).front().elements;
  hand.height = 1.21;
  hand.bearing_k = 6e8;
  hand.bearing_depth = 4.79;
  hand.pad_k = 1e8;
  hand.k = 1e7 * t.spacing;
  hand.limit = 2e4 * t.spacing;
  hand.loaded_k = 3e7 * t.spacing;
  hand.loaded_limit = 6e4 * t.spacing;
  for (const double x : t.expansion_devices)
    hand.device = static_cast<int>(std::lround((x - mesh.start) / mesh.element));
  return hand;
}

inline HandLoads by_hand(const Loads& loads) {
  return {loads.strains, loads.from, loads.to, loads.weight, loads.along_from, loads.along_to, loads.along};
}

/// Largest difference over the largest value of rail stress, displacement and force of sleepers, bearing force and
/// opening of the device.
inline double difference(const rail::State& state, const HandState& hand) {
  double worst = 0.0;
  const auto compare = [&](const std::vector<double>& a, const std::vector<double>& b, double factor) {
    ASSERT_EQ(a.size(), b.size());
    double largest = 0.0, off = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest = std::max(largest, std::abs(b[i]));
      off = std::max(off, std::abs(factor * a[i] - b[i]));
    }
    worst = std::max(worst, off / largest);
  };
  compare(state.stress, hand.stretch, area);
  compare(state.displacement, hand.displacement, 1.0);
  compare(state.slid.force, hand.force, 1.0);
  compare(state.bearings, {hand.bearing}, 1.0);
  if (!state.openings.empty()) compare(state.openings, {hand.opening}, 1.0);
  return worst;
}

/// A train of 120 m whose front is at x, braking.
inline Loads train_at(double x) {
  Loads loads;
  loads.from = loads.along_from = x - 120.0;
  loads.to = loads.along_to = x;
  loads.weight = 8e4;
  loads.along = 2e4;
  return loads;
}

/// A small deck that two forces cross until sleepers slide.
inline constexpr const char* small_deck_in_time = R"(
beam: {spans: 12.0, EI: 2.0e9, EA: 4.0e9, mass: 3000.0, surface_height: 1.0}
support: {types: [roller, roller]}
foundation: {longitudinal: {x: 0.0, k: 2.0e8, depth: 0.5}}
track:
  rail: {EI: 1.28e7, EA: 3.2212e9, mass: 120.0, ends: held}
  spacing: 0.6
  pad: {k: 1.0e8, c: 2.0e5}
  longitudinal: {k: 6.0e6, c: 1.0e4, limit: 1000.0, loaded_k: 1.8e7, loaded_limit: 3000.0}
  approach: 12.0
load: {forces: [1.0e5, 1.0e5], positions: [-1.0, -7.0], speed: 20.0}
ts: {dt: 5.0e-5, max_time: 0.8}
output: {interval: 0.01, probes: [3.0, 6.0, 9.0]}
)";

/// The data of the scene above for the computation by hand, with `each` rail elements between two sleepers.
inline HandRail small_deck_by_hand(int each) {
  HandRail hand;
  hand.rail_EA = rail_EA;
  hand.rail_EI = 1.28e7;
  hand.rail_mass = 120.0;
  hand.start = -12.0;
  hand.element = 0.6 / each;
  hand.elements = 60 * each;
  hand.each = each;
  hand.EA = 4e9;
  hand.EI = 2e9;
  hand.mass = 3000.0;
  hand.length = 12.0;
  hand.deck = 20 * each;
  hand.height = 1.0;
  hand.bearing_k = 2e8;
  hand.bearing_depth = 0.5;
  hand.pad_k = 1e8;
  hand.pad_c = 2e5;
  hand.c = 1e4;
  hand.k = 6e6;
  hand.limit = 1000.0;
  hand.loaded_k = 1.8e7;
  hand.loaded_limit = 3000.0;
  return hand;
}

/// Its motion every 0.01 s.
struct HandHistory {
  std::vector<double> rail_u, deck_u, deck_v;  // at 3, 6 and 9 m, sample by sample
  std::vector<double> opening;                 // opening of the device
  bool slid = false;                           // whether a loaded sleeper has slid
};

/// The motion by Newmark's method, with this number of steps for each sample.
inline HandHistory cross(const HandRail& hand, int steps, int samples) {
  HandRailModel model(hand);
  const auto forces_at = [](double t) {
    return std::vector<std::pair<double, double>>{{-1.0 + 20.0 * t, 1e5}, {-7.0 + 20.0 * t, 1e5}};
  };
  HandMotion motion = model.at_rest(forces_at(0.0));
  const double h = 0.01 / steps;
  HandHistory history;
  for (int i = 0; i <= samples * steps; ++i) {
    if (i > 0) {
      HandLoads loads;
      loads.from = -7.0 + 20.0 * (i - 1) * h;
      loads.to = -1.0 + 20.0 * i * h;
      model.step(motion, forces_at(i * h), loads, h);
    }
    for (const double force : motion.settled.force) history.slid = history.slid || std::abs(force) == hand.loaded_limit;
    if (i % steps != 0) continue;
    for (const int x : {3, 6, 9}) {
      history.rail_u.push_back(model.rail_u(motion, static_cast<int>(std::lround((x - hand.start) / hand.element))));
      const int node = static_cast<int>(std::lround(x / (hand.length / hand.deck)));
      history.deck_u.push_back(model.deck_u(motion, node));
      history.deck_v.push_back(model.deck_v(motion, node));
    }
    history.opening.push_back(model.opening(motion.v));
  }
  return history;
}

}  // namespace traverse::test
