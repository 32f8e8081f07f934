// Newton's method for the point of the deflected surface closest to the wheel's centre; penetration R - |d| (equation
// 47 of the paper, as corrected), its rate and the sliding speed follow from that point.
#include "train/wheel_on_track.hpp"

#include <algorithm>
#include <cmath>

#include "train/element_surface.hpp"

namespace traverse::train {
namespace {

using Point = SurfacePoint<double>;

struct PatchSurface {
  const Patch& patch;
  const track::Profile& profile;
  ElementSurface<Surface::general, double> element;

  PatchSurface(const Patch& patch_, const track::Profile& profile_, int block, const double* v)
      : patch(patch_), profile(profile_) {
    if (patch.element < 0) return;
    element.per_length = 1.0 / patch.length;
    element.height = patch.height;
    const double *left = v + block - 2, *right = left + block;  // (v, theta)
    element.set(patch.shear, left[0], patch.length * left[1], right[0], patch.length * right[1]);
    if (block < 3) return;
    element.axial = v[0];
    element.axial_slope = v[3] - v[0];
  }

  Point at(double x) const {
    const track::Height h = profile.at(x);
    Point p = {x, h.value + patch.rise, 1.0, h.slope, 0.0, h.curvature};
    if (patch.element < 0) return p;
    p.xi = (x - patch.x) * element.per_length;
    element.move(p);
    return p;
  }
};

// Station of the point s closest to the centre c: (c - P).P_x = 0, by Newton's method.
double closest_station(const PatchSurface& surface, const Eigen::Vector2d& c, double start, Point& s) {
  const double low = surface.patch.low, high = surface.patch.high;
  double x = std::clamp(start, low, high);
  for (int i = 0; i < 20; ++i) {
    s = surface.at(x);
    const double dx = c.x() - s.x, dy = c.y() - s.y;
    const double next = std::clamp(x + s.approach(dx, dy) / s.curvature(dx, dy), low, high);
    if (std::abs(next - x) <= 1e-15 * (1.0 + std::abs(next))) return x;
    x = next;
  }
  s = surface.at(x);
  return x;
}

// The station between low and high where the distance to c has its minimum (sign 1) or maximum (sign -1), from the
// start on: Newton's method with bisection as a safeguard. The result is low or high if there is no extremum.
double station_within(const PatchSurface& surface, const Eigen::Vector2d& c, double sign) {
  double low = surface.patch.low, high = surface.patch.high;
  double x = std::clamp(surface.patch.start, low, high);
  for (int i = 0; i < 100; ++i) {
    const Point s = surface.at(x);
    const double dx = c.x() - s.x, dy = c.y() - s.y;
    const double f = sign * s.approach(dx, dy), f_x = -sign * s.curvature(dx, dy);  // f > 0: it is to the right
    const double resolution = 1e-15 * (1.0 + std::abs(x));
    (f > 0.0 ? low : high) = x;
    if (high - low <= resolution || (f_x < 0.0 && std::abs(f) <= -f_x * resolution)) break;
    const double newton = f_x < 0.0 ? x - f / f_x : low;
    x = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return x;
}

}  // namespace

bool touch(const Patch& patch, const track::Profile& profile, double radius, const Eigen::Vector3d& q,
           const Eigen::Vector3d& qd, int block, const double* v, const double* w, Touch& out, Find find) {
  const PatchSurface surface(patch, profile, block, v);
  const Eigen::Vector2d c = q.head<2>();
  Point s;
  double x = 0.0;
  if (find == Find::closest) {
    x = closest_station(surface, c, c.x() + out.ahead, s);
  } else {
    x = station_within(surface, c, find == Find::closest_within ? 1.0 : -1.0);
    s = surface.at(x);
  }
  const Eigen::Vector2d from_surface(c.x() - s.x, c.y() - s.y);
  const double distance = from_surface.norm();
  if (!std::isfinite(distance)) return false;
  const bool at_end = x == patch.low || x == patch.high;  // a wheel may have fallen beside it
  if (!(from_surface.y() > 0.0) && !(at_end && distance > radius)) return false;
  const Eigen::Vector2d n = from_surface / distance;
  const Eigen::Vector2d tau(n.y(), -n.x());

  Eigen::Vector2d relative = qd.head<2>();  // velocity of the centre relative to the surface's material
  relative.y() -= patch.rise_rate;
  out.kinematics = {radius - distance, -n.dot(relative), tau.dot(relative) + distance * qd.z()};
  out.xi = s.xi;
  out.local_compliance = out.local_compliance_by_x = 0.0;
  out.station = x;
  out.ahead = x - c.x();
  out.normal_on_body = {-n.x(), -n.y(), 0.0};
  out.tangent_on_body = {tau.x(), tau.y(), distance};
  if (patch.element < 0) return true;
  const auto local = local_compliance_at<Surface::general>(s.xi, patch.length, patch.shear, patch.compliance);
  out.local_compliance = local.value;
  out.local_compliance_by_x = local.by_x;
  const auto shapes = shapes_at<Surface::general>(s.xi, patch.length, patch.shear);
  const auto set = [&](double up, double along, double* on_beam) {
    directions<Surface::general>(shapes, block, patch.height, s.xi, s.turn, up, along, on_beam);
  };
  set(n.y(), n.x(), out.normal_on_beam.data());
  set(-tau.y(), -tau.x(), out.tangent_on_beam.data());
  for (std::size_t i = 0; i < 2 * static_cast<std::size_t>(block); ++i) {
    out.kinematics.penetration_rate += out.normal_on_beam[i] * w[i];
    out.kinematics.sliding_speed += out.tangent_on_beam[i] * w[i];
  }
  return true;
}

}  // namespace traverse::train
