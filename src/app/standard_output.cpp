// Replaces stdout by a stream of its own (fopencookie) that discards all output after the first failed write and keeps
// the error code.
#include "standard_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>

namespace traverse::app {
namespace {

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

}  // namespace

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
