#include "results/study_reader.hpp"

#include <hdf5.h>

#include <filesystem>

#include "hdf5.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

using hdf5::Id;

class Reading {
 public:
  explicit Reading(const std::string& path) : path_(path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Id access(check(H5Pcreate(H5P_FILE_ACCESS)));
    check(H5Pset_file_locking(access.get(), false, true));  // the place is locked, by this program
    file_ = Id(check(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get())));
  }

  bool has(const char* name) const { return H5Lexists(file_.get(), name, H5P_DEFAULT) > 0; }

  std::vector<std::string> datasets_of(const char* group) const {
    const Id folder(check(H5Gopen2(file_.get(), group, H5P_DEFAULT)));
    H5G_info_t info;
    check(H5Gget_info(folder.get(), &info));
    std::vector<std::string> names;
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      char name[512] = "";
      check(static_cast<hid_t>(
          H5Lget_name_by_idx(folder.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof(name), H5P_DEFAULT)));
      const Id object(check(H5Oopen(folder.get(), name, H5P_DEFAULT)));
      if (H5Iget_type(object.get()) == H5I_DATASET) names.emplace_back(name);
    }
    return names;
  }

  std::vector<double> numbers(const std::string& name) const {
    const Id set(check(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT))), space(check(H5Dget_space(set.get())));
    std::vector<double> values(static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.get()))));
    check(H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    return values;
  }

  /// Of a table with two columns.
  std::map<std::string, std::string> pairs(const char* name) const {
    const Id set(check(H5Dopen2(file_.get(), name, H5P_DEFAULT))), space(check(H5Dget_space(set.get()))),
        type(check(H5Dget_type(set.get())));
    std::vector<char*> cells(static_cast<std::size_t>(check(H5Sget_simple_extent_npoints(space.get()))));
    check(H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(cells.data())));
    std::map<std::string, std::string> pairs;
    for (std::size_t i = 0; i + 1 < cells.size(); i += 2) pairs[cells[i]] = cells[i + 1];
    check(H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, static_cast<void*>(cells.data())));
    return pairs;
  }

  void attributes_of(const char* group, StoredStudy& study) const {
    const Id folder(check(H5Oopen(file_.get(), group, H5P_DEFAULT)));
    const int count = H5Aget_num_attrs(folder.get());
    for (int i = 0; i < count; ++i) {
      const Id attribute(check(H5Aopen_by_idx(folder.get(), ".", H5_INDEX_NAME, H5_ITER_INC, static_cast<hsize_t>(i),
                                              H5P_DEFAULT, H5P_DEFAULT))),
          type(check(H5Aget_type(attribute.get())));
      char name[512] = "";
      check(static_cast<hid_t>(H5Aget_name(attribute.get(), sizeof(name), name)));
      if (H5Tget_class(type.get()) == H5T_STRING) {
        char* text = nullptr;
        check(H5Aread(attribute.get(), type.get(), static_cast<void*>(&text)));
        study.texts[name] = text == nullptr ? "" : text;
        H5free_memory(text);
      } else {
        check(H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &study.numbers[name]));
      }
    }
  }

 private:
  hid_t check(hid_t result) const {
    if (result < 0)
      throw FileError("cannot read the results file " + path_ + " that the study was to go on with: HDF5 refuses it");
    return result;
  }

  std::string path_;
  Id file_;
};

}  // namespace

StoredStudy read_study(const std::string& path) {
  StoredStudy study;
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(path, ignored) || std::filesystem::file_size(path, ignored) == 0)
    return study;
  const Reading file(path);
  if (!file.has("/study") || !file.has("/options")) return study;
  study.options = file.pairs("/options");
  for (const std::string& name : file.datasets_of("/study")) study.datasets[name] = file.numbers("/study/" + name);
  file.attributes_of("/study", study);
  return study;
}

}  // namespace traverse::results
