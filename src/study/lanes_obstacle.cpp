// What of a scene keeps its runs from going side by side.
#include "study/lanes_obstacle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "integrate/integrator_choice.hpp"

namespace traverse::app {
namespace {

constexpr double no_step = 1e-9;  // of the shapes' largest values: surfaces that meet without a step

/// Whether wheels come onto the bridge, go on from span to span, and leave it without a step.
bool level(const structure::ModalBridge& bridge) {
  const structure::PiecewiseCubic& influence = bridge.influence();
  double largest = 0.0, step = 0.0;
  std::vector<double> before(bridge.modes(), 0.0);  // at the end of the piece on the left
  for (std::size_t piece = 0; piece < influence.pieces(); ++piece) {
    const double length = influence.breaks[piece + 1] - influence.breaks[piece];
    for (std::size_t i = 0; i < bridge.modes(); ++i) {
      const double* c = &influence.coefficients[4 * influence.channels * piece + i];
      const std::size_t n = influence.channels;
      const double left = c[0], right = c[0] + length * (c[n] + length * (c[2 * n] + length * c[3 * n]));
      largest = std::max({largest, std::abs(left), std::abs(right)});
      step = std::max(step, std::abs(left - before[i]));
      before[i] = right;
    }
  }
  for (const double right : before) step = std::max(step, std::abs(right));
  return step <= no_step * largest;
}

}  // namespace

std::string lanes_obstacle(const Scene& scene, const SharedBeam& shared) {
  if (!shared.modal) return "the bridge is taken by its elements, not by modes";
  if (scene.vehicles.empty()) return "no vehicles run";
  if (!scene.load.forces.empty()) return "forces move beside the vehicles";
  if (scene.vehicle_model != VehicleModel::linear) return "vehicles are mechanisms, not linear";
  if (scene.train.drive != Drive::constant) return "the train's speed is not prescribed";
  if (!scene.train.courses.empty()) return "several trains run, or one whose speed changes or is below 0";
  if (scene.start != Start::equilibrium) return "runs do not start in equilibrium";
  if (scene.self_weight) return "the bridge's own weight bends it";
  if (scene.beam->strained()) return "temperature or settlements bend the bridge";
  if (!integrate::own_method(scene.integrator)) return "ts_type is one of PETSc's own";
  if (!scene.time_step) return "the step is not known";
  if (!scene.output.passages.empty()) return "steps end where wheels pass the places of output_passages";
  if (scene.beam->ground != std::array{true, true}) return "the running surface ends with the bridge";
  return level(*shared.modal) ? "" : "wheels meet steps of the surface, where the bridge's ends or joints yield";
}

}  // namespace traverse::app
