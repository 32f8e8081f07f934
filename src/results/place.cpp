#include "results/place.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "hdf5.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

namespace fs = std::filesystem;

// What a signal that ends the program at once has to remove: the file, then its folders, the innermost first.
std::vector<std::string> made_names;
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

/// Whether the file is HDF5 and says of itself that Traverse has written it.
bool is_results_file(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hdf5::Id access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access.get(), false, true);
  const hdf5::Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
  if (file.get() < 0 || H5Aexists(file.get(), "program") <= 0) return false;
  const hdf5::Id attribute(H5Aopen(file.get(), "program", H5P_DEFAULT)), type(H5Aget_type(attribute.get()));
  if (type.get() < 0 || H5Tis_variable_str(type.get()) <= 0) return false;
  char* text = nullptr;
  if (H5Aread(attribute.get(), type.get(), static_cast<void*>(&text)) < 0 || text == nullptr) return false;
  const bool ours = std::string_view(text) == "traverse";
  H5free_memory(text);
  return ours;
}

}  // namespace

Place::Place(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::error_code ignored;
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
  struct stat status {};
  made_ = ::stat(path_.c_str(), &status) != 0;
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    made_ = false;
    fail(path_, std::strerror(errno));
  }
  if (!locks_are_off() && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    made_ = false;
    fail(path_, "another run or program has it open; name another file with -output_file");
  }
  if (::fstat(descriptor_, &status) != 0) fail(path_, std::strerror(errno));
  if (status.st_size > 0 && !is_results_file(path_))
    fail(path_, "it is there already and is no results file of Traverse; name another file with -output_file");
  if (!made_) return;
  made_names = {path_};
  made_names.insert(made_names.end(), folders_.rbegin(), folders_.rend());
  made_something = true;
}

void Place::copy_aside(const std::string& source) {
  std::error_code error;
  const std::string& found = fs::exists(source, error) ? source : path_;  // they may have been moved
  if (!is_results_file(found))
    fail(path_, "the results to take up, " + source + ", are not there; name them with -output_file");
  copied_ = true;
  fs::copy_file(found, aside(), fs::copy_options::overwrite_existing, error);
  if (error) fail(path_, error.message());
}

void Place::take_aside() {
  const int taken = ::open(aside().c_str(), O_RDWR | O_CLOEXEC);
  if (taken < 0) fail(path_, std::strerror(errno));
  if (!locks_are_off()) (void)::flock(taken, LOCK_EX | LOCK_NB);
  if (::rename(aside().c_str(), path_.c_str()) != 0) {
    ::close(taken);
    fail(path_, std::strerror(errno));
  }
  copied_ = false;
  ::close(descriptor_);
  descriptor_ = taken;
  keep();
}

void Place::give_up() noexcept {
  std::error_code ignored;
  if (copied_) fs::remove(aside(), ignored);
  copied_ = false;
  if (made_) made_something = false;
  if (made_) fs::remove(path_, ignored);
  for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) fs::remove(*folder, ignored);
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
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
  for (const std::string& name : made_names)
    if (::unlink(name.c_str()) != 0) (void)::rmdir(name.c_str());
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
  std::swap(descriptor_, other.descriptor_);
  std::swap(made_, other.made_);
  std::swap(copied_, other.copied_);
  std::swap(folders_, other.folders_);
  return *this;
}

Place::~Place() { give_up(); }

}  // namespace traverse::results
