// Compares the runner of one point of each factor with that of the nominal point.
#include "study/local_steps.hpp"

#include "base/sampling_design.hpp"

namespace traverse::study {

void reduce_local_steps(StudyScenes& scenes) {
  options::Study study = scenes.study();
  if (!study.sensitivity || study.sensitivity->method != options::Sensitivity::Method::local) return;
  const StudyScenes::Runner nominal = scenes.runner(0);
  if (!nominal.runs->has_lanes()) return;
  const std::size_t axis = study.sensitivity->axis;
  const auto base_of = [&](std::size_t point) {
    std::size_t run = 0;
    while (scenes.study().place(run, axis) != point) ++run;
    return scenes.runs()[run].base;
  };
  std::size_t point = 1;  // the first point of the factor
  for (options::StudyDimension& d : study.dimensions) {
    if (d.axis != axis) continue;
    if (StudyScenes::compatible(scenes.runner(base_of(point)), nominal))
      for (double& value : d.values)
        value = d.values.front() + (value - d.values.front()) * base::batch_step / base::local_step;
    point += base::local_points_per_factor;
  }
  scenes.enumerate(study);
}

}  // namespace traverse::study
