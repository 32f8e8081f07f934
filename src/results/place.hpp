// Where a results file will stand: claimed before anything is computed, so that a run does not find out at its end that
// it may not write there, and never overwrites what is no results file.
#pragma once

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "results/own_file.hpp"

namespace traverse::results {

/// A path that this process may write, locked against other runs until the object goes. What it made (an empty file,
/// folders) goes with it unless keep() was called.
class Place {
 public:
  Place() = default;
  /// An empty path is no place. FileError when it is a folder, a link or a special file, cannot be written, is open
  /// elsewhere, or holds something that is no results file of Traverse.
  explicit Place(std::string path);
  Place(Place&& other) noexcept;
  Place& operator=(Place&& other) noexcept;
  ~Place();

  const std::string& path() const { return path_; }
  /// A results file has been begun: it stays.
  void keep();

  /// The file by a name that leads to it even where another one has been put at its path.
  std::string file() const { return file_.path(); }
  /// FileError where the file is not at its path any more.
  void check_is_there() const;

  /// Copies the first results file, of these and the one at the place, whose copy `is_right` beside the place, under
  /// the name aside(). FileError where none is, or where something else has that name.
  void copy_aside(std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right);
  std::string aside() const { return path_ + ".part"; }
  std::string file_aside() const { return aside_.path(); }
  /// The copy takes the place, locked.
  void take_aside();

 private:
  void claim();
  void make_aside(const Descriptor& source);
  void drop_aside() noexcept;
  void give_up() noexcept;

  std::string path_;
  Descriptor file_, aside_;  // aside: a copy, where there is one
  bool made_ = false;        // the file, by this object
  std::vector<std::filesystem::path> folders_;
};

/// Collective: rank 0 claims the place, the others hold none. The same FileError on every rank.
Place claim_place(MPI_Comm comm, const std::string& path);

/// Removes what a place that is not kept has made; only calls what a signal handler may call.
void remove_made_place() noexcept;

/// Collective: a failure on rank 0, empty when there is none, becomes the same FileError on every rank.
void share_failure(MPI_Comm comm, std::string failure);

}  // namespace traverse::results
