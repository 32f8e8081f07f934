// A thin layer over the HDF5 C API: one owner per identifier, and every failure a FileError naming the file.
#pragma once

#include <hdf5.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/digest.hpp"
#include "results/place.hpp"

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

/// Opens a file to read it; not valid where HDF5 cannot. Called within isolated_read.
Id open_to_read(const std::string& path);
/// An attribute's text; empty where there is none. Called within isolated_read.
std::string text_of(const Id& file, const char* object, const char* attribute);
/// The same as open_to_read where all of it can be reached, and none of it stands in other files; otherwise FileError.
Id open_whole(const std::string& path);

/// A file being written, by one process, such that a kill at any time leaves the state of the last flush() readable:
/// the oldest superblock has no mark of an unfinished writer, whoever appends to a Series flushes at once, and the
/// file's new end is on disk before anything refers to what lies there (HDF5 itself writes it last).
class File {
 public:
  /// Creates the file at its place, replacing an older one. The place is held until the file is closed.
  explicit File(Place place);

  /// Opens a copy of a results file beside its place, which it takes by take_place() and not before: of the first
  /// source whose copy `is_right`, by its path. FileError where none is.
  File(Place place, std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right);

  const std::string& path() const { return path_; }
  /// A copy that has been changed becomes the file at its place, at once.
  void take_place();
  /// The paths of all groups and datasets.
  std::vector<std::string> objects() const;
  /// Removes all others.
  void keep_only(const std::vector<std::string>& objects);
  void forget_attribute(const std::string& object, const std::string& name);
  /// The identifier or status as it was; FileError with HDF5's innermost reason when it is negative.
  hid_t check(hid_t result) const;
  /// Takes the space on disk that the next flush needs, so that a full disk shows before anything of the file's
  /// structure is touched: HDF5 1.10 cannot close a file, nor end the program, after a flush of its own has failed.
  void secure_space();
  /// FileError when the disk is full.
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
  /// The same of one that is never rewritten: what is small lies beside its description.
  void fixed_dataset(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
                     const std::string& unit);
  /// The values of a dataset that is there, in their place: nothing of the file's structure changes.
  void rewrite(const std::string& name, const std::vector<double>& values);
  /// Text in two columns as it is, [n,2].
  void texts(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows);
  /// The same, with an escape for what no reader takes.
  void table(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows);

  /// The unit of a dataset that has none yet.
  void label(const Id& dataset, const std::string& unit);
  /// The dataset to be kept open by its owner, or nothing where there are too many already.
  Id stays_open(Id dataset);

  hid_t id() const { return file_.get(); }
  hid_t parents() const { return parents_.get(); }  // link creation: makes the groups on the way
  hid_t rows_access() const { return rows_access_.get(); }

 private:
  void open(Id file);
  Id access() const;
  int descriptor() const;
  void create(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
              const std::string& unit, hid_t creation);
  void write_attribute(const std::string& object, const std::string& name, hid_t type, const void* value);

  Place place_;
  std::string path_;
  Id file_, parents_, rows_access_, compact_, text_;
  off_t reserved_ = 0;    // bytes of the file that have their place on the disk
  std::size_t open_ = 0;  // datasets that stay open
};

/// A dataset that grows by rows, [n] or [n, ...], with a buffer in memory. The first 2,000 of a file stay open, the
/// others are open only while they are written: an open one costs 20 kB, and a long train has fifty thousand.
class Series {
 public:
  struct Rows {
    std::size_t buffered = 1;  // between two writes
    std::size_t expected = 0;  // in all; 0: not known
    std::size_t there = 0;     // of the dataset that is there, and keeps no more than these; 0: it is made
    std::uint64_t digest = base::Digest().value();  // of those
  };
  /// `row`: the shape of one sample, empty for a number.
  Series(File& file, std::string name, const std::vector<hsize_t>& row, const std::string& unit, const Rows& rows);
  std::size_t rows() const { return static_cast<std::size_t>(shape_[0]); }  // written so far

  std::uint64_t digest() const { return digest_.value(); }  // of their numbers

  void add(double value) { buffer_.push_back(value); }
  /// Adds a row from its first number; returns what follows it.
  const double* add(const double* row) {
    buffer_.insert(buffer_.end(), row, row + width_);
    return row + width_;
  }
  /// Appends the buffer to the dataset and empties it. On disk only after File::flush().
  void write(File& file);

 private:
  void make(File& file, const std::string& unit, hsize_t expected);
  void cut(File& file, hsize_t rows);
  void append(File& file, const Id& dataset);

  std::string name_;
  Id dataset_;                  // where it stays open
  std::vector<hsize_t> shape_;  // of what is written so far
  base::Digest digest_;         // of the same
  std::size_t width_ = 1;       // numbers a row
  std::vector<double> buffer_;
};

/// Of the first `rows` of each dataset. FileError where there is no such one. Called within isolated_read.
std::vector<std::uint64_t> digests_of(const std::string& path, const std::vector<std::string>& names, hsize_t rows);

}  // namespace traverse::results::hdf5
