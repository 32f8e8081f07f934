// Rows of the option table: joints and couplers. The types and the data that each of them needs come from the table of
// joint types.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "derived_rows.hpp"
#include "traverse/multibody/joint_type.hpp"

namespace traverse::options {
namespace {

using enum Kind;
using multibody::JointRow;

bool any_type(const JointRow&) { return true; }
bool has_point(const JointRow& row) { return row.needs.point; }
bool has_axis(const JointRow& row) { return row.needs.axis; }
bool has_ends(const JointRow& row) { return row.needs.ends; }
bool slides(const JointRow& row) { return row.slides; }

/// The names of the joint types that fit, and the text: "prismatic, slot: text".
std::string_view with_types(bool (*fits)(const JointRow&), std::string_view text, std::string_view before = "") {
  return permanent(fmt::format("{}{}: {}", before, multibody::joint_names(fits), text));
}

std::string_view all_texts() {
  std::string texts;
  for (const JointRow& row : multibody::joint_rows())
    texts += fmt::format("{}{}: {}", texts.empty() ? "" : "; ", row.name, row.text);
  return permanent(texts);
}

std::vector<Row> make_joint_rows() {
  // clang-format off
  std::vector<Row> made = {
    {"type", choice, "", "", any, permanent(multibody::joint_names(any_type, " ", " ")), 0, all_texts()},
    {"bodies", texts, "", "", any, "", 2, "the two bodies; ground is the fixed frame"},
    {"point", numbers, "m", "", any, "", 2, with_types(has_point, "x, y of the joint at t = 0")},
    {"axis", numbers, "1", "", any, "", 2, with_types(has_axis, "direction of the axis, fixed in the first body")},
    {"from", numbers, "m", "", any, "", 2, with_types(has_ends, "x, y on the first body at t = 0")},
    {"to", numbers, "m", "", any, "", 2, with_types(has_ends, "x, y on the second body at t = 0")},
    {"friction", number, "1", "0", not_negative, "", 0, with_types(slides, "coefficient of dry friction along the axis, times the joint's normal force")},
    {"friction_force", number, "N", "0", not_negative, "", 0, with_types(slides, "dry friction force that does not depend on the normal force, as of clamped plates; added to friction")},
    {"transition_speed", number, "m/s", "0.01", positive, "", 0, "sliding speed at which friction nearly has its full value: factor tanh(speed/transition_speed)"},
  };
  // clang-format on
  for (const JointRow& row : multibody::joint_rows()) {
    for (const multibody::JointNumber& own : row.numbers)
      made.push_back(
          {own.name, number, own.unit, "", any, "", 0, permanent(fmt::format("{}: {}", row.name, own.text))});
  }
  return made;
}

std::vector<Row> make_coupler_rows() {
  const std::string_view types = permanent("spring " + multibody::joint_names(any_type, " ", " "));
  // clang-format off
  return {
    {"type", choice, "", "spring", any, types, 0, "type of the connection between two neighbouring vehicles"},
    {"bodies", texts, "", "", any, "", 2, "a body of the front vehicle, then a body of the rear vehicle"},
    {"after", integers, "", "(all but the last)", {0, 100000}, "", 0, "the vehicles behind which this coupler is, counted from 0", true},
    {"point", numbers, "m", "", any, "", 2, with_types(has_point, "x, y at t = 0, relative to the front vehicle's origin")},
    {"axis", numbers, "1", "", any, "", 2, with_types(has_axis, "direction of the axis, fixed in the front vehicle's body")},
    {"from", numbers, "m", "", any, "", 2, with_types(has_ends, "x, y on the front vehicle's body, relative to its origin", "spring, ")},
    {"to", numbers, "m", "", any, "", 2, with_types(has_ends, "x, y on the rear vehicle's body, relative to its origin", "spring, ")},
  };
  // clang-format on
}

}  // namespace

std::span<const Row> joint_rows() {
  static const std::vector<Row> rows = make_joint_rows();
  return rows;
}

std::span<const Row> coupler_rows() {
  static const std::vector<Row> rows = make_coupler_rows();
  return rows;
}

}  // namespace traverse::options
