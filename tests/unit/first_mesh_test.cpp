// Meshes that trial runs begin with have nodes where springs hold the beam, however many these are.
#include <gtest/gtest.h>

#include <string>

#include "error_control/accuracy.hpp"
#include "error_control/trial_runs.hpp"
#include "scene_helpers.hpp"

namespace traverse::error_control {
namespace {

/// A rail on pads that are 0.6 m apart, of which there are `count`.
scene::Scene rail_on_pads(int count) {
  const std::string length = std::to_string(0.6 * count), last = std::to_string(0.6 * count - 0.3);
  return scene::scene_of("beam: {spans: " + length +
                         ", EI: 1.32e7, mass: 121.0}\n"
                         "support: {types: free}\n"
                         "foundation: {vertical: {x: [0.3, " +
                         last +
                         "], spacing: 0.6, k: 2.81e7, c: 1.6e4}}\n"
                         "load: {forces: 1.0e5, positions: 3.0, speed: 50.0}\n"
                         "output: {probes: " +
                         last + "}\n");
}

TEST(FirstMesh, MeetsThePads) {
  for (const int count : {20, 100, 300}) {
    scene::Scene scene = rail_on_pads(count);
    ASSERT_TRUE(scene.mesh_open);
    set_first_mesh(scene);
    EXPECT_TRUE(aligned(scene, mesh_of(scene))) << count << " pads, " << mesh_of(scene) << " elements";
    EXPECT_FALSE(aligned(scene, 2 * count + 2)) << count;
    EXPECT_TRUE(aligned(scene, 2 * mesh_of(scene))) << count;  // as trial runs double it
  }
}

}  // namespace
}  // namespace traverse::error_control
