// Rows of the option table: the options of each kind of foundation, for springs at stations or for a bed.
#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <string>
#include <vector>

#include "derived_rows.hpp"
#include "traverse/beam/foundation.hpp"

namespace traverse::options {
namespace {

using enum Kind;
using beam::Direction;
using beam::FoundationKind;

/// The senses of a gap, by direction.
constexpr std::string_view senses[] = {"up and down (one-sided: down)", "in both directions", "in both senses"};

/// A unit without blanks, as in the table.
std::string_view unit(std::string_view text) {
  std::string out(text);
  std::erase(out, ' ');
  return permanent(out);
}

void add_points(const FoundationKind& kind, std::vector<Row>& rows) {
  const beam::FoundationUnits units = beam::units_of(kind);
  const auto add = [&](const char* name, Kind type, std::string_view of, std::string_view fallback, Range range,
                       std::string_view choices, std::string text) {
    rows.push_back({permanent(fmt::format("foundation_{}_{}", kind.name, name)), type, of, fallback, range, choices, 0,
                    permanent(std::move(text))});
  };
  const std::string_view sense = senses[static_cast<std::size_t>(kind.direction)];
  // clang-format off
  add("x", numbers, "m", "", not_negative, "", fmt::format("stations of {} springs and dampers", kind.name));
  add("spacing", number, "m", "", positive, "", "distance of equally spaced stations; x: the first and the last of them");
  add("k", numbers, unit(units.k), "0", not_negative, "", "stiffness of the springs; one value applies to all");
  add("c", numbers, unit(units.c), "0", not_negative, "", "damping coefficient of the dampers; one value applies to all");
  if (kind.direction == Direction::longitudinal)
    add("limit", numbers, "N", "0", not_negative, "", "force at which the springs slide, as bearings with friction, 0: no sliding; one value applies to all");
  if (kind.direction == Direction::longitudinal)
    add("depth", numbers, "m", "0", not_negative, "", "distance of the springs below the beam's axis, as of bearings, only at span ends; one value applies to all");
  if (kind.direction == Direction::vertical)
    add("eccentricity", numbers, "m", "0", any, "", "distance of the springs to the left of the beam's axis, as of bearings; one value applies to all");
  if (kind.direction == Direction::vertical)
    add("one_sided", choice_list, "", "false", any, "true false", "acts only in compression, where the beam moves down; one word applies to all");
  add("gap", numbers, unit(units.gap), "0", not_negative, "", fmt::format("gap {} before the spring acts; one value applies to all", sense));
  add("cubic", numbers, unit(units.cubic), "0", not_negative, "", "coefficient of the cubic spring force; one value applies to all");
  add("side", choice_list, "", "right", any, "right left both", "at a joint of separate spans or a hinge: the side of the beam with the spring; one word applies to all");
  // clang-format on
}

void add_bed(const FoundationKind& kind, std::vector<Row>& rows) {
  const beam::FoundationUnits units = beam::units_of(kind);
  std::string bed(kind.name);
  std::replace(bed.begin(), bed.end(), '_', ' ');
  const auto add = [&](const char* name, Kind type, std::string_view of, std::string_view fallback, Range range,
                       const char* text) {
    rows.push_back({permanent(fmt::format("foundation_{}_{}", kind.name, name)), type, of, fallback, range, "", 0,
                    permanent(fmt::format("{}: {}", bed, text))});
  };
  add("k", number_or_file, unit(units.k), "0", not_negative, "stiffness per length, or a file x,value");
  add("c", number_or_file, unit(units.c), "0", not_negative, "damping per length, or a file x,value");
  if (kind.direction == Direction::vertical)
    add("one_sided", flag, "", "false", any, "acts only in compression, where the beam moves down");
  add("gap", number, unit(units.gap), "0", not_negative, "gap before the bed acts");
  add("cubic", number, unit(units.cubic), "0", not_negative, "coefficient of the cubic spring force");
}

}  // namespace

std::string_view permanent(std::string text) {
  static std::list<std::string> all;
  return all.emplace_back(std::move(text));
}

std::span<const Row> foundation_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
    for (const FoundationKind& kind : beam::foundation_kinds) (kind.bed != nullptr ? add_bed : add_points)(kind, all);
    return all;
  }();
  return rows;
}

}  // namespace traverse::options
