// The units in which people read quantities: scripts/engineering_units.csv, which pictures and reports read too.
#pragma once

#include <string>
#include <string_view>

namespace traverse::results {

struct EngineeringUnit {
  std::string_view quantity, si, name;
  double factor = 1.0;  // from SI
};

/// The row of a quantity such as "deflection"; std::logic_error if there is none.
const EngineeringUnit& engineering_unit(std::string_view quantity);

/// "-4.213 mm": a value in SI units in its engineering unit.
std::string in_engineering_units(std::string_view quantity, double value, int digits = 4);

}  // namespace traverse::results
