// The place of a results file. It is claimed before any computation, so that a missing permission is detected early,
// and no file is overwritten that is not a results file.
#pragma once

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/own_file.hpp"

namespace traverse::results {

/// A path that this process may write, locked against other runs during the object's life. An empty file and folders
/// that it created are removed with it unless keep() was called.
class Place {
 public:
  Place() = default;
  /// Claims a path; with an empty path there is no file. FileError if the path is a folder, a link or a special file,
  /// cannot be written, is open in another process, or is a file that is no results file of Traverse.
  explicit Place(std::string path);
  Place(Place&& other) noexcept;
  Place& operator=(Place&& other) noexcept;
  ~Place();

  const std::string& path() const { return path_; }
  /// The results file is started: the created files remain.
  void keep();

  /// A name of the file that is valid even if another file has been moved to its path.
  std::string file() const { return file_.path(); }
  /// FileError if the file is no longer at its path.
  void check_is_there() const;

  /// Copies a results file to the name temporary(): the first one of the sources and of the file at this place for
  /// whose copy `is_right` is true. FileError if there is none, or if another file has that name.
  void copy_temporarily(std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right);
  std::string temporary() const { return path_ + ".part"; }
  std::string temporary_file() const { return temporary_.path(); }
  /// Moves the locked copy to this place.
  void replace_by_temporary();

 private:
  void claim();
  void make_temporary(const Descriptor& source);
  void remove_temporary() noexcept;
  void release() noexcept;

  std::string path_;
  Descriptor file_, temporary_;  // temporary: a copy, if there is one
  bool created_ = false;         // the file was created by this object
  std::vector<std::filesystem::path> folders_;
};

/// Collective: rank 0 claims the place, the others have an empty one. The same FileError on every rank.
Place claim_place(MPI_Comm comm, const std::string& path);

/// Removes the files of a place without keep(); calls async-signal-safe functions only.
void remove_made_place() noexcept;

/// Collective: throws the failure of rank 0, if it is not empty, as the same FileError on every rank.
void share_failure(MPI_Comm comm, std::string failure);

}  // namespace traverse::results
