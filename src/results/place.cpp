// Creates or opens the results file, locks it (flock), checks that Traverse has written it, and removes created files
// and folders if the run ends before it has results. There are no race conditions: files are created with O_EXCL and
// O_NOFOLLOW, identified by device and inode, and renamed without replacing an existing file.
#include "results/place.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/broadcast.hpp"
#include "hdf5.hpp"
#include "isolated_read.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

namespace fs = std::filesystem;

// Names to remove after a signal that ends the program at once: the file, then its folders, the innermost first.
std::vector<std::string> created_names;
FileId created_file;
std::string unfinished_name;  // the temporary file
FileId unfinished_file;       // if there is one
std::atomic<bool> must_remove{false};

constexpr const char* hdf5_locks = "HDF5_USE_FILE_LOCKING";

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw FileError("cannot write the results file " + path + ": " + reason);
}

/// Creates the folder of the file and those above it; returns the created ones, the topmost first.
std::vector<fs::path> make_folders(const std::string& path) {
  std::vector<fs::path> created;
  std::error_code error;
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) return created;
  for (; !folder.empty() && !fs::exists(folder, error); folder = folder.parent_path()) {
    created.insert(created.begin(), folder);
    if (folder == folder.parent_path()) break;
  }
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) {
    for (auto last = created.rbegin(); last != created.rend(); ++last) {
      std::error_code ignored;
      fs::remove(*last, ignored);
    }
    fail(path, "its folder cannot be made: " + error.message());
  }
  return created;
}

/// Whether the user has disabled locks, for a file system without them.
bool locks_are_off() {
  static const bool off = [] {
    const char* value = std::getenv(hdf5_locks);
    const bool switched_off =
        value != nullptr && (std::string_view(value) == "FALSE" || std::string_view(value) == "0");
    setenv(hdf5_locks, "FALSE", 1);  // HDF5's own locks would conflict with these
    return switched_off;
  }();
  return off;
}

/// Copies the content of a file; false on failure, with the reason in errno.
bool copy(const Descriptor& from, const Descriptor& to) {
  std::vector<char> part(std::size_t{1} << 20);
  for (;;) {
    const ssize_t read = ::read(from.get(), part.data(), part.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return read == 0;
    if (!write_all(to, {part.data(), static_cast<std::size_t>(read)})) return false;
  }
}

/// A free name beside a file, for each attempt another one.
std::string temporary_name(const std::string& path, int attempt) {
  return path + ".part." + std::to_string(::getpid()) + (attempt == 0 ? "" : "." + std::to_string(attempt));
}

constexpr int max_attempts = 100;  // names tried

constexpr const char* place_advice = "; name another file with -output_file";

FileId id_of_status(const struct stat& status) { return {true, status.st_dev, status.st_ino}; }

/// Must be called in a separate process, because HDF5 may crash with a damaged file.
bool is_from_traverse(const std::string& path) {
  return hdf5::text_of(hdf5::open_to_read(path), "/", "program") == "traverse";
}

}  // namespace

Place::Place(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::error_code ignored;
  if (fs::is_symlink(path_, ignored))
    fail(path_, std::string("it is a link, and no results file of Traverse itself") + place_advice);
  if (fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored))
    fail(path_, fs::is_directory(path_, ignored)
                    ? "it is a folder and no ordinary file; name a file in it with -output_file"
                    : "it is there already and is no ordinary file");
  folders_ = make_folders(path_);
  try {
    claim();
  } catch (...) {
    release();
    throw;
  }
}

void Place::claim() {
  file_ = make_file(path_);
  created_ = file_.open();
  if (!created_ && errno == EEXIST) file_ = open_ordinary(path_, true);
  if (!file_.open()) fail(path_, std::strerror(errno));
  if (!locks_are_off() && ::flock(file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    created_ = false;
    fail(path_, std::string("another run or program has it open") + place_advice);
  }
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) fail(path_, std::strerror(errno));
  if (id_at(path_.c_str()) != id_of(file_)) {  // another run has replaced it since
    created_ = false;
    fail(path_, std::string("another run or program has it open") + place_advice);
  }
  if (status.st_size > 0 && !is_results_file(file_))
    fail(path_, std::string("it is there already and is no results file of Traverse") + place_advice);
  if (!created_) return;
  created_file = id_of(file_);
  created_names = {path_};
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) created_names.push_back(folder->string());
  must_remove = true;
}

