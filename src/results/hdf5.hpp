// A thin layer over the HDF5 C API: each identifier has one owner, and every failure throws a FileError with the file's
// name.
#pragma once

#include <hdf5.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <unordered_set>
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

/// Opens a file for reading; the identifier is invalid if HDF5 cannot open it. Called within isolated_read.
Id open_to_read(const std::string& path);
/// An attribute's text; empty without it. Called within isolated_read.
std::string text_of(const Id& file, const char* object, const char* attribute);
/// Like open_to_read, but all objects must be readable and be in this file, and no newer major version of Traverse may
/// have written it; otherwise FileError.
Id open_whole(const std::string& path);

/// A file that one process writes so that after a kill the state of the last flush() is readable: the oldest superblock
/// has no mark of an unfinished writer, every append to a Series is followed by a flush, and the file's new end is on
/// disk before any metadata refer to the new part (HDF5 itself writes it last).
class File {
 public:
  /// Creates a file beside its place, which publish() or close() moves there. The place is claimed until the file is
  /// closed.
  explicit File(Place place);

  /// Opens a copy of a results file beside its place. It is a copy of the first source for which is_right(path of the
  /// copy) is true. FileError if there is none.
  File(Place place, std::vector<std::string> sources, const std::function<bool(const std::string&)>& is_right);

  const std::string& path() const { return path_; }
  /// Moves a file from beside its place to it, atomically; nothing if it is there already.
  void publish();
  /// Continues in a copy beside the place, so that a kill leaves the file as it is now; in the file itself if the disk
  /// has no room for a copy. No dataset may be open.
  void change_beside();
  /// The paths of all groups and datasets.
  std::vector<std::string> objects() const;
  /// Removes all other objects.
  void remove_all_except(const std::vector<std::string>& objects);
  void remove_attribute(const std::string& object, const std::string& name);
  /// Returns a valid identifier or status; FileError with HDF5's innermost reason if it is negative.
  hid_t check(hid_t result) const;
  /// Allocates the disk space of the next flush, so that a full disk is detected before any metadata are written: HDF5
  /// 1.10 cannot close a file, nor end the program, after its own flush has failed.
  void secure_space();
  /// FileError if the disk is full.
  void flush();
  void close();
  /// After a failure: preserves the data on disk. Data that HDF5 writes when it closes the file go to memory
  /// that is freed with the file's descriptor.
  void abandon() noexcept;

  Id group(const std::string& name);
  /// object: a group or dataset by its path, "/" for the root.
  void attribute(const std::string& object, const std::string& name, const std::string& text);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, long value);
  /// A complete dataset with its attribute `unit`; missing parent groups are created.
  void dataset(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
               const std::string& unit);
  /// A complete dataset that is never rewritten; a small one is stored in its object header.
  void fixed_dataset(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
                     const std::string& unit);
  /// A dataset of unknown numbers (NaN), for write_row().
  void empty_rows(const std::string& name, const std::vector<hsize_t>& shape, const std::string& unit);
  /// Overwrites one row along the first dimension, without a change of metadata.
  void write_row(const std::string& name, hsize_t row, const std::vector<double>& values);
  /// Overwrites the values of an existing dataset, without a change of metadata.
  void rewrite(const std::string& name, const std::vector<double>& values);
  /// Unchanged text in two columns, [n,2].
  void texts(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows);
  /// Unchangeable text in two columns, with escapes for characters that readers reject.
  void table(const std::string& name, const std::vector<std::pair<std::string, std::string>>& rows);

  /// A dimension with a word for each place along it, unless the file has it already.
  void words(const std::string& name, const std::vector<std::string>& words);

  /// Sets the unit and the long name of a new dataset. The next flush gives it its dimensions.
  void label(const Id& dataset, const std::string& name, const std::string& unit);
  /// Returns the dataset if its owner may keep it open, or an invalid identifier if too many datasets are open.
  Id hold_open(Id dataset);

  hid_t id() const { return file_.get(); }
  hid_t parents() const { return parents_.get(); }  // link creation, which creates missing parent groups
  hid_t rows_access() const { return rows_access_.get(); }

 private:
  void open(Id file);
  void open_existing(const std::string& path);
  Id access() const;
  int descriptor() const;
  void set_text(const Id& object, const char* name, const std::string& text);
  /// Gives the new datasets their dimension scales, as netCDF-4 has them; they are created where they are missing.
  void attach_scales();
  void attach_scales(const std::string& dataset, const std::vector<std::string>& dimensions);
  struct Scale {
    std::string path;
    hobj_ref_t reference = 0;
    hsize_t length = 0;  // any length for the time, which grows
  };
  const Scale& scale_of(const std::string& dimension, hsize_t length);
  void make_scale(const Id& dataset, const std::string& name);
  void create(const std::string& name, const std::vector<hsize_t>& shape, const std::vector<double>& values,
              const std::string& unit, hid_t creation);
  void write_attribute(const std::string& object, const std::string& name, hid_t type, const void* value);

  Place place_;
  std::string path_;
  Id file_, parents_, rows_access_, compact_, text_;
  off_t reserved_ = 0;    // bytes of the file that are allocated on the disk
  std::size_t open_ = 0;  // datasets held open
  std::vector<std::pair<std::string, std::vector<std::string>>> unscaled_;  // new datasets and their dimensions
  std::unordered_map<std::string, Scale> scales_;                           // of each dimension
  std::unordered_set<std::string> linked_;                                  // paths of links to scales in other groups
};

/// A dataset that grows by rows, [n] or [n, ...], with a buffer in memory. The first 2,000 datasets of a file remain
/// open, the others are open only during a write, because an open dataset needs 20 kB and a long train has fifty
/// thousand.
class Series {
 public:
  struct Rows {
    std::size_t buffered = 1;                       // rows between two writes
    std::size_t expected = 0;                       // total number; 0: unknown
    std::size_t existing = 0;                       // rows of the existing dataset that remain; 0: a new one is created
    std::uint64_t digest = base::Digest().value();  // digest of the existing rows
  };
  /// `row`: the shape of one sample, empty for a number.
  Series(File& file, std::string name, const std::vector<hsize_t>& row, const std::string& unit, const Rows& rows);
  std::size_t rows() const { return static_cast<std::size_t>(shape_[0]); }  // number of written rows

  std::uint64_t digest() const { return digest_.value(); }  // for the written rows

  void add(double value) { buffer_.push_back(value); }
  /// Adds a row from its first number; returns the pointer behind it.
  const double* add(const double* row) {
    buffer_.insert(buffer_.end(), row, row + width_);
    return row + width_;
  }
  /// Appends the buffer to the dataset and empties it. The data are on disk only after File::flush().
  void write(File& file);

 private:
  void make(File& file, const std::string& unit, hsize_t expected);
  void cut(File& file, hsize_t rows);
  void append(File& file, const Id& dataset);

  std::string name_;
  Id dataset_;                  // valid while it is held open
  std::vector<hsize_t> shape_;  // for the written rows
  base::Digest digest_;         // for the written rows
  std::size_t width_ = 1;       // numbers in a row
  std::vector<double> buffer_;
};

/// Digests of the first `rows` rows of each dataset. FileError if one does not exist or is shorter. Called within
/// isolated_read.
std::vector<std::uint64_t> digests_of(const std::string& path, const std::vector<std::string>& names, hsize_t rows);

}  // namespace traverse::results::hdf5
