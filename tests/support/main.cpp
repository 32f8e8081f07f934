// The main of every test program that uses PETSc: GoogleTest between SlepcInitialize and SlepcFinalize, on any
// number of ranks. A test has passed only when it has passed on every rank.

#include <gtest/gtest.h>
#include <mpi.h>
#include <slepcsys.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
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

double seconds_of(int who) {
  rusage used{};
  getrusage(who, &used);
  return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

// A test that computes without end is stopped by the processor time it has used, and each says at its end how much that
// was, with the programs that it has run: other than time by the clock, that does not depend on what else the machine
// has to do.
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