void Place::open_temporary() {
  for (int attempt = 0; !temporary_.open() && attempt < max_attempts; ++attempt) {
    temporary_name_ = temporary_name(path_, attempt);
    temporary_ = make_file(temporary_name_);
    if (!temporary_.open() && errno != EEXIST) break;
  }
  if (!temporary_.open()) fail(path_, "its folder takes no new file: " + std::string(std::strerror(errno)));
  unfinished_name = temporary_name_;
  unfinished_file = id_of(temporary_);
  if (!locks_are_off()) (void)::flock(temporary_.get(), LOCK_EX | LOCK_NB);
  struct stat replaced {};
  if (::fstat(file_.get(), &replaced) == 0) (void)::fchmod(temporary_.get(), replaced.st_mode);
}

bool Place::copy_to_temporary(const Descriptor& source) {
  open_temporary();
  return copy(source, temporary_);
}

bool Place::copy_temporarily() {
  const Descriptor source = open_ordinary(path_, false);
  check_is_there();
  const bool copied = copy_to_temporary(source);
  if (!copied) remove_temporary();
  return copied;
}

void Place::copy_temporarily(std::vector<std::string> sources,
                             const std::function<bool(const std::string&)>& is_right) {
  sources.push_back(path_);  // the results may have been moved there
  std::string failures;
  for (auto source = sources.begin(); source != sources.end(); ++source) {
    if (std::find(sources.begin(), source, *source) != source) continue;
    const Descriptor from = open_ordinary(*source, false);
    const bool valid = from.open() && is_results_file(from);
    const FileId id = id_at(source->c_str());
    const bool missing = !id.there || (created_ && id == id_of(file_));  // the claimed file itself does not count
    if (valid) {
      if (!copy_to_temporary(from)) fail(path_, std::strerror(errno));
      if (is_right(temporary_file())) return;
      remove_temporary();
    }
    failures +=
        (failures.empty() ? "" : "; ") + *source +
        (valid     ? ": its datasets do not hold the rows that the checkpoint was written with, as it is damaged or "
                     "another one"
         : missing ? " is not there"
                   : " is no results file of Traverse");
  }
  fail(path_, "there are no results to take up: " + failures + "; name them with -output_file");
}

void Place::remove_temporary() noexcept {
  if (!temporary_.open()) return;
  unfinished_file = {};
  if (id_at(temporary_name_.c_str()) == id_of(temporary_)) (void)::unlink(temporary_name_.c_str());
  temporary_ = Descriptor();
}

void Place::replace_by_temporary() {
  check_is_there();
  if (id_at(temporary_name_.c_str()) != id_of(temporary_))
    fail(path_, temporary_name_ + " was removed or replaced meanwhile");
  if (::rename(temporary_name_.c_str(), path_.c_str()) != 0) fail(path_, std::strerror(errno));
  unfinished_file = {};
  file_ = std::move(temporary_);
  temporary_ = Descriptor();
  keep();
}

void Place::check_is_there() const {
  if (file_.open() && id_at(path_.c_str()) != id_of(file_))
    throw FileError("the results file " + path_ + " was removed, moved or replaced while the run went on");
}

void Place::release() noexcept {
  std::error_code ignored;
  remove_temporary();
  if (created_) must_remove = false;
  if (created_ && file_.open() && id_at(path_.c_str()) == id_of(file_)) fs::remove(path_, ignored);
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) fs::remove(*folder, ignored);
  file_ = Descriptor();
  created_ = false;
  folders_.clear();
}

void Place::keep() {
  must_remove = false;
  created_ = false;
  folders_.clear();
}

void remove_made_place() noexcept {
  if (unfinished_file.there && id_at(unfinished_name.c_str()) == unfinished_file)
    (void)::unlink(unfinished_name.c_str());
  if (!must_remove) return;
  bool file = true;  // the first name
  for (const std::string& name : created_names) {
    if (!file)
      (void)::rmdir(name.c_str());
    else if (id_at(name.c_str()) == created_file)
      (void)::unlink(name.c_str());
    file = false;
  }
}

Place claim_place(MPI_Comm comm, const std::string& path) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  Place place;
  std::string failure;
  try {
    if (rank == 0) place = Place(path);
  } catch (const FileError& error) {
    failure = error.what();
  }
  share_failure(comm, failure);
  return place;
}

void share_failure(MPI_Comm comm, std::string failure) {
  failure = base::broadcast(comm, std::move(failure));
  if (!failure.empty()) throw FileError(failure);
}

Place::Place(Place&& other) noexcept { *this = std::move(other); }

Place& Place::operator=(Place&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(temporary_, other.temporary_);
  std::swap(temporary_name_, other.temporary_name_);
  std::swap(created_, other.created_);
  std::swap(folders_, other.folders_);
  return *this;
}

Place::~Place() { release(); }

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
