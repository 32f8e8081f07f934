// The main of every test program that uses PETSc: GoogleTest between SlepcInitialize and SlepcFinalize, on any
// number of ranks. A test has passed only when it has passed on every rank.

#include <gtest/gtest.h>
#include <mpi.h>
#include <slepcsys.h>

#include <cstdlib>
#include <cstring>

namespace {

// Start-up takes 50 ms instead of 300 when Open MPI neither looks for networks and displays nor starts a daemon.
void start_quickly() {
  setenv("OMPI_MCA_pml", "ob1", 0);
  setenv("OMPI_MCA_btl", "self,vader", 0);
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("HWLOC_COMPONENTS", "-gl,-opencl", 0);
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--gtest_list_tests") == 0) {  // asked by the build: no need for PETSc
      testing::InitGoogleTest(&argc, argv);
      return RUN_ALL_TESTS();
    }
  }
  start_quickly();
  MPI_Init(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) GTEST_FLAG_SET(brief, true);  // the other ranks print failures only
  testing::InitGoogleTest(&argc, argv);        // takes its own arguments out, before PETSc sees them

  if (SlepcInitialize(&argc, &argv, nullptr, nullptr) != 0) return EXIT_FAILURE;
  PetscPopSignalHandler();
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);  // errors that tests provoke print no trace
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  PetscPopErrorHandler();
  SlepcFinalize();
  MPI_Finalize();
  return failed;
}
