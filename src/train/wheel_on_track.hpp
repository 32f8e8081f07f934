// A wheel (a circle) on the running surface y = h(x) + v(x, t): the contact point lies along the surface's local
// normal through the wheel's centre. Penetration and sliding speed come with the directions in which they change,
// and the contact force acts along exactly these directions on the wheel's body and on the beam element, so that
// action and reaction cancel to rounding and the power of the pair is -f_n alpha' - f_t beta' (paper, eqs. 45-50).
//
// v is the element's cubic. Under a force inside it the element sinks further, as a beam clamped at its nodes does: by
// h^3 xi^3 (1 - xi)^3/(3 EI) a newton at the force itself, and by more where it shears (seat_of). Where that counts it
// is condensed into the contact, as a seat in series with the law (contact::Law::seat): it has no mass, so that it
// needs no unknowns. Its energy s f^2/2 changes with the place too: the wheel is driven on by f^2/2 ds/dx, which is
// what the slope of that shape makes of f.
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/bytes.hpp"
#include "traverse/contact/law.hpp"
#include "traverse/track/profile.hpp"

namespace traverse::train {

/// A piece of running surface without a kink inside: rigid ground, or one element of the beam.
struct Patch {
  int element = -1;              // -1: rigid ground
  double x = 0.0, length = 0.0;  // of the element, m
  double shear = 0.0;            // 12 EI/(GA length^2)
  double height = 0.0;           // of the surface above the beam's neutral axis, m
  double compliance = 0.0;       // length^3/(3 EI), m/N, where the element's inner shape counts
  double low = 0.0, high = 0.0;  // stations between which the piece reaches; a wheel beyond touches its corner
  double start = 0.0;            // where Find::closest_within and farthest_within begin to look
};

inline constexpr int most_element_unknowns = 6;

/// Kinematics of a contact and their directions. Element unknowns are ordered as the beam's nodes are:
/// (v, theta) or (u, v, theta) of the left node, then of the right one.
struct Touch {
  contact::Kinematics kinematics;
  Eigen::Vector3d normal_on_body = Eigen::Vector3d::Zero();   // d alpha / d(x, y, phi)
  Eigen::Vector3d tangent_on_body = Eigen::Vector3d::Zero();  // d beta' / d(x', y', phi')
  Eigen::Vector3d normal_on_other = Eigen::Vector3d::Zero();  // the same of the other body, where two bodies touch
  Eigen::Vector3d tangent_on_other = Eigen::Vector3d::Zero();
  std::array<double, most_element_unknowns> normal_on_beam{};   // d alpha / d(element unknowns)
  std::array<double, most_element_unknowns> tangent_on_beam{};  // d beta' / d(their rates)
  double xi = 0.0;                                              // of the contact point in the element
  double station = 0.0;                                         // x of the contact point on the undeformed track, m
  double seat = 0.0, seat_by_x = 0.0;  // what the element yields there between its ends, m/N, and d/dx of it, 1/N
  double ahead = 0.0;  // of it before the wheel's centre, m; where the next search for the closest point begins

  void keep(base::Bytes& bytes) {
    bytes(kinematics, normal_on_body, tangent_on_body, normal_on_other, tangent_on_other, normal_on_beam,
          tangent_on_beam, xi, station, seat, seat_by_x, ahead);
  }
};

/// Which point of a patch is meant: the one closest to the wheel's centre, of which there is one; where there may be
/// several such points, the one next to the patch's start (or its end, towards which the distance falls on), or the
/// farthest one between two of them.
enum class Find { closest, closest_within, farthest_within };

/// q, qd: x, y, phi of the wheel's body and their rates. v, w: the element's unknowns and their rates (2*block
/// values, where block is the number of unknowns of a node; not read on rigid ground). Returns false where no contact
/// point exists (the centre lies below the surface, and not beside its end).
bool touch(const Patch& patch, const track::Profile& profile, double radius, const Eigen::Vector3d& q,
           const Eigen::Vector3d& qd, int block, const double* v, const double* w, Touch& out,
           Find find = Find::closest);

}  // namespace traverse::train
