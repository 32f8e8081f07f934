// The main function of every test program that uses PETSc: GoogleTest between SlepcInitialize and SlepcFinalize, on any
// number of ranks. A test has passed only if it has passed on every rank.

#include <gtest/gtest.h>
#include <mpi.h>
#include <slepcsys.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

// Shortens MPI_Init from 300 ms to 50 ms: without mpirun, Open MPI does not need to search for networks and displays,
// and no daemon. It also gets no session folder, for which single processes that run at the same time would compete.
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
  unsetenv(no_folder);  // an mpirun that a test starts needs its session folder
}

double seconds_of(int who) {
  rusage used{};
  getrusage(who, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

// Limits the processor time of a test, so that a test that does not end is stopped, and prints the processor time of
// each test with the programs that it has run. Unlike time by the clock, it does not depend on other work of the
// machine.
class ProcessorTime : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    constexpr rlim_t longest = 900;  // s
    rlimit limit{};
    getrlimit(RLIMIT_CPU, &limit);
    limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(seconds_of(RUSAGE_SELF)) + longest);
    setrlimit(RLIMIT_CPU, &limit);
    start_ = seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN);
  }
  void OnTestEnd(const testing::TestInfo& test) override {
    if (GTEST_FLAG_GET(brief)) return;
    std::printf("[ SECONDS  ] %s.%s %.2f\n", test.test_suite_name(), test.name(),
                seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN) - start_);
  }
  double start_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--gtest_list_tests") == 0) {  // requested by the build, without PETSc
      testing::InitGoogleTest(&argc, argv);
      return RUN_ALL_TESTS();
    }
  }
  start_mpi(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) GTEST_FLAG_SET(brief, true);  // the other ranks print failures only
  testing::InitGoogleTest(&argc, argv);        // removes its own arguments before PETSc reads them

  testing::UnitTest::GetInstance()->listeners().Append(new ProcessorTime);

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
