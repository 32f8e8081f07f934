#include "traverse/modes/modes.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "eigen.hpp"
#include "nodal_shape.hpp"
#include "segment.hpp"

namespace traverse::modes {
namespace {

constexpr double distinct = 1e-6;  // relative difference of two frequencies

struct Mode {
  double omega = 0.0;
  const Segment* segment = nullptr;
  int offset = 0;
  std::vector<double> shape;  // of the segment's unknowns
};

/// The `count` lowest of all segments and their equals.
std::vector<Mode> lowest(const std::vector<Segment>& segments, int count) {
  std::vector<Mode> modes;
  for (const Segment& s : segments) {
    const int equal = static_cast<int>(s.offsets.size());
    for (const Eigenpair& pair : lowest_modes(s, (count + equal - 1) / equal)) {
      for (int offset : s.offsets) modes.push_back({pair.omega, &s, offset, pair.shape});
    }
  }
  std::stable_sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    return std::tuple(a.omega, a.segment->nodes[0] + a.offset) < std::tuple(b.omega, b.segment->nodes[0] + b.offset);
  });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

/// The lowest frequencies of one segment that differ and are not zero: two, or as many as it has.
std::vector<double> distinct_of(const Segment& s) {
  for (int count = 2 + static_cast<int>(s.rigid.size());; count *= 2) {
    std::vector<double> found;
    for (const Eigenpair& pair : lowest_modes(s, count)) {
      const bool repeated = !found.empty() && pair.omega <= found.back() * (1.0 + distinct);
      if (pair.omega > 0.0 && !repeated) found.push_back(pair.omega);
    }
    if (found.size() >= 2 || count >= s.size()) return found;
  }
}

}  // namespace

Modes natural_modes(const beam::Beam& beam, int count, bool shapes) {
  auto segments = transverse_segments(beam);
  for (Segment& s : axial_segments(beam)) segments.push_back(std::move(s));
  Modes result;
  for (const Mode& mode : lowest(segments, std::max(count, 0))) {
    result.omega.push_back(mode.omega);
    result.axial.push_back(mode.segment->axial ? 1 : 0);
    if (shapes) result.shape.push_back(nodal_shape(*mode.segment, mode.offset, mode.shape, beam.mesh().nodes()));
  }
  return result;
}

std::pair<double, double> distinct_pair(const beam::Beam& beam) {
  std::vector<double> all;
  for (const Segment& s : transverse_segments(beam)) {
    const auto some = distinct_of(s);
    all.insert(all.end(), some.begin(), some.end());
  }
  std::sort(all.begin(), all.end());
  const auto second =
      std::find_if(all.begin(), all.end(), [&](double omega) { return omega > all.front() * (1.0 + distinct); });
  if (second == all.end()) {
    throw InputError(
        "beam_damping_ratios: the mesh has " + std::string(all.empty() ? "no" : "only one") +
        " natural frequency of bending, and two distinct ones are needed; raise beam_elements_per_span, or "
        "give beam_rayleigh instead");
  }
  return {all.front(), *second};
}

beam::Rayleigh rayleigh(double omega1, double omega2, double zeta1, double zeta2) {
  // Eq. 20 divided by omega2 - omega1, so that nothing cancels: equal ratios give their limit exactly.
  const double sum = omega1 + omega2, slope = omega1 * (zeta1 - zeta2) / (omega2 - omega1);
  return {2.0 * omega1 * omega2 / sum * (zeta1 + slope), 2.0 / sum * (zeta2 - slope)};
}

}  // namespace traverse::modes
