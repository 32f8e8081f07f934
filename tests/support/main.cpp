// The main of every test program that uses PETSc: GoogleTest between SlepcInitialize and SlepcFinalize, on any
// number of ranks. A test has passed only when it has passed on every rank.

#include <gtest/gtest.h>
#include <mpi.h>
#include <slepcsys.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace {

// MPI_Init in 50 ms instead of 300: without mpirun, Open MPI need not look for networks and displays nor start a
// daemon. Nor does it get a session folder, for which single processes that run side by side compete.
void start_mpi(int* argc, char*** argv) {
  const char* no_folder = "OMPI_MCA_orte_create_session_dirs";
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) {
    setenv("OMPI_MCA_pml", "ob1", 0);
    setenv("OMPI_MCA_btl", "self,vader", 0);
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    setenv("HWLOC_COMPONENTS", "-gl,-opencl", 0);
    setenv(no_folder, "0", 1);
  }
  MPI_Init(argc, argv);
  unsetenv(no_folder);  // an mpirun that a test starts cannot do without
}

// A test that computes without end is stopped by the processor time it has used: other than time by the clock, that
// does not depend on what else the machine has to do.
class ProcessorLimit : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    constexpr rlim_t longest = 900;  // s
    rusage used{};
    rlimit limit{};
    getrusage(RUSAGE_SELF, &used);
    getrlimit(RLIMIT_CPU, &limit);
    const auto seconds = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
    limit.rlim_cur = std::min(limit.rlim_max, seconds + longest);
    setrlimit(RLIMIT_CPU, &limit);
  }
};

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--gtest_list_tests") == 0) {  // asked by the build: no need for PETSc
      testing::InitGoogleTest(&argc, argv);
      return RUN_ALL_TESTS();
    }
  }
  start_mpi(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) GTEST_FLAG_SET(brief, true);  // the other ranks print failures only
  testing::InitGoogleTest(&argc, argv);        // takes its own arguments out, before PETSc sees them

  testing::UnitTest::GetInstance()->listeners().Append(new ProcessorLimit);

  if (SlepcInitialize(&argc, &argv, nullptr, nullptr) != 0) return EXIT_FAILURE;
  (void)PetscPopSignalHandler();
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);  // errors that tests provoke print no trace
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  (void)PetscPopErrorHandler();
  (void)SlepcFinalize();
  MPI_Finalize();
  return failed;
}
