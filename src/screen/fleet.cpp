// Groups the rows of a table by the names of the formations and converts loads and positions.
#include "screen/fleet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <unordered_set>

#include "options/input_texts.hpp"
#include "screen/header_table.hpp"
#include "traverse/base/error.hpp"

namespace traverse::screen {
namespace {

constexpr std::size_t most_axles = 5000, most_formations = 200'000;
constexpr double longest = 2000.0, heaviest = 1e6;  // m, of a train; N, of an axle

struct LoadColumn {
  const char* name;
  double newton;
};
constexpr LoadColumn load_columns[] = {{"load_kN", 1e3}, {"load_t", 9810.0}, {"load_N", 1.0}};

const LoadColumn& load_column(const HeaderTable& table) {
  const LoadColumn* found = nullptr;
  for (const LoadColumn& column : load_columns) {
    if (!table.has(column.name)) continue;
    if (found != nullptr)
      table.refuse_columns(fmt::format("{} and {}; allowed: one of them", found->name, column.name));
    found = &column;
  }
  if (found == nullptr) table.refuse_columns("there is no column of the loads; allowed: load_kN, load_t or load_N");
  return *found;
}

/// Positions count along the train in either direction; distances count behind the first axle.
void set_distances(const HeaderTable& table, std::size_t first, std::vector<double> x, Formation& formation) {
  if (table.has("spacing")) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (i == 0) x[i] = 0.0;  // the distance to the train before has no effect
      if (x[i] < 0.0) table.refuse(first + i, fmt::format("spacing: {:g}; allowed: 0 or above", x[i]));
      if (i > 0) x[i] += x[i - 1];
    }
  } else {
    const double direction = x.back() < x.front() ? -1.0 : 1.0, start = x.front();
    for (double& place : x) place = direction * (place - start);
    for (std::size_t i = 1; i < x.size(); ++i)
      if (x[i] < x[i - 1]) table.refuse(first + i, "position: the axles of a formation must be in order");
  }
  if (x.back() > longest)
    table.refuse(first, fmt::format("the formation is {:g} m long; allowed: at most {:g} m", x.back(), longest));
  formation.distance = std::move(x);
}

double speed_of(const HeaderTable& table, std::size_t first, std::size_t last) {
  if (!table.has("speed")) return std::numeric_limits<double>::infinity();
  const double speed = table.speed(first, "speed");
  for (std::size_t row = first; row < last; ++row)
    if (table.speed(row, "speed") != speed) table.refuse(row, "speed: differs within the formation");
  return speed;
}

Formation formation_of(const HeaderTable& table, std::size_t first, std::size_t last, const std::string& name) {
  Formation formation;
  formation.name = name;
  if (last - first > most_axles)
    table.refuse(first, fmt::format("a formation of {} axles; allowed: at most {}", last - first, most_axles));
  formation.speed = speed_of(table, first, last);
  const LoadColumn& load = load_column(table);
  std::vector<double> x;
  for (std::size_t row = first; row < last; ++row) {
    formation.loads.push_back(load.newton * table.positive(row, load.name));
    if (formation.loads.back() > heaviest)
      table.refuse(row, fmt::format("an axle load of {:g} kN; allowed: at most {:g} kN", 1e-3 * formation.loads.back(),
                                    1e-3 * heaviest));
    x.push_back(table.number(row, table.has("spacing") ? "spacing" : "position"));
  }
  set_distances(table, first, std::move(x), formation);
  return formation;
}

void read_table(const std::string& path, std::vector<Formation>& fleet) {
  const HeaderTable table(path, {"name", "speed", "load_kN", "load_t", "load_N", "position", "spacing"});
  if (table.has("position") == table.has("spacing"))
    table.refuse_columns("where the axles are; allowed: one of the columns position and spacing");
  const std::string alone = table.has("name") ? "" : printable(std::filesystem::path(path).stem().string());
  const auto name = [&](std::size_t row) { return alone.empty() ? table.text(row, "name") : alone; };
  for (std::size_t first = 0, last = 0; first < table.rows(); first = last) {
    if (name(first).empty()) table.refuse(first, "name: missing");
    while (last < table.rows() && name(last) == name(first)) ++last;
    fleet.push_back(formation_of(table, first, last, name(first)));
    if (fleet.size() > most_formations)
      table.refuse(first, fmt::format("allowed: at most {} formations", most_formations));
  }
}

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

std::vector<Formation> read_fleet(const std::string& path) {
  std::vector<Formation> fleet;
  std::error_code ignored;
  const bool folder = !options::mounted_in(path).empty() || std::filesystem::is_directory(path, ignored);
  for (const std::string& file : folder ? tables_in(path) : std::vector<std::string>{path}) read_table(file, fleet);
  std::unordered_set<std::string> names;
  for (const Formation& formation : fleet)
    if (!names.insert(formation.name).second)
      throw InputError(fmt::format("{}: the formation {} is given twice", path, formation.name));
  return fleet;
}

}  // namespace traverse::screen
