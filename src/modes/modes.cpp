// Merges the modes of all segments in ascending order, scales and orthonormalises their shapes, and computes the terms
// of each mode that the beam's own damping does not contain. Given modes become vectors of the unknowns at their
// stations.
#include "modes/modes.hpp"

#include <cmath>
#include <numeric>
#include <tuple>

#include "eigen.hpp"
#include "segment.hpp"

namespace traverse::modes {
namespace {

constexpr double distinct = 1e-6;  // relative difference of two frequencies
// The tolerance between spans that are not coupled: frequencies are proportional to the inverse square of a span; two
// spans of one drawing may be built 20 mm longer and shorter (EN 13670, 10.4), which is this difference at 8 m.
constexpr double distinct_spans = 0.01;

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

/// A frequency of one segment, with the shapes of all its copies.
struct Distinct {
  double omega = 0.0;
  std::size_t segment = 0;
  std::vector<std::vector<double>> shapes;
};

/// The lowest distinct non-zero frequencies of one segment: `wanted`, or as many as it has.
std::vector<Distinct> distinct_of(const Segment& s, std::size_t index, std::size_t wanted) {
  for (int count = static_cast<int>(wanted + s.rigid.size());; count *= 2) {
    std::vector<Distinct> found;
    for (const Eigenpair& pair : lowest_modes(s, count)) {
      if (pair.omega <= 0.0) continue;
      if (found.empty() || pair.omega > found.back().omega * (1.0 + distinct)) found.push_back({pair.omega, index, {}});
      found.back().shapes.push_back(pair.shape);
    }
    if (found.size() >= wanted || count >= s.size()) return found;
  }
}

/// The lowest distinct frequencies of all segments.
std::vector<Distinct> distinct_of(const std::vector<Segment>& segments, std::size_t count) {
  std::vector<Distinct> all, found;
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (Distinct& one : distinct_of(segments[i], i, count)) all.push_back(std::move(one));
  std::stable_sort(all.begin(), all.end(), [](const Distinct& a, const Distinct& b) { return a.omega < b.omega; });
  for (Distinct& candidate : all) {
    const auto is_copy = [&](const Distinct& other) {
      const double limit = candidate.segment == other.segment ? distinct : distinct_spans;
      return candidate.omega <= other.omega * (1.0 + limit);
    };
    if (found.size() < count && std::none_of(found.begin(), found.end(), is_copy))
      found.push_back(std::move(candidate));
  }
  return found;
}

std::vector<double> product(const Band& A, const std::vector<double>& x) {
  std::vector<double> Ax(x.size(), 0.0);
  add_product(A, 1.0, x.data(), Ax.data());
  return Ax;
}

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

double form(const Band& A, const std::vector<double>& x) { return dot(x, product(A, x)); }

double modal_mass(const Mode& mode) { return form(mode.segment->M, mode.shape); }

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
  const std::vector<double> raw = points.curve<double>(beam.bridge(), beam::Along::deflection, value),
                            &shape = modes.shape.back();
  const std::size_t largest = static_cast<std::size_t>(std::max_element(shape.begin(), shape.end()) - shape.begin());
  const double scale = shape[largest] / raw[largest];
  modes.slope.push_back(points.slopes(beam.bridge(), value));
  for (double& slope : modes.slope.back()) slope *= scale;
  modes.mass.push_back(mass * scale * scale);
}

/// Adds damping ratios if C* = a M + b K*, for which the modes are not coupled.
void add_ratios(const beam::Beam& beam, Modes& modes) {
  const beam::Rayleigh ab = beam.rayleigh();
  const bool other_mass = beam.mass() != beam.beam_mass() && ab.a != 0.0;
  if (beam.dampers() != nullptr || (beam.springs() != nullptr && ab.b != 0.0) || other_mass) return;
  for (const double omega : modes.omega)
    modes.ratio.push_back(omega > 0.0 ? (ab.a + ab.b * omega * omega) / (2.0 * omega) : 0.0);
}

/// The damping ratios phi^T C* phi/(2 omega) of modes, divided into the beam's own and those by dampers.
void add_terms(const beam::Beam& beam, const std::vector<Segment>& segments, const std::vector<Mode>& found,
               Modes& modes) {
  modes.beam_ratio.assign(found.size(), 0.0);
  modes.damper_ratio.assign(found.size(), 0.0);
  for (const Segment& s : segments) {
    if (std::none_of(found.begin(), found.end(), [&](const Mode& mode) { return mode.segment == &s; })) continue;
    const Band all = part_of(beam.damping(), s), dampers = part_of(beam.dampers(), s);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].segment != &s || !(found[i].omega > 0.0)) continue;
      const double scale = 0.5 / (modal_mass(found[i]) * found[i].omega);
      modes.damper_ratio[i] = scale * form(dampers, found[i].shape);
      modes.beam_ratio[i] = scale * form(all, found[i].shape) - modes.damper_ratio[i];
    }
  }
}

