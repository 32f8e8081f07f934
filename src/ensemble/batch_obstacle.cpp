// Conditions of a scene that prevent batched runs.
#include "ensemble/batch_obstacle.hpp"

#include <array>

#include "engine/batch.hpp"
#include "integrate/integrator_choice.hpp"

namespace traverse::app {
std::string batch_obstacle(const Scene& scene, const SharedBeam& shared) {
  if (scene.beam->gradient != 0.0) return "the track is inclined";
  if (scene.supports_move()) return "the supports move";
  if (scene.vehicles.empty()) return "the scene has no vehicles";
  if (!(scene.train.speed > 0.0)) return "the train stands";
  if (!scene.load.forces.empty()) return "forces move in addition to the vehicles";
  if (scene.model.vehicles != VehicleModel::linear) return "vehicles are mechanisms, not linear";
  if (scene.train.drive != Drive::constant) return "the train's speed is not prescribed";
  if (!scene.train.courses.empty()) return "several trains run, or one whose speed changes or is below 0";
  if (scene.start != Start::equilibrium) return "runs do not start in equilibrium";
  if (!integrate::own_method(scene.model.method)) return "ts_type is one of PETSc's own";
  if (!scene.model.step) return "the step is not known";
  if (!scene.output.passages.empty()) return "steps end where wheels pass the places of output_passages";
  if (scene.beam->ground != std::array{true, true}) return "the running surface ends with the bridge";
  return engine::BatchStructure::obstacle(*shared.beam, shared.modal ? &*shared.modal : nullptr);
}

}  // namespace traverse::app
