// Contact of two bodies, arc on arc or arc on straight line (eqs. 45-50 of the paper as corrected in doc/theory.md,
// figures 7 and 8): penetration, its rate and sliding speed with their gradients. The two contact forces act along
// exactly these directions through one common point, so that action and reaction, their moments and their power cancel
// to rounding.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "traverse/contact/law.hpp"
#include "traverse/multibody/frame.hpp"

namespace traverse::contact {

enum class PairType { arc_arc, arc_line };

/// A contact as the user describes it, with points in the global frame at t = 0. The first body has the (first) arc,
/// the second body has the other arc or the line.
struct BodyContact {
  std::string name;
  PairType type = PairType::arc_arc;
  std::array<int, 2> bodies = {-1, -1};      // -1: the ground
  std::array<double, 2> radii = {0.0, 0.0};  // radii of arcs, m; negative: hollow, with the other arc inside
  std::array<Eigen::Vector2d, 2> centres = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  std::array<Eigen::Vector2d, 2> line = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};  // ends of the line
  Law law;
};

/// R_i R_j/(R_i + R_j) of eq. 48; for an arc on a line the arc's radius.
double effective_radius(const BodyContact& contact);

/// A contact pair in body-fixed components.
struct PairGeometry {
  PairType type = PairType::arc_arc;
  double radius_sum = 0.0;                               // R_i + R_j
  double first_radius = 0.0;                             // R_i
  Eigen::Vector2d first_arm = Eigen::Vector2d::Zero();   // to the arc's centre
  Eigen::Vector2d second_arm = Eigen::Vector2d::Zero();  // to the other centre, or to the start of the line
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // along the line
  double length = 0.0;                                   // length of the line
  double side = 1.0;                                     // side of the line with the arc: 1 left, -1 right
};

/// `first` and `second` are the bodies' frames at t = 0.
PairGeometry pair_geometry(const BodyContact& contact, const multibody::Frame& first, const multibody::Frame& second);

/// Kinematics with their gradients over (x, y, phi) of the first and the second body.
struct PairTouch {
  Kinematics kinematics;
  std::array<Eigen::Vector3d, 2> normal;   // d alpha / d(x, y, phi)
  std::array<Eigen::Vector3d, 2> tangent;  // d beta' / d(x', y', phi')
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
};

/// An arc that is past the end of a line touches its end point. Returns false if the arc's centre has passed through
/// the line.
bool touch(const PairGeometry& pair, const multibody::Frame& first, const multibody::Frame& second, PairTouch& out);

/// Updates the side of the line after the arc has moved round an end of the line.
void record_side(PairGeometry& pair, const multibody::Frame& first, const multibody::Frame& second);

}  // namespace traverse::contact
