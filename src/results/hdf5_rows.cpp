// Tables that are written row by row, in any order, and series, which grow by blocks of rows. All space of a table is
// allocated at the start, so that a row changes no metadata and a kill leaves every other row intact.
//
// Each dataset has unit, long name and dimension scales as netCDF-4 has them. Its readers look for the coordinates of a
// dataset in the dataset's group and in the parents of it, some in the group only: there it has a link to the time and
// to coordinates that are in none of these. REFERENCE_LIST, the way
// back from a scale, is left out: no reader needs it, and H5DSattach_scale would rewrite it for each of the fifty
// thousand datasets of a long train, for two minutes (decision 041).
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "hdf5.hpp"
#include "results/dataset_words.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results::hdf5 {
namespace {

constexpr hsize_t kChunkRows = 256;
constexpr hsize_t kChunkBytes = 1 << 20;
constexpr hsize_t kMaxChunks = 60;           // a node of the index has 64
constexpr hsize_t kMaxChunkBytes = 1 << 15;  // limit of chunks that are enlarged for that

// What netCDF-4 writes for a dimension without coordinates, which its readers do not show as a variable.
constexpr const char* without_coordinates = "This is a netCDF dimension but not a netCDF variable.";

std::string folder_of(const std::string& path) { return path.substr(0, path.find_last_of('/') + 1); }
std::string last_of(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

hsize_t length_of(const File& file, const std::string& name) {
  const Id data(file.check(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT)));
  const Id space(file.check(H5Dget_space(data.get())));
  std::array<hsize_t, H5S_MAX_RANK> shape{};
  file.check(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr));
  return shape[0];
}

}  // namespace

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

Series::Series(File& file, std::string name, const std::vector<hsize_t>& row, const std::string& unit, const Rows& rows)
    : name_(std::move(name)),
      shape_{0},
      width_(std::accumulate(row.begin(), row.end(), std::size_t{1},
                             [](std::size_t a, hsize_t b) { return a * static_cast<std::size_t>(b); })) {
  shape_.insert(shape_.end(), row.begin(), row.end());
  if (rows.existing == 0)
    make(file, unit, rows.expected);
  else
    cut(file, rows.existing);
  digest_ = base::Digest(rows.digest);
  buffer_.reserve(width_ * rows.buffered);
}

// If the process is killed while HDF5 splits the index of the chunks, the index is damaged. Therefore the expected
// chunks fit into one node of it.
void Series::make(File& file, const std::string& unit, hsize_t expected) {
  auto max_shape = shape_;
  max_shape[0] = H5S_UNLIMITED;
  auto chunk = shape_;
  const hsize_t row = sizeof(double) * width_, default_rows = std::clamp<hsize_t>(kChunkBytes / row, 1, kChunkRows);
  chunk[0] = std::max(default_rows, std::min(expected / kMaxChunks + 1, kMaxChunkBytes / row));

  const Id space(file.check(H5Screate_simple(static_cast<int>(shape_.size()), shape_.data(), max_shape.data())));
  const Id creation(file.check(H5Pcreate(H5P_DATASET_CREATE)));
  file.check(H5Pset_chunk(creation.get(), static_cast<int>(chunk.size()), chunk.data()));
  file.check(H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER));
  Id dataset(file.check(H5Dcreate2(file.id(), name_.c_str(), H5T_NATIVE_DOUBLE, space.get(), file.parents(),
                                   creation.get(), file.rows_access())));
  file.label(dataset, name_, unit);
  dataset_ = file.hold_open(std::move(dataset));
}

void Series::cut(File& file, hsize_t rows) {
  Id dataset(file.check(H5Dopen2(file.id(), name_.c_str(), file.rows_access())));
  const Id space(file.check(H5Dget_space(dataset.get())));
  std::vector<hsize_t> existing(shape_.size());
  const bool fits = H5Sget_simple_extent_ndims(space.get()) == static_cast<int>(shape_.size()) &&
                    H5Sget_simple_extent_dims(space.get(), existing.data(), nullptr) >= 0 && existing[0] >= rows &&
                    std::equal(existing.begin() + 1, existing.end(), shape_.begin() + 1);
  if (!fits)
    throw FileError("cannot write the results file " + file.path() +
                    ": the results to take up are not those of the checkpoint");
  shape_[0] = rows;
  file.check(H5Dset_extent(dataset.get(), shape_.data()));
  dataset_ = file.hold_open(std::move(dataset));
}

