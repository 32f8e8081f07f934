// Stores options and input texts in the tables of /input with a digest, and restores the options of a run from an
// existing results file.
#include "results/origin.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <string_view>
#include <utility>

#include "base/digest.hpp"
#include "hdf5.hpp"
#include "isolated_read.hpp"
#include "options/data_file.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse::results {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

constexpr const char *entries_table = "/input/options", *sources_table = "/input/sources",
                     *files_table = "/input/files";
constexpr const char *group = "/input", *digest_name = "digest";
constexpr std::string_view new_name = "another name than ";
// Options that apply to a single run only.
std::string opened_file;
constexpr std::array single_run_options = {"restart",  "checkpoint_file", "options_file", "ts_max_steps",
                                           "log_view", "malloc_debug",    "skip_petscrc"};

bool is_of_single_run(const std::string& name) {
  return std::find(single_run_options.begin(), single_run_options.end(), name) != single_run_options.end();
}

std::string without_mount(const std::string& name) { return name.substr(options::mounted(name).size()); }

long digest_of_texts(const std::vector<Pairs>& tables) {
  base::Digest digest;
  for (const Pairs& set : tables) {
    digest.add(std::to_string(set.size()) + ";");
    for (const auto& [key, value] : set) {
      for (const std::string* text : {&key, &value}) {
        digest.add(std::to_string(text->size()) + ":");
        digest.add(*text);
      }
    }
  }
  return std::bit_cast<long>(digest.value());
}

/// A table with two columns; empty if it does not exist.
Pairs read_pairs(hid_t file, const char* name) {
  Pairs pairs;
  const hdf5::Id data(H5Dopen2(file, name, H5P_DEFAULT));
  if (data.get() < 0) return pairs;
  const hdf5::Id space(H5Dget_space(data.get())), type(H5Dget_type(data.get()));
  hsize_t shape[2] = {0, 0};
  if (H5Sget_simple_extent_ndims(space.get()) != 2 || H5Sget_simple_extent_dims(space.get(), shape, nullptr) < 0 ||
      shape[1] != 2 || H5Tis_variable_str(type.get()) <= 0)
    return pairs;
  std::vector<char*> cells(2 * shape[0], nullptr);
  if (shape[0] == 0 || H5Dread(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, cells.data()) < 0) return pairs;
  const auto text = [](const char* cell) { return std::string(cell == nullptr ? "" : cell); };
  for (std::size_t i = 0; i < cells.size(); i += 2) pairs.emplace_back(text(cells[i]), text(cells[i + 1]));
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, cells.data());
  return pairs;
}

struct Texts {
  Pairs entries, sources, files;
  void keep(base::Bytes& bytes) { bytes(entries, sources, files); }
};

/// Called in a separate process. FileError if the texts differ from those that were written.
Texts texts_of(const std::string& path) {
  const hdf5::Id file = hdf5::open_whole(path);
  Texts texts;
  for (const auto& [name, pairs] :
       {std::pair{entries_table, &texts.entries}, {sources_table, &texts.sources}, {files_table, &texts.files}})
    *pairs = read_pairs(file.get(), name);
  const htri_t has_digest = H5Aexists_by_name(file.get(), group, digest_name, H5P_DEFAULT);
  if (has_digest == 0 || texts.entries.empty()) return texts;  // from older versions
  long digest = 0;
  const hdf5::Id attribute(H5Aopen_by_name(file.get(), group, digest_name, H5P_DEFAULT, H5P_DEFAULT));
  H5Aread(attribute.get(), H5T_NATIVE_LONG, &digest);
  if (digest != digest_of_texts({texts.entries, texts.sources, texts.files}))
    throw FileError(path + ": the texts of its scene (/input) are not those that were written: the file is damaged");
  return texts;
}

}  // namespace

void record_origin(hdf5::File& file) {
  Pairs entries, sources, files;
  for (const options::Entry& entry : options::in_force()) {
    if (is_of_single_run(entry.name)) continue;
    entries.emplace_back(entry.name, entry.value);
    sources.emplace_back(without_mount(entry.source), std::to_string(entry.line));
  }
  if (entries.empty()) return;
  for (const options::InputText& text : options::inputs_read()) files.emplace_back(text.name, text.text);
  file.texts(entries_table, entries);
  file.texts(sources_table, sources);
  file.texts(files_table, files);
  file.attribute(group, digest_name, digest_of_texts({entries, sources, files}));
}

bool is_hdf5(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && H5Fis_hdf5(path.c_str()) > 0;
}

std::vector<options::Entry> origin_of(const std::string& path) {
  auto [stored, sources, files] = isolated_read(path, [&] { return texts_of(path); });
  if (stored.empty() || sources.size() != stored.size())
    throw InputError(path +
                     ": holds no texts of its scene, as files of older versions; run the scene's own options files");
  opened_file = path;
  const std::string prefix = path + ":";
  std::vector<options::InputText> texts;
  for (auto& [name, text] : files) texts.push_back({name, std::move(text)});
  options::mount_inputs(prefix, std::move(texts));
  std::vector<options::Entry> entries;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    double line = 0.0;
    (void)options::parse_number(sources[i].second, line);
    if (stored[i].first == "output_file" || is_of_single_run(stored[i].first)) continue;
    // All entries are in a file now, also the entries of the command line: the files that they name are found in it.
    entries.push_back(
        {stored[i].first, stored[i].second, prefix + sources[i].first, std::max(1, static_cast<int>(line))});
  }
  const std::filesystem::path given(path);
  const std::string new_file = (given.parent_path() / (given.stem().string() + "_again.h5")).string();
  entries.push_back({"output_file", new_file, std::string(new_name) + path, 0});
  return entries;
}

const std::string& opened_origin() { return opened_file; }

bool is_new_name(const options::Entry& output_file) { return output_file.source.starts_with(new_name); }

}  // namespace traverse::results
