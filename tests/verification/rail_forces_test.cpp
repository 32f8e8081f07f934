// Rail and bridge together, UIC 774-3: the forces along the track against closed forms of a rail on its bed, against a
// model of its own, and what has to hold whatever the track is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rail/rail_bridge.hpp"
#include "support/hand_rail.hpp"
#include "support/record.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

using rail::Loads;
using rail::RailBridge;
using rail::State;

constexpr double area = 0.0153389, rail_EA = 3.2212e9, expansion = 1e-5;

/// A deck under a track on ballast: 20 kN/m at 2 mm, 60 kN/m under a train.
beam::BeamModel deck_of(double span, double spacing, double approach) {
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

/// The same by hand.
HandRail by_hand(const beam::BeamModel& model) {
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
  return hand;
}

HandLoads by_hand(const Loads& loads) {
  return {loads.strains, loads.from, loads.to, loads.weight, loads.along_from, loads.along_to, loads.along};
}

/// Largest difference over the largest value: rail stress, displacement and force of sleepers, the bearing.
double difference(const State& state, const HandState& hand) {
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
  return worst;
}

/// A train of 120 m whose front is at x, braking.
Loads train_at(double x) {
  Loads loads;
  loads.from = loads.along_from = x - 120.0;
  loads.to = loads.along_to = x;
  loads.weight = 8e4;
  loads.along = 2e4;
  return loads;
}

}  // namespace

TEST(RailForces, AgainstAModelOfItsOwn) {
  const beam::BeamModel model = deck_of(60.0, 0.6, 180.0);
  RailBridge bridge(model, area, 1e7);
  const HandRailModel hand(by_hand(model));
  Loads strains;
  strains.strains = true;
  const State warm = bridge.rest(strains);
  const HandState hand_warm = hand.rest(by_hand(strains));
  double worst[4] = {difference(warm, hand_warm), 0.0, 0.0, 0.0};
  for (const double front : {0.0, 30.0, 60.0, 99.0}) {
    Loads train = train_at(front), bends = train;
    bends.along = 0.0;
    worst[1] = std::max(worst[1], difference(bridge.rest(bends), hand.rest(by_hand(bends))));
    train.strains = true;
    worst[2] = std::max(worst[2], difference(bridge.rest(train, &warm), hand.rest(by_hand(train), &hand_warm)));
    worst[3] = std::max(worst[3], difference(bridge.rest(train), hand.rest(by_hand(train))));
  }
  const char* names[] = {"temperature_error", "bending_error", "sequence_error", "at_once_error"};
  for (std::size_t i = 0; i < 4; ++i) record(names[i], worst[i]);
  EXPECT_LT(*std::max_element(worst, worst + 4), 1e-7);
}

// A rail with a free end that is warmer by T. It slides over the length a, over which its force grows from the end at
// the rate r, to the station at which the bed holds: N = EA(alpha T - lambda u0) there, lambda^2 = (r/u0)/EA.
TEST(RailForces, FreeEndBreathes) {
  double error[2] = {};
  for (const int i : {0, 1}) {
    const double spacing = i == 0 ? 1.2 : 0.6;
    beam::BeamModel model = deck_of(6.0, spacing, 240.0);
    model.temperature.reset();
    model.track->rail_ends_held = false;
    RailBridge bridge(model, area, 1e7);
    Loads strains;
    strains.strains = true;
    const State state = bridge.rest(strains);
    const double r = 2e4, u0 = 2e-3, lambda = std::sqrt(r / u0 / rail_EA), N0 = rail_EA * 50.0 * expansion;
    const double N = N0 - rail_EA * lambda * u0, a = N / r - 0.5 * spacing;  // the last sleeper stands at the end
    // The strain that is left is (N0 - r(x + spacing/2))/EA.
    const double end = u0 + (N0 * a - 0.5 * r * a * (a + spacing)) / rail_EA;
    error[i] = std::abs(state.displacement.back() / end - 1.0);
  }
  record("error", *std::max_element(error, error + 2));
  EXPECT_LT(*std::max_element(error, error + 2), 2e-5);
}

// A rail on a bed that holds, pushed along 2a: u = p/k (1 - exp(-lambda a)) in the middle.
TEST(RailForces, BrakingOnTheGround) {
  double error[2] = {};
  for (const int i : {0, 1}) {
    const double spacing = i == 0 ? 1.2 : 0.6, p = 5e3;
    beam::BeamModel model = deck_of(6.0, spacing, 480.0);
    model.temperature.reset();
    RailBridge bridge(model, area, 1e7);
    Loads push;
    push.along_from = 150.0;
    push.along_to = 198.0;
    push.along = p;
    const State state = bridge.rest(push);
    const double lambda = std::sqrt(1e7 / rail_EA), u = p / 1e7 * (1.0 - std::exp(-24.0 * lambda));
    for (std::size_t s = 0; s < bridge.sleepers().size(); ++s)
      if (std::abs(bridge.sleepers()[s] - 174.0) < 1e-6) error[i] = std::abs(state.displacement[s] / u - 1.0);
  }
  record("error", error[1]);
  record("order", std::log2(error[0] / error[1]));
  EXPECT_LT(error[1], 2e-4);
  EXPECT_GT(std::log2(error[0] / error[1]), 1.9);
}

