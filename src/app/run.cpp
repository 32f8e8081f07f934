#include "traverse/app/run.hpp"

#include "analyses.hpp"
#include "results/stage.hpp"
#include "study/lanes_choice.hpp"
#include "study/study.hpp"

namespace traverse::app {

namespace {

/// Fills in what is open of the scene's model, as the accuracy asks.
Accuracy choose_model(MPI_Comm comm, Scene& scene, std::vector<std::string>& notes) {
  const std::optional<LanesChoice> lanes = lanes_for_one(scene, notes);
  if (!lanes) return choose(comm, scene, notes);
  scene = lanes->scene;
  Accuracy accuracy;
  accuracy.measured = true;
  for (std::size_t q = 0; q < quantities; ++q) accuracy.promises[q] = {true, true, lanes->errors[q], ""};
  return accuracy;
}

}  // namespace

int run(MPI_Comm comm, const Scene& given) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const results::Heartbeat heartbeat(given.quiet || rank != 0);
  results::Place place = results::claim_place(comm, given.output.file);
  if (given.sweep) return run_sweep(comm, given, std::move(place));
  Scene scene = given;
  std::vector<std::string> notes;
  const Accuracy accuracy = choose_model(comm, scene, notes);
  SharedBeam shared(comm, scene, notes);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  return run_of(scene.analysis)->run({comm, scene, std::move(place), accuracy, shared, std::move(notes)});
}

}  // namespace traverse::app
