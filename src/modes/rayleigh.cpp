// Rayleigh coefficients from the damping ratios of two modes, equation 20 of the paper for modes of the whole
// structure, of which the beam's mass and stiffness are only a part.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "modes/modes.hpp"

namespace traverse::modes {
namespace {

// relative tolerance of a damping ratio: a limit copied from a message is accepted
constexpr double ratio_tolerance = 1e-5;
constexpr double critical = 1.0;

double hertz(const BendingMode& mode) { return mode.omega / (2.0 * std::numbers::pi); }

/// The ratio of the other mode with which b = 0, and the one with which a = 0.
struct Limits {
  double without_b, without_a;

  Limits(const BendingMode& one, const BendingMode& other, double zeta1) {
    const double scale = zeta1 * one.omega / other.omega;
    without_b = scale * other.own_mass() / one.own_mass();
    without_a = one.own_stiffness() > 0.0 ? scale * other.own_stiffness() / one.own_stiffness()
                                          : std::numeric_limits<double>::infinity();
  }
  double least() const { return std::min(without_a, without_b); }
  double most() const { return std::max(without_a, without_b); }
  bool contain(double zeta2) const {
    return zeta2 >= least() * (1.0 - ratio_tolerance) && zeta2 <= most() * (1.0 + ratio_tolerance);
  }
};

/// The solution of both equations, divided by omega2 - omega1, so that no large terms cancel.
beam::Rayleigh solution(const BendingMode& one, const BendingMode& other, double zeta1, double zeta2) {
  const double w1 = one.omega, w2 = other.omega, difference = w2 - w1, m1 = one.own_mass(), m2 = other.own_mass();
  const double determinant =
      m1 * (w1 + w2 - (other.springs - one.springs) / difference) - (m2 - m1) / difference * one.own_stiffness();
  const double by_mass = w1 * w2 * (zeta1 + w1 * (zeta1 - zeta2) / difference) -
                         (zeta1 * w1 * other.springs - zeta2 * w2 * one.springs) / difference;
  const double by_stiffness = zeta2 * m1 + w1 * (zeta2 * m1 - zeta1 * m2) / difference;
  return {std::max(2.0 * by_mass / determinant, 0.0), std::max(2.0 * by_stiffness / determinant, 0.0)};
}

}  // namespace

BendingMode between(const std::vector<BendingMode>& modes, double omega) {
  const auto above = std::find_if(modes.begin(), modes.end(), [&](const BendingMode& m) { return m.omega >= omega; });
  if (modes.empty()) return {omega};
  if (above == modes.begin() || above == modes.end()) {
    BendingMode mode = above == modes.end() ? modes.back() : modes.front();
    mode.omega = omega;
    return mode;
  }
  const BendingMode &low = above[-1], &high = *above;
  const double squared = low.omega * low.omega, share = (omega * omega - squared) / (high.omega * high.omega - squared);
  return {omega, std::lerp(low.springs, high.springs, share), std::lerp(low.other_mass, high.other_mass, share), 0.0};
}

beam::Rayleigh rayleigh(const BendingMode& one, const BendingMode& other, double zeta1, double zeta2) {
  if (zeta1 == 0.0 && zeta2 == 0.0) return {};
  const Limits limits(one, other, zeta1);
  if (!limits.contain(zeta2))
    throw InputError(
        fmt::format("beam_damping_ratios = {:g},{:g}: Rayleigh damping that has these at {:.6g} and {:.6g} Hz has a "
                    "negative {}, which feeds energy into the beam; allowed beside {:g}: from {:.6g} to {:.6g}; "
                    "beam_damping_frequencies names other frequencies",
                    zeta1, zeta2, hertz(one), hertz(other),
                    (zeta2 < limits.least()) == (limits.without_b < limits.without_a) ? "b" : "a", zeta1,
                    limits.least(), limits.most()));
  return solution(one, other, zeta1, std::clamp(zeta2, limits.least(), limits.most()));
}

std::pair<double, double> first_two(const std::vector<BendingMode>& modes) {
  if (modes.size() < 2)
    throw InputError(
        "beam_damping_ratios: the mesh has " + std::string(modes.empty() ? "no" : "only one") +
        " natural frequency of bending, and two distinct ones are needed; raise beam_elements_per_span, or "
        "give beam_rayleigh instead");
  return {modes[0].omega, modes[1].omega};
}

RayleighPair rayleigh_pair(const std::vector<BendingMode>& modes, double zeta1, double zeta2) {
  (void)first_two(modes);
  if (zeta1 != zeta2 || zeta1 == 0.0) return {rayleigh(modes[0], modes[1], zeta1, zeta2), 1};
  for (std::size_t second = 1; second < modes.size(); ++second) {
    if (!Limits(modes[0], modes[second], zeta1).contain(zeta2)) continue;
    const beam::Rayleigh ab = rayleigh(modes[0], modes[second], zeta1, zeta2);
    // Springs that the second mode moves more than the first raise b above that of a beam without them.
    const bool raised = modes[second].springs > modes[0].springs && second + 1 < modes.size();
    if (!raised || modes[second + 1].ratio(ab) < critical) return {ab, second};
  }
  throw InputError(
      fmt::format("beam_damping_ratios = {:g}: no a, b >= 0 give the first mode, {:.6g} Hz, and one of the next {} "
                  "modes this ratio, because the springs carry the beam without bending it; give beam_rayleigh, or "
                  "model_modes with model_damping_ratios",
                  zeta1, hertz(modes[0]), modes.size() - 1));
}

}  // namespace traverse::modes
