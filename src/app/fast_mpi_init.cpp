// Sets environment variables of Open MPI and hwloc that shorten MPI_Init for a single process.
#include "fast_mpi_init.hpp"

#include <cstdlib>

namespace traverse::app {
namespace {

constexpr const char* no_session_folder = "OMPI_MCA_orte_create_session_dirs";

}  // namespace

// Without mpirun the initialisation of Open MPI needs 0.3 s, unless it is set to a single process; programs that start
// at the same time would compete for its session folder. The search for displays as accelerators is disabled too.
void start_lightly() {
  setenv("HWLOC_COMPONENTS", "-gl,-opencl", 0);
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) return;
  setenv(no_session_folder, "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
  setenv("OMPI_MCA_btl", "self", 1);  // without shared memory
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
}

void started() { unsetenv(no_session_folder); }

}  // namespace traverse::app
