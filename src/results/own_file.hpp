// Files that a run makes, replaces or removes. Names are looked at without following links, new files are made where
// nothing is, and nothing is replaced or removed that Traverse has not written.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace traverse::results {

/// A file descriptor with one owner.
class Descriptor {
 public:
  Descriptor() = default;
  /// name: the path that it was opened by.
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
  /// A name by which libraries open the very file, whatever stands at its path by then; where the system has no /proc,
  /// that path.
  std::string path() const;

 private:
  int number_ = -1;
  std::string name_;
};

/// Tells one file from another as long as one of its names or descriptors is held; `there` false: there is none.
struct FileId {
  bool there = false;
  unsigned long device = 0, number = 0;
  bool operator==(const FileId&) const = default;
};
/// Of what stands at a path, a link itself included; only calls what a signal handler may call.
FileId id_at(const char* path) noexcept;
FileId id_of(const Descriptor& file) noexcept;

/// A new file at a path where nothing is; none where that cannot be, errno says why.
Descriptor make_file(const std::string& path);
/// An ordinary file that is there, neither a link nor one that would have to be waited for.
Descriptor open_ordinary(const std::string& path, bool to_write);

/// Whether it is HDF5 and says of itself that Traverse has written it.
bool is_results_file(const Descriptor& file);
bool is_results_file(const std::string& path);
/// Whether an ordinary file begins with these bytes.
bool begins_with(const std::string& path, std::string_view mark);

/// Writes all. False where that fails, errno says why.
bool write_all(const Descriptor& file, std::string_view bytes);
/// Moves a file to another name in its folder where nothing is. False where something is, or it cannot be.
bool move_to_free_name(const std::string& from, const std::string& to);

}  // namespace traverse::results
