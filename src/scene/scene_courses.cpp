// Reads the option blocks of several trains and loads, and the courses of those with a variable or negative speed.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "base/notes.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

bool is_plain_word(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// Whether names of options begin with this word.
bool is_group(const std::string& name) {
  const auto begins = [&](const options::Row& row) { return row.name == name || row.name.starts_with(name + "_"); };
  const auto rows = options::fixed_rows();
  return name == "vehicle" || std::any_of(rows.begin(), rows.end(), begins);
}

/// Declares the options of `kind` (train, load or track) for each name in `list`, those that `belongs` says.
void declare_list(Options& o, const std::string& list, const std::string& kind,
                  const std::function<bool(std::string_view)>& belongs) {
  if (!o.has(list)) return;
  const std::string prefix = kind + "_";
  for (const options::Row& row : options::fixed_rows())
    if (row.name.starts_with(prefix) && belongs(row.name.substr(prefix.size())) && o.has(std::string(row.name)))
      o.refuse(std::string(row.name),
               fmt::format("{} names several blocks; give the options of {} in these blocks", list, kind));
  for (const std::string& name : o.texts(list)) {
    if (!is_plain_word(name))
      o.refuse(list,
               fmt::format("'{}' cannot be a name; allowed: a word of letters, digits and _ that begins with a letter",
                           name));
    if (is_group(name)) o.refuse(list, fmt::format("'{}' is the name of a group of options; choose another one", name));
    for (const options::Row& row : options::fixed_rows()) {
      if (!row.name.starts_with(prefix) || !belongs(row.name.substr(prefix.size()))) continue;
      const std::string full = name + "_" + std::string(row.name.substr(prefix.size()));
      if (options::owned_by_petsc(full))
        o.refuse(list, fmt::format("'{}' cannot be a name: {} is an option of PETSc; choose another one", name, full));
      if (!o.declare(full, row)) o.refuse(list, fmt::format("two options would have the name {}; rename one", full));
    }
  }
}

/// What `make` returns for x or t, and v, of a block's speed_file.
template <class Make>
auto from_speeds(const Options& o, const Block& block, Make&& make) {
  options::WantedColumns wanted = rising_pairs;
  if (o.choice(block.option("speed_over")) == "position") wanted.units = "m, m/s";
  return from_table(o, block.option("speed_file"), wanted, make);
}

/// What `make` returns for t and x of a block's position_file.
template <class Make>
auto from_positions(const Options& o, const Block& block, Make&& make) {
  options::WantedColumns wanted = rising_pairs;
  wanted.units = "s, m";
  return from_table(o, block.option("position_file"), wanted, make);
}

std::string direction_text(double direction) { return direction < 0.0 ? "to the left" : "to the right"; }

std::string course_text(const train::Course& course) {
  const base::SpeedLaw& law = course.speed;
  if (law.direction() == 0.0) return course.name + " at rest";
  if (law.constant())
    return fmt::format("{} at {:g} m/s {}", course.name, law.fastest(), direction_text(law.direction()));
  const double standstill = law.standstill();
  return fmt::format("{} at up to {:g} m/s {}{}", course.name, law.fastest(), direction_text(law.direction()),
                     std::isfinite(standstill) ? fmt::format(", at rest after {:.6g} s", standstill) : "");
}

/// Completes the lines on which something acts: there is one at least, and one of unit lever for the torques of weights
/// in curves or on cant.
void complete_lines(const Options& o, Scene& scene) {
  if (!scene.beam || !scene.beam->torsion) return;
  if (scene.beam->torsion->tracks.empty()) carry(&scene.tracks.front(), scene);
  if (!scene.beam->torsion->shifts()) return;
  carry({1.0, true}, scene);
  if (scene.train.drive == Drive::free)
    o.refuse("train_drive", "tracks with a curve or cant need trains whose speed is prescribed");
}

}  // namespace

void declare_blocks(Options& o) {
  const auto all = [](std::string_view) { return true; };
  declare_list(o, "trains", "train", all);
  declare_list(o, "loads", "load", all);
  declare_list(o, "tracks", "track", [](std::string_view word) {
    return word == "eccentricity" || word == "curve_radius" || word.starts_with("cant") || word == "height" ||
           word == "load_height" || word == "seed" || word == "wavelengths" || word.starts_with("profile") ||
           word.starts_with("bump_");
  });
}

std::vector<Block> blocks_of(const Options& o, const char* list) {
  std::vector<Block> blocks;
  const std::string_view kind = list;
  if (!o.has(list) && kind == "tracks") return {};
  if (!o.has(list)) return {{kind == "trains" ? "train" : "load", {}}};
  for (const std::string& name : o.texts(list)) blocks.push_back({name, {}});
  return blocks;
}

