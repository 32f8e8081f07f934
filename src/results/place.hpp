// The place of a results file. It is claimed before any computation, so that a missing permission is detected early,
// and no file is overwritten that is not a results file. Links are not followed, new files are created only at free
// paths, and only files that Traverse has written are replaced or removed.
#pragma once

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace traverse::results {

/// A file descriptor with one owner.
class Descriptor {
 public:
  Descriptor() = default;
  /// name: the path by which it was opened.
  Descriptor(int number, std::string name) : number_(number), name_(std::move(name)) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)), name_(std::move(other.name_)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    std::swap(name_, other.name_);
    return *this;
  }
  ~Descriptor();
  int get() const { return number_; }
  bool open() const { return number_ >= 0; }
  /// A name by which libraries open this very file, even if another file has been moved to its path; on systems without
  /// /proc the path itself.
  std::string path() const;

 private:
  int number_ = -1;
  std::string name_;
};

/// Identifies a file while one of its names or descriptors exists; `there` false: no file.
struct FileId {
  bool there = false;
  unsigned long device = 0, number = 0;
  bool operator==(const FileId&) const = default;
};
/// The file at a path, or the link itself; calls async-signal-safe functions only.
FileId id_at(const char* path) noexcept;
FileId id_of(const Descriptor& file) noexcept;

/// Creates a file at a free path; invalid on failure, with the reason in errno.
Descriptor make_file(const std::string& path);
/// Opens an existing ordinary file. Links and files that block are rejected.
Descriptor open_ordinary(const std::string& path, bool to_write);

/// Whether the file is HDF5 with the attribute program = "traverse".
bool is_results_file(const Descriptor& file);
bool is_results_file(const std::string& path);
/// Whether the path is an ordinary file that begins with these bytes.
bool begins_with(const std::string& path, std::string_view signature);

/// Writes all bytes. False on failure, with the reason in errno.
bool write_all(const Descriptor& file, std::string_view bytes);
/// Moves a file to a free name in its folder. False if the name exists or the move fails.
bool move_to_free_name(const std::string& from, const std::string& to);

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