void Series::write(File& file) {
  if (buffer_.empty()) return;
  if (dataset_.get() >= 0) return append(file, dataset_);
  append(file, Id(file.check(H5Dopen2(file.id(), name_.c_str(), file.rows_access()))));
}

void Series::append(File& file, const Id& dataset) {
  const hsize_t rows = buffer_.size() / width_;
  std::vector<hsize_t> start(shape_.size(), 0), count = shape_;
  start[0] = shape_[0];
  count[0] = rows;
  shape_[0] += rows;
  file.check(H5Dset_extent(dataset.get(), shape_.data()));
  const Id file_space(file.check(H5Dget_space(dataset.get())));
  const Id memory_space(file.check(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr)));
  file.check(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  file.check(
      H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, memory_space.get(), file_space.get(), H5P_DEFAULT, buffer_.data()));
  file.secure_space();  // HDF5 may write metadata when its cache is full
  digest_.add(buffer_);
  buffer_.clear();
}

std::vector<std::uint64_t> digests_of(const std::string& path, const std::vector<std::string>& names, hsize_t rows) {
  const auto check = [&](hid_t result) {
    if (result < 0) throw FileError(path + ": HDF5 cannot read it: the file is damaged");
    return result;
  };
  const Id file = open_whole(path);
  std::vector<std::uint64_t> digests;
  std::vector<double> block;
  for (const std::string& name : names) {
    const Id data(check(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT))), file_space(check(H5Dget_space(data.get())));
    std::vector<hsize_t> shape(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(file_space.get()))));
    check(H5Sget_simple_extent_dims(file_space.get(), shape.data(), nullptr));
    if (shape.empty() || shape[0] < rows) check(H5I_INVALID_HID);
    const hsize_t width = std::accumulate(shape.begin() + 1, shape.end(), hsize_t{1}, std::multiplies<>());
    base::Digest digest;
    std::vector<hsize_t> start(shape.size(), 0), count = shape;
    for (; start[0] < rows; start[0] += count[0]) {
      count[0] = std::min(std::max<hsize_t>(kChunkBytes / (sizeof(double) * width), 1), rows - start[0]);
      block.resize(count[0] * width);
      const Id memory_space(check(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr)));
      check(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
      check(H5Dread(data.get(), H5T_NATIVE_DOUBLE, memory_space.get(), file_space.get(), H5P_DEFAULT, block.data()));
      digest.add(block);
    }
    digests.push_back(digest.value());
  }
  return digests;
}

void File::set_text(const Id& object, const char* name, const std::string& text) {
  const std::string valid = printable(text);
  const char* value = valid.c_str();
  const Id space(check(H5Screate(H5S_SCALAR)));
  const Id attribute(check(H5Acreate2(object.get(), name, text_.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT)));
  check(H5Awrite(attribute.get(), text_.get(), &value));
}

void File::label(const Id& dataset, const std::string& name, const std::string& unit) {
  const Id space(check(H5Dget_space(dataset.get())));
  DatasetWords words = words_of(name, static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space.get()))));
  set_text(dataset, "unit", unit);
  set_text(dataset, "units", unit);
  set_text(dataset, "long_name", words.long_name);
  if (!words.dimensions.empty()) unscaled_.emplace_back(name, std::move(words.dimensions));
}

void File::make_scale(const Id& dataset, const std::string& name) {
  if (check(H5Aexists(dataset.get(), "CLASS")) > 0) return;
  const auto text = [&](const char* attribute, const std::string& value) {  // of fixed length, as the library writes it
    const Id type(check(H5Tcopy(H5T_C_S1))), space(check(H5Screate(H5S_SCALAR)));
    check(H5Tset_size(type.get(), value.size() + 1));
    const Id made(check(H5Acreate2(dataset.get(), attribute, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT)));
    check(H5Awrite(made.get(), type.get(), value.c_str()));
  };
  text("CLASS", "DIMENSION_SCALE");
  text("NAME", name);
}

