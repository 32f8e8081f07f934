// A thin layer over the HDF5 C API: one owner per identifier, and every failure a FileError naming the file.
#pragma once

#include <hdf5.h>
#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

namespace traverse::results::hdf5 {

/// Move-only owner of one HDF5 identifier of any kind.
class Id {
 public:
  Id() = default;
  explicit Id(hid_t id) : id_(id) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Id() {
    if (id_ >= 0) H5Idec_ref(id_);
  }

  hid_t get() const { return id_; }
  hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

/// A file being written, by one process. A run that is killed leaves the state of the last flush(): superblock
/// version 2 has no mark of an unfinished writer, and whoever appends to a Series flushes at once.
class File {
 public:
  /// Creates the file and its folder, replacing an older file unless another program has it open.
  explicit File(std::string path);

  const std::string& path() const { return path_; }
  /// The identifier or status as it was; FileError with HDF5's innermost reason when it is negative.
  hid_t check(hid_t result) const;
  /// Takes the space on disk first, so that a full disk shows before anything of the file's structure is touched:
  /// HDF5 1.10 cannot close a file, nor end the program, after a flush of its own has failed.
  void flush();
  void close();
  /// After a failure: leaves on disk what is there. What HDF5 still wants to write while it closes goes into memory
  /// that vanishes with the file's descriptor.
  void abandon() noexcept;

  Id group(const std::string& name);
  /// Where attributes go: a group or dataset by its path, "/" for the root.
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, long value);
  /// A complete dataset with its attribute `unit`; groups on the way are made.
  void dataset(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
               const std::string& unit);
  /// Text in two columns, [n,2].
  void table(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows);

  hid_t id() const { return file_.get(); }
  hid_t parents() const { return parents_.get(); }  // link creation: makes the groups on the way

 private:
  int descriptor() const;
  void write_attribute(const std::string& object, const std::string& name, hid_t type, const void* value);

  std::string path_;
  Id file_, parents_, text_;
  off_t reserved_ = 0;  // bytes of the file that have their place on the disk
};

/// A dataset that grows by rows, [n] or [n, ...], with a buffer in memory.
class Series {
 public:
  /// `row`: the shape of one sample, empty for a number. `rows`: how many the buffer holds between two writes.
  Series(File& file, const std::string& name, const std::vector<hsize_t>& row, const std::string& unit, int rows);

  void add(double value) { buffer_.push_back(value); }
  template <class Values>
  void add(const Values& values) {
    buffer_.insert(buffer_.end(), values.begin(), values.end());
  }
  /// Appends the buffer to the dataset and empties it. On disk only after File::flush().
  void write(const File& file);

 private:
  Id dataset_;
  std::vector<hsize_t> shape_;  // of what is written so far
  std::size_t width_ = 1;       // numbers a row
  std::vector<double> buffer_;
};

}  // namespace traverse::results::hdf5
