// The types of joints. A type is one row of the table in src/multibody/joint_types.cpp: its name and its equations,
// each kind of which is a file in src/multibody/equations. Options, their help, the scene reader and the checks use the
// names and needs of these rows.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <string_view>

namespace traverse::multibody {

struct Frame;
struct Joint;
struct JointGeometry;

inline constexpr int most_joint_rows = 3;     // rows of Phi
inline constexpr int most_joint_numbers = 2;  // additional numbers of one type

/// Rows of Phi_q of one joint (the first `rows` of its type), columns x1 y1 phi1 x2 y2 phi2.
using JointJacobian = Eigen::Matrix<double, most_joint_rows, 6>;
using JointCurvature = Eigen::Matrix<double, 6, 6>;

/// The members of Joint that the equations of a type need.
struct JointNeeds {
  bool point = false;  // Joint::point
  bool axis = false;   // Joint::axis
  bool ends = false;   // Joint::from and Joint::to
};

/// An additional number of all joints of one type, as an option: its name, unit and one line of text.
struct JointNumber {
  std::string_view name, unit, text;
};

/// One row of the table. Its functions combine the equations of the type; joint.hpp describes their results.
struct JointRow {
  std::string_view name;                    // name in the options
  std::string_view text;                    // the motion that it allows, or the quantity that it keeps constant
  std::span<const JointNumber> numbers;     // in the order of Joint::numbers
  int rows;                                 // number of equations
  std::array<bool, most_joint_rows> angle;  // whether an equation has the unit rad instead of m
  JointNeeds needs;
  bool slides;  // along the axis, with friction if wanted; the first multiplier is then the normal force

  void (*prepare)(const Joint&, const Frame&, const Frame&, JointGeometry&);
  void (*residual)(const JointGeometry&, const Frame&, const Frame&, double*);
  void (*jacobian)(const JointGeometry&, const Frame&, const Frame&, JointJacobian&);
  void (*gamma)(const JointGeometry&, const Frame&, const Frame&, double*);
  void (*curvature)(const JointGeometry&, const Frame&, const Frame&, const double*, JointCurvature&);
  Eigen::Vector3d (*reaction)(const JointGeometry&, const Frame&, const Frame&, const double*);
};

/// The whole table.
std::span<const JointRow> joint_rows();

/// A reference to a row of the table.
class JointType {
 public:
  static const JointType revolute, prismatic, slot, weld, distance;  // some types, for programs; the table has all

  /// The type that a row of the table describes.
  constexpr explicit JointType(const JointRow& row) : row_(&row) {}
  /// Throws InputError if there is no type of this name.
  static JointType named(std::string_view name);

  const JointRow* operator->() const { return row_; }
  friend bool operator==(const JointType&, const JointType&) = default;

 private:
  const JointRow* row_;
};

/// The names of the types that satisfy `fits`: "prismatic, slot".
std::string joint_names(bool (*fits)(const JointRow&), std::string_view between = ", ", std::string_view last = ", ");

}  // namespace traverse::multibody
