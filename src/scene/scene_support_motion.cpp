// Reads the motion of the supports over time, and refuses what does not go with it.
#include <fmt/format.h>

#include <algorithm>

#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

/// The displacements of the columns of a file.
std::vector<base::TimeFunction> displacements(const options::Options& o, const std::string& file,
                                              std::size_t supports) {
  const bool integrated = o.choice("support_motion_values") == "acceleration";
  const options::WantedColumns wanted = {2, supports + 1, options::Order::rising, integrated ? "s, m/s2" : "s, m"};
  return from_table(o, file, wanted, [&](const auto& columns) {
    if (columns.size() != 2 && columns.size() != supports + 1)
      throw InputError("allowed: a time and one column, or one for each span end");
    std::vector<base::TimeFunction> all;
    for (std::size_t i = 0; i < supports; ++i) {
      const std::vector<double>& values = columns[columns.size() == 2 ? 1 : i + 1];
      all.push_back(integrated ? base::TimeFunction::second_integral(columns[0], values)
                               : base::TimeFunction(columns[0], values));
    }
    return all;
  });
}

/// Refuses what does not go with moving supports.
void check_motion(const options::Options& o, const std::string& file, const Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  const auto on_ground =
      [&](const beam::FoundationKind& kind) {  // a tension is a rotational bed, but not on the ground
        const bool tension = kind.bed == &beam::Foundation::rotational_bed && o.has("beam_tension");
        return beam::present(beam.foundation, kind) && !tension;
      };
  if (beam.track || std::ranges::any_of(beam::foundation_kinds, on_ground))
    o.refuse(file, "is not allowed with a foundation or a layered track, whose ground would move too");
  if (scene.model.modes > 0) o.refuse(file, "needs elements; allowed: model_modes 0");
}

void check_motion_along(const options::Options& o, const std::string& file, const Scene& scene) {
  if (!std::ranges::any_of(scene.beam->supports, beam::fixes_axial))
    o.refuse(file, "needs a support that holds the beam along x (support_types)");
  const auto has_friction = [](const Vehicle& vehicle) {
    return std::ranges::any_of(vehicle.wheels, [](const Wheel& wheel) { return wheel.law.friction > 0.0; });
  };
  if (scene.train.drive == Drive::free || std::ranges::any_of(scene.vehicles, has_friction))
    o.refuse(
        file,
        "is not allowed with train_drive free or wheels with friction, on which the ground beside the bridge would "
        "act along x");
}

void read_motion(const options::Options& o, Scene& scene) {
  const std::string upward = "support_motion", along = "support_motion_along";
  if (!o.has(upward) && !o.has(along)) return;
  check_motion(o, o.has(upward) ? upward : along, scene);
  const std::vector<beam::Support>& supports = scene.beam->supports;
  if (o.has(upward)) {
    if (!std::ranges::all_of(supports, beam::fixes_vertical))
      o.refuse(upward,
               "needs supports that hold the beam vertically at every span end (support_types, support_stiffness)");
    scene.support_motion = displacements(o, upward, supports.size());
  }
  if (o.has(along)) {
    check_motion_along(o, along, scene);
    scene.support_motion_along = displacements(o, along, supports.size());
  }
  scene.modes_open = false;
}

}  // namespace

void read_support_motion(const options::Options& o, Scene& scene) {
  read_motion(o, scene);
  const bool has_peaks = scene.analysis == Analysis::transient || scene.analysis == Analysis::static_response;
  if (has_peaks && scene.supports_displaced())
    scene.notes.push_back(
        fmt::format("the supports {}: greatest deflections, their limits, envelopes and amplifications are relative to "
                    "the straight lines between the supports",
                    scene.support_motion.empty() ? "have settled" : "move"));
}

}  // namespace traverse::scene
