// Output of static analyses: verdicts, a table on the terminal, the results file.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "analyses.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "run/model_record.hpp"
#include "run/outputs.hpp"
#include "run/process.hpp"

namespace traverse::app {

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

}  // namespace traverse::app
