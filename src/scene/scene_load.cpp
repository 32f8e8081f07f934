// Reads the moving forces of a scene: their number, positions and speed, line loads, concentrated moments and the part
// of forces that varies over time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "formations.hpp"
#include "load_models.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double most_forces = 1e5;

/// The options and the direction of one load.
struct LoadBlock {
  const Block& block;
  double direction = 1.0;
};

/// x of the first axle at t = 0.
double read_first_axle(const Options& o, const LoadBlock& load, const Scene& scene, const std::string& trains) {
  const std::string positions = load.block.option("positions");
  if (!o.has(positions)) return entrance(scene, load.direction);
  const std::vector<double> given = o.numbers(positions);
  if (given.size() != 1) o.refuse(positions, "allowed with " + trains + ": one number, x of the first axle at t = 0");
  return given.front();
}

MovingLoad placed(const AxleList& axles, double first, double direction) {
  MovingLoad load;
  load.forces = axles.forces;
  load.positions = axles.offsets;
  for (double& x : load.positions) x = first + direction * x;
  return load;
}

/// Distributes each force over three sleepers (EN 1991-2, 6.3.6.1). from_zero: the foremost of the three parts is at
/// the position of the foremost force.
void spread(double spacing, bool from_zero, double direction, MovingLoad& load) {
  MovingLoad parts;
  for (std::size_t i = 0; i < load.forces.size(); ++i)
    for (const auto& [part, ahead] : {std::pair{0.25, 1.0}, {0.5, 0.0}, {0.25, -1.0}}) {
      parts.forces.push_back(part * load.forces[i]);
      parts.positions.push_back(load.positions[i] + direction * (ahead - (from_zero ? 1.0 : 0.0)) * spacing);
    }
  load.forces = parts.forces;
  load.positions = parts.positions;
}

/// The formation or vehicle of a block's table of axles.
Formation formation_of(const Options& o, const Block& block) {
  constexpr std::size_t most_listed = 10;
  const std::string file = block.option("file"), option = block.option("formation");
  for (const options::Row& row : options::table_rows())
    if (const std::string beside = file + "_" + std::string(row.name); o.has(beside))
      o.refuse(beside, "is for a file of two columns, but " + o.path(file) + " has formations");
  std::string note, names;
  std::vector<Formation> all;
  try {
    all = read_formations(o.path(file), note);
  } catch (const InputError& error) {
    o.refuse(file, error.what());
  }
  if (!note.empty()) o.note(note);
  if (all.size() == 1 && !o.has(option)) return all.front();
  for (const Formation& one : all)
    if (o.has(option) && one.name == o.text(option)) return one;
  for (std::size_t i = 0; i < std::min(all.size(), most_listed); ++i) names += (i > 0 ? ", " : "") + all[i].name;
  const std::string which = fmt::format("{}{}", names, all.size() > most_listed ? ", ..." : "");
  if (o.has(option))
    o.refuse(option, fmt::format("there is no such formation in {}; allowed: {}", o.path(file), which));
  o.refuse(file, fmt::format("has {} formations; {} names one of them: {}", all.size(), option, which));
}

/// The train that an option of the block selects, other than forces and sweep_hslm_a.
AxleList named_train(const Options& o, const Block& block, const std::string& option) {
  if (option == block.option("hslm_a")) return hslm_a(o.integer(option));
  if (option == block.option("en15528")) return en15528(o.text(option), o.integer(block.option("wagons")));
  if (option == block.option("file") && has_formations(o, option)) return axles_of(formation_of(o, block));
  if (option == block.option("file"))
    return from_table(o, option, {}, [&](const auto& columns) {
      return axles_of(columns, o.text(block.option("file_x")) == "backward");
    });
  const std::vector<double> given = o.numbers(option);  // load_hslm_b
  if (given[0] != std::floor(given[0]) || given[0] > most_forces)
    o.refuse(option, fmt::format("allowed: a whole number of forces up to {:g}, and their distance in m", most_forces));
  return hslm_b(static_cast<int>(given[0]), given[1]);
}

void read_forces(const Options& o, const LoadBlock& from, const Scene& scene, MovingLoad& load) {
  const std::string positions_option = from.block.option("positions"), forces_option = from.block.option("forces");
  const std::vector<double> positions =
      o.has(positions_option) ? o.numbers(positions_option) : std::vector<double>{entrance(scene, from.direction)};
  if (!o.has(positions_option) && o.numbers(forces_option).size() > 1)
    o.refuse(positions_option, "missing: x of each force at t = 0");
  load.forces = o.numbers(forces_option, positions.size(), "one per position");
  load.positions = positions;
}