void File::words(const std::string& name, const std::vector<std::string>& words) {
  if (check(H5Lexists(id(), name.c_str(), H5P_DEFAULT)) > 0) return;
  std::vector<const char*> cells;
  for (const std::string& word : words) cells.push_back(word.c_str());
  const hsize_t count = cells.size();
  const Id space(check(H5Screate_simple(1, &count, nullptr)));
  const Id data(check(H5Dcreate2(id(), name.c_str(), text_.get(), space.get(), parents(), H5P_DEFAULT, H5P_DEFAULT)));
  check(H5Dwrite(data.get(), text_.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(cells.data())));
  set_text(data, "unit", "text");
  make_scale(data, name_of_dimension(name));
}

// The dataset of a dimension: the named one if it has this length, otherwise one without coordinates at the root.
const File::Scale& File::scale_of(const std::string& dimension, hsize_t length) {
  const auto known = scales_.find(dimension);
  if (known != scales_.end()) return known->second;
  const auto exists = [&](const std::string& path) {
    return check(H5Lexists(id(), folder_of(path).c_str(), H5P_DEFAULT)) > 0 &&
           check(H5Lexists(id(), path.c_str(), H5P_DEFAULT)) > 0;
  };
  Scale scale{exists(dimension) ? dimension : "/" + last_of(dimension)};
  if (!exists(scale.path)) {
    if (const std::vector<std::string> along = words_along(scale.path); along.size() == length) {
      words(scale.path, along);
    } else {
      const Id space(check(H5Screate_simple(1, &length, nullptr)));
      make_scale(Id(check(H5Dcreate2(id(), scale.path.c_str(), H5T_IEEE_F32BE, space.get(), parents(), H5P_DEFAULT,
                                     H5P_DEFAULT))),
                 without_coordinates);
    }
  }
  make_scale(Id(check(H5Dopen2(id(), scale.path.c_str(), H5P_DEFAULT))), name_of_dimension(scale.path));
  check(H5Rcreate(&scale.reference, id(), scale.path.c_str(), H5R_OBJECT, H5I_INVALID_HID));
  scale.length = length_of(*this, scale.path);
  return scales_.emplace(dimension, std::move(scale)).first->second;
}

void File::attach_scales(const std::string& dataset, const std::vector<std::string>& dimensions) {
  const Id data(check(H5Dopen2(id(), dataset.c_str(), H5P_DEFAULT)));
  if (dimensions == std::vector{dataset}) return make_scale(data, name_of_dimension(dataset));
  const Id space(check(H5Dget_space(data.get())));
  std::array<hsize_t, H5S_MAX_RANK> shape{};
  check(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr));
  std::vector<hobj_ref_t> references(dimensions.size());
  std::vector<hvl_t> lists;
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const Scale& scale = scale_of(dimensions[i], shape[i]);
    if (scale.length != shape[i] && scale.path != "/time") return;
    const std::string folder = folder_of(dataset), here = folder + last_of(scale.path),
                      of_scale = folder_of(scale.path);
    const bool in_parent = folder.starts_with(of_scale);
    if (!in_parent || (folder != of_scale && last_of(scale.path) == "time"))
      if (linked_.insert(here).second && check(H5Lexists(id(), here.c_str(), H5P_DEFAULT)) == 0)
        check(in_parent ? H5Lcreate_soft(scale.path.c_str(), id(), here.c_str(), H5P_DEFAULT, H5P_DEFAULT)
                        : H5Lcreate_hard(id(), scale.path.c_str(), id(), here.c_str(), H5P_DEFAULT, H5P_DEFAULT));
    references[i] = scale.reference;
    lists.push_back({1, &references[i]});
  }
  const hsize_t rank = lists.size();
  const Id type(check(H5Tvlen_create(H5T_STD_REF_OBJ))), row(check(H5Screate_simple(1, &rank, nullptr)));
  const Id list(check(H5Acreate2(data.get(), "DIMENSION_LIST", type.get(), row.get(), H5P_DEFAULT, H5P_DEFAULT)));
  check(H5Awrite(list.get(), type.get(), lists.data()));
}

void File::attach_scales() {
  for (const auto& [dataset, dimensions] : std::exchange(unscaled_, {})) attach_scales(dataset, dimensions);
}

}  // namespace traverse::results::hdf5
