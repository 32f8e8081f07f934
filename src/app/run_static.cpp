// Static analyses: the largest static effects of the scene's train and of load models over all their positions, and
// forces between rail and bridge along the track, UIC 774-3. Both give verdicts, a table on the terminal and a results
// file.
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "analyses.hpp"
#include "rail/track_bridge_interaction.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

/// Collective. Prints and stores the results of a static analysis. Found has the functions find(verdicts), print() and
/// record(recorder). Returns the exit status.
template <class Found>
int report_at_rest(Job& job, const Found& found) {
  const scene::Scene& scene = job.scene;
  std::vector<results::Verdict> verdicts;
  for (const options::VerdictLimit& limit : scene.limits)
    verdicts.push_back({limit, std::string(options::limit_quantity(limit.quantity)->unit), {}, 1, 0});
  found.find(verdicts);
  int rank = 0;
  MPI_Comm_rank(job.comm, &rank);
  if (rank == 0) {
    found.print();
    results::print_verdicts(verdicts, scene.unusual);
  }
  if (scene.output.file.empty()) return 0;
  const run::DeferredSignals noted;  // signals are delayed until the file is complete
  results::Layout layout;
  layout.constants = run::stations({}, job.beam.beam->mesh().span_ends());
  results::Recorder recorder(job.comm, std::move(job.place), layout, run::attributes(job.comm, scene), scene.options);
  run::record_model(scene, job.notes, recorder);
  found.record(recorder);
  results::record_verdicts(recorder, verdicts);
  recorder.finish_with({{"ended", "reached its end"}});
  if (rank == 0) fmt::print("results  {}\n", scene.output.file);
  return 0;
}

}  // namespace

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

int run_rail(Job job) {
  for (const std::string& note : options::notes_on_unused(*job.scene.given)) job.notes.push_back(note);
  run::print_notes(job.comm, job.scene, job.notes);
  return report_at_rest(job, rail::RailForces(*job.scene.beam, *job.scene.rail_loads));
}

}  // namespace traverse::app
