// Rail expansion devices: against a closed form of free ends that breathe, against a model of its own at rest and in
// time, and what they do to a design case.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rail_deck.hpp"
#include "support/record.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {

// Rails that are warmer by T, with a device between two sleepers far from all else. Either side slides over the length
// a, over which its force grows from the device at the rate r, to the station at which the bed holds.
TEST(RailDevices, FreeEndsBreathe) {
  double error[2] = {}, sides[2] = {};
  for (const int i : {0, 1}) {
    const double spacing = i == 0 ? 1.2 : 0.6;
    beam::BeamModel model = deck_of(6.0, spacing, 480.0);
    model.temperature.reset();
    model.track->expansion_devices = {-240.0 + 0.5 * spacing};
    rail::RailBridge bridge(model, area, 1e7);
    Loads strains;
    strains.strains = true;
    const rail::State state = bridge.equilibrium(strains);
    const double r = 2e4, u0 = 2e-3, lambda = std::sqrt(r / u0 / rail_EA), N0 = rail_EA * 50.0 * expansion;
    const double a = (N0 - rail_EA * lambda * u0) / r;  // the force at its end is EA (alpha T - lambda u0)
    const double end = u0 + (N0 * a - 0.5 * r * a * a) / rail_EA;
    error[i] = std::abs(state.openings.front() / (-2.0 * end) - 1.0);
    const auto beyond = std::lower_bound(bridge.sleepers().begin(), bridge.sleepers().end(), -240.0 + 0.5 * spacing);
    const auto right = static_cast<std::size_t>(beyond - bridge.sleepers().begin());
    sides[i] = std::abs(state.displacement[right] / state.displacement[right - 1] + 1.0);
  }
  record("coarse_error", error[0]);
  record("error", error[1]);
  record("sides_error", *std::max_element(sides, sides + 2));
  EXPECT_LT(error[1], 2e-5);
  EXPECT_LT(error[1], 0.5 * error[0]);
  EXPECT_LT(*std::max_element(sides, sides + 2), 1e-7);
}

TEST(RailDevices, AgainstAModelOfItsOwn) {
  beam::BeamModel model = deck_of(60.0, 0.6, 180.0);
  model.track->expansion_devices = {60.3};
  rail::RailBridge bridge(model, area, 1e7);
  const HandRailModel hand(by_hand(model));
  Loads strains;
  strains.strains = true;
  const rail::State warm = bridge.equilibrium(strains);
  const HandState hand_warm = hand.rest(by_hand(strains));
  double worst[3] = {difference(warm, hand_warm), 0.0, 0.0};
  for (const double front : {30.0, 60.0, 99.0}) {
    Loads train = train_at(front);
    worst[1] = std::max(worst[1], difference(bridge.equilibrium(train), hand.rest(by_hand(train))));
    train.strains = true;
    const rail::State state = bridge.equilibrium(train, &warm);
    worst[2] = std::max(worst[2], difference(state, hand.rest(by_hand(train), &hand_warm)));
    EXPECT_LT(std::abs(bridge.residual(train, state)) / 1e6, 1e-9);
  }
  const char* names[] = {"temperature_error", "train_error", "sequence_error"};
  for (std::size_t i = 0; i < 3; ++i) record(names[i], worst[i]);
  EXPECT_LT(*std::max_element(worst, worst + 3), 1e-7);
}

TEST(RailDevices, InTimeAgainstNewmark) {
  Results run = run_yaml(small_deck_in_time, {{"track_rail_expansion_devices", "12.3"}, {"ts_max_time", "0.4"}});
  HandRail deck = small_deck_by_hand(2);
  deck.device = 81;
  const HandHistory hand = cross(deck, 160, 40);
  const double opening_error = relative_difference(run("/rail/devices/opening"), hand.opening);
  const double rail_error = relative_difference(run("/rail/axial_displacement"), hand.rail_u);
  record("opening_error", opening_error);
  record("rail_error", rail_error);
  record("energy_error", energy_error(run));
  EXPECT_EQ(run("/rail/devices/x"), std::vector<double>{12.3});
  EXPECT_LT(opening_error, 3e-3);
  EXPECT_LT(rail_error, 3e-3);
  EXPECT_LT(energy_error(run), 1e-5);
}

// At the movable end of the deck: compression falls, and what is left of it holds for warm rails, whose own stress the
// device releases; cold and unheated rails are further runs.
TEST(RailDevices, AtTheMovableEndOfTheUicTestCase) {
  Results without = run_scene("uic774_e13");
  Results with = run_scene("uic774_e13", {{"track_rail_expansion_devices", "60.3"}});
  record("residual", with.attribute("/rail_forces", "residual"));
  EXPECT_LT(with.attribute("/rail_forces", "residual"), 1e-8);
  for (const char* name : {"in_sequence", "at_once"}) {
    const std::string its = "/rail_forces/" + std::string(name) + "/";
    record((std::string(name) + "_compression_MPa").c_str(), 1e-6 * with(its + "compression")[0]);
    record((std::string(name) + "_opening_mm").c_str(), 1e3 * with(its + "opening")[0]);
    EXPECT_LT(std::abs(with(its + "compression")[0]), 0.2 * std::abs(without(its + "compression")[0])) << name;
    EXPECT_LT(with(its + "tension")[0], 0.3 * without(its + "tension")[0]) << name;
    EXPECT_LT(with(its + "opening")[0], -0.04) << name;  // warm rails close it
  }
}

}  // namespace traverse::test
