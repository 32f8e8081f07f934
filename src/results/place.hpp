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

  /// Creates a file under a free name beside this place, which takes its place when it is complete. FileError.
  void open_temporary();
  /// Like open_temporary(), with the content of this place. False, without a temporary file, if the copy fails, such as
  /// on a disk without room for it.
  bool copy_temporarily();
  /// Like open_temporary(), with the content of the first results file of the sources and of this place for whose copy
  /// `is_right` is true. FileError if there is none.
  void copy_temporarily(std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right);
  bool has_temporary() const { return temporary_.open(); }
  std::string temporary_file() const { return temporary_.path(); }
  /// Moves the locked temporary file to this place, atomically.
  void replace_by_temporary();

 private:
  void claim();
  bool copy_to_temporary(const Descriptor& source);  // false on failure, with the reason in errno
  void remove_temporary() noexcept;
  void release() noexcept;

  std::string path_;
  Descriptor file_, temporary_;  // temporary: if there is one
  std::string temporary_name_;
  bool created_ = false;  // the file was created by this object
  std::vector<std::filesystem::path> folders_;
};

/// Collective: rank 0 claims the place, the others have an empty one. The same FileError on every rank.
Place claim_place(MPI_Comm comm, const std::string& path);

/// Removes the files of a place without keep(); calls async-signal-safe functions only.
void remove_made_place() noexcept;

/// Collective: throws the failure of rank 0, if it is not empty, as the same FileError on every rank.
void share_failure(MPI_Comm comm, std::string failure);

}  // namespace traverse::results
