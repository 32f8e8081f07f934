// Tables that are written row by row, in any order. All space is allocated at the start, so that a row changes no
// metadata and a kill leaves every other row intact.
#include <limits>

#include "hdf5.hpp"

namespace traverse::results::hdf5 {

void File::empty_rows(const std::string& name, const std::vector<hsize_t>& shape, const std::string& unit) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const Id space(check(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr)));
  const Id creation(check(H5Pcreate(H5P_DATASET_CREATE)));
  check(H5Pset_fill_value(creation.get(), H5T_NATIVE_DOUBLE, &unknown));
  check(H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY));
  const Id data(
      check(H5Dcreate2(id(), name.c_str(), H5T_NATIVE_DOUBLE, space.get(), parents(), creation.get(), H5P_DEFAULT)));
  label(data, name, unit);
}

void File::write_row(const std::string& name, hsize_t row, const std::vector<double>& values) {
  const Id data(check(H5Dopen2(id(), name.c_str(), H5P_DEFAULT))), space(check(H5Dget_space(data.get())));
  std::vector<hsize_t> start(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.get()))), 0),
      count(start.size());
  check(H5Sget_simple_extent_dims(space.get(), count.data(), nullptr));
  start[0] = row;
  count[0] = 1;
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  const Id memory(check(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr)));
  check(H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, values.data()));
}

}  // namespace traverse::results::hdf5
