// A run in time, and its repetition if the linear vehicles or the selected time step were not accurate enough.
#include <fmt/format.h>

#include <optional>

#include "timed_run.hpp"

namespace traverse::app {
namespace {

constexpr int most_halvings = 4;  // limit of halvings of a selected time step

}  // namespace

int run_in_time(Job job) {
  const bool is_continued = job.earlier != nullptr;
  Scene scene = job.scene;
  Accuracy accuracy = job.accuracy;
  results::Repeated repeated = is_continued ? job.earlier->repeated : results::Repeated();
  std::optional<SharedBeam> own;
  if (repeated.with_mechanisms) {
    std::vector<std::string> ignored;
    scene.model.vehicles = VehicleModel::full;  // instead of linear vehicles
    own.emplace(job.comm, scene, ignored);
  }
  int halvings = is_continued || !scene.step_open ? 0 : most_halvings;
  SharedBeam& beam_of_first = own ? *own : job.beam;
  Job first{job.comm, scene, std::move(job.place), accuracy, beam_of_first, std::move(job.notes), job.earlier};
  RunEnd end = run_once(first, repeated, halvings > 0);
  while (end.again != Retry::none) {
    std::vector<std::string> notes;
    if (end.again == Retry::mechanisms) {
      scene.model.vehicles = VehicleModel::full;
      repeated.with_mechanisms = true;
      notes.push_back(fmt::format(
          "the residual of the linearised vehicles exceeded {:.1g} of their weights: the run is repeated with "
          "the mechanisms",
          scene.model.residual_limit));
    } else {
      --halvings;
      scene.model.step = 0.5 * end.step;
      accuracy.reject_all();
      notes.push_back(fmt::format("the run is repeated with steps of {:g} s, without error estimates: {}",
                                  *scene.model.step, end.why));
    }
    SharedBeam beam(job.comm, scene, notes);
    Job again{job.comm, scene, results::claim_place(job.comm, scene.output.file), accuracy, beam, std::move(notes)};
    end = run_once(again, repeated, halvings > 0);
  }
  return end.status;
}

}  // namespace traverse::app
