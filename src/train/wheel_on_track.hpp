// A wheel (a circle) on the running surface y = h(x) + v(x, t): the contact point is on the surface's local normal
// through the wheel's centre. Penetration and sliding speed are computed together with their derivatives by the
// coordinates. The contact force acts along exactly these directions on the wheel's body and on the beam element, so
// that action and reaction cancel to rounding and the power of the pair is -f_n alpha' - f_t beta' (paper, eqs. 45-50).
//
// v is the element's cubic. A force inside the element causes an additional deflection, the deflection of a beam
// clamped at the nodes: h^3 xi^3 (1 - xi)^3/(3 EI) per newton at the force itself, and more with shear
// (local_compliance_at). If it is included, it is condensed into the contact as a local compliance s in series with the
// law (contact::Law::local_compliance); it has no mass and therefore no unknowns. Its energy s f^2/2 changes along x
// too: the wheel is driven by f^2/2 ds/dx, the component of f due to the slope of that deflection.
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/bytes.hpp"
#include "traverse/contact/law.hpp"
#include "traverse/track/profile.hpp"

namespace traverse::train {

/// A piece of running surface without a kink: rigid ground, or one element of the beam.
struct Patch {
  int element = -1;                    // -1: rigid ground
  double x = 0.0, length = 0.0;        // left end and length of the element, m
  double shear = 0.0;                  // 12 EI/(GA length^2)
  double height = 0.0;                 // height of the surface above the beam's neutral axis, m
  double compliance = 0.0;             // length^3/(3 EI), m/N, if the local compliance is included
  double low = 0.0, high = 0.0;        // ends of the piece, m; a wheel outside touches its corner
  double start = 0.0;                  // initial station of Find::closest_within and farthest_within
  double rise = 0.0, rise_rate = 0.0;  // of moving ground, m and m/s
};

inline constexpr int most_element_unknowns = 6;

/// Kinematics of a contact and their directions. The element's unknowns are in the order of the beam's nodes: (v,
/// theta) or (u, v, theta) of the left node, then of the right node.
struct Touch {
  contact::Kinematics kinematics;
  Eigen::Vector3d normal_on_body = Eigen::Vector3d::Zero();   // d alpha / d(x, y, phi)
  Eigen::Vector3d tangent_on_body = Eigen::Vector3d::Zero();  // d beta' / d(x', y', phi')
  Eigen::Vector3d normal_on_other = Eigen::Vector3d::Zero();  // normal_on_body for the other body of two
  Eigen::Vector3d tangent_on_other = Eigen::Vector3d::Zero();
  std::array<double, most_element_unknowns> normal_on_beam{};   // d alpha / d(element unknowns)
  std::array<double, most_element_unknowns> tangent_on_beam{};  // d beta' / d(their rates)
  double xi = 0.0;                                              // position of the contact point in the element
  double station = 0.0;                                         // x of the contact point on the undeformed track, m
  double local_compliance = 0.0, local_compliance_by_x = 0.0;   // local compliance at the point, m/N, and its d/dx, 1/N
  double ahead = 0.0;  // distance ahead of the wheel's centre, m; start of the next search

  void keep(base::Bytes& bytes) {
    bytes(kinematics, normal_on_body, tangent_on_body, normal_on_other, tangent_on_other, normal_on_beam,
          tangent_on_beam, xi, station, local_compliance, local_compliance_by_x, ahead);
  }
};

/// The point of a patch to find. closest: the point closest to the wheel's centre, if it is unique. closest_within: the
/// local minimum of the distance next to the patch's start (or its end, if the distance decreases towards it).
/// farthest_within: the maximum of the distance between two minima.
enum class Find { closest, closest_within, farthest_within };

/// q, qd: x, y, phi of the wheel's body and their rates. v, w: the element's unknowns and their rates (2*block values,
/// with `block` unknowns at a node; not read on rigid ground). False if there is no contact point (the centre is below
/// the surface, and not beside its end).
bool touch(const Patch& patch, const track::Profile& profile, double radius, const Eigen::Vector3d& q,
           const Eigen::Vector3d& qd, int block, const double* v, const double* w, Touch& out,
           Find find = Find::closest);

}  // namespace traverse::train
