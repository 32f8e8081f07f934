// What MPI is told before it starts, so that a single process starts in no time.
#pragma once

namespace traverse::app {

/// Before MPI starts: sets what is not set in the environment.
void start_lightly();
/// After that: takes back what would keep mpirun from working when this process starts it.
void started();

}  // namespace traverse::app
