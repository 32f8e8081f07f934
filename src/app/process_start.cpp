// Sets environment variables of Open MPI and hwloc that shorten MPI_Init for a single process. Replaces stdout by a
// stream of its own (fopencookie) that discards all output after the first failed write and keeps the error code.
#include "process_start.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace traverse::app {
namespace {

constexpr const char* no_session_folder = "OMPI_MCA_orte_create_session_dirs";

std::atomic<int> reason{0};  // errno of the first failure

ssize_t write_all(void*, const char* text, std::size_t size) {
  for (std::size_t at = 0; reason == 0 && at < size;) {
    const ssize_t written = write(STDOUT_FILENO, text + at, size - at);
    if (written >= 0)
      at += static_cast<std::size_t>(written);
    else if (errno != EINTR)
      reason = errno;
  }
  return static_cast<ssize_t>(size);
}

/// Functions of OpenBLAS; null where another library is used. They are looked up once: a program may call each step.
struct OpenBlas {
  int (*get_threads)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  void (*set_threads)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
};

const OpenBlas& openblas() {
  static const OpenBlas functions;
  return functions;
}

}  // namespace

const char* rank_of_launcher() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  return rank != nullptr ? rank : std::getenv("PMIX_RANK");
}

// Without a launcher the initialisation of Open MPI needs 0.3 s, unless it is set to a single process; programs that
// start at the same time would compete for its session folder. The search for displays as accelerators is disabled too.
void start_lightly() {
  setenv("HWLOC_COMPONENTS", "-gl,-opencl", 0);
  if (rank_of_launcher() != nullptr) return;
  setenv(no_session_folder, "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
  setenv("OMPI_MCA_btl", "self", 1);  // without shared memory
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
}

OneThreadOfBlas::OneThreadOfBlas() {
  if (openblas().get_threads == nullptr || openblas().set_threads == nullptr) return;
  before_ = openblas().get_threads();
  if (before_ > 1) openblas().set_threads(1);
}

OneThreadOfBlas::~OneThreadOfBlas() {
  if (before_ > 1) openblas().set_threads(before_);
}

void started() { unsetenv(no_session_folder); }

void guard_standard_output() {
  for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) (void)!open("/dev/null", O_RDWR);  // gets the lowest free number
  std::FILE* guarded = fopencookie(nullptr, "w", {nullptr, write_all, nullptr, nullptr});
  if (guarded == nullptr) return;
  std::setvbuf(guarded, nullptr, isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF, BUFSIZ);
  stdout = guarded;
}

int lost_output() {
  std::fflush(stdout);
  return reason;
}

}  // namespace traverse::app
