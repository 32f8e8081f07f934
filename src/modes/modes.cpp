// Merges the modes of all segments in ascending order, scales and orthonormalises their shapes, and computes Rayleigh
// coefficients from two distinct frequencies (equation 20 of the paper).
#include "modes/modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "eigen.hpp"
#include "segment.hpp"
#include "stored_shape.hpp"

namespace traverse::modes {
namespace {

constexpr double distinct = 1e-6;  // relative difference of two frequencies
// The tolerance between spans that are not coupled: frequencies are proportional to the inverse square of a span; two
// spans of one drawing may be built 20 mm longer and shorter (EN 13670, 10.4), which is this difference at 8 m.
constexpr double distinct_spans = 0.01;
constexpr double ratio_tolerance =
    1e-5;  // relative tolerance of a damping ratio: a limit copied from a message is accepted

struct Mode {
  double omega = 0.0;
  const Segment* segment = nullptr;
  int offset = 0;
  std::vector<double> shape;  // displacements of the segment's unknowns
};

/// The `count` lowest modes of all segments and their equal copies.
std::vector<Mode> lowest(const std::vector<Segment>& segments, int count) {
  std::vector<Mode> modes;
  for (const Segment& s : segments) {
    const int copies = static_cast<int>(s.offsets.size());
    for (const Eigenpair& pair : lowest_modes(s, (count + copies - 1) / copies)) {
      for (int offset : s.offsets) modes.push_back({pair.omega, &s, offset, pair.shape});
    }
  }
  std::stable_sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    return std::tuple(a.omega, a.segment->nodes[0] + a.offset) < std::tuple(b.omega, b.segment->nodes[0] + b.offset);
  });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

/// The lowest distinct non-zero frequencies of one segment: `wanted`, or as many as it has.
std::vector<double> distinct_of(const Segment& s, std::size_t wanted) {
  for (int count = static_cast<int>(wanted + s.rigid.size());; count *= 2) {
    std::vector<double> found;
    for (const Eigenpair& pair : lowest_modes(s, count)) {
      const bool repeated = !found.empty() && pair.omega <= found.back() * (1.0 + distinct);
      if (pair.omega > 0.0 && !repeated) found.push_back(pair.omega);
    }
    if (found.size() >= wanted || count >= s.size()) return found;
  }
}

std::vector<double> product(const Band& A, const std::vector<double>& x) {
  std::vector<double> Ax(x.size(), 0.0);
  add_product(A, 1.0, x.data(), Ax.data());
  return Ax;
}

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

double modal_mass(const Mode& mode) { return dot(mode.shape, product(mode.segment->M, mode.shape)); }

/// Scales to phi^T M phi = 1 by Gram-Schmidt, because computed copies of a frequency are not exactly orthogonal.
void orthonormalise(std::vector<Mode>& modes) {
  std::vector<std::vector<double>> momenta;  // M phi
  for (std::size_t i = 0; i < modes.size(); ++i) {
    std::vector<double>& shape = modes[i].shape;
    for (std::size_t j = 0; j < i; ++j) {
      if (modes[j].segment != modes[i].segment || modes[j].offset != modes[i].offset) continue;
      const double part = dot(shape, momenta[j]);
      for (std::size_t k = 0; k < shape.size(); ++k) shape[k] -= part * modes[j].shape[k];
    }
    const double length = std::sqrt(modal_mass(modes[i]));
    for (double& value : shape) value /= length;
    momenta.push_back(product(modes[i].segment->M, shape));
  }
}

/// Whether every shape has one value and one slope at every station.
bool without_kinks(const beam::Beam& beam) {
  const beam::BeamModel& model = beam.model();
  if (beam.rail() != nullptr || !model.hinges.empty()) return false;
  for (int i = 1; i < static_cast<int>(model.spans.size()); ++i)
    if (model.joint(i) != beam::Joint::continuous) return false;
  return true;
}

/// Adds the slopes and the modal mass of the last stored shape; `mass` is phi^T M phi of its vector.
void add_slopes(const beam::Beam& beam, const beam::ShapePoints& points, const std::vector<double>& vector, double mass,
                Modes& modes) {
  const auto value = [&](int unknown) { return vector[static_cast<std::size_t>(unknown)]; };
  const std::vector<double> raw = points.curve<double>(beam.bridge(), false, value), &shape = modes.shape.back();
  const std::size_t largest = static_cast<std::size_t>(std::max_element(shape.begin(), shape.end()) - shape.begin());
  const double scale = shape[largest] / raw[largest];
  modes.slope.push_back(points.slopes(beam.bridge(), value));
  for (double& slope : modes.slope.back()) slope *= scale;
  modes.mass.push_back(mass * scale * scale);
}

/// Adds damping ratios if C* = a M + b K*, for which the modes are not coupled.
void add_ratios(const beam::Beam& beam, Modes& modes) {
  const beam::Rayleigh ab = beam.rayleigh();
  if (beam.dampers() != nullptr || (beam.springs() != nullptr && ab.b != 0.0)) return;
  for (const double omega : modes.omega)
    modes.ratio.push_back(omega > 0.0 ? (ab.a + ab.b * omega * omega) / (2.0 * omega) : 0.0);
}

Modes modes_of(const beam::Beam& beam, int count, const beam::ShapePoints* points) {
  auto segments = transverse_segments(beam);
  for (Segment& s : axial_segments(beam)) segments.push_back(std::move(s));
  const bool smooth = points != nullptr && without_kinks(beam);
  Modes result;
  if (points != nullptr) result.x = points->x();
  for (const Mode& mode : lowest(segments, std::max(count, 0))) {
    result.omega.push_back(mode.omega);
    result.axial.push_back(mode.segment->axial ? 1 : 0);
    if (points == nullptr) continue;
    result.shape.push_back(stored_shape(beam, *mode.segment, mode.offset, mode.shape, *points));
    if (!smooth) continue;
    std::vector<double> all(static_cast<std::size_t>(beam.columns()) * static_cast<std::size_t>(beam.block()), 0.0);
    for (std::size_t i = 0; i < mode.shape.size(); ++i)
      all[static_cast<std::size_t>(mode.segment->unknowns[i] + mode.offset * beam.block())] = mode.shape[i];
    if (mode.segment->axial) {  // excluded from the modes of bending
      result.slope.emplace_back(points->points().size(), 0.0);
      result.mass.push_back(1.0);
    } else {
      add_slopes(beam, *points, all, modal_mass(mode), result);
    }
  }
  if (smooth) add_ratios(beam, result);
  return result;
}

/// The result of `lowest` with all copies of the last frequency.
std::vector<Mode> lowest_with_copies(const std::vector<Segment>& segments, int count) {
  for (int larger_count = count + 1;; larger_count *= 2) {
    std::vector<Mode> modes = lowest(segments, larger_count);
    if (static_cast<int>(modes.size()) <= count) return modes;
    const double last = modes[static_cast<std::size_t>(count) - 1].omega * (1.0 + distinct);
    if (modes.back().omega <= last && static_cast<int>(modes.size()) == larger_count) continue;
    std::erase_if(modes, [&](const Mode& mode) { return mode.omega > last; });
    return modes;
  }
}

}  // namespace

