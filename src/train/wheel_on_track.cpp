// Newton's method for the point of the deflected surface closest to the wheel's centre; penetration R - |d| (equation
// 47 of the paper, as corrected), its rate and the sliding speed follow from that point.
#include "train/wheel_on_track.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "beam/shape.hpp"

namespace traverse::train {
namespace {

// The surface point of the material station x, and its derivatives along x. At a height e above the neutral axis it
// moves by (-e theta, -e theta^2/2), because plane sections rotate; theta = v' without shear. The second order term of
// y is necessary: the force is along the normal, which rotates with the section, and has no moment about the axis.
struct SurfacePoint {
  Eigen::Vector2d P, P_x, P_xx;
  double turn = 0.0;  // theta
};

struct Surface {
  const Patch& patch;
  const track::Profile& profile;
  int block;
  const double* v;
  double per_length = 0.0, strain = 0.0;  // strain: v' - theta
  std::array<double, 4> deflection{};     // deflection of the element: coefficients of the powers of xi

  Surface(const Patch& patch_, const track::Profile& profile_, int block_, const double* v_)
      : patch(patch_), profile(profile_), block(block_), v(v_) {
    if (patch.element < 0) return;
    per_length = 1.0 / patch.length;
    const int o = block - 2;  // index of v among a node's unknowns
    const double difference = v[block + o] - v[o];
    double left = patch.length * v[o + 1], right = patch.length * v[block + o + 1];
    if (patch.shear != 0.0) {
      const double sheared = patch.shear / (1.0 + patch.shear) * (difference - 0.5 * (left + right));
      strain = sheared * per_length;
      left += sheared;
      right += sheared;
    }
    deflection = {v[o], left, 3.0 * difference - 2.0 * left - right, left + right - 2.0 * difference};
  }

  SurfacePoint at(double x) const {
    const track::Height h = profile.at(x);
    SurfacePoint s{{x, h.value + patch.rise}, {1.0, h.slope}, {0.0, h.curvature}, 0.0};
    if (patch.element < 0) return s;
    const double xi = (x - patch.x) * per_length;
    const auto [c0, c1, c2, c3] = deflection;
    const double slope = (c1 + xi * (2.0 * c2 + xi * 3.0 * c3)) * per_length;
    const double curvature = (2.0 * c2 + xi * 6.0 * c3) * per_length * per_length;
    const double third = 6.0 * c3 * per_length * per_length * per_length;
    const double turn = slope - strain, e = patch.height;
    s.turn = turn;
    s.P += Eigen::Vector2d(-e * turn, c0 + xi * (c1 + xi * (c2 + xi * c3)) - 0.5 * e * turn * turn);
    s.P_x += Eigen::Vector2d(-e * curvature, slope - e * turn * curvature);
    s.P_xx += Eigen::Vector2d(-e * third, curvature - e * (curvature * curvature + turn * third));
    if (block == 3) {
      s.P.x() += (1.0 - xi) * v[0] + xi * v[3];
      s.P_x.x() += (v[3] - v[0]) * per_length;
    }
    return s;
  }
};

/// The compliance of an element clamped at its nodes for a force at xi, m/N, and its derivative over x. With u = xi (1
/// - xi) and s = 12 EI/(GA h^2) it is h^3/(12 EI) ((4 u^3 + s u^2)/(1 + s) + s u).
std::pair<double, double> local_compliance_of(const Patch& patch, double xi) {
  const double u = xi * (1.0 - xi), by_x = (1.0 - 2.0 * xi) / patch.length;
  if (patch.shear == 0.0) return {patch.compliance * u * u * u, patch.compliance * 3.0 * u * u * by_x};
  const double s = patch.shear, quarter = 0.25 * patch.compliance;
  return {quarter * u * ((4.0 * u + s) * u / (1.0 + s) + s),
          quarter * ((12.0 * u + 2.0 * s) * u / (1.0 + s) + s) * by_x};
}

// Station of the point s closest to the centre c: (c - P).P_x = 0, by Newton's method.
double closest_station(const Surface& surface, const Eigen::Vector2d& c, double start, SurfacePoint& s) {
  const double low = surface.patch.low, high = surface.patch.high;
  double x = std::clamp(start, low, high);
  for (int i = 0; i < 20; ++i) {
    s = surface.at(x);
    const Eigen::Vector2d d = c - s.P;
    const double step = d.dot(s.P_x) / (s.P_x.squaredNorm() - d.dot(s.P_xx));
    const double next = std::clamp(x + step, low, high);
    if (std::abs(next - x) <= 1e-15 * (1.0 + std::abs(next))) return x;
    x = next;
  }
  s = surface.at(x);
  return x;
}

// The station between low and high where the distance to c has its minimum (sign 1) or maximum (sign -1), from the
// start on: Newton's method with bisection as a safeguard. The result is low or high if there is no extremum.
double station_within(const Surface& surface, const Eigen::Vector2d& c, double sign) {
  double low = surface.patch.low, high = surface.patch.high;
  double x = std::clamp(surface.patch.start, low, high);
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint s = surface.at(x);
    const Eigen::Vector2d d = c - s.P;
    const double f = sign * d.dot(s.P_x);  // positive: the station is to the right
    const double f_x = sign * (d.dot(s.P_xx) - s.P_x.squaredNorm());
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
  const Surface surface(patch, profile, block, v);
  const Eigen::Vector2d c = q.head<2>();
  SurfacePoint s;
  double x = 0.0;
  if (find == Find::closest) {
    x = closest_station(surface, c, c.x() + out.ahead, s);
  } else {
    x = station_within(surface, c, find == Find::closest_within ? 1.0 : -1.0);
    s = surface.at(x);
  }
  const Eigen::Vector2d from_surface = c - s.P;
  const double distance = from_surface.norm();
  if (!std::isfinite(distance)) return false;
  const bool at_end = x == patch.low || x == patch.high;  // a wheel may have fallen beside it
  if (!(from_surface.y() > 0.0) && !(at_end && distance > radius)) return false;
  const Eigen::Vector2d n = from_surface / distance;
  const Eigen::Vector2d tau(n.y(), -n.x());

  Eigen::Vector2d relative = qd.head<2>();  // velocity of the centre relative to the surface's material
  relative.y() -= patch.rise_rate;
  out.xi = out.local_compliance = out.local_compliance_by_x = 0.0;
  out.station = x;
  out.ahead = x - c.x();
  if (patch.element >= 0) {
    out.xi = (x - patch.x) * surface.per_length;
    std::tie(out.local_compliance, out.local_compliance_by_x) = local_compliance_of(patch, out.xi);
    const beam::Hermite psi = beam::hermite(out.xi, patch.length, patch.shear);
    const std::array<double, 4> turn =
        patch.shear == 0.0 ? psi.slope : beam::rotation(out.xi, patch.length, patch.shear);
    const int o = block - 2;
    const std::array<int, 4> place = {o, o + 1, block + o, block + o + 1};
    for (int i = 0; i < 4; ++i) {
      const double along = -patch.height * turn[i], up = psi.value[i] + along * s.turn;
      out.normal_on_beam[place[i]] = n.y() * up + n.x() * along;
      out.tangent_on_beam[place[i]] = -tau.y() * up - tau.x() * along;
      relative.y() -= up * w[place[i]];
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

}  // namespace traverse::train
