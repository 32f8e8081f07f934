// Rows of the option table: the kinds of foundation, each with the options of points at stations or of a bed.
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

/// Which way a gap is, by direction.
constexpr std::string_view ways[] = {"up and down (one-sided: down)", "to and fro", "either way"};

/// The units as the table writes them.
std::string_view unit(std::string_view text) {
  std::string out(text);
  std::erase(out, ' ');
  return kept(out);
}

void add_points(const FoundationKind& kind, std::vector<Row>& rows) {
  const beam::FoundationUnits units = beam::units_of(kind);
  const auto add = [&](const char* name, Kind type, std::string_view of, std::string_view fallback, Range range,
                       std::string_view choices, std::string text) {
    rows.push_back({kept(fmt::format("foundation_{}_{}", kind.name, name)), type, of, fallback, range, choices, 0,
                    kept(std::move(text))});
  };
  const std::string_view way = ways[static_cast<std::size_t>(kind.direction)];
  // clang-format off
  add("x", numbers, "m", "", not_negative, "", fmt::format("stations of {} springs and dampers", kind.name));
  add("spacing", number, "m", "", positive, "", "of stations at equal distances: x holds the first and the last");
  add("k", numbers, unit(units.k), "0", not_negative, "", "their stiffness, one serves all");
  add("c", numbers, unit(units.c), "0", not_negative, "", "their damping, one serves all");
  if (kind.direction == Direction::longitudinal)
    add("limit", numbers, "N", "0", not_negative, "", "force at which they slide, as a bearing's friction has it, one serves all; 0: they hold");
  if (kind.direction == Direction::longitudinal)
    add("depth", numbers, "m", "0", not_negative, "", "how far below the beam's axis they hold, as bearings do, one serves all; at span ends");
  if (kind.direction == Direction::vertical)
    add("one_sided", choice_list, "", "false", any, "true false", "pushes only, where the beam is pressed down; one word serves all");
  add("gap", numbers, unit(units.gap), "0", not_negative, "", fmt::format("{} before it acts, one serves all", way));
  add("cubic", numbers, unit(units.cubic), "0", not_negative, "", "cubic term of the spring, one serves all");
  add("side", choice_list, "", "right", any, "right left both", "at a joint of separate spans or a hinge: the side that a point holds, one word serves all");
  // clang-format on
}

void add_bed(const FoundationKind& kind, std::vector<Row>& rows) {
  const beam::FoundationUnits units = beam::units_of(kind);
  std::string bed(kind.name);
  std::replace(bed.begin(), bed.end(), '_', ' ');
  const auto add = [&](const char* name, Kind type, std::string_view of, std::string_view fallback, Range range,
                       const char* text) {
    rows.push_back({kept(fmt::format("foundation_{}_{}", kind.name, name)), type, of, fallback, range, "", 0,
                    kept(fmt::format("{}: {}", bed, text))});
  };
  add("k", number_or_file, unit(units.k), "0", not_negative, "stiffness along the beam, or a file x,value");
  add("c", number_or_file, unit(units.c), "0", not_negative, "damping, or a file x,value");
  if (kind.direction == Direction::vertical)
    add("one_sided", flag, "", "false", any, "pushes only, where the beam is pressed down");
  add("gap", number, unit(units.gap), "0", not_negative, "before it acts");
  add("cubic", number, unit(units.cubic), "0", not_negative, "cubic term of the spring");
}

}  // namespace

std::string_view kept(std::string text) {
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