// What a train leaves behind: sleepers hold no more than without one, and a second passage changes nothing.
TEST(RailForces, SleepersHoldLessWhenTheTrainHasGone) {
  const beam::BeamModel model = deck_of(60.0, 0.6, 180.0);
  RailBridge bridge(model, area, 1e7);
  Loads strains;
  strains.strains = true;
  const State warm = bridge.rest(strains);
  Loads train = train_at(60.0);
  train.strains = true;
  const State loaded = bridge.rest(train, &warm);
  const State after = bridge.rest(strains, &loaded);
  const double limit = 2e4 * 0.6;
  double most_loaded = 0.0, most_after = 0.0;
  for (std::size_t i = 0; i < after.slid.force.size(); ++i) {
    most_loaded = std::max(most_loaded, std::abs(loaded.slid.force[i]));
    most_after = std::max(most_after, std::abs(after.slid.force[i]));
  }
  EXPECT_GT(most_loaded, 1.5 * limit);
  EXPECT_LE(most_after, limit * (1.0 + 1e-12));
  EXPECT_LT(bridge.residual(strains, after) / limit, 1e-6);
  const State again = bridge.rest(strains, &after);
  EXPECT_LT(relative_difference(again.stress, after.stress), 1e-9);
}

// Two forces cross; the deck's running surface, 1 m above its axis, turns and pushes the rail until sleepers slide.
TEST(RailForces, SlidingInTimeAgainstNewmark) {
  Results run = run_yaml(R"(
beam: {spans: 12.0, EI: 2.0e9, EA: 4.0e9, mass: 3000.0, surface_height: 1.0}
support: {types: [roller, roller]}
foundation: {longitudinal: {x: 0.0, k: 2.0e8, depth: 0.5}}
track:
  rail: {EI: 1.28e7, EA: 3.2212e9, mass: 120.0, ends: held}
  spacing: 0.6
  elements_per_bay: 1
  pad: {k: 1.0e8, c: 2.0e5}
  longitudinal: {k: 6.0e6, c: 1.0e4, limit: 1000.0, loaded_k: 1.8e7, loaded_limit: 3000.0}
  approach: 12.0
load: {forces: [1.0e5, 1.0e5], positions: [-1.0, -7.0], speed: 20.0}
ts: {dt: 5.0e-5, max_time: 0.8}
output: {interval: 0.01, probes: [3.0, 6.0, 9.0]}
)");
  HandRail hand;
  hand.rail_EA = rail_EA;
  hand.rail_EI = 1.28e7;
  hand.rail_mass = 120.0;
  hand.start = -12.0;
  hand.element = 0.6;
  hand.elements = 60;
  hand.EA = 4e9;
  hand.EI = 2e9;
  hand.mass = 3000.0;
  hand.length = 12.0;
  hand.deck = 20;
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
  HandRailModel model(hand);
  const auto forces_at = [](double t) {
    return std::vector<std::pair<double, double>>{{-1.0 + 20.0 * t, 1e5}, {-7.0 + 20.0 * t, 1e5}};
  };
  HandMotion motion = model.at_rest(forces_at(0.0));
  constexpr int steps = 160;  // a sample
  const double h = 0.01 / steps;
  std::vector<double> rail_u, deck_u, deck_v;
  bool slid = false;
  for (int i = 0; i <= 80 * steps; ++i) {
    if (i > 0) {
      HandLoads loads;
      loads.from = -7.0 + 20.0 * (i - 1) * h;
      loads.to = -1.0 + 20.0 * i * h;
      model.step(motion, forces_at(i * h), loads, h);
    }
    for (const double force : motion.settled.force) slid = slid || std::abs(force) == 3000.0;
    if (i % steps != 0) continue;
    for (const int node : {5, 10, 15}) {
      rail_u.push_back(model.rail_u(motion, 20 + node));
      deck_u.push_back(model.deck_u(motion, node));
      deck_v.push_back(model.deck_v(motion, node));
    }
  }
  EXPECT_TRUE(slid);
  const double rail_error = relative_difference(run("/rail/axial_displacement"), rail_u);
  const double deck_error = relative_difference(run("/probes/axial_displacement"), deck_u);
  const double deflection_error = relative_difference(run("/probes/deflection"), deck_v);
  record("rail_error", rail_error);
  record("deck_error", deck_error);
  record("deflection_error", deflection_error);
  record("energy_error", energy_error(run));
  EXPECT_LT(rail_error, 3e-3);
  EXPECT_LT(deck_error, 2e-3);
  EXPECT_LT(deflection_error, 1e-4);
  EXPECT_LT(energy_error(run), 1e-5);
}

TEST(RailForces, Uic774TestCase) {
  Results run = run_scene("uic774_e13");
  const double residual = run.attribute("/rail_forces", "residual");
  record("residual", residual);
  EXPECT_LT(residual, 1e-8);
  for (const char* name : {"temperature", "bending", "braking", "traction", "separate", "in_sequence", "at_once"}) {
    const std::string its = "/rail_forces/" + std::string(name) + "/";
    record((std::string(name) + "_tension_MPa").c_str(), 1e-6 * run(its + "tension")[0]);
    record((std::string(name) + "_compression_MPa").c_str(), 1e-6 * run(its + "compression")[0]);
  }
  // Superposition is on the safe side of what comes one after the other.
  EXPECT_GT(run("/rail_forces/separate/tension")[0], run("/rail_forces/in_sequence/tension")[0]);
  EXPECT_LT(run("/rail_forces/separate/compression")[0], run("/rail_forces/in_sequence/compression")[0]);
}

}  // namespace traverse::test
