// Reads options, datasets and attributes of /study, and compares the digest of every finished run with the stored one.
#include "results/study_reader.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <exception>
#include <filesystem>
#include <span>
#include <utility>

#include "base/broadcast.hpp"
#include "base/digest.hpp"
#include "hdf5.hpp"
#include "isolated_read.hpp"
#include "results/study_table.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

using hdf5::Id;

class StudyReader {
 public:
  explicit StudyReader(const std::string& path) : path_(path), file_(hdf5::open_whole(path)) {}

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

  /// The rows of a table with two columns.
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

template <class Value>
void serialize_map(base::Bytes& bytes, std::map<std::string, Value>& map) {
  std::vector<std::pair<std::string, Value>> rows(map.begin(), map.end());
  bytes(rows);
  map = {rows.begin(), rows.end()};
}

StoredStudy group_of(const std::string& path, const std::string& group) {
  StoredStudy study;
  const StudyReader file(path);
  if (!file.has(group.c_str()) || !file.has("/options")) return study;
  study.options = file.pairs("/options");
  for (const std::string& name : file.datasets_of(group.c_str()))
    study.datasets[name] = file.numbers(group + "/" + name);
  file.attributes_of(group.c_str(), study);
  return study;
}

StoredStudy study_of(const std::string& path) {
  StoredStudy study = group_of(path, "/study");
  const auto digests = study.datasets.find(row_digest);  // older versions have none
  const auto finished = study.datasets.find("finished");
  if (digests == study.datasets.end() || finished == study.datasets.end()) return study;
  const std::vector<double> digests_now = row_digests(study.datasets);
  for (std::size_t run = 0; run < digests_now.size(); ++run)
    if (finished->second[run] == 1.0 && (run >= digests->second.size() || digests->second[run] != digests_now[run]))
      throw FileError(
          fmt::format("the results of its run {} are not those that were written: the file is damaged", run));
  return study;
}

}  // namespace

void StoredStudy::keep(base::Bytes& bytes) {
  serialize_map(bytes, options);
  serialize_map(bytes, datasets);
  serialize_map(bytes, texts);
  serialize_map(bytes, numbers);
}

std::vector<double> row_digests(const std::map<std::string, std::vector<double>>& datasets) {
  const std::size_t runs = datasets.at("finished").size();
  std::vector<double> digests;
  for (std::size_t run = 0; run < runs; ++run) {
    base::Digest digest;
    for (const StudyColumn& column : study_columns) {
      const auto found = datasets.find(column.name);
      if (found == datasets.end()) continue;
      const std::size_t width = found->second.size() / runs;
      digest.add(std::span<const double>(found->second).subspan(run * width, width));
    }
    digests.push_back(static_cast<double>(digest.value() >> 11));
  }
  return digests;
}

namespace {

bool is_empty(const std::string& path) {
  std::error_code ignored;
  return path.empty() || !std::filesystem::exists(path, ignored) || std::filesystem::file_size(path, ignored) == 0;
}

}  // namespace

StoredStudy read_study(const std::string& path) {
  return is_empty(path) ? StoredStudy() : isolated_read(path, [&] { return study_of(path); });
}

StoredStudy read_group(const std::string& path, const std::string& group) {
  return is_empty(path) ? StoredStudy() : isolated_read(path, [&] { return group_of(path, group); });
}

void read_to_resume(MPI_Comm comm, const std::string& option, const std::string& file, const std::string& others,
                    const std::string& all, const std::function<std::string()>& read) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string why;
  try {
    if (rank == 0) why = read();
  } catch (const std::exception& error) {
    why = error.what();
  }
  why = base::broadcast(comm, std::move(why));
  if (!why.empty())
    throw InputError(
        fmt::format("{}: {} contains {}: {}; without {} {} computed again", option, file, others, why, option, all));
}

}  // namespace traverse::results
