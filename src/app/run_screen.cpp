// The screen of a stock of bridges with a fleet of trains.
#include <fmt/format.h>

#include "analyses.hpp"
#include "run/process.hpp"
#include "screen/screen.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {

int check_screen(MPI_Comm comm, const Scene& scene) {
  print_notes(comm, scene, screen::description(screen::read_problem(scene)));
  return 0;
}

int run_screen(Job job) {
  const screen::Problem problem = screen::read_problem(job.scene);
  for (const std::string& line : screen::description(problem)) job.notes.push_back(line);
  for (const std::string& note : options::notes_on_unused(options::in_force())) job.notes.push_back(note);
  const std::vector<std::string>& pair = job.scene.screen->pair;
  if (pair.empty()) {
    print_notes(job.comm, job.scene, job.notes);
    return screen::run(job.comm, std::move(job.place), problem, job.notes);
  }
  const std::string text = screen::pair_scene(problem, pair[0], pair[1]);
  int rank = 0;
  MPI_Comm_rank(job.comm, &rank);
  if (rank == 0) fmt::print("{}", text);
  return 0;
}

}  // namespace traverse::app
