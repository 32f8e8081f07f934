// The screen of a stock of bridges with a fleet of trains.
#include <fmt/format.h>

#include <utility>

#include "analyses.hpp"
#include "results/terminal.hpp"
#include "run/process.hpp"
#include "screen/screen.hpp"
#include "screen/unusual.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {

int check_screen(MPI_Comm comm, const scene::Scene& scene) {
  const screen::Problem problem = screen::read_problem(scene);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank != 0) return 0;
  fmt::print("analysis\n");
  for (const std::string& line : screen::description(problem)) fmt::print("  {}\n", line);
  fmt::print("cost, estimated\n  memory of a rank       {:.3g} MB\n", 1e-6 * screen::memory_of(problem));
  fmt::print("unusual input\n");
  std::vector<std::string> unusual = scene.notes;
  for (std::string& line : screen::unusual_in(problem)) unusual.push_back(std::move(line));
  for (const std::string& line : unusual) fmt::print("  {}\n", line);
  if (unusual.empty()) fmt::print("  nothing\n");
  return 0;
}

int run_screen(Job job) {
  const screen::Problem problem = screen::read_problem(job.scene);
  for (const std::string& line : screen::description(problem)) job.notes.push_back(line);
  for (const std::string& note : options::notes_on_unused(*job.scene.given)) job.notes.push_back(note);
  if (job.scene.screen->pair.empty()) {
    const std::vector<std::string> unusual = screen::unusual_in(problem);
    results::print_unusual(unusual);
    run::print_notes(job.comm, job.scene, job.notes);
    job.notes.insert(job.notes.end(), unusual.begin(), unusual.end());
    return screen::run(job.comm, std::move(job.place), problem, job.notes);
  }
  const std::string text = screen::pair_scene(problem);
  int rank = 0;
  MPI_Comm_rank(job.comm, &rank);
  if (rank == 0) fmt::print("{}", text);
  return 0;
}

}  // namespace traverse::app
