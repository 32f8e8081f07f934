#include "traverse/options/input.hpp"

#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "traverse/base/petsc.hpp"
#include "traverse/options/read_file.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

Entries last_put;  // as PETSc's own table: one for the process

/// A word that stands alone on the command line is most likely an options file without -options_file.
std::vector<Entry> command_line(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front().find_first_not_of('-') == 0) {
    throw InputError(fmt::format("command line: '{}' belongs to no option; did you mean -options_file {}?",
                                 words.front(), words.front()));
  }
  return parse_words(words, "command line", 0);
}

void add(Input& input, Entry entry) {
  if (entry.name == "h" || entry.name == "help") {
    input.help = true;
    if (entry.value == "petsc") input.petsc_words.emplace_back("-help");
  } else if (entry.name == "version" || entry.name == "v") {
    input.version = true;
  } else {
    input.entries.set(std::move(entry));
  }
}

void check_room(const Entries& entries) {
  if (entries.size() <= most_options) return;
  throw InputError(fmt::format(
      "the options files and the command line hold {} options, PETSc's table at most {}: put each vehicle into a file "
      "of its own and name it, vehicle: {{NAME: {{file: NAME.yml}}}} (the same keys without vehicle: {{NAME: ...}})",
      entries.size(), most_options));
}

/// Options that PETSc took from its environment variable or .petscrc and that we read, too.
void add_from_petsc(Input& input) {
  char* all = nullptr;
  base::check(PetscOptionsGetAll(nullptr, &all));
  std::istringstream text(all);
  (void)PetscFree(all);
  std::vector<Entry> entries;
  for (std::string word; text >> word;) {
    if (word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0) {
      entries.push_back({word.substr(1), "", "PETSC_OPTIONS or .petscrc", 0});
    } else if (!entries.empty()) {
      entries.back().value += (entries.back().value.empty() ? "" : " ") + word;
    }
  }
  for (Entry& entry : entries) {
    const bool ours = find_row(fixed_rows(), entry.name) != nullptr;
    if (ours || !owned_by_petsc(entry.name)) input.entries.set_default(std::move(entry));
  }
}

template <std::size_t count>
bool starts_with_one_of(const std::string& name, const std::array<const char*, count>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const char* p) { return name.starts_with(p); });
}

/// Kinds of options that a solver asks for, or nobody does.
bool asked_by_solvers(const std::string& name) {
  return starts_with_one_of(name, std::array{"ts_", "snes_", "ksp_", "pc_", "mat_", "vec_", "eps_", "st_", "svd_",
                                             "pep_", "nep_", "bv_", "ds_", "rg_", "fn_", "beam_"});
}

/// Kinds of options that PETSc itself asks for when it starts; a few only when it ends.
bool asked_by_petsc(const std::string& name) {
  return starts_with_one_of(name, std::array{"log_", "options_", "malloc", "info", "memory_", "objects_"});
}

}  // namespace

Input read_input(int argc, char** argv) {
  Input input;
  std::string scene_name;
  for (Entry& entry : command_line(argc, argv)) {
    if (entry.name != "options_file") {
      add(input, std::move(entry));
      continue;
    }
    if (entry.value.empty()) throw InputError("options_file (command line): wanted: the name of a file");
    if (scene_name.empty()) scene_name = std::filesystem::path(entry.value).stem().string();
    for (Entry& inner : read_options_file(entry.value)) add(input, std::move(inner));
  }
  check_room(input.entries);
  input.entries.set_default({"scene_name", scene_name.empty() ? "scene" : scene_name, "options_file", 0});
  input.petsc_words.insert(input.petsc_words.begin(), argc > 0 ? argv[0] : "traverse");
  for (const Entry& entry : input.entries) {
    if (!owned_by_petsc(entry.name)) continue;
    input.petsc_words.push_back("-" + entry.name);
    if (!entry.value.empty()) input.petsc_words.push_back(entry.value);
  }
  return input;
}

Arguments::Arguments(std::vector<std::string> words) : words_(std::move(words)) {
  for (std::string& word : words_) pointers_.push_back(word.data());
  argc_ = static_cast<int>(pointers_.size());
  pointers_.push_back(nullptr);
  argv_ = pointers_.data();
}

void put_into_petsc(Input& input) {
  add_from_petsc(input);
  check_room(input.entries);
  for (const Entry& entry : input.entries) {
    if (owned_by_petsc(entry.name)) continue;  // PETSc has them from its arguments
    const std::string name = "-" + entry.name;
    base::check(PetscOptionsSetValue(nullptr, name.c_str(), entry.value.c_str()));
    PetscBool found = PETSC_FALSE;  // asking marks it as used, for -options_left
    base::check(PetscOptionsHasName(nullptr, nullptr, name.c_str(), &found));
  }
  last_put = input.entries;
}

WithoutMonitors::WithoutMonitors() {
  static constexpr std::array prefixes = {"ts_monitor",       "ts_view",   "ts_max_steps",
                                          "ts_adapt_monitor", "ts_save",   "ts_trajectory",
                                          "snes_monitor",     "snes_view", "snes_converged_reason"};
  for (const Entry& entry : last_put)
    if (starts_with_one_of(entry.name, prefixes)) aside_.push_back(entry);
  for (const Entry& entry : aside_) base::check(PetscOptionsClearValue(nullptr, ("-" + entry.name).c_str()));
}

WithoutMonitors::~WithoutMonitors() {
  for (const Entry& entry : aside_)
    (void)PetscOptionsSetValue(nullptr, ("-" + entry.name).c_str(),
                               entry.value.empty() ? nullptr : entry.value.c_str());
}

const Entries& in_force() { return last_put; }

std::vector<std::string> check_all_used(const Entries& entries) {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  base::check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> left(names, names + count);
  base::check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  const auto common = common_petsc_names();
  const std::vector<std::string> known(common.begin(), common.end());
  std::vector<std::string> notes;
  for (const std::string& name : left) {
    const bool solver = asked_by_solvers(name);
    if (!solver && !asked_by_petsc(name)) continue;
    const Entry* entry = entries.find(name);
    const std::string given = entry != nullptr ? entry->given() : name;
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      if (solver) notes.push_back(given + " has no effect in this scene");
      continue;
    }
    const std::string near = nearest(name, known);
    throw InputError(fmt::format("option {}: {} asks for it{}", given, solver ? "no solver of this scene" : "nothing",
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  return notes;
}

}  // namespace traverse::options
