// The text of the option -help, by groups of options. The vehicles, trains and loads that come with the program are
// listed by the head lines of the files in options/vehicles, options/trains and options/loads, so that the list always
// agrees with the files.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "help_groups.hpp"
#include "options/petscrc.hpp"
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

/// A table for each folder of the library: file, and the sentence after `# What:` in its head. A folder is searched as
/// the files of a scene are (find_file), then beside the folder of the program, as in a build tree. InputError if there
/// is no such folder.
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

/// The first word of option names, their group in -help, and its heading. A word that is not listed is the name of a
/// group itself.
struct Heading {
  std::string_view word, group, heading;
};
constexpr Heading headings[] = {
    {"options", "scene", "Scene and analysis"},
    {"gravity", "scene", ""},
    {"modes", "scene", ""},
    {"describe", "scene", ""},
    {"help", "scene", ""},
    {"bridge", "bridge", "Bridge by given modes"},
    {"beam", "beam", "Bridge"},
    {"support", "support", "Supports"},
    {"foundation", "foundation", "Foundation: springs, dampers and beds"},
    {"train", "train", "Train"},
    {"trains", "train", ""},
    {"load", "load", "Moving forces"},
    {"loads", "load", ""},
    {"track", "track", "Running surface and layered track"},
    {"surface", "track", ""},
    {"ts", "step", "Time and steps"},
    {"contact", "step", ""},
    {"accuracy", "accuracy", "Accuracy"},
    {"model", "model", "Model"},
    {"limits", "norm", "Limits and load models of EN 1990 and EN 1991-2"},
    {"uic774", "rail", "Track-bridge interaction: scene_analysis rail, UIC 774-3"},
    {"screen", "screen", "Screen of a bridge stock with a fleet: scene_analysis screen"},
    {"output", "output", "Results"},
    {"checkpoint", "checkpoint", "Checkpoints"},
    {"restart", "restart", "Restart from a checkpoint"},
    {"report", "report", "Title page and language of the report (scripts/traverse-report)"},
    {"sweep", "sweep", "Sweeps over speeds and trains"},
    {"study", "study", "Studies of varied options"},
    {"find", "find", "Values of an option that keep limits"},
    {"fit", "fit", "Fit of options to measurements"},
    {"tao", "fit", ""},
    {"log", "petsc", "Other options of PETSc than ts_..."},
    {"malloc", "petsc", ""},
    {"skip", "petsc", ""},
};

std::string_view group_of(std::string_view word) {
  const auto* row =
      std::find_if(std::begin(headings), std::end(headings), [&](const Heading& h) { return h.word == word; });
  return row == std::end(headings) ? word : row->group;
}

std::string_view heading_of(std::string_view group) {
  const auto* row = std::find_if(std::begin(headings), std::end(headings),
                                 [&](const Heading& h) { return h.group == group && !h.heading.empty(); });
  return row == std::end(headings) ? group : row->heading;
}

std::string_view first_word(std::string_view name) { return name.substr(0, name.find('_')); }

void append(const HelpGroup& group, std::string& out) {
  out += fmt::format("\n{} (-help {})\n", group.heading, group.name);
  for (const auto& [name, row] : group.options)
    out += fmt::format("  -{:<32} {}\n{:37}{}\n", name, row->text, "", allowed_in_short(*row));
}

std::string everything() {
  std::string out =
      "traverse computes the motion of trains, vehicles and bridges.\n\n"
      "  [mpirun -n N] traverse -options_file scene.yml [-options_file more.yml] [-option value ...]\n"
      "  traverse run|study|fit|screen|describe scene.yml [-option value ...]    the same, if the scene asks for it\n\n"
      "In a YAML file nested keys join with underscores (beam: {spans: [25.0, 30.0]} is -beam_spans 25.0,30.0). SI "
      "units;\n"
      "x along the track from the bridge's left end, y upward. In lists value*count repeats. Later options override "
      "earlier ones.\n";
  for (const HelpGroup& group : help_groups()) append(group, out);
  return out + "\nOther options of PETSc and SLEPc are rejected.\n";
}

