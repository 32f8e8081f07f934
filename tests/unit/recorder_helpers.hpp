// What the tests of the results file share: a sample whose numbers are known, a reader, and disasters.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results::testing {

inline Layout small_layout() {
  Layout layout;
  layout.interval = 1.0;
  layout.constants = {{"/probes/x", {2.5, 5.0}, "m"}, {"/supports/x", {0.0, 5.0, 10.0}, "m"}};
  layout.fields = {{"/probes/deflection", {2}, "m"},
                   {"/supports/reaction", {3, 3}, "N, N, N m"},
                   {"/energy/residual", {}, "J"},
                   {"/vehicles/0/car/position", {3}, "m, m, rad"},
                   {"/vehicles/0/rear_wheel/penetration", {}, "m"}};
  return layout;
}

/// Every number of a sample is different, and known from its index.
inline Sample sample_at(long i) {
  const double t = static_cast<double>(i);
  Sample sample;
  sample.time = t;
  sample.values = {t + 0.01, t + 0.11,  // probes
                   t + 0.2,  t + 0.21, t + 0.22, t + 0.23, t + 0.24,
                   t + 0.25, t + 0.26, t + 0.27, t + 0.28,  // supports
                   t + 0.85, t + 0.3,  t + 0.31, t + 0.32, t + 0.45};
  return sample;
}

/// A results file open for reading, as any other program sees it.
class Reader {
 public:
  explicit Reader(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Reader() {
    if (file_ >= 0) H5Fclose(file_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool opened() const { return file_ >= 0; }
  bool has(const std::string& name) const { return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0; }

  std::vector<hsize_t> shape(const std::string& name) const {
    const hid_t data = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    if (data < 0) return {};
    const hid_t space = H5Dget_space(data);
    std::vector<hsize_t> result(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, result.data(), nullptr);
    H5Sclose(space);
    H5Dclose(data);
    return result;
  }

  /// All numbers of a dataset, or those of its first rows.
  std::vector<double> values(const std::string& name, std::optional<hsize_t> rows = {}) const {
    auto extent = shape(name);
    if (rows && !extent.empty()) extent[0] = std::min(extent[0], *rows);
    std::size_t size = 1;
    for (const auto one : extent) size *= one;
    std::vector<double> result(size);
    const hid_t data = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    const hid_t there = H5Dget_space(data);
    const hid_t here = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const std::vector<hsize_t> start(extent.size(), 0);
    H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
    EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, result.data()), 0) << name;
    H5Sclose(here);
    H5Sclose(there);
    H5Dclose(data);
    return result;
  }

  double number(const std::string& object, const std::string& name) const {
    double value = -1.0;
    const hid_t attribute = open_attribute(object, name);
    EXPECT_GE(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), 0) << object << " " << name;
    H5Aclose(attribute);
    return value;
  }

  std::string text(const std::string& object, const std::string& name) const {
    const hid_t attribute = open_attribute(object, name);
    if (attribute < 0) return "(no attribute)";
    const hid_t type = H5Aget_type(attribute);
    char* value = nullptr;
    EXPECT_GE(H5Aread(attribute, type, &value), 0) << object << " " << name;
    std::string result = value == nullptr ? "" : value;
    H5free_memory(value);
    H5Tclose(type);
    H5Aclose(attribute);
    return result;
  }

  std::vector<std::string> options() const {
    const hid_t data = H5Dopen2(file_, "/options", H5P_DEFAULT);
    const hid_t type = H5Dget_type(data);
    std::vector<char*> cells(shape("/options")[0] * 2, nullptr);
    EXPECT_GE(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, cells.data()), 0);
    std::vector<std::string> result;
    for (char* cell : cells) {
      result.emplace_back(cell);
      H5free_memory(cell);
    }
    H5Tclose(type);
    H5Dclose(data);
    return result;
  }

 private:
  hid_t open_attribute(const std::string& object, const std::string& name) const {
    return H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }

  hid_t file_;
};

/// Runs `write` in a process of its own, kills it `delay` after its word that it may be killed.
template <class Write>
void run_and_kill(Write&& write, useconds_t delay) {
  int ready[2] = {-1, -1};
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    write([&] { std::ignore = ::write(ready[1], "x", 1); });
    for (;;) pause();
  }
  ::close(ready[1]);
  char word = 0;
  EXPECT_EQ(read(ready[0], &word, 1), 1);
  usleep(delay);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ::close(ready[0]);
}

/// Puts /dev/full in the place of this process's open file.
inline void fill_disk_of(const std::filesystem::path& file) {
  const int full = ::open("/dev/full", O_RDWR);
  struct stat wanted {};
  ASSERT_EQ(::stat(file.c_str(), &wanted), 0);
  for (int descriptor = 3; descriptor < 256; ++descriptor) {
    struct stat open {};
    if (::fstat(descriptor, &open) == 0 && open.st_dev == wanted.st_dev && open.st_ino == wanted.st_ino)
      dup2(full, descriptor);
  }
  ::close(full);
}

}  // namespace traverse::results::testing