Basis bending_basis(const beam::Beam& beam, int count) {
  const auto segments = transverse_segments(beam);
  std::vector<Mode> modes = lowest_with_copies(segments, count);
  orthonormalise(modes);
  Basis basis;
  for (const Mode& mode : modes) {
    basis.omega.push_back(mode.omega);
    auto& shape = basis.shape.emplace_back(static_cast<std::size_t>(beam.columns()) * beam.block(), 0.0);
    for (std::size_t i = 0; i < mode.shape.size(); ++i)
      shape[static_cast<std::size_t>(mode.segment->unknowns[i] + mode.offset * beam.block())] = mode.shape[i];
  }
  return basis;
}

Modes as_stored(const beam::Beam& beam, const Basis& basis, const beam::ShapePoints& points) {
  Modes modes;
  modes.omega = basis.omega;
  modes.axial.assign(basis.omega.size(), 0);
  modes.x = points.x();
  for (const auto& mode : basis.shape) {
    const auto value = [&](int unknown) { return mode[static_cast<std::size_t>(unknown)]; };
    modes.shape.push_back(points.curve<double>(beam.bridge(), false, value));
    scale_to_one(modes.shape.back(), 0.0);
    if (without_kinks(beam)) add_slopes(beam, points, mode, 1.0, modes);
  }
  return modes;
}

