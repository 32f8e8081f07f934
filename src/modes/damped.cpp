// Damped modes of the whole beam from the damped modes of its segments. For proportional damping they follow from the
// natural modes by lambda^2 + (a + b omega^2) lambda + omega^2 = 0, otherwise from the quadratic eigenvalue problem.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "eigen.hpp"
#include "modes/modes.hpp"
#include "quadratic.hpp"
#include "segment.hpp"

namespace traverse::modes {
namespace {

using Complex = std::complex<double>;

struct DampedMode {
  Complex lambda;
  const Segment* segment = nullptr;
  int offset = 0;
  std::vector<Complex> shape;  // displacements of the segment's unknowns
};

/// a and b of the segment's C = a M + b K, if C has this form: without dampers, or with dampers proportional to the
/// mass.
std::optional<beam::Rayleigh> proportional(const Segment& s, const beam::Rayleigh& ab) {
  const double extra = s.D.at(0, 0) / s.M.at(0, 0);
  for (int i = 0; i < s.size(); ++i) {
    if ((s.D.at(i, i) != 0.0) != (extra != 0.0)) return std::nullopt;
    for (int j = std::max(0, i - s.D.width()); j <= i; ++j) {
      const double D = s.D.at(i, j), from_mass = extra * s.M.at(i, j);
      // D contains the rounding errors of the element matrices and of C.
      const double rounding = 1e-13 * (std::abs(D) + std::abs(from_mass)) +
                              16.0 * std::numeric_limits<double>::epsilon() * std::abs(ab.b * s.K.at(i, j));
      if (std::abs(D - from_mass) > rounding) return std::nullopt;
    }
  }
  return beam::Rayleigh{ab.a + extra, ab.b};
}

/// Roots of lambda^2 + (a + b omega^2) lambda + omega^2 = 0: only the root with Im > 0 of a complex pair, otherwise
/// both real roots. A rigid motion has the root 0 and, if it is damped, -a.
std::vector<Complex> roots(double omega, const beam::Rayleigh& ab) {
  const double half = 0.5 * (ab.a + ab.b * omega * omega);
  if (omega == 0.0) {
    if (ab.a == 0.0) return {0.0};
    return {0.0, -ab.a};
  }
  if (std::abs(half) < omega) return {Complex(-half, std::sqrt((omega - half) * (omega + half)))};
  const double larger = half + std::copysign(std::sqrt((half - omega) * (half + omega)), half);
  return {-omega * (omega / larger), -larger};
}

/// The modes of one segment.
std::vector<DampedPair> damped_modes_of(const Segment& s, const beam::Rayleigh& ab, int count) {
  const auto proportional_ab = proportional(s, ab);
  if (!proportional_ab) return lowest_damped(s, ab, count);
  std::vector<DampedPair> modes;
  for (const Eigenpair& natural : lowest_modes(s, count)) {
    for (const Complex lambda : roots(natural.omega, *proportional_ab)) {
      modes.push_back({lambda, {natural.shape.begin(), natural.shape.end()}});
    }
  }
  return modes;
}

std::vector<DampedMode> lowest_damped(const std::vector<Segment>& segments, const beam::Rayleigh& ab, int count) {
  std::vector<DampedMode> modes;
  for (const Segment& s : segments) {
    const int copies = static_cast<int>(s.offsets.size());
    for (const DampedPair& pair : damped_modes_of(s, ab, (count + copies - 1) / copies)) {
      for (int offset : s.offsets) modes.push_back({pair.lambda, &s, offset, pair.shape});
    }
  }
  std::stable_sort(modes.begin(), modes.end(), [](const DampedMode& a, const DampedMode& b) {
    return std::tuple(std::abs(a.lambda), a.segment->nodes[0] + a.offset) <
           std::tuple(std::abs(b.lambda), b.segment->nodes[0] + b.offset);
  });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

DampedModes damped_modes_of(const beam::Beam& beam, int count, const beam::ShapePoints* points) {
  const std::vector<Segment> segments = segments_of(beam, true, Damping::included);
  DampedModes result;
  for (const DampedMode& mode : lowest_damped(segments, beam.rayleigh(), std::max(count, 0))) {
    result.lambda.push_back(mode.lambda);
    result.motion.push_back(mode.segment->motion);
    if (points != nullptr) result.shape.push_back(stored_shape(beam, *mode.segment, mode.offset, mode.shape, *points));
  }
  return result;
}

}  // namespace

DampedModes damped_modes(const beam::Beam& beam, int count, bool shapes) {
  if (!shapes) return damped_modes_of(beam, count, nullptr);
  return damped_modes(beam, count, beam::ShapePoints::at_nodes(beam.mesh()));
}

DampedModes damped_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points) {
  return damped_modes_of(beam, count, &points);
}

bool damped(const beam::Beam& beam) {
  PetscReal norm = 0.0;
  base::check(MatNorm(beam.damping(), NORM_INFINITY, &norm));
  return norm > 0.0;
}

}  // namespace traverse::modes
