// Rail and bridge together, UIC 774-3: the forces along the track against closed forms of a rail on its bed, against a
// model of its own, and what has to hold whatever the track is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rail_deck.hpp"
#include "support/record.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {

TEST(RailForces, AgainstAModelOfItsOwn) {
  const beam::BeamModel model = deck_of(60.0, 0.6, 180.0);
  rail::RailBridge bridge(model, area, 1e7);
  const HandRailModel hand(by_hand(model));
  Loads strains;
  strains.strains = true;
  const rail::State warm = bridge.equilibrium(strains);
  const HandState hand_warm = hand.rest(by_hand(strains));
  double worst[4] = {difference(warm, hand_warm), 0.0, 0.0, 0.0};
  for (const double front : {0.0, 30.0, 60.0, 99.0}) {
    Loads train = train_at(front), roughness = train;
    roughness.along = 0.0;
    worst[1] = std::max(worst[1], difference(bridge.equilibrium(roughness), hand.rest(by_hand(roughness))));
    train.strains = true;
    worst[2] = std::max(worst[2], difference(bridge.equilibrium(train, &warm), hand.rest(by_hand(train), &hand_warm)));
    worst[3] = std::max(worst[3], difference(bridge.equilibrium(train), hand.rest(by_hand(train))));
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
    rail::RailBridge bridge(model, area, 1e7);
    Loads strains;
    strains.strains = true;
    const rail::State state = bridge.equilibrium(strains);
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
    rail::RailBridge bridge(model, area, 1e7);
    Loads push;
    push.along_from = 150.0;
    push.along_to = 198.0;
    push.along = p;
    const rail::State state = bridge.equilibrium(push);
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
  rail::RailBridge bridge(model, area, 1e7);
  Loads strains;
  strains.strains = true;
  const rail::State warm = bridge.equilibrium(strains);
  Loads train = train_at(60.0);
  train.strains = true;
  const rail::State loaded = bridge.equilibrium(train, &warm);
  const rail::State after = bridge.equilibrium(strains, &loaded);
  const double limit = 2e4 * 0.6;
  double most_loaded = 0.0, most_after = 0.0;
  for (std::size_t i = 0; i < after.slid.force.size(); ++i) {
    most_loaded = std::max(most_loaded, std::abs(loaded.slid.force[i]));
    most_after = std::max(most_after, std::abs(after.slid.force[i]));
  }
  EXPECT_GT(most_loaded, 1.5 * limit);
  EXPECT_LE(most_after, limit * (1.0 + 1e-12));
  EXPECT_LT(bridge.residual(strains, after) / limit, 1e-6);
  const rail::State again = bridge.equilibrium(strains, &after);
  EXPECT_LT(relative_difference(again.stress, after.stress), 1e-9);
}

// Two forces cross; the deck's running surface, 1 m above its axis, turns and pushes the rail until sleepers slide.
TEST(RailForces, SlidingInTimeAgainstNewmark) {
  Results run = run_yaml(small_deck_in_time, {{"track_elements_per_bay", "1"}});
  const HandHistory hand = cross(small_deck_by_hand(1), 160, 80);
  EXPECT_TRUE(hand.slid);
  const double rail_error = relative_difference(run("/rail/axial_displacement"), hand.rail_u);
  const double deck_error = relative_difference(run("/probes/axial_displacement"), hand.deck_u);
  const double deflection_error = relative_difference(run("/probes/deflection"), hand.deck_v);
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
