// Finds the vehicles of a scene, reads their files and declares the options of their parts.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "options/read_file.hpp"
#include "repeated_parts.hpp"
#include "scene_parts.hpp"
#include "traverse/base/error.hpp"

namespace traverse::scene {
namespace {

using options::Entry;
using options::Options;
using options::Part;

bool is_word(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(),
                                      [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

/// Adds the options of a vehicle's file, unless they are given already.
void add_file(Options& o, const std::string& prefix) {
  const std::string path = o.path(prefix + "file");
  std::vector<Entry> entries = options::read_options_file(path);
  for (Entry& entry : entries) {
    if (entry.name.starts_with("vehicle_")) {
      throw InputError(fmt::format(
          "{} ({}): the file of a vehicle must have the keys of this vehicle without vehicle: {{NAME: ...}} "
          "around them",
          entry.name, entry.where()));
    }
    if (entry.name == "file") o.refuse(prefix + "file", "a vehicle's file cannot name another file");
    entry.name = prefix + entry.name;
  }
  o.add_defaults(entries);
}

/// Declares the options of each listed part. The name of a part must be unique in its vehicle.
void declare_parts(Options& o, const std::string& prefix) {
  std::unordered_map<std::string, Part> seen;
  for (int kind = 0; kind < options::part_kinds; ++kind) {
    const Part part = static_cast<Part>(kind);
    const std::string list = prefix + std::string(options::part_list(part));
    for (const std::string& name : part_names(o, prefix, part)) {
      if (!is_word(name) || name == "ground" || options::find_row(options::vehicle_rows(), name) != nullptr) {
        o.refuse(list, fmt::format("'{}' cannot be a part's name; allowed: a word of letters, digits and _", name));
      }
      const auto [other, is_new] = seen.try_emplace(name, part);
      if (!is_new) {
        o.refuse(list, fmt::format("'{}' is already the name of a {}; allowed: different names for all parts", name,
                                   options::part_word(other->second)));
      }
      for (const options::Row& row : options::part_rows(part)) {
        const std::string full = fmt::format("{}{}_{}", prefix, name, row.name);
        if (!o.declare(full, row)) o.refuse(list, fmt::format("two parts would have the option {}; rename one", full));
      }
    }
  }
}

void declare_vehicle(Options& o, const std::string& name) {
  const std::string prefix = "vehicle_" + name + "_";
  for (const options::Row& row : options::vehicle_rows()) o.declare(prefix + std::string(row.name), row);
  if (o.has(prefix + "file")) add_file(o, prefix);
  add_repeated_parts(o, prefix);
  declare_parts(o, prefix);
}

/// NAME of each vehicle_NAME_file and vehicle_NAME_bodies that is not yet known, shortest first.
std::vector<std::string> vehicles_in(const Options& o) {
  std::vector<std::string> names;
  for (const Entry& entry : o.entries()) {
    for (const char* ending : {"_file", "_bodies"}) {
      if (!entry.name.starts_with("vehicle_") || !entry.name.ends_with(ending) || o.knows(entry.name)) continue;
      const std::size_t length = entry.name.size() - std::string(ending).size();
      if (length > 8) names.push_back(entry.name.substr(8, length - 8));
    }
  }
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// Refuses a part that is in no list of its vehicle: its options look like the options of another vehicle,
/// VEHICLE_PART.
void check_unlisted_part(const Options& o, const std::string& name, const std::vector<std::string>& vehicles) {
  const std::string prefix = "vehicle_" + name + "_";
  if (o.entries().has(prefix + "file")) return;
  for (const std::string& body : o.texts(prefix + "bodies")) {
    if (o.entries().has(prefix + body + "_mass")) return;
  }
  for (const std::string& vehicle : vehicles) {
    if (!name.starts_with(vehicle + "_")) continue;
    o.refuse(prefix + "bodies", fmt::format("'{}' is in no list of vehicle {} (joints, springs, ...); add it to one",
                                            name.substr(vehicle.size() + 1), vehicle));
  }
}

bool is_defined(const Options& o, const std::string& name) {
  return o.entries().has("vehicle_" + name + "_file") || o.entries().has("vehicle_" + name + "_bodies");
}

void check_defined(const Options& o, const std::string& option, const std::string& name) {
  if (is_defined(o, name)) return;
  std::vector<std::string> known = vehicles_in(o);
  const std::string near = options::nearest(name, known);
  o.refuse(option, fmt::format("vehicle '{}' is not defined: neither vehicle_{}_bodies nor vehicle_{}_file is given{}",
                               name, name, name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

}  // namespace

NamedVehicles declare_vehicles(Options& o) {
  std::vector<std::string> train;
  std::vector<Block> trains = blocks_of(o, "trains");
  for (Block& one : trains) {
    const std::string option = one.option("vehicles");
    if (o.has(option)) one.vehicles = o.texts(option);
    if (one.vehicles.empty() && o.has("trains")) o.refuse(option, "missing: the vehicles of this train");
    for (const std::string& name : one.vehicles) check_defined(o, option, name);
    train.insert(train.end(), one.vehicles.begin(), one.vehicles.end());
  }
  std::vector<std::string> types = train;
  std::sort(types.begin(), types.end());
  types.erase(std::unique(types.begin(), types.end()), types.end());
  for (const std::string& name : types) declare_vehicle(o, name);
  std::vector<std::string> others;
  for (const std::string& name : vehicles_in(o)) {
    // an option of a part of a vehicle found so far may end like an option of a vehicle
    if (o.knows("vehicle_" + name + "_file") || (o.knows("vehicle_" + name + "_bodies"))) continue;
    declare_vehicle(o, name);
    check_unlisted_part(o, name, types);
    others.push_back(name);
    types.push_back(name);
  }
  const std::string loads = o.has("loads") ? "loads" : load_option(o);
  if (!o.has("trains") && !o.entries().has("train_vehicles") && (loads.empty() || loads == "sweep_hslm_a") &&
      others.size() == 1)
    return {others, {{"train", others}}, {}};
  return {train, trains, others};
}

namespace {

void declare_couplers_of(Options& o, const Block& train) {
  const std::string list = train.option("couplers");
  if (!o.has(list)) return;
  for (const std::string& name : o.texts(list)) {
    if (!is_word(name)) o.refuse(list, fmt::format("'{}' cannot be a coupler's name; allowed: a word", name));
    const auto full = [&](std::string_view word) { return fmt::format("{}_{}_{}", train.name, name, word); };
    for (const options::Row& row : options::coupler_rows())
      if (!o.declare(full(row.name), row))
        o.refuse(list, fmt::format("two options would have the name {}; rename one", full(row.name)));
    for (const Part part : {Part::spring, Part::joint})  // the options without a row for couplers
      for (const options::Row& row : options::part_rows(part)) o.declare(full(row.name), row);
  }
}

}  // namespace

void declare_couplers(Options& o) {
  for (const Block& train : blocks_of(o, "trains")) declare_couplers_of(o, train);
}

}  // namespace traverse::scene
