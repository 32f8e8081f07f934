#include "traverse/coupling/wheel_on_track.hpp"

#include <algorithm>
#include <cmath>

#include "traverse/beam/shape.hpp"

namespace traverse::coupling {
namespace {

// The surface point that belongs to the material station x, and how it changes along x. At a height e above the
// neutral axis it moves by -e v' along x, as the plane sections turn.
struct SurfacePoint {
  Eigen::Vector2d P, P_x, P_xx;
};

struct Surface {
  const Patch& patch;
  const track::Profile& profile;
  int block;
  const double* v;

  SurfacePoint at(double x) const {
    const track::Height h = profile.at(x);
    SurfacePoint s{{x, h.value}, {1.0, h.slope}, {0.0, h.curvature}};
    if (patch.element < 0) return s;
    const double xi = (x - patch.x) / patch.length;
    const beam::Hermite psi = beam::hermite(xi, patch.length);
    const int o = block - 2;  // where v stands among a node's unknowns
    const std::array<double, 4> n = {v[o], v[o + 1], v[block + o], v[block + o + 1]};
    for (int i = 0; i < 4; ++i) {
      s.P.y() += psi.value[i] * n[i];
      s.P_x.y() += psi.slope[i] * n[i];
      s.P_xx.y() += psi.curvature[i] * n[i];
      s.P.x() -= patch.height * psi.slope[i] * n[i];
      s.P_x.x() -= patch.height * psi.curvature[i] * n[i];
      s.P_xx.x() -= patch.height * psi.third[i] * n[i];
    }
    if (block == 3) {
      s.P.x() += (1.0 - xi) * v[0] + xi * v[3];
      s.P_x.x() += (v[3] - v[0]) / patch.length;
    }
    return s;
  }
};

// Station of the point closest to the centre c: (c - P).P_x = 0, by Newton from below the centre.
double closest_station(const Surface& surface, const Eigen::Vector2d& c, double low, double high) {
  double x = std::clamp(c.x(), low, high);
  for (int i = 0; i < 20; ++i) {
    const SurfacePoint s = surface.at(x);
    const Eigen::Vector2d d = c - s.P;
    const double step = d.dot(s.P_x) / (s.P_x.squaredNorm() - d.dot(s.P_xx));
    const double next = std::clamp(x + step, low, high);
    const double moved = std::abs(next - x);
    x = next;
    if (moved <= 1e-15 * (1.0 + std::abs(x))) break;
  }
  return x;
}

// The station between low and high where the distance to c is least (sign 1) or greatest (sign -1), from the start on:
// Newton, kept in the right direction by bisection, which ends at low or high where there is none.
double station_within(const Surface& surface, const Eigen::Vector2d& c, double sign) {
  double low = surface.patch.low, high = surface.patch.high;
  double x = std::clamp(surface.patch.start, low, high);
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint s = surface.at(x);
    const Eigen::Vector2d d = c - s.P;
    const double f = sign * d.dot(s.P_x);  // above 0: it lies to the right
    const double f_x = sign * (d.dot(s.P_xx) - s.P_x.squaredNorm());
    const double tiny = 1e-15 * (1.0 + std::abs(x));
    (f > 0.0 ? low : high) = x;
    if (high - low <= tiny || (f_x < 0.0 && std::abs(f) <= -f_x * tiny)) break;
    const double newton = f_x < 0.0 ? x - f / f_x : low;
    x = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return x;
}

}  // namespace

bool touch(const Patch& patch, const track::Profile& profile, double radius, const Eigen::Vector3d& q,
           const Eigen::Vector3d& qd, int block, const double* v, const double* w, Touch& out, Find find) {
  const Surface surface{patch, profile, block, v};
  const Eigen::Vector2d c = q.head<2>();
  const double x = find == Find::closest ? closest_station(surface, c, patch.low, patch.high)
                                         : station_within(surface, c, find == Find::closest_within ? 1.0 : -1.0);
  const SurfacePoint s = surface.at(x);
  const Eigen::Vector2d from_surface = c - s.P;
  const double distance = from_surface.norm();
  if (!(from_surface.y() > 0.0) || !std::isfinite(distance)) return false;
  const Eigen::Vector2d n = from_surface / distance;
  const Eigen::Vector2d tau(n.y(), -n.x());

  Eigen::Vector2d relative = qd.head<2>();  // of the centre against the surface's material
  out.xi = 0.0;
  out.station = x;
  if (patch.element >= 0) {
    out.xi = (x - patch.x) / patch.length;
    const beam::Hermite psi = beam::hermite(out.xi, patch.length);
    const int o = block - 2;
    const std::array<int, 4> place = {o, o + 1, block + o, block + o + 1};
    for (int i = 0; i < 4; ++i) {
      const double along = -patch.height * psi.slope[i];
      out.normal_on_beam[place[i]] = n.y() * psi.value[i] + n.x() * along;
      out.tangent_on_beam[place[i]] = -tau.y() * psi.value[i] - tau.x() * along;
      relative.y() -= psi.value[i] * w[place[i]];
      relative.x() -= along * w[place[i]];
    }
    if (block == 3) {
      const std::array<double, 2> phi = beam::linear(out.xi);
      for (int i = 0; i < 2; ++i) {
        out.normal_on_beam[3 * i] = n.x() * phi[i];
        out.tangent_on_beam[3 * i] = -tau.x() * phi[i];
        relative.x() -= phi[i] * w[3 * i];
      }
    }
  }
  out.normal_on_body = {-n.x(), -n.y(), 0.0};
  out.tangent_on_body = {tau.x(), tau.y(), distance};
  out.kinematics.penetration = radius - distance;
  out.kinematics.penetration_rate = -n.dot(relative);
  out.kinematics.sliding_speed = tau.dot(relative) + distance * qd.z();
  return true;
}

}  // namespace traverse::coupling
