// Opens a file without blocking, rejects everything that fstat does not report as a regular file, and reads it up to a
// limit of bytes.
#include "base/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace traverse::base {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::string& path)
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {
  }  // a pipe without a writer must not block
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

std::string read_error() {
  return errno == ENOENT ? "there is no such file" : std::string("the file cannot be read: ") + std::strerror(errno);
}

}  // namespace

std::string read_regular_file(const std::string& path, std::size_t most, std::string& bytes) {
  bytes.clear();
  const Descriptor file(path);
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) return read_error();
  if (S_ISDIR(status.st_mode)) return "is a folder, not a file";
  if (!S_ISREG(status.st_mode)) return "is a pipe or a device, not a file";
  for (std::array<char, 65536> part; bytes.size() <= most;) {
    const ssize_t read = ::read(file.number(), part.data(), part.size());
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return read_error();
    if (read == 0) return "";
    bytes.append(part.data(), static_cast<std::size_t>(read));
  }
  return too_long;
}

}  // namespace traverse::base
