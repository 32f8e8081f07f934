// The table comes from the CSV file when the program is built.
#include "results/engineering_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace traverse::results {
namespace {

constexpr EngineeringUnit table[] = {
#include "engineering_units_rows.inc"
};

}  // namespace

const EngineeringUnit& engineering_unit(std::string_view quantity) {
  const auto* row = std::find_if(std::begin(table), std::end(table),
                                 [&](const EngineeringUnit& u) { return u.quantity == quantity; });
  if (row == std::end(table)) throw std::logic_error("no engineering unit for " + std::string(quantity));
  return *row;
}

std::string in_engineering_units(std::string_view quantity, double value, int digits) {
  const EngineeringUnit& unit = engineering_unit(quantity);
  return fmt::format("{:.{}g} {}", unit.factor * value, digits, unit.name);
}

}  // namespace traverse::results
