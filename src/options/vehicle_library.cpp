// Lists the files of the folders options/vehicles, options/trains and options/loads by their head lines, so that the
// list always agrees with the files.
#include "options/vehicle_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "options/read_file.hpp"
#include "traverse/base/error.hpp"

namespace traverse::options {
namespace {

/// A folder of the library, and the options that read its files.
struct LibraryFolder {
  std::string_view name, use;
};
constexpr LibraryFolder library_folders[] = {
    {"options/vehicles", "vehicles, read by -vehicle_NAME_file"},
    {"options/trains", "articulated trains, read by -options_file, and their cars, read by -vehicle_NAME_file"},
    {"options/loads", "moving forces, read by -options_file"},
};

/// The path of a folder; empty if it is not found.
std::filesystem::path library_path(std::string_view name) {
  if (std::string found = find_file(std::string(name), ""); !found.empty()) return found;
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::canonical("/proc/self/exe", ignored);
  std::filesystem::path beside = program.parent_path().parent_path() / name;
  return std::filesystem::is_directory(beside, ignored) ? beside : std::filesystem::path();
}

/// The text after `# What:` among the comment lines at the head of a file; empty if there is none.
std::string what_it_is(const std::filesystem::path& file) {
  constexpr std::string_view mark = "# What: ";
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line) && line.starts_with('#');)
    if (line.starts_with(mark)) return line.substr(mark.size());
  return "";
}

/// The YAML files of a folder with their sentences, by name.
std::vector<std::pair<std::string, std::string>> library_files(const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable))
    if (entry.path().extension() == ".yml" && entry.is_regular_file(unreadable))
      files.emplace_back(entry.path().filename().string(), what_it_is(entry.path()));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::string vehicle_library() {
  std::string out;
  for (const LibraryFolder& folder : library_folders) {
    const std::filesystem::path path = library_path(folder.name);
    if (path.empty()) continue;
    const auto files = library_files(path);
    std::size_t width = 0;
    for (const auto& [name, what] : files) width = std::max(width, name.size());
    out += fmt::format("{}{}: {}\n", out.empty() ? "" : "\n", path.string(), folder.use);
    for (const auto& [name, what] : files) out += fmt::format("  {:<{}}  {}\n", name, width, what);
  }
  if (out.empty())
    throw InputError(
        "help = vehicles: there is no folder options/vehicles in the working directory, in share/traverse, or beside "
        "the folder of the program");
  return out;
}

}  // namespace traverse::options
