// File operations without race conditions: files are created with O_EXCL and O_NOFOLLOW, identified by device and
// inode, and renamed without replacing an existing file.
#include "results/own_file.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "hdf5.hpp"
#include "isolated_read.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

FileId id_of_status(const struct stat& status) { return {true, status.st_dev, status.st_ino}; }

/// Must be called in a separate process, because HDF5 may crash with a damaged file.
bool is_from_traverse(const std::string& path) {
  return hdf5::text_of(hdf5::open_to_read(path), "/", "program") == "traverse";
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

FileId id_at(const char* path) noexcept {
  struct stat status {};
  return ::lstat(path, &status) == 0 ? id_of_status(status) : FileId();
}

std::string Descriptor::path() const {
  std::string open_file = "/proc/self/fd/" + std::to_string(number_);
  return ::access(open_file.c_str(), F_OK) == 0 ? open_file : name_;
}

FileId id_of(const Descriptor& file) noexcept {
  struct stat status {};
  return ::fstat(file.get(), &status) == 0 ? id_of_status(status) : FileId();
}

Descriptor make_file(const std::string& path) {
  return {::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666), path};
}

Descriptor open_ordinary(const std::string& path, bool to_write) {
  Descriptor file(::open(path.c_str(), (to_write ? O_RDWR : O_RDONLY) | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC), path);
  struct stat status {};
  if (!file.open() || (::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode))) return file;
  errno = EINVAL;
  return {};
}

bool is_results_file(const Descriptor& file) {
  try {
    return isolated_read(file.path(), [&] { return is_from_traverse(file.path()); });
  } catch (const FileError&) {
    return false;
  }
}

bool is_results_file(const std::string& path) {
  const Descriptor file = open_ordinary(path, false);
  return file.open() && is_results_file(file);
}

bool begins_with(const std::string& path, std::string_view signature) {
  const Descriptor file = open_ordinary(path, false);
  std::string first_bytes(signature.size(), '\0');
  return file.open() &&
         ::pread(file.get(), first_bytes.data(), first_bytes.size(), 0) == static_cast<ssize_t>(signature.size()) &&
         first_bytes == signature;
}

bool write_all(const Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file.get(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
  return true;
}

// A file system without this operation gets a second link, which fails if the name exists.
bool move_to_free_name(const std::string& from, const std::string& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  return ::link(from.c_str(), to.c_str()) == 0 && ::unlink(from.c_str()) == 0;
}

}  // namespace traverse::results
