// Reads frequencies, modal masses, damping ratios, shapes and outputs of the group /modes, checks their sizes, and
// writes the bending modes as comma-separated text.
#include "results/modes_text.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "hdf5.hpp"
#include "isolated_read.hpp"
#include "traverse/base/error.hpp"

namespace traverse::results {
namespace {

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
  const std::vector<double> axial =
      file.has("/modes/axial") ? file.of_modes("/modes/axial", modes) : std::vector<double>(modes, 0.0);
  const std::size_t rank = shape.shape.size();
  if (rank < 2 || rank > 3 || shape.shape[rank - 2] != modes || shape.shape[rank - 1] != points)
    file.refuse(shapes, fmt::format("wanted: [{0},{1}] or [tracks,{0},{1}], modes and stations", modes, points));
  const std::size_t tracks = rank == 3 ? shape.shape[0] : 1;
  Values slope;
  if (file.has(slopes)) slope = file.values(slopes);
  if (!slope.numbers.empty() && slope.shape != shape.shape) file.refuse(slopes, "its size is not that of /modes/shape");
  std::string text = "# the group /modes of " + path + "\n" + row("frequency", frequency.numbers, axial) +
                     row("modal_mass", file.of_modes("/modes/modal_mass", modes), axial) +
                     row("damping_ratio", file.of_modes("/modes/modal_damping_ratio", modes), axial);
  for (const std::string& name : file.outputs()) {
    const std::string full = "/modes/outputs/" + name;
    text += row(fmt::format("output, {}, {}", name, file.unit_of(full)), file.of_modes(full, modes), axial);
  }
  for (std::size_t track = 0; track < tracks; ++track)
    text += fmt::format("track, {}\n", track + 1) +
            stations(x, shape.numbers.data() + track * modes * points,
                     slope.numbers.empty() ? nullptr : slope.numbers.data() + track * modes * points, axial);
  return text;
}

}  // namespace

std::string modes_as_text(const std::string& path) {
  return isolated_read(path, [&] { return text_of(path); });
}

}  // namespace traverse::results
