// Reads line loads, concentrated moments and the part of forces that varies over time.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "options/data_file.hpp"
#include "scene_parts.hpp"
#include "traverse/base/error.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double highest_frequency = 1e4;  // Hz

base::TimeFunction read_force_table(const Options& o, const std::string& option) {
  try {
    std::vector<std::vector<double>> table = options::read_columns(o.path(option), 2, 2, options::Order::rising);
    return base::TimeFunction::piecewise_linear(std::move(table[0]), std::move(table[1]));
  } catch (const InputError& error) {
    if (std::string_view(error.what()).starts_with(option)) throw;  // the message of the path itself
    o.refuse(option, error.what());
  }
}

}  // namespace

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
  if (o.has(block.option("spread")))
    o.refuse(block.option("moments"), "give either moments or " + block.option("spread"));
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
  if (const std::string table = block.option("table"); o.has(table)) variation.table = read_force_table(o, table);
  const std::string frequency = block.option("frequency"), amplitude = block.option("amplitude"),
                    unbalance = block.option("unbalance"), phase = block.option("phase");
  if (!o.has(frequency)) {
    for (const std::string& option : {amplitude, unbalance, phase})
      if (o.has(option)) o.refuse(option, "needs " + frequency);
    return variation;
  }
  if (!o.has(amplitude) && !o.has(unbalance)) o.refuse(frequency, "needs " + amplitude + " or " + unbalance);
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
