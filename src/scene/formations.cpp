// Groups the rows of a table by the names of the formations, or reads a vehicle from each, and converts loads and
// positions.
#include "formations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>

#include "options/named_table.hpp"
#include "traverse/base/error.hpp"

namespace traverse::scene {
namespace {

using options::NamedTable;

constexpr std::size_t most_axles = 5000, most_formations = 200'000;
constexpr double longest = 2000.0, heaviest = 1e6;  // m, of a train; N, of an axle

constexpr options::KnownColumn formation_columns[] = {{"name"},    {"speed", "m/s"},  {"load_kN"},      {"load_t"},
                                                      {"load_N"},  {"position", "m"}, {"spacing", "m"}, {"loads_kN"},
                                                      {"loads_t"}, {"loads_N"},       {"spacings", "m"}};

struct LoadColumn {
  const char* name;
  double newton;
};
constexpr std::array<LoadColumn, 3> load_columns = {{{"load_kN", 1e3}, {"load_t", 9810.0}, {"load_N", 1.0}}};
constexpr std::array<LoadColumn, 3> lists_of_loads = {{{"loads_kN", 1e3}, {"loads_t", 9810.0}, {"loads_N", 1.0}}};

/// Columns with the loads of the axles 1, 2, ... of a vehicle, and of the distances behind them.
struct NumberedColumns {
  const char *load, *spacing;  // {0}: the number of the axle, {1}: that of the next one
  double newton, metre;        // of their units
};
constexpr NumberedColumns numbered_columns[] = {{"load_{0}_kN", "spacing_{0}", 1e3, 1.0},
                                                {"load_{0}_t", "spacing_{0}", 9810.0, 1.0},
                                                {"AWT{0:02}", "W{0}_{1}", 9.81, 0.01}};
constexpr double speed_of_station = 0.01 / 3.6;  // m/s, the unit of SPEED

std::string numbered(const char* column, std::size_t axle) {
  return fmt::format(fmt::runtime(column), axle + 1, axle + 2);
}

/// The column of the loads, of which a table has one.
const LoadColumn& load_column(const NamedTable& table, const std::array<LoadColumn, 3>& columns) {
  const LoadColumn* found = nullptr;
  for (const LoadColumn& column : columns) {
    if (!table.has(column.name)) continue;
    if (found != nullptr)
      table.refuse_columns(fmt::format("{} and {}; allowed: one of them", found->name, column.name));
    found = &column;
  }
  if (found == nullptr) table.refuse_columns("there is no column of the loads; allowed: load_kN, load_t or load_N");
  return *found;
}

/// Positions count along the train in either direction; distances count behind the first axle.
void set_distances(const NamedTable& table, std::size_t first, std::vector<double> x, Formation& formation) {
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

double speed_of(const NamedTable& table, std::size_t first, std::size_t last) {
  if (!table.has("speed")) return std::numeric_limits<double>::infinity();
  const double speed = table.speed(first, "speed");
  for (std::size_t row = first; row < last; ++row)
    if (table.speed(row, "speed") != speed) table.refuse(row, "speed: differs within the formation");
  return speed;
}

void check_load(const NamedTable& table, std::size_t row, double load) {
  if (load > heaviest)
    table.refuse(row, fmt::format("an axle load of {:g} kN; allowed: at most {:g} kN", 1e-3 * load, 1e-3 * heaviest));
}

Formation formation_of(const NamedTable& table, std::size_t first, std::size_t last, const std::string& name) {
  Formation formation;
  formation.name = name;
  if (last - first > most_axles)
    table.refuse(first, fmt::format("a formation of {} axles; allowed: at most {}", last - first, most_axles));
  formation.speed = speed_of(table, first, last);
  const LoadColumn& load = load_column(table, load_columns);
  std::vector<double> x;
  for (std::size_t row = first; row < last; ++row) {
    formation.loads.push_back(load.newton * table.positive(row, load.name));
    check_load(table, row, formation.loads.back());
    x.push_back(table.number(row, table.has("spacing") ? "spacing" : "position"));
  }
  set_distances(table, first, std::move(x), formation);
  return formation;
}

void add_axles(const NamedTable& table, const std::string& file, std::vector<Formation>& fleet) {
  table.check_names();
  if (table.has("position") == table.has("spacing"))
    table.refuse_columns("where the axles are; allowed: one of the columns position and spacing");
  const auto name = [&](std::size_t row) { return table.has("name") ? std::string(table.text(row, "name")) : file; };
  for (std::size_t first = 0, last = 0; first < table.rows(); first = last) {
    if (name(first).empty()) table.refuse(first, "name: missing");
    while (last < table.rows() && name(last) == name(first)) ++last;
    fleet.push_back(formation_of(table, first, last, name(first)));
    if (fleet.size() > most_formations)
      table.refuse(first, fmt::format("allowed: at most {} formations", most_formations));
  }
}

/// The numbers of numbered columns up to the last one above 0, in a unit.
std::vector<double> numbers_of(const NamedTable& table, std::size_t row, const char* columns, double unit) {
  std::vector<double> numbers;
  std::size_t count = 0;
  for (std::string column; table.has(column = numbered(columns, numbers.size()));) {
    numbers.push_back(table.text(row, column).empty() ? 0.0 : unit * table.number(row, column));
    if (numbers.back() != 0.0) count = numbers.size();
  }
  numbers.resize(count);
  return numbers;
}

Formation vehicle_of(const NamedTable& table, std::size_t row, const NumberedColumns* numbered) {
  Formation vehicle;
  std::vector<double> spacings;
  if (numbered != nullptr) {
    vehicle.loads = numbers_of(table, row, numbered->load, numbered->newton);
    spacings = numbers_of(table, row, numbered->spacing, numbered->metre);
  } else {
    const LoadColumn& column = load_column(table, lists_of_loads);
    vehicle.loads = table.numbers(row, column.name);
    for (double& load : vehicle.loads) load *= column.newton;
    spacings = table.numbers(row, "spacings");
  }
  const std::size_t axles = vehicle.loads.size();
  if (axles == 0 || spacings.size() != axles - 1 ||
      (table.has("AX") && table.number(row, "AX") != static_cast<double>(axles)))
    table.refuse(row, fmt::format("{} axle loads and {} distances{}; expected one distance less; remove the row if the "
                                  "station has not weighed all axles",
                                  axles, spacings.size(),
                                  table.has("AX") ? fmt::format(" of {} axles (AX)", table.text(row, "AX")) : ""));
  vehicle.distance = {0.0};
  for (std::size_t i = 0; i < axles; ++i) {
    if (!(vehicle.loads[i] > 0.0)) table.refuse(row, fmt::format("the load of axle {} is not above 0", i + 1));
    check_load(table, row, vehicle.loads[i]);
    if (i == 0) continue;
    if (!(spacings[i - 1] > 0.0)) table.refuse(row, fmt::format("the distance behind axle {} is not above 0", i));
    vehicle.distance.push_back(vehicle.distance.back() + spacings[i - 1]);
  }
  vehicle.speed = table.has("SPEED") ? speed_of_station * table.positive(row, "SPEED") : speed_of(table, row, row + 1);
  return vehicle;
}

void add_vehicles(const NamedTable& table, const std::string& file, const NumberedColumns* numbered,
                  std::vector<Formation>& fleet) {
  if (table.rows() > most_formations)
    table.refuse(most_formations, fmt::format("allowed: at most {} vehicles", most_formations));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    fleet.push_back(vehicle_of(table, row, numbered));
    fleet.back().name = table.has("name") ? std::string(table.text(row, "name")) : fmt::format("{} {}", file, row + 1);
  }
}

const NumberedColumns* numbered_of(const std::function<bool(const std::string&)>& has) {
  const auto found = std::ranges::find_if(
      numbered_columns, [&](const NumberedColumns& columns) { return has(numbered(columns.load, 0)); });
  return found == std::end(numbered_columns) ? nullptr : &*found;
}

}  // namespace

bool has_formations(const std::string& path) {
  const options::TableText table(path, options::Decimal::found, "load_file_decimal");
  const auto has = [&](const std::string& column) {
    return std::ranges::any_of(table.names(), [&](const std::string& name) {
      const options::UnitName parts = options::unit_name(name);
      return name == column || parts.name + "_" + parts.unit == column;
    });
  };
  const auto is_there = [&](const LoadColumn& column) { return has(column.name); };
  return std::ranges::any_of(load_columns, is_there) || std::ranges::any_of(lists_of_loads, is_there) ||
         numbered_of(has) != nullptr;
}

std::vector<Formation> read_formations(const std::string& path, std::string& note) {
  const NamedTable table(path, formation_columns);
  note = table.note();
  std::vector<Formation> fleet;
  const std::string file = printable(std::filesystem::path(path).stem().string());
  const NumberedColumns* numbered = numbered_of([&](const std::string& column) { return table.has(column); });
  if (numbered != nullptr ||
      std::ranges::any_of(lists_of_loads, [&](const LoadColumn& one) { return table.has(one.name); }))
    add_vehicles(table, file, numbered, fleet);
  else
    add_axles(table, file, fleet);
  return fleet;
}

}  // namespace traverse::scene
