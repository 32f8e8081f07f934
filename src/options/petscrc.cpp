// Collects options from the files and environment variables of PETSc, and adds the options of Traverse among them with
// the lowest precedence and a message on each. Converts option names between the older and the newer ones of PETSc, and
// former names of Traverse to the present ones, by the tables of both.
#include "options/petscrc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/petsc.hpp"
#include "options/old_names.hpp"
#include "options/read_file.hpp"
#include "traverse/base/error.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> command_line_only = {"options_file", "help", "describe", "restart",
                                                               "skip_petscrc"};

std::string_view kind_of(std::string_view name) { return name.substr(0, name.find('_')); }

/// Whether the name is an option of Traverse, possibly misspelt, and not of another program that uses PETSc.
bool belongs_to_traverse(std::string_view name) {
  if (std::find(command_line_only.begin(), command_line_only.end(), name) != command_line_only.end()) return false;
  if (owned_by_petsc(name)) return passes_to_petsc(name);
  const auto rows = fixed_rows();
  return kind_of(name) == "vehicle" ||
         std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return kind_of(row.name) == kind_of(name); });
}

std::vector<std::string> existing_files() {
  std::vector<std::string> files;
  const char* home = std::getenv("HOME");
  std::error_code ignored;
  const bool at_home = home != nullptr && fs::equivalent(home, ".", ignored);
  if (home != nullptr && !at_home) files.push_back((fs::path(home) / ".petscrc").string());
  files.insert(files.end(), {".petscrc", "petscrc"});
  std::erase_if(files, [&](const std::string& file) { return !fs::is_regular_file(file, ignored); });
  return files;
}

/// The value of an environment variable, which is removed from the environment.
std::string remove_variable(const char* name) {
  const char* value = std::getenv(name);
  std::string text = value == nullptr ? "" : value;
  unsetenv(name);
  return text;
}

}  // namespace

std::vector<Entry> read_petscrc(bool files) {
  std::vector<Entry> all;
  const auto add = [&all](std::vector<Entry> more) {
    for (Entry& entry : more) all.push_back(std::move(entry));
  };
  if (files)
    for (const std::string& file : existing_files()) add(read_classic_file(file));
  const std::string words = remove_variable("PETSC_OPTIONS"), yaml = remove_variable("PETSC_OPTIONS_YAML");
  add(parse_words(split_words(words, "PETSC_OPTIONS: "), "PETSC_OPTIONS", 0));
  add(parse_yaml(yaml, "PETSC_OPTIONS_YAML"));
  return all;
}

std::vector<std::string> add_weakest(std::vector<Entry> given, Entries& in_force) {
  std::vector<std::string> notes(given.size());
  for (std::size_t i = given.size(); i-- > 0;) {
    Entry& entry = given[i];
    entry.name = own_name(entry.name);
    if (!belongs_to_traverse(entry.name)) {
      notes[i] = entry.given() + " is ignored: Traverse does not read this option from there";
    } else if (const Entry* stronger = in_force.find(entry.name)) {
      notes[i] = entry.given() + " has no effect: " + stronger->given() + " overrides it";
    } else {
      notes[i] = entry.given() + " is in force: nothing overrides it";
      in_force.set(std::move(entry));
    }
  }
  return notes;
}

std::vector<std::string> use_own_names(Entries& entries) {
  std::vector<std::string> notes;
  const auto rename = [&](std::string_view from, std::string_view to) {
    const Entry *one = entries.find(to), *other = entries.find(from);
    if (other == nullptr) return false;
    if (one != nullptr)
      throw InputError(
          fmt::format("{}: this is another name of {}; give only one of the two", other->given(), one->given()));
    entries.rename(std::string(from), std::string(to));
    return true;
  };
  for (const base::RenamedOption& option : base::renamed_options) rename(option.newer, option.name);
  for (const OldName& old : old_names)
    if (rename(old.name, old.present))
      notes.push_back(fmt::format("{} is the former name of {}, which is read until version {} of Traverse", old.name,
                                  old.present, old.until));
  return notes;
}

std::string name_in_petsc(const std::string& name) {
  for (const base::RenamedOption& option : base::renamed_options)
    if (name == option.name) return option.known();
  return name;
}

std::string own_name(const std::string& name) {
  for (const OldName& old : old_names)
    if (name == old.name) return std::string(old.present);
  for (const base::RenamedOption& option : base::renamed_options)
    if (name == option.newer) return option.name;
  return name;
}

}  // namespace traverse::options
