// Operations on files that a run creates, replaces or removes. Links are not followed, new files are created only at
// free paths, and only files that Traverse has written are replaced or removed.
#pragma once

#include <string>
#include <string_view>
#include <utility>

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

}  // namespace traverse::results
