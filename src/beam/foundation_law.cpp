// Force, tangents, energy and dissipation of a foundation with a gap, one-sided action or a cubic term, and of an
// elastic-perfectly plastic spring.
#include "traverse/beam/foundation_law.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::beam {
namespace {
constexpr double engagement = 1e-9;  // m or rad, over which the damper force increases from zero
}

FoundationForce foundation_force(const FoundationLaw& law, double k, double c, double d, double w) {
  const bool can_separate = law.one_sided || law.gap > 0.0;
  const double s = std::abs(d) - law.gap;
  if (can_separate && (!(s > 0.0) || (law.one_sided && d > 0.0))) return {};
  const double side = d > 0.0 ? 1.0 : -1.0, rate = side * w;
  const double share = can_separate ? std::min(1.0, s / engagement) : 1.0;
  const double spring = k * s + law.cubic * s * s * s, damper = share * c * rate;
  FoundationForce f;
  f.energy = (0.5 * k + 0.25 * law.cubic * s * s) * s * s;
  if (can_separate && !(spring + damper > 0.0)) {
    f.dissipation = -spring * rate;
    return f;
  }
  f.force = -side * (spring + damper);
  f.by_displacement = k + 3.0 * law.cubic * s * s + (share < 1.0 ? c * rate / engagement : 0.0);
  f.by_rate = share * c;
  f.dissipation = damper * rate;
  return f;
}

FoundationForce sliding_force(double k, double limit, double previous, double d) {
  const double trial = std::clamp(previous, -limit, limit) - k * d;
  FoundationForce f;
  f.force = std::clamp(trial, -limit, limit);
  f.by_displacement = f.force == trial ? k : 0.0;
  f.energy = 0.5 * f.force * f.force / k;
  return f;
}

}  // namespace traverse::beam
