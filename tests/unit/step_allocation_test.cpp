// Once a run is under way its steps take no memory from the heap, as long as no wheel enters another element.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "integrate/stepper.hpp"
#include "run/outputs.hpp"
#include "run/passage.hpp"
#include "support/counted_memory.hpp"
#include "support/folders.hpp"
#include "traverse/options/input.hpp"
#include "traverse/scene/scene.hpp"

#ifdef TRAVERSE_COUNTS_MEMORY

namespace traverse::integrate {
namespace {

using Words = std::vector<std::string>;

const std::string folder = source_folder() + "/options/";

Words quarter_car_on_a_span() {
  return {"-options_file",
          folder + "scenes/r4_hertz_wheel.yml",
          "-beam_elements_per_span",
          "10",
          "-train_positions",
          "11.0",
          "-train_speed",
          "2.0"};
}

Words coaches_on_a_continuous_bridge() {
  return {"-beam_spans",
          "32.0*4",
          "-beam_elements_per_span",
          "10",
          "-beam_EI",
          "3.795e11",
          "-beam_mass",
          "3.0e4",
          "-support_types",
          "roller",
          "-vehicle_coach_file",
          folder + "vehicles/s300.yml",
          "-train_vehicles",
          "coach*4",
          "-train_positions",
          "100.3",
          "-train_spacing",
          "25.0",
          "-train_speed",
          "2.0"};
}

scene::Scene scene_of(Words words) {
  words.insert(words.begin(), "traverse");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  base::check(PetscOptionsClear(nullptr));
  options::Input input = options::read_input(static_cast<int>(argv.size()), argv.data());
  options::put_into_petsc(input);
  return scene::read_scene();
}

/// Modes that a damper couples.
Words coaches_on_a_damped_bridge() {
  Words words = coaches_on_a_continuous_bridge();
  for (const char* word : {"-foundation_vertical_x", "48.0", "-foundation_vertical_c", "3e6", "-model_modes", "20"})
    words.emplace_back(word);
  return words;
}

/// What 50 steps of 1 ms allocate after 20 that warm up.
long allocations_of_steps(const Words& scene_words, const std::string& type, const std::string& adapt = "none") {
  Words words = {"-ts_max_time", "0.1", "-ts_type", type, "-ts_adapt_type", adapt};
  words.insert(words.end(), scene_words.begin(), scene_words.end());
  const scene::Scene scene = scene_of(words);
  std::vector<std::string> notes;
  run::SharedBeam shared(PETSC_COMM_SELF, scene, notes);
  shared.beam->set_rayleigh({0.5, 5e-4});
  shared.prepare(scene, notes);
  const coupling::SystemInput input = run::system_input(scene, false);
  coupling::System system(PETSC_COMM_SELF, run::carrier(scene, shared, input), input);
  Stepper stepper(system, {0.1, 1e-3, 0.1, {}, 1e-6});
  double* y = stepper.state();
  (void)system.start(true, y);
  if (scene.model.vehicles == scene::VehicleModel::linear) (void)system.linearise_vehicles(y);
  stepper.restore_state(&y);
  long before = 0, after = 0;
  stepper.run([](const Instant&) {},
              [&](double, long steps) {
                if (steps == 20) before = allocations;
                if (steps == 70) after = allocations;
                return steps < 70;
              });
  EXPECT_GT(before, 0);  // the counting works
  return after - before;
}

TEST(Steps, OfAQuarterCarTakeNoMemory) {
  for (const char* type : {"esdirk4", "genalpha"})
    EXPECT_EQ(allocations_of_steps(quarter_car_on_a_span(), type), 0) << type;
}

TEST(Steps, JudgedByTheirErrorsTakeNoMemory) {
  EXPECT_EQ(allocations_of_steps(quarter_car_on_a_span(), "esdirk4", "ladder"), 0);
  EXPECT_EQ(allocations_of_steps(coaches_on_a_continuous_bridge(), "esdirk4", "ladder"), 0);
}

TEST(Steps, OfATrainTakeNoMemory) {
  for (const char* type : {"esdirk4", "genalpha"})
    EXPECT_EQ(allocations_of_steps(coaches_on_a_continuous_bridge(), type), 0) << type;
}

TEST(Steps, OnABridgeWhoseModesAreCoupledTakeNoMemory) {
  for (const char* type : {"esdirk4", "genalpha"})
    EXPECT_EQ(allocations_of_steps(coaches_on_a_damped_bridge(), type), 0) << type;
}

TEST(Steps, OfLinearVehiclesTakeNoMemory) {
  Words scene = coaches_on_a_continuous_bridge();
  scene.insert(scene.end(), {"-model_vehicles", "linear"});
  for (const char* type : {"esdirk4", "genalpha"}) {
    EXPECT_EQ(allocations_of_steps(scene, type), 0) << type;
  }
}

TEST(Steps, OverSpansApartTakeNoMemory) {
  Words scene = coaches_on_a_continuous_bridge();
  scene.insert(scene.end(), {"-model_vehicles", "linear", "-beam_continuity", "simply_supported"});
  for (const char* type : {"esdirk4", "genalpha"}) EXPECT_EQ(allocations_of_steps(scene, type), 0) << type;
}

TEST(Steps, OverModesTakeNoMemory) {
  Words scene = coaches_on_a_continuous_bridge();
  scene.insert(scene.end(), {"-model_vehicles", "linear", "-model_modes", "12", "-ts_dt", "1e-3"});
  for (const char* type : {"esdirk4", "genalpha"}) EXPECT_EQ(allocations_of_steps(scene, type), 0) << type;
}

// All that a results file holds of a train on a bridge, at one instant.
TEST(Outputs, TakeNoMemoryOnceTheirSampleIsThere) {
  const scene::Scene scene = scene_of(coaches_on_a_continuous_bridge());
  std::vector<std::string> notes;
  run::SharedBeam shared(PETSC_COMM_SELF, scene, notes);
  shared.damp(scene, false, notes);
  shared.prepare(scene, notes);
  run::Passage passage(scene, shared, notes);
  passage.start(notes);
  const run::Outputs outputs = run::outputs_of({scene, passage.system().fleet(), shared.bridge()});
  run::Observed now;
  now.probes.resize(scene.output.probes.size());
  now.supports.resize(scene.beam->spans.size() + 1);
  now.ground.emplace(*shared.beam);
  std::vector<double> values;
  outputs.fill(now, values);
  EXPECT_EQ(values.size(), outputs.layout().width());
  EXPECT_GT(values.size(), 400U);
  const long before = allocations;
  outputs.fill(now, values);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace traverse::integrate

#endif