/// The forces of one load with their positions; `option` selects them.
MovingLoad read_one_load(const Options& o, const LoadBlock& from, const std::string& option, Scene& scene) {
  const bool swept = option == "sweep_hslm_a", default_position = !o.has(from.block.option("positions"));
  MovingLoad load;
  std::vector<MovingLoad> others;
  if (option == from.block.option("forces")) {
    read_forces(o, from, scene, load);
  } else if (option == from.block.option("moments")) {
    place_moments(o, from.block, entrance(scene, from.direction), load);
  } else if (option != from.block.option("distributed")) {
    const double first = read_first_axle(o, from, scene, option);
    load =
        placed(swept ? hslm_a(scene.sweep->trains.front()) : named_train(o, from.block, option), first, from.direction);
    if (swept)
      for (const int train : scene.sweep->trains) others.push_back(placed(hslm_a(train), first, from.direction));
  }
  if (const std::string option_of_spread = from.block.option("spread"); o.has(option_of_spread)) {
    const double spacing = o.number(option_of_spread);
    spread(spacing, default_position, from.direction, load);
    for (MovingLoad& other : others) spread(spacing, default_position, from.direction, other);
  }
  if (o.has(from.block.option("moments")) && option != from.block.option("moments")) add_moments(o, from.block, load);
  if (o.has(from.block.option("distributed"))) add_line_loads(o, from.block, load);
  if (swept) scene.sweep->loads = std::move(others);
  return load;
}

/// Appends the forces of one block to the forces of the blocks before it.
void append(const MovingLoad& load, MovingLoad& all) {
  const std::size_t before = all.forces.size(), size = before + load.forces.size();
  all.forces.insert(all.forces.end(), load.forces.begin(), load.forces.end());
  all.positions.insert(all.positions.end(), load.positions.begin(), load.positions.end());
  all.lengths.resize(size, 0.0);
  all.moments.resize(size, 0.0);
  for (std::size_t i = before; i < size; ++i) {
    all.lengths[i] = length_of(load, i - before);
    all.moments[i] = moment_of(load, i - before);
  }
}

double read_load_speed(const Options& o, const Block& block, const Scene& scene) {
  const std::string speed = block.option("speed");
  const bool needed = scene.analysis == Analysis::transient && !o.has("train_speed");
  if (scene.sweep && !scene.sweep->speeds.empty() && !stands(o, block)) return scene.sweep->speeds.front();
  if (o.has(speed) || needed) return o.number(speed);
  return o.has("train_speed") ? o.number("train_speed") : 0.0;
}

constexpr double highest_frequency = 1e4;  // Hz

}  // namespace

std::string load_option(const Options& o, const std::string& load) {
  for (const char* word : {"_forces", "_hslm_a", "_hslm_b", "_en15528", "_file"})
    if (o.has(load + word)) return load + word;
  if (load == "load" && o.has("sweep_hslm_a")) return "sweep_hslm_a";
  for (const char* word : {"_moments", "_distributed"})
    if (o.has(load + word)) return load + word;
  return "";
}

bool has_formations(const Options& o, const std::string& option) {
  try {
    return !o.has(option + "_columns") && !o.has(option + "_decimal") && has_formations(o.path(option));
  } catch (const InputError& error) {
    o.refuse(option, error.what());
  }
}

bool forces_move(const Options& o) { return o.has("loads") || !load_option(o).empty(); }

