// Unit, long name and dimension scales of each dataset as netCDF-4 has them. Its readers look for the coordinates of a
// dataset in the dataset's group and in the parents of it. REFERENCE_LIST, the way back from a scale, is left out: no
// reader needs it, and it would be rewritten for each of the fifty thousand datasets of a long train.
#include <array>
#include <utility>

#include "hdf5.hpp"
#include "results/dataset_words.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results::hdf5 {
namespace {

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
    if (const std::string folder = folder_of(dataset); !folder.starts_with(folder_of(scale.path)))
      if (const std::string here = folder + last_of(scale.path); check(H5Lexists(id(), here.c_str(), H5P_DEFAULT)) == 0)
        check(H5Lcreate_hard(id(), scale.path.c_str(), id(), here.c_str(), H5P_DEFAULT, H5P_DEFAULT));
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
