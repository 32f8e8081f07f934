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

#include "results/stage.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

constexpr double min_seconds = 10.0, seconds_per_byte = 1e-7;  // processor time of HDF5
constexpr double min_memory = 1 << 30,
                 memory_per_byte = 64.0;  // in addition to this process; data may be compressed

/// The result of the child process: an error's status (0: none) and message, then the bytes.
struct ChildResult {
  int status = 0;
  std::string message, bytes;
  bool complete = false;  // written last
  void keep(base::Bytes& to) { to(status, message, bytes, complete); }
};

double size_of(const std::string& path) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  return failed ? 0.0 : static_cast<double>(size);
}

void limit(int resource, double most) {
  struct rlimit current = {};
  if (getrlimit(resource, &current) != 0) return;
  current.rlim_cur = std::min(current.rlim_cur, static_cast<rlim_t>(most));
  setrlimit(resource, &current);
}

/// Restores the default actions of signals, and limits processor time and memory to the needs of a file of this size.
void confine(double size) {
  for (const int number :
       {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGPIPE})
    ::signal(number, SIG_DFL);
  if (const int null_device = ::open("/dev/null", O_WRONLY); null_device >= 0) ::dup2(null_device, STDERR_FILENO);
  limit(RLIMIT_CORE, 0.0);
  limit(RLIMIT_CPU, min_seconds + seconds_per_byte * size);
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  limit(RLIMIT_AS, pages * static_cast<double>(sysconf(_SC_PAGESIZE)) + min_memory + memory_per_byte * size);
}

ChildResult read_in_child(const std::function<void(base::Bytes&)>& read) {
  ChildResult result;
  try {
    base::Bytes bytes;
    read(bytes);
    result.bytes = bytes.written();
  } catch (const Error& error) {
    result.status = error.status();
    result.message = error.what();
  } catch (const std::exception& error) {
    result.status = FileError("").status();
    result.message = "the file is damaged: " + std::string(error.what());
  }
  result.complete = true;
  return result;
}

[[noreturn]] void send(int to, ChildResult result) {
  base::Bytes bytes;
  bytes(result);
  for (std::string_view remaining = bytes.written(); !remaining.empty();) {
    const ssize_t done = ::write(to, remaining.data(), remaining.size());
    if (done < 0 && errno != EINTR) break;
    remaining.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(done, 0)));
  }
  _exit(0);
}

std::string receive(int from) {
  std::string text;
  for (std::array<char, 65536> part;;) {
    const ssize_t read = ::read(from, part.data(), part.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(read));
  }
}

std::optional<ChildResult> parse(const std::string& text) {
  ChildResult result;
  try {
    base::Bytes bytes{std::span<const char>(text)};
    bytes(result);
  } catch (const FileError&) {  // the child process ended before it was complete
    return std::nullopt;
  }
  return result;
}

[[noreturn]] void rethrow(const ChildResult& result) {
  if (result.status == FileError("").status()) throw FileError(result.message);
  if (result.status == InputError("").status()) throw InputError(result.message);
  throw Error(result.message, result.status);
}

}  // namespace

std::string isolated_bytes(const std::string& path, const std::function<void(base::Bytes&)>& read) {
  const double size = size_of(path);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw FileError(path + ": no pipe to read it through");
  std::unique_lock lock = Heartbeat::asleep();
  const pid_t child = ::fork();
  lock.unlock();
  if (child == 0) {
    ::close(ends[0]);
    confine(size);
    send(ends[1], read_in_child(read));
  }
  ::close(ends[1]);
  const std::string text = child < 0 ? std::string() : receive(ends[0]);
  ::close(ends[0]);
  while (child > 0 && ::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (child < 0) throw FileError(path + ": no process to read it in");
  std::optional<ChildResult> result = parse(text);
  if (!result || !result->complete) throw FileError(path + ": the file is damaged: HDF5 cannot read it");
  if (result->status != 0) rethrow(*result);
  return std::move(result->bytes);
}

}  // namespace traverse::results
