// Creates or opens the results file, locks it (flock), checks that it is one of Traverse's own, and removes what was
// created if the run ends before it has results.
#include "results/place.hpp"

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "results/own_file.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

namespace fs = std::filesystem;

// What a signal that ends the program at once has to remove: the file, then its folders, the innermost first.
std::vector<std::string> made_names;
FileId made_file;
std::atomic<bool> made_something{false};

constexpr const char* hdf5_locks = "HDF5_USE_FILE_LOCKING";

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw FileError("cannot write the results file " + path + ": " + reason);
}

/// Makes the folder of the file and those above it; returns those made, the topmost one first.
std::vector<fs::path> make_folders(const std::string& path) {
  std::vector<fs::path> made;
  std::error_code error;
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) return made;
  for (; !folder.empty() && !fs::exists(folder, error); folder = folder.parent_path()) {
    made.insert(made.begin(), folder);
    if (folder == folder.parent_path()) break;
  }
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) {
    for (auto last = made.rbegin(); last != made.rend(); ++last) {
      std::error_code ignored;
      fs::remove(*last, ignored);
    }
    fail(path, "its folder cannot be made: " + error.message());
  }
  return made;
}

/// Whether the user has switched locks off, for a file system that has none.
bool locks_are_off() {
  static const bool off = [] {
    const char* value = std::getenv(hdf5_locks);
    const bool switched_off =
        value != nullptr && (std::string_view(value) == "FALSE" || std::string_view(value) == "0");
    setenv(hdf5_locks, "FALSE", 1);  // our locks hold for HDF5, too, whose own would contradict them
    return switched_off;
  }();
  return off;
}

/// Copies what a file holds; false where that fails, errno says why.
bool copy(const Descriptor& from, const Descriptor& to) {
  std::vector<char> part(std::size_t{1} << 20);
  for (;;) {
    const ssize_t read = ::read(from.get(), part.data(), part.size());
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return read == 0;
    if (!write_all(to, {part.data(), static_cast<std::size_t>(read)})) return false;
  }
}

/// Whether a file is what a run that was killed has left of its copy of `source`: nobody has it open, and it is a
/// beginning of that.
bool is_left_over(const std::string& path, const Descriptor& source) {
  const Descriptor file = open_ordinary(path, false);
  if (!file.open()) return false;
  if (!locks_are_off() && ::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  std::vector<char> part(std::size_t{1} << 20), same(part.size());
  for (off_t at = 0;;) {
    const ssize_t read = ::pread(file.get(), part.data(), part.size(), at);
    if (read <= 0) return read == 0;
    const auto size = static_cast<std::size_t>(read);
    if (::pread(source.get(), same.data(), size, at) != read ||
        !std::equal(part.begin(), part.begin() + read, same.begin()))
      return false;
    at += read;
  }
}

constexpr const char* other_results = "; name another file with -output_file";

}  // namespace

Place::Place(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::error_code ignored;
  if (fs::is_symlink(path_, ignored))
    fail(path_, std::string("it is a link, and no results file of Traverse itself") + other_results);
  if (fs::exists(path_, ignored) && !fs::is_regular_file(path_, ignored))
    fail(path_, fs::is_directory(path_, ignored)
                    ? "it is a folder and no ordinary file; name a file in it with -output_file"
                    : "it is there already and is no ordinary file");
  folders_ = make_folders(path_);
  try {
    claim();
  } catch (...) {
    give_up();
    throw;
  }
}

void Place::claim() {
  file_ = make_file(path_);
  made_ = file_.open();
  if (!made_ && errno == EEXIST) file_ = open_ordinary(path_, true);
  if (!file_.open()) fail(path_, std::strerror(errno));
  if (!locks_are_off() && ::flock(file_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    made_ = false;
    fail(path_, std::string("another run or program has it open") + other_results);
  }
  struct stat status {};
  if (::fstat(file_.get(), &status) != 0) fail(path_, std::strerror(errno));
  if (status.st_size > 0 && !is_results_file(file_))
    fail(path_, std::string("it is there already and is no results file of Traverse") + other_results);
  if (!made_) return;
  made_file = id_of(file_);
  made_names = {path_};
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) made_names.push_back(folder->string());
  made_something = true;
}

