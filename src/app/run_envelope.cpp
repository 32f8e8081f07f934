// The largest static effects of the scene's train and of load models, wherever they stand.
#include <fmt/format.h>

#include "analyses.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "run/model_record.hpp"
#include "run/norm_run.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/signals.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {

int run_envelope(Job job) {
  const MPI_Comm comm = job.comm;
  const Scene& scene = job.scene;
  SharedBeam& shared = job.beam;
  shared.damp(scene, false, job.notes);
  if (!scene.vehicles.empty()) shared.prepare(scene, job.notes);
  for (const std::string& note : options::check_all_used(options::in_force())) job.notes.push_back(note);
  print_notes(comm, job.notes);
  const norm::NormCheck check = norm_check(scene, trains_at_rest(scene, shared));
  if (check.effects().loads.empty())
    throw InputError(
        "scene_analysis: there is nothing to envelop; allowed: load_forces, train_vehicles, norm_load_models");
  std::vector<results::Verdict> verdicts;
  for (const options::VerdictLimit& limit : scene.limits)
    verdicts.push_back({limit, std::string(options::limit_quantity(limit.quantity)->unit), {}, 1, 0});
  check.find(verdicts);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) {
    check.print();
    results::print_verdicts(verdicts);
  }
  if (scene.output.file.empty()) return 0;
  const SignalsNoted noted;  // a moment, and the file is complete
  results::Layout layout;
  layout.constants = stations({}, shared.beam->mesh().span_ends());
  results::Recorder recorder(comm, std::move(job.place), layout, attributes(comm, scene), scene.options);
  record_model(scene, job.notes, recorder);
  check.record(recorder);
  results::record_verdicts(recorder, verdicts);
  recorder.finish_with({{"ended", "reached its end"}});
  if (rank == 0) fmt::print("results  {}\n", scene.output.file);
  return 0;
}

}  // namespace traverse::app