/// The words with underscores instead of blanks: torsion_spring.
std::string as_name(std::string_view words) {
  std::string name(words);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace

std::vector<HelpGroup> help_groups() {
  std::vector<HelpGroup> groups;
  for (const Row& row : fixed_rows()) {
    const std::string_view name = group_of(first_word(row.name));
    auto group = std::find_if(groups.begin(), groups.end(), [&](const HelpGroup& g) { return g.name == name; });
    if (group == groups.end())
      group = groups.insert(groups.end(), {std::string(name), std::string(heading_of(name)), {}});
    group->options.push_back({std::string(row.name), &row});
  }
  const auto add = [&](const std::string& prefix, std::span<const Row> rows) {
    for (const Row& row : rows) groups.back().options.push_back({prefix + std::string(row.name), &row});
  };
  groups.push_back({"vehicle", "Vehicle NAME; without vehicle_NAME_ in the file of -vehicle_NAME_file", {}});
  add("vehicle_NAME_", vehicle_rows());
  for (int kind = 0; kind < part_kinds; ++kind) {
    const auto part = static_cast<Part>(kind);
    groups.push_back({as_name(part_word(part)),
                      fmt::format("Each {} PART in the list of {} of vehicle NAME", part_word(part), part_list(part)),
                      {}});
    add("vehicle_NAME_PART_", part_rows(part));
  }
  groups.push_back(
      {"coupler",
       "Each coupler NAME in the list of train_couplers, in addition to the options of a spring or a joint",
       {}});
  add("train_NAME_", coupler_rows());
  groups.push_back({"damper", "Each tuned mass damper NAME in the list of beam_dampers", {}});
  add("beam_NAME_", damper_rows());
  groups.push_back({"stretch", "Each stretch NAME in the list of track_stretches", {}});
  add("track_NAME_", stretch_rows());
  groups.push_back({"table", "Each option NAME that names a table of numbers (doc/guide/tables.md)", {}});
  add("NAME_", table_rows());
  groups.push_back({"vary", "Each option NAME that a study varies", {}});
  add("study_vary_NAME", {&vary_list_row(), 1});
  add("study_vary_NAME_", vary_rows());
  groups.push_back({"measured", "Each option NAME that a fit estimates, and each measurement NAME", {}});
  add("fit_vary_NAME", {&fit_bounds_row(), 1});
  add("fit_to_NAME_", fit_rows());
  return groups;
}

std::string help_text(const std::string& about) {
  if (about.empty()) return everything();
  const std::string wanted = own_name(as_name(about.substr(std::min(about.find_first_not_of('-'), about.size()))));
  if (wanted == "vehicles") return vehicle_library();
  const std::vector<HelpGroup> groups = help_groups();
  std::string names, out;
  std::vector<std::string> candidates = {"integrators", "vehicles"};
  for (const std::string_view name : {std::string_view(wanted), group_of(wanted)})
    for (const HelpGroup& group : groups)
      if (out.empty() && group.name == name) append(group, out);
  if (!out.empty()) return out.substr(1);  // without the leading newline
  for (const HelpGroup& group : groups) {
    names += group.name + ", ";
    candidates.push_back(group.name);
    for (const HelpGroup::Option& option : group.options) candidates.push_back(option.name);
  }
  const auto beside = beside_table(wanted);
  for (HelpGroup group : groups) {
    if (beside && std::ranges::any_of(group.options, [&](const HelpGroup::Option& option) {
          return option.name == beside->first && names_table(*option.row);
        }))
      group.options.push_back({wanted, beside->second});
    std::erase_if(group.options,
                  [&](const HelpGroup::Option& option) { return option.name != wanted && option.row->name != wanted; });
    if (!group.options.empty()) append(group, out);
  }
  if (!out.empty()) return out.substr(1);  // without the leading newline
  const std::string near = nearest(wanted, candidates);
  throw InputError(
      fmt::format("help = {}: not an option or a group of options{}; allowed: {}integrators, vehicles, man, bash, "
                  "or an option",
                  about, near.empty() ? "" : fmt::format("; did you mean {}?", near), names));
}

}  // namespace traverse::options
