// The types of joints. A type is one row of the table in src/multibody/joint_types.cpp: its name, and the equations
// that it is made of, each kind of which is a file in src/multibody/equations. Options, their help, the scene reader
// and the checks take names and needs from here.
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

inline constexpr int most_joint_rows = 3;     // of Phi
inline constexpr int most_joint_numbers = 2;  // of a type's own

/// Rows of Phi_q of one joint (the first `rows` of its type), columns x1 y1 phi1 x2 y2 phi2.
using JointJacobian = Eigen::Matrix<double, most_joint_rows, 6>;
using JointCurvature = Eigen::Matrix<double, 6, 6>;

/// Where a joint is: what its equations need to know of it besides the bodies.
struct JointNeeds {
  bool point = false;  // Joint::point
  bool axis = false;   // Joint::axis
  bool ends = false;   // Joint::from and Joint::to
};

/// A number that joints of one type have, as an option: its name, unit and one line of text.
struct JointNumber {
  std::string_view name, unit, text;
};

/// One row of the table. The functions walk the equations of the type; what they give is said in joint.hpp.
struct JointRow {
  std::string_view name;                    // as users write it
  std::string_view text;                    // what it leaves free, or what it keeps
  std::span<const JointNumber> numbers;     // in the order of Joint::numbers
  int rows;                                 // its number of equations
  std::array<bool, most_joint_rows> angle;  // whether an equation is about an angle (rad) instead of a length (m)
  JointNeeds needs;
  bool slides;  // along the axis, where there may be friction; its first equation then has the normal force

  void (*prepare)(const Joint&, const Frame&, const Frame&, JointGeometry&);
  void (*residual)(const JointGeometry&, const Frame&, const Frame&, double*);
  void (*jacobian)(const JointGeometry&, const Frame&, const Frame&, JointJacobian&);
  void (*gamma)(const JointGeometry&, const Frame&, const Frame&, double*);
  void (*curvature)(const JointGeometry&, const Frame&, const Frame&, const double*, JointCurvature&);
  Eigen::Vector3d (*reaction)(const JointGeometry&, const Frame&, const Frame&, const double*);
};

/// The whole table.
std::span<const JointRow> joint_rows();

/// Stands for a row of the table.
class JointType {
 public:
  static const JointType revolute, prismatic, slot, weld, distance;  // some, for programs; the table has them all

  /// The type that a row of the table describes.
  constexpr explicit JointType(const JointRow& row) : row_(&row) {}
  /// Throws InputError when there is no such type.
  static JointType named(std::string_view name);

  const JointRow* operator->() const { return row_; }
  friend bool operator==(const JointType&, const JointType&) = default;

 private:
  const JointRow* row_;
};

/// The names of the types that `fits`: "prismatic, slot".
std::string joint_names(bool (*fits)(const JointRow&), std::string_view between = ", ", std::string_view last = ", ");

}  // namespace traverse::multibody
