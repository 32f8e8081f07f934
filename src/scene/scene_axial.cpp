// Decides whether the beam has axial unknowns, which it needs if something in the scene acts along it.
#include <fmt/format.h>

#include <algorithm>

#include "base/notes.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

bool acts_along_x(const options::Options& o, const std::string& actuator) {
  return o.has(actuator + "_table") || o.numbers(actuator + "_force").front() != 0.0;
}

/// The option of a layered track that acts only along x; empty if there is none.
std::string option_along_the_track(const options::Options& o, const Scene& scene) {
  if (!scene.beam->track) return "";
  if (o.number("track_rail_temperature") != 0.0) return "track_rail_temperature";
  if (scene.beam->track->slides()) return "track_longitudinal_limit";
  if (!scene.beam->track->expansion_devices.empty()) return "track_rail_expansion_devices";
  return "";
}

/// A description of the action along the beam; empty if there is none. The horizontal components of normal forces on an
/// inclined surface are neglected.
std::string longitudinal_action(const options::Options& o, const Scene& scene) {
  const beam::Foundation& foundation = scene.beam->foundation;
  if (present(foundation, beam::Direction::longitudinal)) return "longitudinal foundations";
  if (scene.beam->temperature && scene.beam->temperature->strain() != 0.0) return "temperature";
  if (o.has("support_motion_along")) return "support_motion_along";
  if (!option_along_the_track(o, scene).empty()) return "the track's resistance along x";
  if (scene.beam->gradient != 0.0 && (scene.self_weight || !scene.vehicles.empty())) return "track_gradient";
  if (scene.analysis == Analysis::rail_forces) return "the requested rail forces";
  if (scene.analysis == Analysis::modes) return "the requested modes";
  const auto& courses = scene.train.courses;
  const bool speed_changes =
      std::any_of(courses.begin(), courses.end(), [](const train::Course& c) { return !c.speed.constant(); });
  for (const Vehicle& vehicle : scene.vehicles) {
    const bool rolls = !vehicle.wheels.empty();
    if (rolls && scene.train.drive == Drive::free) return "train_drive free";
    if (rolls && speed_changes) return "trains whose speed changes";
    for (const Wheel& wheel : vehicle.wheels) {
      if (wheel.law.friction > 0.0) return "friction of wheels";
    }
    for (const multibody::Actuator& actuator : vehicle.mechanism.actuators) {
      if (rolls && acts_along_x(o, "vehicle_" + vehicle.name + "_" + actuator.name)) return "actuators along x";
    }
  }
  return "";
}

}  // namespace

void decide_axial(const options::Options& o, Scene& scene) {
  if (!scene.beam || scene.beam->given) return;
  const std::string setting = o.choice("model_axial");
  std::string missing;
  if (!o.has("beam_EA")) missing = "beam_EA";
  for (const char* name : {"track_rail_EA", "track_longitudinal_k"}) {
    if (scene.beam->track && !o.has(name)) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  const bool stiffness = missing.empty();
  const bool axial_strain = scene.beam->temperature && scene.beam->temperature->strain() != 0.0;
  if (axial_strain && (!stiffness || setting == "false"))
    o.refuse("beam_temperature_uniform", stiffness ? "causes axial strain; allowed with it: model_axial auto or true"
                                                   : "causes axial strain, which needs " + missing);
  if (o.has("support_motion_along") && (!stiffness || setting == "false"))
    o.refuse("support_motion_along", stiffness ? "acts along x; allowed with it: model_axial auto or true"
                                               : "acts along x, which needs " + missing);
  if (setting == "true" && !stiffness) o.refuse("model_axial", "needs " + missing);
  if (const std::string along = option_along_the_track(o, scene); !along.empty() && (!stiffness || setting == "false"))
    o.refuse(along, stiffness ? "acts along x; allowed with it: model_axial auto or true"
                              : "acts along x, which needs " + missing);
  if (setting != "auto") {
    scene.beam->axial = setting == "true";
    scene.notes.push_back(
        base::detail(fmt::format("axial unknowns: {}, as requested", scene.beam->axial ? "modelled" : "none")));
    return;
  }
  const beam::Foundation& foundation = scene.beam->foundation;
  if (!stiffness && present(foundation, beam::Direction::longitudinal)) {
    const options::Entry* entry = o.first_with_prefix("foundation_longitudinal");
    o.refuse(entry->name, "longitudinal foundations need " + missing);
  }
  const std::string action = longitudinal_action(o, scene);
  scene.beam->axial = stiffness && !action.empty();
  if (scene.beam->axial) {
    scene.notes.push_back(base::detail("axial unknowns: modelled, because of " + action));
  } else if (action.empty()) {
    scene.notes.push_back(base::detail("axial unknowns: none, nothing acts along the beam"));
  } else {
    scene.notes.push_back(fmt::format("axial unknowns: none, {} not given ({} would use them)", missing, action));
  }
}

}  // namespace traverse::scene
