// The table of the types of joints.
#include <algorithm>
#include <type_traits>

#include "equations/angle.hpp"
#include "equations/distance.hpp"
#include "equations/gear.hpp"
#include "equations/normal.hpp"
#include "equations/point.hpp"
#include "traverse/base/error.hpp"
#include "traverse/multibody/joint_type.hpp"

namespace traverse::multibody {
namespace {

using namespace equations;

/// A joint of these kinds of equations, in this order.
template <class First, class... Others>
struct Combination {
  static constexpr int rows = (First::rows + ... + Others::rows);
  static_assert(rows <= most_joint_rows, "most_joint_rows has to be larger");
  static_assert(!(false || ... || Others::needs.axis), "the equation of the normal force has to be the first one");

  /// Calls use(kind, its first row) for every kind.
  template <class Use>
  static constexpr void each(Use use) {
    int row = 0;
    const auto next = [&](auto kind) {
      use(kind, row);
      row += decltype(kind)::rows;
    };
    next(First());
    (next(Others()), ...);
  }

  static constexpr JointNeeds needs() {
    return {.point = (First::needs.point || ... || Others::needs.point),
            .axis = First::needs.axis,
            .ends = (First::needs.ends || ... || Others::needs.ends)};
  }
  static constexpr std::array<bool, most_joint_rows> angle() {
    std::array<bool, most_joint_rows> of_rows{};
    each([&](auto kind, int row) {
      for (int i = row; i < row + kind.rows; ++i) of_rows[static_cast<std::size_t>(i)] = kind.angle;
    });
    return of_rows;
  }

  static void prepare(const Joint& joint, const Frame& first, const Frame& second, JointGeometry& j) {
    each([&](auto kind, int) { kind.prepare(joint, first, second, j); });
  }
  static void residual(const JointGeometry& j, const Frame& first, const Frame& second, double* Phi) {
    each([&](auto kind, int row) { kind.residual(j, first, second, Phi + row); });
  }
  static void jacobian(const JointGeometry& j, const Frame& first, const Frame& second, JointJacobian& Phi_q) {
    each([&](auto kind, int row) { kind.gradient(j, first, second, row, Phi_q); });
  }
  static void gamma(const JointGeometry& j, const Frame& first, const Frame& second, double* values) {
    each([&](auto kind, int row) { kind.gamma(j, first, second, values + row); });
  }
  static void curvature(const JointGeometry& j, const Frame& first, const Frame& second, const double* lambda,
                        JointCurvature& K) {
    K.setZero();
    each([&](auto kind, int row) { kind.curvature(j, first, second, lambda + row, K); });
  }
  static Eigen::Vector3d reaction(const JointGeometry& j, const Frame& first, const Frame& second,
                                  const double* lambda) {
    Eigen::Vector3d sum = First::reaction(j, first, second, lambda);
    each([&](auto kind, int row) {
      if (row > 0) sum += kind.reaction(j, first, second, lambda + row);
    });
    return sum;
  }
};

template <class... Kinds>
constexpr JointRow row(std::string_view name, std::string_view text, std::span<const JointNumber> numbers = {}) {
  using Joint = Combination<Kinds...>;
  return {name,
          text,
          numbers,
          Joint::rows,
          Joint::angle(),
          Joint::needs(),
          Joint::needs().axis,
          Joint::prepare,
          Joint::residual,
          Joint::jacobian,
          Joint::gamma,
          Joint::curvature,
          Joint::reaction};
}

// clang-format off
constexpr JointRow table[] = {
    row<Point>("revolute", "turns about the point"),
    row<Normal, Angle>("prismatic", "slides along the axis"),
    row<Normal>("slot", "slides and turns"),
    row<Point, Angle>("weld", "nothing is free"),
    row<Distance>("distance", "a rod from one body to the other"),
    row<Gear>("gear", "the two bodies turn together, by a ratio", Gear::numbers),
};
// clang-format on

constexpr const JointRow* find(std::string_view name) {
  for (const JointRow& row : table)
    if (row.name == name) return &row;
  return nullptr;
}
constexpr bool fits_in(const JointRow& row) { return row.numbers.size() <= most_joint_numbers; }
static_assert(std::all_of(std::begin(table), std::end(table), fits_in), "most_joint_numbers has to be larger");

}  // namespace

constinit const JointType JointType::revolute{*find("revolute")};
constinit const JointType JointType::prismatic{*find("prismatic")};
constinit const JointType JointType::slot{*find("slot")};
constinit const JointType JointType::weld{*find("weld")};
constinit const JointType JointType::distance{*find("distance")};

std::span<const JointRow> joint_rows() { return table; }

JointType JointType::named(std::string_view name) {
  if (const JointRow* row = find(name)) return JointType(*row);
  const auto all = [](const JointRow&) { return true; };
  throw InputError("there is no joint of type '" + std::string(name) + "'; allowed: one of " + joint_names(all));
}

std::string joint_names(bool (*fits)(const JointRow&), std::string_view between, std::string_view last) {
  std::string names;
  const auto any_from = [&](const JointRow* from) { return std::any_of(from, std::end(table), fits); };
  for (const JointRow* row = table; row != std::end(table); ++row) {
    if (!fits(*row)) continue;
    if (!names.empty()) names += any_from(row + 1) ? between : last;
    names += row->name;
  }
  return names;
}

}  // namespace traverse::multibody
