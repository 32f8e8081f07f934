// Forces between rail and bridge along the track, UIC 774-3.
#include <fmt/format.h>

#include "analyses.hpp"
#include "rail/rail_forces.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "run/model_record.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"
#include "run/signals.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {

int run_rail(Job job) {
  const MPI_Comm comm = job.comm;
  const Scene& scene = job.scene;
  for (const std::string& note : options::check_all_used(options::in_force())) job.notes.push_back(note);
  print_notes(comm, job.notes);
  const SignalsNoted noted;  // seconds, and the file is complete
  const rail::RailForces forces(*scene.beam, *scene.rail_loads);
  std::vector<results::Verdict> verdicts;
  for (const options::VerdictLimit& limit : scene.limits)
    verdicts.push_back({limit, std::string(options::limit_quantity(limit.quantity)->unit), {}, 1, 0});
  forces.find(verdicts);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) {
    forces.print();
    results::print_verdicts(verdicts);
  }
  if (scene.output.file.empty()) return 0;
  results::Layout layout;
  layout.constants = stations({}, job.beam.beam->mesh().span_ends());
  results::Recorder recorder(comm, std::move(job.place), layout, attributes(comm, scene), scene.options);
  record_model(scene, job.notes, recorder);
  forces.record(recorder);
  results::record_verdicts(recorder, verdicts);
  recorder.finish_with({{"ended", "reached its end"}});
  if (rank == 0) fmt::print("results  {}\n", scene.output.file);
  return 0;
}

}  // namespace traverse::app