void read_load(const Options& o, Scene& scene) {
  const bool swept = scene.sweep && !scene.sweep->trains.empty();
  const std::vector<Block> blocks = blocks_of(o, "loads");
  const bool courses =
      needs_courses(o, blocks) || (o.has("train_speed") && !o.has("load_speed") && o.number("train_speed") < 0.0);
  for (const Block& block : blocks) {
    const std::string option = swept ? "sweep_hslm_a" : load_option(o, block.name);
    if (option.empty() && o.has("loads")) o.refuse(block.option("forces"), "missing: the forces of this load");
    if (option.empty()) return;
    if (!scene.beam) o.refuse(option, "moving forces need a beam (beam_spans)");
    const bool table = !table_of_motion(o, block).empty();
    const double speed = table ? 0.0 : read_load_speed(o, block, scene);
    const LoadBlock from{block, table ? direction_of(o, block) : speed < 0.0 ? -1.0 : 1.0};
    MovingLoad load = read_one_load(o, from, option, scene);
    if (!courses) {
      scene.load = std::move(load);
      scene.load.speed = speed;
      scene.load.track = carry(track_of_block(o, block, scene), scene);
      return;
    }
    train::Course course;
    course.name = block.name;
    course.first = scene.load.forces.size();
    const std::string sideways = block.option("sideways_height");
    course.track = o.has(sideways) ? carry(beam::ActionLine{o.number(sideways), true}, scene)
                                   : carry(track_of_block(o, block, scene), scene);
    const double ahead = option == block.option("distributed") ? 0.5 * from.direction * load.lengths.front() : 0.0;
    if (const std::optional<double> start = start_by_table(o, block)) {
      const double shift = *start - load.positions.front() - ahead;
      for (double& x : load.positions) x += shift;
    }
    course.speed = table ? read_motion(o, block, load.positions.front() + ahead) : base::SpeedLaw(speed);
    course.variation = read_variation(o, block);
    scene.load.speed = std::max(scene.load.speed, course.speed.fastest());
    scene.load.courses.push_back(std::move(course));
    append(load, scene.load);
  }
}

bool has_line_loads_or_variation(const Options& o, const Block& block) {
  for (const char* name : {"moments", "distributed", "table", "frequency", "amplitude", "phase", "unbalance"})
    if (const std::string option = block.option(name); o.knows(option) && o.has(option)) return true;
  return false;
}

void place_moments(const Options& o, const Block& block, double entrance, MovingLoad& load) {
  const std::string positions = block.option("positions");
  load.positions = o.has(positions) ? o.numbers(positions) : std::vector<double>{entrance};
  load.moments = o.numbers(block.option("moments"), load.positions.size(), "one per position");
  load.forces.assign(load.positions.size(), 0.0);
}

void add_moments(const Options& o, const Block& block, MovingLoad& load) {
  load.moments = o.numbers(block.option("moments"), load.forces.size(), "one per force");
}

void add_line_loads(const Options& o, const Block& block, MovingLoad& load) {
  const std::string option = block.option("distributed");
  const std::vector<double> given = o.numbers(option);
  if (given.empty() || given.size() % 3 != 0)
    o.refuse(option,
             fmt::format("{} numbers; allowed: three for each line load: x of both ends in m, N/m", given.size()));
  load.lengths.resize(load.forces.size(), 0.0);
  for (std::size_t i = 0; i < given.size(); i += 3) {
    const double from = given[i], to = given[i + 1];
    if (!(to > from))
      o.refuse(option, fmt::format("from {:g} to {:g} m; allowed: a second end beyond the first", from, to));
    load.positions.push_back(0.5 * (from + to));
    load.lengths.push_back(to - from);
    load.forces.push_back(given[i + 2] * (to - from));
  }
  if (!load.moments.empty()) load.moments.resize(load.forces.size(), 0.0);
}

train::ForceVariation read_variation(const Options& o, const Block& block) {
  train::ForceVariation variation;
  if (const std::string table = block.option("table"); o.has(table))
    variation.table = from_table(o, table, rising_pairs, [](auto columns) {
      return base::TimeFunction::piecewise_linear(std::move(columns[0]), std::move(columns[1]));
    });
  const std::string frequency = block.option("frequency"), amplitude = block.option("amplitude"),
                    unbalance = block.option("unbalance"), phase = block.option("phase");
  if (!o.has(frequency)) return variation;
  variation.frequency = o.number(frequency);
  if (o.has(amplitude)) variation.amplitudes = o.numbers(amplitude);
  if (o.has(unbalance)) {
    if (variation.amplitudes.empty()) variation.amplitudes = {0.0};
    variation.amplitudes[0] += o.number(unbalance) * std::pow(2.0 * std::numbers::pi * variation.frequency, 2);
  }
  const std::size_t harmonics = variation.amplitudes.size();
  if (variation.frequency * static_cast<double>(harmonics) > highest_frequency)
    o.refuse(frequency, fmt::format("{:g} Hz with {} harmonics; allowed: harmonics up to {:g} Hz", variation.frequency,
                                    harmonics, highest_frequency));
  variation.phases =
      o.has(phase) ? o.numbers(phase, harmonics, "one per amplitude") : std::vector<double>(harmonics, 0.0);
  return variation;
}

}  // namespace traverse::scene