const Track* track_of_block(const Options& o, const Block& block, const Scene& scene) {
  const std::string option = block.option("track");
  if (scene.tracks.empty()) {
    if (o.has(option))
      o.refuse(option, "names one of the tracks of a bridge that twists, which the option tracks lists");
    return nullptr;
  }
  std::string names;
  for (const Track& track : scene.tracks) {
    if (o.has(option) ? o.text(option) == track.name : scene.tracks.size() == 1) return &track;
    names += (names.empty() ? "" : ", ") + track.name;
  }
  o.refuse(option, fmt::format("{}; allowed: {}", o.has(option) ? "there is no such track" : "missing", names));
}

int carry(const Track* track, Scene& scene) { return track == nullptr ? 0 : carry(track->line, scene); }

int carry(const beam::ActionLine& line, Scene& scene) {
  std::vector<beam::ActionLine>& carrying = scene.beam->torsion->tracks;
  const auto same = std::ranges::find(carrying, line);
  const auto index = static_cast<int>(same - carrying.begin());
  if (same == carrying.end()) carrying.push_back(line);
  return index;
}

std::string table_of_motion(const Options& o, const Block& block) {
  for (const char* name : {"speed_file", "position_file"})
    if (const std::string option = block.option(name); o.knows(option) && o.has(option)) return option;
  return {};
}

double direction_of(const Options& o, const Block& block) {
  if (o.has(block.option("position_file")))
    return from_positions(o, block, [](const auto& table) { return table[1].back() < table[1].front() ? -1.0 : 1.0; });
  if (o.has(block.option("speed_file")))
    return from_speeds(o, block, [](const auto& table) { return std::ranges::min(table[1]) < 0.0 ? -1.0 : 1.0; });
  const std::string speed = block.option("speed");
  return o.has(speed) && o.number(speed) < 0.0 ? -1.0 : 1.0;
}

bool stands(const Options& o, const Block& block) {
  const std::string speed = block.option("speed");
  return o.has(speed) && o.number(speed) == 0.0;
}

double entrance(const Scene& scene, double direction) {
  return direction < 0.0 && scene.beam ? scene.beam->length() : 0.0;
}

std::optional<double> start_by_table(const Options& o, const Block& block) {
  if (!o.has(block.option("position_file"))) return {};
  return from_positions(o, block, [](const auto& table) {
    return table[1].front() - base::SpeedLaw::through(table[0], table[1]).distance(table[0].front());
  });
}

base::SpeedLaw read_motion(const Options& o, const Block& block, double front) {
  if (o.has(block.option("position_file")))
    return from_positions(o, block, [](const auto& table) { return base::SpeedLaw::through(table[0], table[1]); });
  const bool over_place = o.choice(block.option("speed_over")) == "position";
  return from_speeds(o, block, [&](const auto& table) {
    return over_place ? base::SpeedLaw::over_place(table[0], table[1], front)
                      : base::SpeedLaw::over_time(table[0], table[1]);
  });
}

bool needs_courses(const Options& o, const std::vector<Block>& blocks) {
  const auto own = [&](const Block& block) {
    const std::string profile = block.option("profile");
    const std::string times = block.option("times");
    const std::string sideways = block.option("sideways_height");
    return !table_of_motion(o, block).empty() || (o.knows(sideways) && o.has(sideways)) ||
           direction_of(o, block) < 0.0 || (o.knows(profile) && o.has(profile)) || (o.knows(times) && o.has(times)) ||
           has_line_loads_or_variation(o, block);
  };
  return blocks.size() > 1 || std::any_of(blocks.begin(), blocks.end(), own);
}

bool several_courses(const Scene& scene) {
  const std::size_t courses = scene.train.courses.size() + scene.load.courses.size();
  return courses > 1 || (courses == 1 && !scene.vehicles.empty() && !scene.load.forces.empty());
}

void check_courses(const Options& o, Scene& scene) {
  complete_lines(o, scene);
  const std::size_t trains = scene.train.courses.size(), loads = scene.load.courses.size();
  if (trains + loads == 0) return;
  for (const char* sweep : {"sweep_speed", "sweep_hslm_a"})
    if (o.has(sweep))
      o.refuse(sweep,
               "a sweep needs one train or load that runs to the right at constant speed on the track's profile; for "
               "others use a study that varies NAME_speed or other options");
  const bool several = several_courses(scene);
  if (scene.beam && scene.beam->track && several)
    o.refuse("track_rail_EI",
             "a layered track is allowed with one train or load only, because others would need further rails");
  std::string what;
  for (const std::vector<train::Course>* courses : {&scene.train.courses, &scene.load.courses})
    for (const train::Course& course : *courses) what += (what.empty() ? "" : "; ") + course_text(course);
  scene.notes.push_back(base::detail("runs: " + what));
  if (several && scene.tracks.empty())
    scene.notes.emplace_back("parallel tracks: all wheels and forces act on the beam's axis; its torsion is neglected");
}

}  // namespace traverse::scene
