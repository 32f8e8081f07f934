// Forces between rail and bridge along the track, UIC 774-3.
#include "analyses.hpp"
#include "rail/track_bridge_interaction.hpp"
#include "static_report.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {

int run_rail(Job job) {
  for (const std::string& note : options::notes_on_unused(*job.scene.given)) job.notes.push_back(note);
  run::print_notes(job.comm, job.scene, job.notes);
  return report_at_rest(job, rail::RailForces(*job.scene.beam, *job.scene.rail_loads));
}

}  // namespace traverse::app
