// Reads the motion of the supports over time, and refuses what does not go with it.
#include <algorithm>

#include "options/data_file.hpp"
#include "scene_parts.hpp"
#include "traverse/base/error.hpp"

namespace traverse::app {
namespace {

constexpr const char* motion_file = "support_motion";

/// The displacements of the columns of the file.
std::vector<base::TimeFunction> displacements(const options::Options& o, std::size_t supports) {
  const bool integrated = o.choice("support_motion_values") == "acceleration";
  try {
    const auto columns = options::read_columns(o.path(motion_file), 2, supports + 1, options::Order::rising);
    if (columns.size() != 2 && columns.size() != supports + 1)
      throw InputError("allowed: a time and one column, or one for each span end");
    std::vector<base::TimeFunction> all;
    for (std::size_t i = 0; i < supports; ++i) {
      const std::vector<double>& values = columns[columns.size() == 2 ? 1 : i + 1];
      all.push_back(integrated ? base::TimeFunction::second_integral(columns[0], values)
                               : base::TimeFunction(columns[0], values));
    }
    return all;
  } catch (const InputError& error) {
    o.refuse(motion_file, error.what());
  }
}

}  // namespace

void read_support_motion(const options::Options& o, Scene& scene) {
  if (!o.has(motion_file)) {
    if (o.has("support_motion_values")) o.refuse("support_motion_values", "needs support_motion");
    return;
  }
  if (!scene.beam || scene.by_given_modes()) o.refuse(motion_file, "needs a beam with supports (beam_spans)");
  const beam::BeamModel& beam = *scene.beam;
  if (scene.analysis != Analysis::transient) o.refuse(motion_file, "is for transient runs only (scene_analysis)");
  const auto on_ground =
      [&](const beam::FoundationKind& kind) {  // a tension is a rotational bed, but not on the ground
        const bool tension = kind.bed == &beam::Foundation::rotational_bed && o.has("beam_tension");
        return beam::present(beam.foundation, kind) && !tension;
      };
  if (beam.track || std::ranges::any_of(beam::foundation_kinds, on_ground))
    o.refuse(motion_file, "is not allowed with a foundation or a layered track, whose ground would move too");
  if (scene.model.modes > 0) o.refuse(motion_file, "needs elements; allowed: model_modes 0");
  if (scene.sweep) o.refuse(motion_file, "is for single runs; allowed in studies, one by one, without sweep options");
  if (!std::ranges::all_of(beam.supports, beam::fixes_vertical))
    o.refuse(motion_file,
             "needs supports that hold the beam vertically at every span end (support_types, support_stiffness)");
  scene.support_motion = displacements(o, beam.supports.size());
  scene.modes_open = false;
}

}  // namespace traverse::app