Modes natural_modes(const beam::Beam& beam, int count, bool shapes) {
  if (!shapes) return modes_of(beam, count, nullptr);
  return natural_modes(beam, count, beam::ShapePoints::at_nodes(beam.mesh()));
}

Modes natural_modes(const beam::Beam& beam, int count, const beam::ShapePoints& points) {
  return modes_of(beam, count, &points);
}

std::vector<double> distinct_frequencies(const beam::Beam& beam, std::size_t count) {
  using OfSegment = std::pair<double, std::size_t>;
  const std::vector<Segment> segments = transverse_segments(beam);
  std::vector<OfSegment> all, found;
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (const double omega : distinct_of(segments[i], count)) all.emplace_back(omega, i);
  std::sort(all.begin(), all.end());
  for (const OfSegment& candidate : all) {
    const auto is_copy = [&](const OfSegment& other) {
      const double limit = candidate.second == other.second ? distinct : distinct_spans;
      return candidate.first <= other.first * (1.0 + limit);
    };
    if (found.size() < count && std::none_of(found.begin(), found.end(), is_copy)) found.push_back(candidate);
  }
  std::vector<double> omegas;
  for (const OfSegment& candidate : found) omegas.push_back(candidate.first);
  return omegas;
}

std::pair<double, double> distinct_pair(const beam::Beam& beam) {
  const std::vector<double> found = distinct_frequencies(beam, 2);
  if (found.size() < 2) {
    throw InputError(
        "beam_damping_ratios: the mesh has " + std::string(found.empty() ? "no" : "only one") +
        " natural frequency of bending, and two distinct ones are needed; raise beam_elements_per_span, or "
        "give beam_rayleigh instead");
  }
  return {found[0], found[1]};
}

beam::Rayleigh rayleigh(double omega1, double omega2, double zeta1, double zeta2) {
  const auto [least, most] = std::minmax({zeta1 * omega1 / omega2, zeta1 * omega2 / omega1});
  if (zeta2 < least * (1.0 - ratio_tolerance) || zeta2 > most * (1.0 + ratio_tolerance))
    throw InputError(
        fmt::format("beam_damping_ratios = {:g},{:g}: Rayleigh damping that has these at {:.6g} and {:.6g} Hz has a "
                    "negative {}, which feeds energy into the beam; allowed beside {:g}: from {:.6g} to {:.6g}; "
                    "beam_damping_frequencies names other frequencies",
                    zeta1, zeta2, omega1 / (2.0 * std::numbers::pi), omega2 / (2.0 * std::numbers::pi),
                    (zeta2 < least) == (omega1 < omega2) ? "b" : "a", zeta1, least, most));
  zeta2 = std::clamp(zeta2, least, most);
  // Eq. 20 divided by omega2 - omega1, so that no terms cancel: equal ratios result in their exact limit.
  const double sum = omega1 + omega2, slope = omega1 * (zeta1 - zeta2) / (omega2 - omega1);
  return {std::max(2.0 * omega1 * omega2 / sum * (zeta1 + slope), 0.0), std::max(2.0 / sum * (zeta2 - slope), 0.0)};
}

}  // namespace traverse::modes