Modes modes_of(const beam::Beam& beam, int count, const beam::ShapePoints* points) {
  const std::vector<Segment> segments = segments_of(beam, true);
  const bool smooth = points != nullptr && without_kinks(beam);
  Modes result;
  if (points != nullptr) result.x = points->x();
  const std::vector<Mode> found = lowest(segments, std::max(count, 0));
  if (points != nullptr && beam.damping() != nullptr) add_terms(beam, segments, found, result);
  for (const Mode& mode : found) {
    result.omega.push_back(mode.omega);
    result.motion.push_back(mode.segment->motion);
    if (points == nullptr) continue;
    result.shape.push_back(stored_shape(beam, *mode.segment, mode.offset, mode.shape, *points));
    if (!smooth) continue;
    std::vector<double> all(static_cast<std::size_t>(beam.columns()) * static_cast<std::size_t>(beam.block()), 0.0);
    for (std::size_t i = 0; i < mode.shape.size(); ++i)
      all[static_cast<std::size_t>(mode.segment->unknowns[i] + mode.offset * beam.block())] = mode.shape[i];
    if (mode.segment->order() == 2.0) {  // excluded from the modes of bending
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
  const std::vector<Segment> segments = segments_of(beam, false);
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
  modes.motion.assign(basis.omega.size(), Motion::bending);
  modes.x = points.x();
  for (const auto& mode : basis.shape) {
    const auto value = [&](int unknown) { return mode[static_cast<std::size_t>(unknown)]; };
    modes.shape.push_back(points.curve<double>(beam.bridge(), beam::Along::deflection, value));
    scale_to_one(modes.shape.back(), 0.0);
    const bool twists =
        beam.model().torsion && std::ranges::all_of(modes.shape.back(), [](double y) { return y == 0.0; });
    if (twists) {  // alone: excluded from the modes of bending
      modes.motion[modes.shape.size() - 1] = Motion::twist;
      modes.shape.back() = points.curve<double>(beam.bridge(), beam::Along::twist, value);
      scale_to_one(modes.shape.back(), 0.0);
    }
    if (!without_kinks(beam)) continue;
    if (twists) {
      modes.slope.emplace_back(points.points().size(), 0.0);
      modes.mass.push_back(1.0);
    } else {
      add_slopes(beam, points, mode, 1.0, modes);
    }
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
  std::vector<double> omegas;
  for (const Distinct& one : distinct_of(bending_segments(beam), count)) omegas.push_back(one.omega);
  return omegas;
}

std::vector<BendingMode> distinct_modes(const beam::Beam& beam, std::size_t count, Mat own_mass) {
  const std::vector<Segment> segments = bending_segments(beam);
  std::vector<BendingMode> modes;
  for (const Distinct& one : distinct_of(segments, count)) {
    const Segment& s = segments[one.segment];
    const Band springs = part_of(beam.springs(), s), dampers = part_of(beam.dampers(), s),
               own = own_mass == nullptr ? s.M : part_of(own_mass, s);
    BendingMode& mode = modes.emplace_back(BendingMode{one.omega});
    for (const std::vector<double>& shape : one.shapes) {
      const double mass = form(s.M, shape), share = 1.0 / (mass * static_cast<double>(one.shapes.size()));
      mode.springs += share * form(springs, shape);
      mode.dampers += share * form(dampers, shape);
      if (own_mass != nullptr) mode.other_mass += share * (mass - form(own, shape));
    }
  }
  return modes;
}

Basis given_basis(const beam::Beam& beam, int count) {
  const beam::GivenModes& given = *beam.model().given;
  const std::size_t modes = std::min(given.omega.size(), static_cast<std::size_t>(count));
  Basis basis;
  basis.omega.assign(given.omega.begin(), given.omega.begin() + static_cast<std::ptrdiff_t>(modes));
  for (std::size_t i = 0; i < modes; ++i) {
    auto& shape = basis.shape.emplace_back(static_cast<std::size_t>(beam.columns()) * beam.block(), 0.0);
    for (int node = 0; node < beam.mesh().nodes(); ++node) {
      shape[static_cast<std::size_t>(beam.bridge().unknown(node, 1))] = given.shape[i][static_cast<std::size_t>(node)];
      shape[static_cast<std::size_t>(beam.bridge().unknown(node, 2))] = given.slope[i][static_cast<std::size_t>(node)];
    }
  }
  return basis;
}

}  // namespace traverse::modes
