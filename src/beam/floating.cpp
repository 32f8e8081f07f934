// Which parts of a beam nothing holds: by counting, not by the rank of a matrix, so that the answer does not depend
// on rounding.
#include <algorithm>
#include <cstdio>
#include <string>

#include "traverse/beam/model.hpp"

namespace traverse::beam {
namespace {

/// A run of spans that is one body: [first, last], from x = left to x = right.
struct Part {
  int first = 0, last = 0;
  double left = 0.0, right = 0.0;
  bool at_end = false;  // its right end is the beam's
};

std::vector<Part> parts_of(const BeamModel& model) {
  const int spans = static_cast<int>(model.spans.size());
  if (!model.isolated) return {{0, spans - 1, 0.0, model.length(), true}};
  std::vector<Part> parts;
  double x = 0.0;
  for (int span = 0; span < spans; ++span) {
    parts.push_back({span, span, x, x + model.spans[span], span + 1 == spans});
    x += model.spans[span];
  }
  return parts;
}

/// Stations of the springs among `points`, sorted.
std::vector<double> springs(const std::vector<PointFoundation>& points) {
  std::vector<double> stations;
  for (const PointFoundation& p : points) {
    if (p.k > 0.0) stations.push_back(p.x);
  }
  std::sort(stations.begin(), stations.end());
  return stations;
}

/// Those of the part: a station on an inner span end of isolated spans belongs to the right one.
std::vector<double> within(const std::vector<double>& stations, const Part& part) {
  const auto first = std::lower_bound(stations.begin(), stations.end(), part.left);
  const auto last = part.at_end ? stations.end() : std::lower_bound(first, stations.end(), part.right);
  return {first, last};
}

/// Whether the bed has stiffness somewhere between the ends of the part.
bool bed_in(const std::optional<Bed>& bed, const Part& part) {
  if (!bed) return false;
  const Distribution& k = bed->k;
  auto ends = k.breaks(part.left, part.right);
  ends.push_back(part.right);
  double left = part.left;
  for (double right : ends) {  // linear in between
    if (k.at(left, right) > 0.0 || k.at(right, left) > 0.0) return true;
    left = right;
  }
  return false;
}

bool supported_axially(const BeamModel& model, const std::vector<double>& longitudinal, const Part& part) {
  bool held = !within(longitudinal, part).empty() || bed_in(model.foundation.longitudinal_bed, part);
  for (int end = part.first; end <= part.last + 1; ++end) held = held || fixes_axial(model.supports[end]);
  return held;
}

/// Vertical and rotation of one part, from what holds it.
RigidMotion motion_of(const BeamModel& model, const Part& part, std::vector<double> vertical, bool rotation_held) {
  double x = part.left;
  for (int end = part.first; end <= part.last + 1; ++end) {
    if (fixes_vertical(model.supports[end])) vertical.push_back(x);
    rotation_held = rotation_held || fixes_rotation(model.supports[end]);
    if (end <= part.last) x += model.spans[end];
  }
  const bool bed = bed_in(model.foundation.vertical_bed, part);
  const auto [low, high] = std::minmax_element(vertical.begin(), vertical.end());
  RigidMotion motion{part.first, part.last};
  motion.vertical = vertical.empty() && !bed;
  motion.rotation = !rotation_held && !bed && (vertical.empty() || *low == *high);
  motion.pivot = vertical.empty() ? 0.5 * (part.left + part.right) : *low;
  return motion;
}

}  // namespace

std::vector<char> axial_bearings(const BeamModel& model) {
  std::vector<char> needed(model.spans.size(), 0);
  if (!model.axial || !model.isolated) return needed;
  const auto longitudinal = springs(model.foundation.longitudinal);
  for (const Part& part : parts_of(model)) needed[part.first] = !supported_axially(model, longitudinal, part);
  return needed;
}

std::vector<RigidMotion> rigid_motions(const BeamModel& model) {
  const auto vertical = springs(model.foundation.vertical);
  const auto longitudinal = springs(model.foundation.longitudinal);
  const auto rotational = springs(model.foundation.rotational);
  std::vector<RigidMotion> motions;
  for (const Part& part : parts_of(model)) {
    motions.push_back(motion_of(model, part, within(vertical, part), !within(rotational, part).empty()));
    motions.back().axial = model.axial && !model.isolated && !supported_axially(model, longitudinal, part);
  }
  return motions;
}

std::string floating_motion(const BeamModel& model) {
  for (const RigidMotion& m : rigid_motions(model)) {
    const std::string part = model.isolated ? "span " + std::to_string(m.first_span + 1) : "the beam";
    if (m.vertical && m.rotation) return part + " can move vertically and rotate";
    if (m.vertical) return part + " can move vertically";
    if (m.rotation) {
      char text[64];
      std::snprintf(text, sizeof text, " can rotate about x = %.6g m", m.pivot);
      return part + text;
    }
    if (m.axial) return part + " can move along x";
  }
  return {};
}

}  // namespace traverse::beam
