// Stores options and input texts in the tables of /input with a digest, and restores the options of a run from an
// existing results file. Reads frequencies, modal masses, damping ratios, shapes and outputs of the group /modes,
// checks their sizes, and writes the bending modes as comma-separated text.
#include "results/origin.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <string_view>
#include <utility>

#include "base/digest.hpp"
#include "hdf5.hpp"
#include "isolated_read.hpp"
#include "options/parse_number.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/input.hpp"

namespace traverse::results {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

constexpr const char *entries_table = "/input/options", *sources_table = "/input/sources",
                     *files_table = "/input/files";
constexpr const char *input_group = "/input", *digest_name = "digest";
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
  const htri_t has_digest = H5Aexists_by_name(file.get(), input_group, digest_name, H5P_DEFAULT);
  if (has_digest == 0 || texts.entries.empty()) return texts;  // from older versions
  long digest = 0;
  const hdf5::Id attribute(H5Aopen_by_name(file.get(), input_group, digest_name, H5P_DEFAULT, H5P_DEFAULT));
  H5Aread(attribute.get(), H5T_NATIVE_LONG, &digest);
  if (digest != digest_of_texts({texts.entries, texts.sources, texts.files}))
    throw FileError(path + ": the texts of its scene (/input) are not those that were written: the file is damaged");
  return texts;
}

using hdf5::Id;

struct Values {
  std::vector<hsize_t> shape;
  std::vector<double> numbers;
};

class ModesFile {
 public:
  explicit ModesFile(const std::string& path) : path_(path), file_(hdf5::open_whole(path)) {
    if (!has("/modes")) refuse("/modes", "there is no such group");
  }

  [[noreturn]] void refuse(const std::string& name, const std::string& why) const {
    throw InputError(fmt::format("{}: {}: {}", path_, name, why));
  }
  bool has(const std::string& name) const { return H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0; }

  Values values(const std::string& name) const {
    if (!has(name)) refuse(name, "there is no such dataset");
    const Id set(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT));
    if (set.get() < 0) refuse(name, "is no dataset");
    const Id space(H5Dget_space(set.get())), type(H5Dget_type(set.get()));
    if (H5Tget_class(type.get()) != H5T_FLOAT && H5Tget_class(type.get()) != H5T_INTEGER)
      refuse(name, "holds no numbers");
    Values values_found;
    values_found.shape.resize(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
    H5Sget_simple_extent_dims(space.get(), values_found.shape.data(), nullptr);
    values_found.numbers.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    if (H5Dread(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values_found.numbers.data()) < 0)
      refuse(name, "cannot be read");
    return values_found;
  }

  /// One number for each mode.
  std::vector<double> of_modes(const std::string& name, std::size_t modes) const {
    Values values_found = values(name);
    if (values_found.shape != std::vector<hsize_t>{modes})
      refuse(name, fmt::format("holds {} numbers, /modes/frequency {}; wanted: one a mode", values_found.numbers.size(),
                               modes));
    return std::move(values_found.numbers);
  }

  std::vector<std::string> outputs() const {
    std::vector<std::string> names;
    if (!has("/modes/outputs")) return names;
    const Id group(H5Gopen2(file_.get(), "/modes/outputs", H5P_DEFAULT));
    H5G_info_t info;
    if (group.get() < 0 || H5Gget_info(group.get(), &info) < 0) refuse("/modes/outputs", "is no group");
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      char name[256] = "";
      H5Lget_name_by_idx(group.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof(name), H5P_DEFAULT);
      names.emplace_back(name);
    }
    return names;
  }

  /// The attribute `unit`; "1" without it.
  std::string unit_of(const std::string& name) const {
    const Id object(H5Oopen(file_.get(), name.c_str(), H5P_DEFAULT));
    if (H5Aexists(object.get(), "unit") <= 0) return "1";
    const Id attribute(H5Aopen(object.get(), "unit", H5P_DEFAULT)), type(H5Aget_type(attribute.get()));
    if (H5Tget_class(type.get()) != H5T_STRING) refuse(name, "its attribute unit is no text");
    if (H5Tis_variable_str(type.get()) <= 0) {
      std::string text(H5Tget_size(type.get()), '\0');
      H5Aread(attribute.get(), type.get(), text.data());
      return text.substr(0, text.find('\0'));
    }
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), static_cast<void*>(&text)) < 0 || text == nullptr) return "1";
    std::string unit = text;
    H5free_memory(text);
    return unit;
  }

 private:
  std::string path_;
  Id file_;
};

