// Merges command line, options files and .petscrc by precedence, sets the permitted options in PETSc's table, and names
// the options that PETSc refuses or does not use. The list of options is ordered with an index by name; a later entry
// of the same name replaces the earlier one.
#include "traverse/options/input.hpp"

#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>

#include "base/petsc.hpp"
#include "options/parse_number.hpp"
#include "options/petscrc.hpp"
#include "options/read_file.hpp"
#include "traverse/options/options.hpp"
#include "traverse/options/table.hpp"

namespace traverse::options {
namespace {

// There is one set of options per process, as in PETSc.
Entries last_put;
std::vector<std::string> last_notes;

/// The entries of the command line. A first word without a dash is probably an options file without -options_file, or
/// a verb with an error of spelling.
std::vector<Entry> command_line(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front().find_first_not_of('-') == 0) {
    const bool is_file = words.front().find_first_of("./") != std::string::npos;
    throw InputError(fmt::format("command line: '{}' is {}", words.front(),
                                 is_file
                                     ? "not the value of an option; did you mean -options_file " + words.front() + "?"
                                     : "no verb and no option; traverse run SCENE.yml computes a scene"));
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
  } else if (entry.name == "version" || entry.name == "v") {
    input.version = true;
  } else {
    input.entries.set(std::move(entry));
  }
}

/// Refuses options of PETSc that are not permitted, and values that could name a file or a viewer: the permitted values
/// are numbers, plain words, true and false.
void check_for_petsc(const Entries& entries) {
  Entries passing;
  for (const Entry& entry : entries) {
    if (passes_to_petsc(entry.name)) {
      passing.set(entry);
    } else if (owned_by_petsc(entry.name)) {
      std::vector<std::string> names;
      for (const Row& row : fixed_rows())
        if (passes_to_petsc(row.name)) names.emplace_back(row.name);
      const std::string near = nearest(entry.name, names);
      throw InputError(
          fmt::format("option {}: Traverse does not pass this option to PETSc; -help step and -help petsc list the "
                      "permitted ones{}",
                      entry.given(), near.empty() ? "" : fmt::format("; did you mean {}?", near)));
    }
  }
  const Options options(passing);
  options.check_values();
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  for (const Entry& entry : passing) {
    const std::string value = find_row(fixed_rows(), entry.name)->kind == Kind::text ? options.text(entry.name) : "";
    if (!std::all_of(value.begin(), value.end(), plain))
      options.refuse(entry.name, "allowed: a word of letters, digits and _");
  }
}

struct PetscOption {
  std::string name, value;  // value: empty for an option without one
};

bool flag_of(const Entry& entry) {
  Entries alone;
  alone.set(entry);
  return Options(alone).flag(entry.name);
}

/// The option as PETSc reads it; none for a viewer that is switched off.
std::optional<PetscOption> for_petsc(const Entry& entry) {
  constexpr std::array viewers = {"ts_monitor",           "ts_view", "tao_monitor", "tao_view",
                                  "tao_converged_reason", "log_view"};  // a value would name a kind of output
  PetscOption option{"-" + name_in_petsc(entry.name), entry.value};
  if (std::find(viewers.begin(), viewers.end(), entry.name) == viewers.end()) return option;
  if (!flag_of(entry)) return std::nullopt;
  option.value.clear();
  return option;
}

bool is_read_by_solvers(const Entry& entry) { return entry.name.starts_with("ts_") || entry.name.starts_with("tao_"); }

void put(const Entry& entry) {
  if (const std::optional<PetscOption> option = for_petsc(entry))
    base::check(
        PetscOptionsSetValue(nullptr, option->name.c_str(), option->value.empty() ? nullptr : option->value.c_str()));
}

/// The options in PETSc's table that PETSc has not read.
std::vector<std::string> unread_options() {
  PetscInt count = 0;
  char **names = nullptr, **values = nullptr;
  base::check(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> left(names, names + count);
  std::transform(left.begin(), left.end(), left.begin(), own_name);
  base::check(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return left;
}

/// Whether it is an option of the step-size control that PETSc reads but does not use with this ts_adapt_type.
bool is_without_control(const Entry& entry, const Entries& entries) {
  constexpr std::array options = {"ts_rtol",         "ts_atol",       "ts_adapt_dt_max",
                                  "ts_adapt_dt_min", "ts_adapt_clip", "ts_adapt_safety"};
  const Entry* control = entries.find("ts_adapt_type");
  const std::string type = control != nullptr ? control->value : "none";
  return std::find(options.begin(), options.end(), entry.name) != options.end() &&
         (type == "none" || (type == "ladder" && entry.name != "ts_rtol"));
}

/// Whether PETSc's message contains the value, as given or as the same number in another notation.
bool mentions(const std::string& message, const std::string& value) {
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

/// The last part of a message "PETSc error 86: general text: specific text".
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

/// Adds the entries of the file that an option options_file names.
void add_file(Input& input, const Entry& named) {
  if (named.value.empty())
    throw InputError(
        "options_file (command line): the name of a file is missing; write ./-NAME for a name that begins with a dash");
  const std::string found = find_file(named.value, "");
  for (Entry& inner : read_options_file(found.empty() ? named.value : found)) {
    if (inner.name == "skip_petscrc") throw InputError(inner.given() + ": allowed only on the command line");
    add(input, std::move(inner));
  }
}

}  // namespace

Input read_input(int argc, char** argv, const std::vector<Entry>& before, bool petscrc) {
  Input input;
  for (const Entry& entry : before) add(input, entry);
  std::string scene_name;
  bool files = true;
  for (Entry& entry : command_line(argc, argv)) {
    if (entry.name == "skip_petscrc") {
      files = !flag_of(entry);
    } else if (entry.name != "options_file") {
      add(input, std::move(entry));
      continue;
    } else {
      add_file(input, entry);
      if (scene_name.empty()) scene_name = name_of_scene(entry.value);
    }
  }
  input.notes = use_own_names(input.entries);
  if (petscrc) {
    std::vector<std::string> others = add_weakest(read_petscrc(files), input.entries);
    std::move(others.begin(), others.end(), std::back_inserter(input.notes));
  }
  input.entries = complete(std::move(input.entries), scene_name.empty() ? "scene" : scene_name);
  input.petsc_words = {argc > 0 ? argv[0] : "traverse", "-skip_petscrc", "true", "-options_left", "false"};
  for (const Entry& entry : input.entries) {
    if (!passes_to_petsc(entry.name)) continue;
    const std::optional<PetscOption> option = for_petsc(entry);
    if (!option) continue;
    input.petsc_words.push_back(option->name);
    if (!option->value.empty()) input.petsc_words.push_back(option->value);
  }
  return input;
}

Entries complete(Entries entries, const std::string& scene_name) {
  (void)use_own_names(entries);
  entries.set_default({"scene_name", scene_name, "options_file", 0});
  check_for_petsc(entries);
  return entries;
}

Arguments::Arguments(std::vector<std::string> words) : words_(std::move(words)) {
  for (std::string& word : words_) pointers_.push_back(word.data());
  argc_ = static_cast<int>(pointers_.size());
  pointers_.push_back(nullptr);
  argv_ = pointers_.data();
}

void put_into_petsc(const Input& input) {
  for (const Entry& entry : input.entries)
    if (is_read_by_solvers(entry)) put(entry);
  last_put = input.entries;
  last_notes = input.notes;
}

InPetsc::InPetsc(const Entries& entries) {
  for (const Entry& entry : entries) {
    if (!is_read_by_solvers(entry)) continue;
    put(entry);
    names_.push_back("-" + name_in_petsc(entry.name));
  }
}

InPetsc::~InPetsc() {
  for (const std::string& name : names_) (void)PetscOptionsClearValue(nullptr, name.c_str());
}

WithoutMonitors::WithoutMonitors() {
  static constexpr std::array names = {"ts_monitor", "ts_view", "ts_max_steps", "ts_adapt_monitor"};
  for (const Entry& entry : last_put)
    if (std::find(names.begin(), names.end(), entry.name) != names.end()) hidden_.push_back(entry);
  for (const Entry& entry : hidden_) base::check(PetscOptionsClearValue(nullptr, ("-" + entry.name).c_str()));
}

WithoutMonitors::~WithoutMonitors() {
  for (const Entry& entry : hidden_)
    if (const std::optional<PetscOption> option = for_petsc(entry))
      (void)PetscOptionsSetValue(nullptr, option->name.c_str(),
                                 option->value.empty() ? nullptr : option->value.c_str());
}

const std::vector<std::string>& notes_on_input() { return last_notes; }

const Entries& in_force() { return last_put; }

std::vector<std::string> notes_on_unused(const Entries& entries) {
  const std::vector<std::string> left = unread_options();
  const bool vehicles = std::any_of(entries.begin(), entries.end(), [](const Entry& entry) {
    return entry.name.starts_with("vehicle") || entry.name.find("train_vehicles") != std::string::npos;
  });
  std::vector<std::string> notes;
  for (const Entry& entry : entries) {
    if (!vehicles && (entry.name.starts_with("train_") || entry.name.starts_with("contact_")))
      notes.push_back(entry.given() + " has no effect: no vehicles run in this scene");
    if (!is_read_by_solvers(entry)) continue;
    if (std::find(left.begin(), left.end(), entry.name) != left.end())
      notes.push_back(entry.given() + " has no effect in this scene");
    else if (is_without_control(entry, entries))
      notes.push_back(entry.given() + " has no effect with this ts_adapt_type");
  }
  return notes;
}

void refuse_by_petsc(const std::string& message) {
  const std::string reason = specific_part(message);
  std::string mentioned, all;
  const auto add = [](std::string& list, const Entry& entry) { list += (list.empty() ? "" : ", ") + entry.given(); };
  for (const Entry& entry : last_put) {
    if (!is_read_by_solvers(entry)) continue;
    add(all, entry);
    const bool value = !entry.value.empty() && mentions(reason, entry.value);
    if (value || mentions(reason, "-" + name_in_petsc(entry.name))) add(mentioned, entry);
  }
  if (mentioned.empty()) mentioned = all.empty() ? "an option of PETSc's solvers" : "one of " + all;
  throw InputError(mentioned + ": PETSc does not allow it: " + reason);
}

std::string Entry::where() const { return line > 0 ? source + ":" + std::to_string(line) : source; }

std::string Entry::given() const {
  constexpr std::size_t longest = 80;
  std::string text = name;
  if (!value.empty()) text += " = " + value.substr(0, longest) + (value.size() > longest ? "..." : "");
  return text + " (" + where() + ")";
}

void Entries::set(Entry entry) {
  const auto [place, is_new] = index_.try_emplace(entry.name, entries_.size());
  if (is_new) {
    entries_.push_back(std::move(entry));
  } else {
    entries_[place->second] = std::move(entry);
  }
}

void Entries::set_default(Entry entry) {
  if (!has(entry.name)) set(std::move(entry));
}

void Entries::rename(const std::string& from, const std::string& to) {
  auto place = index_.extract(from);
  entries_[place.mapped()].name = place.key() = to;
  index_.insert(std::move(place));
}

const Entry* Entries::find(std::string_view name) const {
  const auto place = index_.find(std::string(name));
  return place == index_.end() ? nullptr : &entries_[place->second];
}

}  // namespace traverse::options
