// A short bridge under a layered track: as a model, as a scene and for the computation by hand.
#pragma once

#include <functional>
#include <string>

#include "support/small_track.hpp"
#include "support/track_model.hpp"
#include "traverse/beam/model.hpp"

namespace traverse::test {

/// A bridge of 12 bays under zhai_layers, with 10 bays on either side.
inline beam::BeamModel short_bridge(int elements_per_bay) {
  beam::BeamModel model;
  model.spans = {7.2};
  model.elements = {1};
  model.EI = 4e9;
  model.EA = 1e10;
  model.mass = 5000.0;
  model.axial = false;
  model.supports = {beam::Support::pinned, beam::Support::roller};
  const TrackLayers& layers = zhai_layers;
  beam::LayeredTrack t;
  t.rail_EI = layers.rail_EI;
  t.rail_mass = layers.rail_mass;
  t.elements_per_bay = elements_per_bay;
  t.pad = {layers.pad_k, layers.pad_c};
  t.sleeper_mass = layers.sleeper_mass;
  t.ballast = beam::Layer{layers.ballast_k, layers.ballast_c};
  t.ballast_mass = layers.ballast_mass;
  t.subballast = beam::Layer{layers.subballast_k, layers.subballast_c};
  t.approach = 6.0;
  model.track = t;
  return model;
}

/// short_bridge(2) as a scene, under a force that runs from the ground onto it.
inline const std::string short_bridge_scene = track_of(zhai_layers, R"(
  elements_per_bay: 2
  approach: 6.0
beam: {spans: 7.2, EI: 4.0e9, mass: 5000.0, rayleigh: [0.0, 0.0]}
load: {forces: 1.0e5, positions: -5.0, speed: 30.0}
gravity: 9.81
output: {probes: [1.8, 3.6, 5.4]}
)");

/// The data of short_bridge for the computation by hand; `change` sets the differences from sleeper to sleeper.
inline DenseTrack by_hand(const beam::BeamModel& model, const std::function<void(DenseSleeper&)>& change) {
  DenseTrack t;
  const int each = model.track->elements_per_bay;
  t.rail_EI = zhai_layers.rail_EI;
  t.rail_mass = zhai_layers.rail_mass;
  t.rail_start = -6.0;
  t.rail_element = 0.6 / each;
  t.rail_elements = 32 * each;
  t.EI = 4e9;
  t.mass = 5000.0;
  t.length = 7.2;
  t.elements = 12 * each - 1;  // a node for each rail node except the last one
  for (int i = 0; i <= 32; ++i) {
    const TrackLayers& l = zhai_layers;
    DenseSleeper s{-6.0 + 0.6 * i, l.pad_k,        l.pad_c,        l.sleeper_mass, l.ballast_k,
                   l.ballast_c,    l.ballast_mass, l.subballast_k, l.subballast_c};
    change(s);
    t.sleepers.push_back(s);
  }
  t.own_mass = model.track->own_mass;
  t.shear_k = model.track->shear.k;
  t.shear_c = model.track->shear.c;
  return t;
}

inline bool within(double x, double from, double to) { return x > from - 1e-6 && x < to + 1e-6; }

}  // namespace traverse::test
