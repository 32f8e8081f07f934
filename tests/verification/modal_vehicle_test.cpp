// Vehicles on a bridge by its modes (model_modes with a train): against the same bridge by its elements.
#include <gtest/gtest.h>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

// Two coaches over three continuous spans, by few elements and with long samples.
const Values coaches = {{"train_vehicles", "coach*2"}, {"beam_elements_per_span", "8"}, {"ts_dt", "5e-4"},
                        {"output_interval", "5e-3"},   {"ts_max_time", "2.2"},          {"output_probes", "20,52,88"}};
const double axle_load = 152055.0;  // N, of options/vehicles/velaro.yml

Results run(const Values& options) { return run_scene("three_span_train", coaches + options); }

const Values all_modes = {{"model_modes", "1000"}};

void expect_equal(Results& modal, Results& full, double bound) {
  for (const char* name : {"/probes/deflection", "/probes/velocity", "/supports/reaction",
                           "/vehicles/0/wheel_1/normal_force", "/vehicles/1/car/position"}) {
    const double difference = relative_difference(modal(name), full(name));
    testing::Test::RecordProperty(name + 1, text(difference));
    EXPECT_LT(difference, bound) << name;
  }
  // By elements it is integrated by another rule.
  EXPECT_LT(relative_difference(modal("/energy/dissipated"), full("/energy/dissipated")), 2e-5);
}

// All modes of the mesh are the mesh, whatever steps it: under the bridge's own weight, with forces beside the train,
// by every kind of integrator.
TEST(ModalVehicle, AllModesAgainstTheElements) {
  const Values forces = {
      {"beam_self_weight", "true"}, {"load_forces", "1e5"}, {"load_positions", "-3"}, {"load_speed", "50"}};
  for (const Values& options : {Values{}, forces, Values{{"ts_type", "genalpha"}}, Values{{"ts_type", "arkimex"}}}) {
    SCOPED_TRACE(options.empty() ? "esdirk4" : options.begin()->second);
    Results full = run(options);
    Results modal = run(options + all_modes);
    expect_equal(modal, full, 1e-7);
  }
}

// Contacts that are lost and gained: steps are taken back.
TEST(ModalVehicle, LosesContactAndGainsItAgain) {
  const Values bump = {{"track_profile", "bump"},
                       {"track_bump_start", "35"},
                       {"track_bump_length", "2"},
                       {"track_bump_height", "0.02"},
                       {"ts_max_time", "1.0"}};
  Results full = run(bump);
  Results modal = run(bump + all_modes);
  EXPECT_GT(full.attribute("/summary", "contact_losses"), 0.0);
  EXPECT_EQ(modal.attribute("/summary", "contact_losses"), full.attribute("/summary", "contact_losses"));
  EXPECT_LT(relative_difference(modal("/probes/deflection"), full("/probes/deflection")), 1e-6);
}

// Ten modes, up to 62 Hz, and the others static: all forces balance, and no energy comes from nowhere.
TEST(ModalVehicle, StaticCorrection) {
  Results full = run({});
  Results modal = run({{"model_modes", "10"}});
  for (const auto& [name, bound] :
       {std::pair("/probes/deflection", 1e-3), {"/probes/moment", 1e-2}, {"/vehicles/0/wheel_1/normal_force", 5e-3}}) {
    const double difference = relative_difference(modal(name), full(name));
    testing::Test::RecordProperty(name + 1, text(difference));
    EXPECT_LT(difference, bound) << name;
  }
  EXPECT_LT(std::abs(peak(modal("/balance/residual")).first), 1e-9 * 8.0 * axle_load);
  EXPECT_LT(energy_error(modal), 1e-8);
}

// A damping ratio of the modes themselves acts like inertia, which the balance counts.
TEST(ModalVehicle, DampingOfEachMode) {
  const std::string scene =
      "beam: {spans: [32, 40, 32], EI: 3.795e11, mass: 3e4, self_weight: true}\n"
      "support: {types: [pinned, roller, roller, roller]}\n"
      "model: {modes: 10, damping_ratios: 0.03}\ntrain: {speed: 83.333}\n"
      "vehicle: {coach: {file: " +
      source_folder() + "/options/vehicles/velaro.yml}}\n";
  Results damped = run_yaml(scene, coaches);
  EXPECT_LT(std::abs(peak(damped("/balance/residual")).first), 1e-9 * 8.0 * axle_load);
  EXPECT_LT(energy_error(damped), 1e-8);
}

}  // namespace
}  // namespace traverse::test
