// Compares every floating-point dataset of two results files relative to its peak; mode shapes may differ in sign.
#include "support/same_on_ranks.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <petscsys.h>

#include <algorithm>
#include <cmath>

namespace traverse::test {
namespace {

// Names of all datasets of numbers.
std::vector<std::string> datasets(const std::string& path) {
  std::vector<std::string> names;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  auto visit = [](hid_t root, const char* name, const auto* info,
                  void* into) -> herr_t {  // H5O_info_t depends on the version of HDF5
    if (info->type != H5O_TYPE_DATASET) return 0;
    const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
    const hid_t type = H5Dget_type(set);
    if (H5Tget_class(type) == H5T_FLOAT)
      static_cast<std::vector<std::string>*>(into)->push_back(std::string("/") + name);
    H5Tclose(type);
    H5Dclose(set);
    return 0;
  };
  H5Ovisit1(file, H5_INDEX_NAME, H5_ITER_INC, visit, &names);
  H5Fclose(file);
  return names;
}

// The sign of a mode is arbitrary: the largest ordinate is made positive.
std::vector<double> with_sign(std::vector<double> shapes, std::size_t modes) {
  const std::size_t nodes = shapes.size() / modes;
  for (std::size_t m = 0; m < modes; ++m) {
    const auto begin = shapes.begin() + static_cast<std::ptrdiff_t>(m * nodes);
    const auto end = begin + static_cast<std::ptrdiff_t>(nodes);
    double first = 0.0, largest = 0.0;
    for (auto it = begin; it != end; ++it) largest = std::max(largest, std::abs(*it));
    for (auto it = begin; it != end && first == 0.0; ++it) {
      if (std::abs(*it) > 0.1 * largest) first = *it;
    }
    if (first < 0.0) std::transform(begin, end, begin, [](double x) { return -x; });
  }
  return shapes;
}

/// A dataset. A dataset of the end of the run follows the series that it continues, so that differences are relative to
/// the peak of this series.
std::vector<double> with_series(Results& run, const std::string& name) {
  if (!name.starts_with("/end/")) return run(name);
  std::vector<double> all = run(name.substr(4));
  const std::vector<double>& end = run(name);
  all.insert(all.end(), end.begin(), end.end());
  return all;
}

}  // namespace

void expect_same(Results& one, Results& all, std::size_t least, double at_rest, double bound) {
  const std::vector<std::string> names = datasets(one.file());
  EXPECT_EQ(names, datasets(all.file()));
  EXPECT_GE(names.size(), least);
  for (const std::string& name : names) {
    if (name.ends_with("residual")) continue;
    const std::size_t modes = name == "/modes/shape" ? one("/modes/frequency").size() : 0;
    const std::vector<double> a = modes > 0 ? with_sign(all(name), modes) : with_series(all, name);
    const std::vector<double> b = modes > 0 ? with_sign(one(name), modes) : with_series(one, name);
    ASSERT_EQ(a.size(), b.size()) << name;
    if (name.ends_with("/balance/inertia") && at_rest > 0.0) continue;
    if (name.ends_with("acceleration") && at_rest > 0.0) {
      EXPECT_LT(std::max(std::abs(peak(a).first), std::abs(peak(b).first)), at_rest) << name;
      continue;
    }
    EXPECT_LT(relative_difference(a, b), bound) << name;
  }
}

void expect_same_on_all_ranks(const std::string& scene, const Values& options, std::size_t least, double bound) {
  Results all = run_scene(scene, options, PETSC_COMM_WORLD);
  Results one = run_scene(scene, options, PETSC_COMM_SELF);
  expect_same(one, all, least, 0.0, bound);
}

}  // namespace traverse::test
