// Rows of the option table: joints and couplers. Types, and what each of them needs, come from the table of joint
// types.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "derived_rows.hpp"
#include "traverse/multibody/joint_type.hpp"

namespace traverse::options {
namespace {

using enum Kind;
using multibody::JointRow;

bool every(const JointRow&) { return true; }
bool has_point(const JointRow& row) { return row.needs.point; }
bool has_axis(const JointRow& row) { return row.needs.axis; }
bool has_ends(const JointRow& row) { return row.needs.ends; }
bool slides(const JointRow& row) { return row.slides; }

/// "prismatic, slot: " and what it is that these have.
std::string_view of(bool (*fits)(const JointRow&), std::string_view text, std::string_view before = "") {
  return kept(fmt::format("{}{}: {}", before, multibody::joint_names(fits), text));
}

std::string_view all_texts() {
  std::string texts;
  for (const JointRow& row : multibody::joint_rows())
    texts += fmt::format("{}{}: {}", texts.empty() ? "" : "; ", row.name, row.text);
  return kept(texts);
}

std::vector<Row> make_joint_rows() {
  // clang-format off
  std::vector<Row> made = {
    {"type", choice, "", "", any, kept(multibody::joint_names(every, " ", " ")), 0, all_texts()},
    {"bodies", texts, "", "", any, "", 2, "the two bodies; ground is the fixed frame"},
    {"point", numbers, "m", "", any, "", 2, of(has_point, "x, y at t = 0")},
    {"axis", numbers, "1", "", any, "", 2, of(has_axis, "direction, fixed in the first body")},
    {"from", numbers, "m", "", any, "", 2, of(has_ends, "x, y on the first body at t = 0")},
    {"to", numbers, "m", "", any, "", 2, of(has_ends, "x, y on the second body at t = 0")},
    {"friction", number, "1", "0", not_negative, "", 0, of(slides, "coefficient of dry friction along the axis, on the joint's normal force")},
    {"friction_force", number, "N", "0", not_negative, "", 0, of(slides, "dry friction whatever the normal force, as of clamped plates; on top of friction")},
    {"transition_speed", number, "m/s", "0.01", positive, "", 0, "sliding speed at which friction is nearly full: times tanh(speed/transition_speed)"},
  };
  // clang-format on
  for (const JointRow& row : multibody::joint_rows()) {
    for (const multibody::JointNumber& own : row.numbers)
      made.push_back({own.name, number, own.unit, "", any, "", 0, kept(fmt::format("{}: {}", row.name, own.text))});
  }
  return made;
}

std::vector<Row> make_coupler_rows() {
  const std::string_view types = kept("spring " + multibody::joint_names(every, " ", " "));
  // clang-format off
  return {
    {"type", choice, "", "spring", any, types, 0, "what joins two neighbours"},
    {"bodies", texts, "", "", any, "", 2, "a body of the vehicle in front, one of the vehicle behind"},
    {"after", integers, "", "(all but the last)", {0, 100000}, "", 0, "the vehicles, counted from 0, behind which it is"},
    {"point", numbers, "m", "", any, "", 2, of(has_point, "x, y at t = 0, from the front vehicle's origin")},
    {"axis", numbers, "1", "", any, "", 2, of(has_axis, "direction, fixed in the front vehicle's body")},
    {"from", numbers, "m", "", any, "", 2, of(has_ends, "x, y on the front one's body, from its origin", "spring, ")},
    {"to", numbers, "m", "", any, "", 2, of(has_ends, "x, y on the other body, from the rear one's origin", "spring, ")},
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