void Place::copy_aside(std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right) {
  sources.push_back(path_);  // they may have been moved there
  std::string tried;
  for (auto source = sources.begin(); source != sources.end(); ++source) {
    if (std::find(sources.begin(), source, *source) != source) continue;
    const Descriptor from = open_ordinary(*source, false);
    const bool there = from.open() && is_results_file(from);
    const FileId id = id_at(source->c_str());
    const bool missing = !id.there || (made_ && id == id_of(file_));  // but for the place that was claimed
    if (there) {
      make_aside(from);
      if (!copy(from, aside_)) fail(path_, aside() + ": " + std::strerror(errno));
      if (is_right(file_aside())) return;
      drop_aside();
    }
    tried += (tried.empty() ? "" : "; ") + *source +
             (there ? ": its datasets do not hold the rows that the checkpoint was written with, as it is damaged or "
                      "another one"
              : missing ? " is not there"
                        : " is no results file of Traverse");
  }
  fail(path_, "there are no results to take up: " + tried + "; name them with -output_file");
}

void Place::make_aside(const Descriptor& source) {
  aside_ = make_file(aside());
  int why = errno;
  if (!aside_.open() && why == EEXIST && is_left_over(aside(), source)) {
    (void)::unlink(aside().c_str());
    aside_ = make_file(aside());
    why = errno;
  }
  if (!aside_.open() && why == EEXIST)
    fail(path_, aside() + " is there already and is no copy that a run has left; move it away");
  if (!aside_.open()) fail(path_, aside() + ": " + std::strerror(why));
  if (!locks_are_off()) (void)::flock(aside_.get(), LOCK_EX | LOCK_NB);
}

void Place::drop_aside() noexcept {
  if (aside_.open() && id_at(aside().c_str()) == id_of(aside_)) (void)::unlink(aside().c_str());
  aside_ = Descriptor();
}

void Place::take_aside() {
  check_is_there();
  if (id_at(aside().c_str()) != id_of(aside_)) fail(path_, aside() + " was removed or replaced meanwhile");
  if (::rename(aside().c_str(), path_.c_str()) != 0) fail(path_, std::strerror(errno));
  file_ = std::move(aside_);
  aside_ = Descriptor();
  keep();
}

void Place::check_is_there() const {
  if (file_.open() && id_at(path_.c_str()) != id_of(file_))
    throw FileError("the results file " + path_ + " was removed, moved or replaced while the run went on");
}

void Place::give_up() noexcept {
  std::error_code ignored;
  drop_aside();
  if (made_) made_something = false;
  if (made_ && file_.open() && id_at(path_.c_str()) == id_of(file_)) fs::remove(path_, ignored);
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) fs::remove(*folder, ignored);
  file_ = Descriptor();
  made_ = false;
  folders_.clear();
}

void Place::keep() {
  made_something = false;
  made_ = false;
  folders_.clear();
}

void remove_made_place() noexcept {
  if (!made_something) return;
  bool file = true;  // the first name
  for (const std::string& name : made_names) {
    if (!file)
      (void)::rmdir(name.c_str());
    else if (id_at(name.c_str()) == made_file)
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
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  if (ranks > 1) {
    int size = static_cast<int>(failure.size());
    MPI_Bcast(&size, 1, MPI_INT, 0, comm);
    failure.resize(static_cast<std::size_t>(size));
    MPI_Bcast(failure.data(), size, MPI_CHAR, 0, comm);
  }
  if (!failure.empty()) throw FileError(failure);
}

Place::Place(Place&& other) noexcept { *this = std::move(other); }

Place& Place::operator=(Place&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(aside_, other.aside_);
  std::swap(made_, other.made_);
  std::swap(folders_, other.folders_);
  return *this;
}

Place::~Place() { give_up(); }

}  // namespace traverse::results
