// Collects the formations of all tables of a fleet.
#include "screen/fleet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <unordered_set>

#include "options/input_texts.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

/// The tables of a folder, on the disk or of a results file that is run again.
std::vector<std::string> tables_in(const std::string& folder) {
  std::vector<std::string> files = options::mounted_in(folder);
  std::error_code unreadable, ignored;
  if (files.empty())
    for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable))
      if (!entry.is_directory(ignored)) files.push_back(entry.path().string());  // the reader refuses what is no file
  if (unreadable) throw InputError("screen_fleet: the folder " + folder + ": " + unreadable.message());
  std::erase_if(files, [](const std::string& file) { return std::filesystem::path(file).extension() != ".csv"; });
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError("screen_fleet: the folder " + folder + " contains no .csv files");
  return files;
}

}  // namespace

std::vector<Formation> read_fleet(const std::string& path, std::vector<std::string>& notes) {
  std::vector<Formation> fleet;
  std::error_code ignored;
  const bool folder = !options::mounted_in(path).empty() || std::filesystem::is_directory(path, ignored);
  for (const std::string& file : folder ? tables_in(path) : std::vector<std::string>{path}) {
    std::string note;
    std::ranges::move(scene::read_formations(file, note), std::back_inserter(fleet));
    if (!note.empty()) notes.push_back(note);
  }
  std::unordered_set<std::string> names;
  for (const Formation& formation : fleet)
    if (!names.insert(formation.name).second)
      throw InputError(fmt::format("{}: the formation {} is given twice", path, formation.name));
  return fleet;
}

}  // namespace traverse::screen
