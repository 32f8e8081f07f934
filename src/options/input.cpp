#include "traverse/options/input.hpp"

#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "base/petsc.hpp"
#include "options/data_file.hpp"
#include "options/other_names.hpp"
#include "options/read_file.hpp"
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

/// The name of the options file without folder and ending; _ for characters that cannot be printed.
std::string name_of_scene(const std::string& file) {
  std::string name = std::filesystem::path(file).stem().string();
  for (char& c : name) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '_';
  }
  return name;
}

void add(Input& input, Entry entry) {
  if (entry.name == "h" || entry.name == "help") {
    input.help = true;
    input.help_about = entry.value;
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
      entries.push_back({own_name(word.substr(1)), "", "PETSC_OPTIONS or .petscrc", 0});
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

bool is_common(const std::string& name) {
  const auto common = common_petsc_names();
  return std::find(common.begin(), common.end(), name) != common.end();
}

/// The options in PETSc's table that nothing has asked for.
std::vector<std::string> left_over() {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  base::check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> left(names, names + count);
  std::transform(left.begin(), left.end(), left.begin(), own_name);
  base::check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return left;
}

[[noreturn]] void refuse_left_over(const Entries& entries, const std::string& name) {
  const Entry* entry = entries.find(name);
  const auto common = common_petsc_names();
  const std::string near = nearest(name, {common.begin(), common.end()});
  throw InputError(fmt::format("option {}: {} asks for it{}", entry != nullptr ? entry->given() : name,
                               asked_by_solvers(name) ? "no solver of this scene" : "nothing",
                               near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

/// PETSc has asked for its own options when it started, or never will.
void check_asked_at_start(const Entries& entries) {
  for (const std::string& name : left_over()) {
    const bool owned = entries.has(name) && owned_by_petsc(name);
    if (owned && !asked_by_solvers(name) && !is_common(name)) refuse_left_over(entries, name);
  }
}

/// Whether PETSc's message holds the value, as it was written or as a number written otherwise.
bool speaks_of(const std::string& message, const std::string& value) {
  double wanted = 0.0, found = 0.0;
  const bool number = parse_number(value, wanted);
  std::string text = message;
  for (char& c : text) {
    if (c == '"' || c == '\'' || c == '(' || c == ')' || c == ',' || c == ';') c = ' ';
  }
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word.back() == '.' || word.back() == ':') word.pop_back();
    if (word == value || (number && parse_number(word, found) && found == wanted)) return true;
  }
  return false;
}

/// "PETSc error 86: what such errors are: what this one is", without all that is said of every such error.
std::string specific_part(const std::string& message) {
  int code = 0, length = 0;
  const char* general = nullptr;
  if (std::sscanf(message.c_str(), "PETSc error %d: %n", &code, &length) != 1 || length == 0) return message;
  std::string reason = message.substr(static_cast<std::size_t>(length));
  if (PetscErrorMessage(static_cast<PetscErrorCode>(code), &general, nullptr) != 0 || general == nullptr ||
      !reason.starts_with(general))
    return reason;
  const std::size_t begin = std::string_view(general).size() + 2;
  return begin < reason.size() ? reason.substr(begin) : reason;
}

}  // namespace

Input read_input(int argc, char** argv, const std::vector<Entry>& before) {
  Input input;
  for (const Entry& entry : before) add(input, entry);
  std::string scene_name;
  for (Entry& entry : command_line(argc, argv)) {
    if (entry.name != "options_file") {
      add(input, std::move(entry));
      continue;
    }
    if (entry.value.empty())
      throw InputError(
          "options_file (command line): wanted: the name of a file; one that starts with a dash is written ./-NAME");
    if (scene_name.empty()) scene_name = name_of_scene(entry.value);
    const std::string found = find_file(entry.value, "");
    for (Entry& inner : read_options_file(found.empty() ? entry.value : found)) add(input, std::move(inner));
  }
  take_other_names(input.entries);
  check_room(input.entries);
  input.entries.set_default({"scene_name", scene_name.empty() ? "scene" : scene_name, "options_file", 0});
  input.petsc_words.insert(input.petsc_words.begin(), argc > 0 ? argv[0] : "traverse");
  for (const Entry& entry : input.entries) {
    if (!owned_by_petsc(entry.name)) continue;
    input.petsc_words.push_back("-" + name_in_petsc(entry.name));
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
  rename_in_petsc();
  add_from_petsc(input);
  check_room(input.entries);
  for (const Entry& entry : input.entries) {
    if (owned_by_petsc(entry.name)) continue;  // PETSc has them from its arguments
    const std::string name = "-" + entry.name;
    base::check(PetscOptionsSetValue(nullptr, name.c_str(), entry.value.c_str()));
    PetscBool found = PETSC_FALSE;  // asking marks it as used, for -options_left
    base::check(PetscOptionsHasName(nullptr, nullptr, name.c_str(), &found));
  }
  PetscBool said = PETSC_FALSE;  // what is left is our own affair: check_all_used
  base::check(PetscOptionsHasName(nullptr, nullptr, "-options_left", &said));
  if (said == PETSC_FALSE) {
    base::check(PetscOptionsSetValue(nullptr, "-options_left", "no"));
    base::check(PetscOptionsHasName(nullptr, nullptr, "-options_left", &said));
  }
  last_put = input.entries;
  check_asked_at_start(last_put);
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
  std::vector<std::string> notes;
  for (const std::string& name : left_over()) {
    const bool common = is_common(name);
    if (!common && owned_by_petsc(name)) refuse_left_over(entries, name);
    const Entry* entry = entries.find(name);
    if (common && asked_by_solvers(name))
      notes.push_back((entry != nullptr ? entry->given() : name) + " has no effect in this scene");
  }
  return notes;
}

void refuse_by_petsc(const std::string& message) {
  const std::string reason = specific_part(message);
  std::string blamed, all;
  const auto add = [](std::string& list, const Entry& entry) { list += (list.empty() ? "" : ", ") + entry.given(); };
  for (const Entry& entry : last_put) {
    if (!asked_by_solvers(entry.name) || find_row(fixed_rows(), entry.name) != nullptr) continue;
    add(all, entry);
    const bool value = !entry.value.empty() && speaks_of(reason, entry.value);
    if (value || speaks_of(reason, "-" + name_in_petsc(entry.name))) add(blamed, entry);
  }
  if (blamed.empty()) blamed = all.empty() ? "an option of PETSc's solvers" : "one of " + all;
  throw InputError(blamed + ": PETSc does not allow it: " + reason);
}

}  // namespace traverse::options
