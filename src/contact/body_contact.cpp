// Penetration, its rate, sliding speed and generalized force directions for arc-arc and arc-line contact (equations 46,
// 47 and 50 of the paper as corrected in doc/theory.md).
#include "traverse/contact/body_contact.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::contact {

using Eigen::Vector2d;
using multibody::Frame;
using multibody::quarter_turn;

namespace {

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The vector to the arc's centre from the other centre or from the nearest point of the line.
struct Gap {
  Vector2d from;       // the other centre or the nearest point
  Vector2d d;          // vector to the arc's centre
  double signed_side;  // side of the line times the distance from it; 1 for arcs
  bool between_ends;
};

Gap gap(const PairGeometry& pair, const Frame& first, const Frame& second) {
  const Vector2d centre = first.origin + first.to_global(pair.first_arm);
  const Vector2d other = second.origin + second.to_global(pair.second_arm);
  if (pair.type == PairType::arc_arc) return {other, centre - other, 1.0, false};
  const Vector2d along = second.to_global(pair.direction);
  const double s = along.dot(centre - other);
  const Vector2d nearest = other + std::clamp(s, 0.0, pair.length) * along;
  return {nearest, centre - nearest, cross(along, centre - other), s >= 0.0 && s <= pair.length};
}

}  // namespace

double effective_radius(const BodyContact& contact) {
  const auto [i, j] = contact.radii;
  return contact.type == PairType::arc_line ? i : std::abs(i * j / (i + j));
}

PairGeometry pair_geometry(const BodyContact& contact, const Frame& first, const Frame& second) {
  PairGeometry pair;
  pair.type = contact.type;
  pair.first_radius = contact.radii[0];
  pair.first_arm = first.to_body(contact.centres[0] - first.origin);
  if (contact.type == PairType::arc_arc) {
    pair.radius_sum = contact.radii[0] + contact.radii[1];
    pair.second_arm = second.to_body(contact.centres[1] - second.origin);
    return pair;
  }
  pair.radius_sum = contact.radii[0];
  pair.second_arm = second.to_body(contact.line[0] - second.origin);
  const Vector2d along = contact.line[1] - contact.line[0];
  pair.length = along.norm();
  pair.direction = second.to_body(along / pair.length);
  pair.side = gap(pair, first, second).signed_side < 0.0 ? -1.0 : 1.0;
  return pair;
}

void record_side(PairGeometry& pair, const Frame& first, const Frame& second) {
  if (pair.type != PairType::arc_line) return;
  const Gap g = gap(pair, first, second);
  if (!g.between_ends) pair.side = g.signed_side < 0.0 ? -1.0 : 1.0;
}

bool touch(const PairGeometry& pair, const Frame& first, const Frame& second, PairTouch& out) {
  const Gap g = gap(pair, first, second);
  if (g.between_ends && g.signed_side * pair.side < 0.0) return false;
  const double distance = g.d.norm();
  const double sign = pair.radius_sum < 0.0 ? -1.0 : 1.0;  // hollow: no contact if the centres are close
  // A coincidence of centres, or of a centre and the line, has no direction; it is far from contact.
  const Vector2d m = distance > 0.0 ? Vector2d(sign / distance * g.d) : Vector2d(0.0, sign);
  const double alpha = pair.radius_sum - sign * distance;
  const Vector2d centre = g.from + g.d;
  out.point = centre - (pair.first_radius - 0.5 * alpha) * m;
  const Vector2d tau(m.y(), -m.x());
  const std::array<const Frame*, 2> frames = {&first, &second};
  out.kinematics = {alpha, 0.0, 0.0};
  for (std::size_t i = 0; i < 2; ++i) {
    const double away = i == 0 ? 1.0 : -1.0;
    const Vector2d turn = quarter_turn(out.point - frames[i]->origin);
    out.normal[i] << -away * m, -away * m.dot(turn);
    out.tangent[i] << away * tau, away * tau.dot(turn);
    const Eigen::Vector3d velocity(frames[i]->velocity.x(), frames[i]->velocity.y(), frames[i]->omega);
    out.kinematics.penetration_rate += out.normal[i].dot(velocity);
    out.kinematics.sliding_speed += out.tangent[i].dot(velocity);
  }
  return true;
}

}  // namespace traverse::contact
