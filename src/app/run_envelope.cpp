// The largest static effects of the scene's train and of load models over all their positions.
#include "analyses.hpp"
#include "run/norm_run.hpp"
#include "static_report.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {

int run_envelope(Job job) {
  const scene::Scene& scene = job.scene;
  run::SharedBeam& shared = job.beam;
  shared.damp(scene, false, job.notes);
  if (!scene.vehicles.empty()) shared.prepare(scene, job.notes);
  for (const std::string& note : options::notes_on_unused(*scene.given)) job.notes.push_back(note);
  run::print_notes(job.comm, scene, job.notes);
  const norm::NormCheck check = run::norm_check(scene, run::static_trains(scene, shared));
  if (check.effects().loads.empty())
    throw InputError(
        "scene_analysis: there is nothing to envelop; allowed: load_forces, train_vehicles, norm_load_models");
  return report_at_rest(job, check);
}

}  // namespace traverse::app