/// A line of text with one number for each bending mode.
std::string row(const std::string& word, const std::vector<double>& numbers, const std::vector<double>& axial) {
  std::string line = word;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (axial[i] == 0.0) line += fmt::format(", {:.17g}", numbers[i]);
  return line + "\n";
}

/// The shapes of one track, one line for each station.
std::string stations(const Values& x, const double* shape, const double* slope, const std::vector<double>& axial) {
  std::string text;
  const std::size_t points = x.numbers.size();
  for (std::size_t k = 0; k < points; ++k) {
    text += fmt::format("{:.17g}", x.numbers[k]);
    for (const double* values : {shape, slope})
      for (std::size_t i = 0; values != nullptr && i < axial.size(); ++i)
        if (axial[i] == 0.0) text += fmt::format(", {:.17g}", values[i * points + k]);
    text += "\n";
  }
  return text;
}

std::string text_of(const std::string& path) {
  const ModesFile file(path);
  const std::string shapes = "/modes/shape", slopes = "/modes/slope";
  const Values frequency = file.values("/modes/frequency"), x = file.values("/modes/x"), shape = file.values(shapes);
  const std::size_t modes = frequency.numbers.size(), points = x.numbers.size();
  std::vector<double> left_out(modes, 0.0);  // modes without a deflection
  for (const char* name : {"/modes/axial", "/modes/twisting"}) {
    if (!file.has(name)) continue;
    const std::vector<double> marks = file.of_modes(name, modes);
    for (std::size_t k = 0; k < modes; ++k) left_out[k] = std::max(left_out[k], marks[k]);
  }
  const std::size_t rank = shape.shape.size();
  if (rank < 2 || rank > 3 || shape.shape[rank - 2] != modes || shape.shape[rank - 1] != points)
    file.refuse(shapes, fmt::format("wanted: [{0},{1}] or [tracks,{0},{1}], modes and stations", modes, points));
  const std::size_t tracks = rank == 3 ? shape.shape[0] : 1;
  Values slope;
  if (file.has(slopes)) slope = file.values(slopes);
  if (!slope.numbers.empty() && slope.shape != shape.shape) file.refuse(slopes, "its size is not that of /modes/shape");
  std::string text = "# the group /modes of " + path + "\n" + row("frequency", frequency.numbers, left_out) +
                     row("modal_mass", file.of_modes("/modes/modal_mass", modes), left_out) +
                     row("damping_ratio", file.of_modes("/modes/modal_damping_ratio", modes), left_out);
  for (const std::string& name : file.outputs()) {
    const std::string full = "/modes/outputs/" + name;
    text += row(fmt::format("output, {}, {}", name, file.unit_of(full)), file.of_modes(full, modes), left_out);
  }
  for (std::size_t track = 0; track < tracks; ++track)
    text += fmt::format("track, {}\n", track + 1) +
            stations(x, shape.numbers.data() + track * modes * points,
                     slope.numbers.empty() ? nullptr : slope.numbers.data() + track * modes * points, left_out);
  return text;
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
  file.attribute(input_group, digest_name, digest_of_texts({entries, sources, files}));
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

std::string modes_as_text(const std::string& path) {
  return isolated_read(path, [&] { return text_of(path); });
}

}  // namespace traverse::results
