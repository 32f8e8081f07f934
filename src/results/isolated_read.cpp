// Forks a process with limits on processor time and memory, which reads the file and returns the data or the error
// through a pipe.
#include "results/isolated_read.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <optional>
#include <utility>

#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

constexpr double seconds_at_least = 10.0, seconds_a_byte = 1e-7;  // of the processor, for what HDF5 does
constexpr double bytes_at_least = 1 << 30,
                 memory_of_a_byte = 64.0;  // beyond what this process has; files may be packed

/// What the copy hands over: an error's status (0: none) and message, then the bytes.
struct Handed {
  int status = 0;
  std::string message, bytes;
  bool whole = false;  // written last
  void keep(base::Bytes& to) { to(status, message, bytes, whole); }
};

double size_of(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  return failed ? 0.0 : static_cast<double>(size);
}

void limit(int resource, double most) {
  struct rlimit now = {};
  if (getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min(now.rlim_cur, static_cast<rlim_t>(most));
  setrlimit(resource, &now);
}

/// Signals and the C library end the copy without a word, and it takes no more than a file of this size can need.
void confine(double size) {
  for (const int number :
       {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGPIPE})
    ::signal(number, SIG_DFL);
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_CORE, 0.0);
  limit(RLIMIT_CPU, seconds_at_least + seconds_a_byte * size);
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  limit(RLIMIT_AS, pages * static_cast<double>(sysconf(_SC_PAGESIZE)) + bytes_at_least + memory_of_a_byte * size);
}

Handed read_here(const std::function<void(base::Bytes&)>& read) {
  Handed handed;
  try {
    base::Bytes bytes;
    read(bytes);
    handed.bytes = bytes.written();
  } catch (const Error& error) {
    handed.status = error.status();
    handed.message = error.what();
  } catch (const std::exception& error) {
    handed.status = FileError("").status();
    handed.message = "the file is damaged: " + std::string(error.what());
  }
  handed.whole = true;
  return handed;
}

[[noreturn]] void hand_over(int to, Handed handed) {
  base::Bytes bytes;
  bytes(handed);
  for (std::string_view rest = bytes.written(); !rest.empty();) {
    const ssize_t done = ::write(to, rest.data(), rest.size());
    if (done < 0 && errno != EINTR) break;
    rest.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(done, 0)));
  }
  _exit(0);
}

std::string all_from(int from) {
  std::string text;
  for (std::array<char, 65536> part;;) {
    const ssize_t read = ::read(from, part.data(), part.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(read));
  }
}

std::optional<Handed> handed_in(const std::string& text) {
  Handed handed;
  try {
    base::Bytes bytes{std::span<const char>(text)};
    bytes(handed);
  } catch (const FileError&) {  // it ended before
    return std::nullopt;
  }
  return handed;
}

[[noreturn]] void throw_again(const Handed& handed) {
  if (handed.status == FileError("").status()) throw FileError(handed.message);
  if (handed.status == InputError("").status()) throw InputError(handed.message);
  throw Error(handed.message, handed.status);
}

}  // namespace

std::string isolated_bytes(const std::string& path, const std::function<void(base::Bytes&)>& read) {
  const double size = size_of(path);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw FileError(path + ": no pipe to read it through");
  const pid_t copy = ::fork();
  if (copy == 0) {
    ::close(ends[0]);
    confine(size);
    hand_over(ends[1], read_here(read));
  }
  ::close(ends[1]);
  const std::string text = copy < 0 ? std::string() : all_from(ends[0]);
  ::close(ends[0]);
  while (copy > 0 && ::waitpid(copy, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (copy < 0) throw FileError(path + ": no process to read it in");
  std::optional<Handed> handed = handed_in(text);
  if (!handed || !handed->whole) throw FileError(path + ": the file is damaged: HDF5 cannot read it");
  if (handed->status != 0) throw_again(*handed);
  return std::move(handed->bytes);
}

}  // namespace traverse::results
