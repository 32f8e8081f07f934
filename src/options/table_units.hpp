// Units of the columns of tables: those of scripts/engineering_units.csv.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace traverse::options {

/// A unit as a factor from SI.
struct TableUnit {
  double factor = 1.0;
  /// Divides by the factor, or multiplies by its inverse, whichever is a whole number: 1.5 mm is 0.0015 m.
  double to_si(double value) const { return factor >= 1.0 ? value / factor : value * (1.0 / factor); }
};

/// A unit of the quantity with this SI unit, in which blanks, *, ^, a raised dot and raised digits do not count; none
/// if it is not one. An empty SI unit stands for any.
std::optional<TableUnit> table_unit(std::string_view unit, std::string_view si);

/// The units of the quantity with this SI unit, for messages: "m, mm, cm".
std::string table_units(std::string_view si);

/// A name with its unit, as in "x [mm]" or "v (km/h)".
struct UnitName {
  std::string name;
  std::string unit;  // empty if there is none in brackets
};
UnitName unit_name(std::string_view text);

}  // namespace traverse::options
