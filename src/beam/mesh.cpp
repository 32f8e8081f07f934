// Creates nodes and elements from the pieces of the spans, records kinks and jumps in height of the running surface,
// and finds the element at a station by bisection over the pieces. Finds the two supports next to a station, and the
// shares of a straight line through them.
#include "beam/mesh.hpp"

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"

namespace traverse::beam {
namespace {

/// The element of length h whose left node is at x.
Element element_of(const BeamModel& model, int left, int span, double x, double h) {
  const double middle = x + 0.5 * h, EI = model.EI.at(middle, x);
  return {left, span, x, h, EI, model.GA ? 12.0 * EI / (model.GA->at(middle, x) * h * h) : 0.0};
}

/// Whether the beam's first (or last) end remains at the height of the ground beside it.
bool level_with_ground(const BeamModel& model, bool last) {
  if (model.given) {
    const auto is_zero_at_end = [last](const std::vector<double>& shape) {
      return (last ? shape.back() : shape.front()) == 0.0;
    };
    return std::all_of(model.given->shape.begin(), model.given->shape.end(), is_zero_at_end);
  }
  const auto& settlements = model.settlement;
  const double settlement = settlements.empty() ? 0.0 : last ? settlements.back() : settlements.front();
  return fixes_vertical(last ? model.supports.back() : model.supports.front()) && settlement == 0.0;
}

constexpr double same_place = 1e-9;  // relative to the length of the bridge

}  // namespace

Mesh::Mesh(const BeamModel& model) : ground_(model.ground) {
  const std::vector<Piece> pieces = pieces_of(model);
  kinks_.push_back(model.start);
  if (ground_[0] && !level_with_ground(model, false)) steps_.push_back(model.start);
  span_ends_.push_back(model.start);
  nodes_at_.emplace_back(0, 0);
  x_.push_back(model.start);
  for (const Piece& piece : pieces) {
    const double length = piece.right - piece.left;
    piece_ends_.push_back(piece.left);
    first_element_.push_back(elements());
    for (int i = 0; i < piece.elements; ++i) {
      const double h = length / piece.elements;
      elements_.push_back(element_of(model, nodes() - 1, piece.span, x_.back(), h));
      ++count_;
      x_.push_back(i + 1 < piece.elements ? piece.left + length * (i + 1) / piece.elements : piece.right);
    }
    joints_.resize(x_.size(), Joint::continuous);
    const int left = nodes() - 1;
    joints_.back() = piece.next;
    if (piece.next != Joint::continuous && piece.next != Joint::expansion) kinks_.push_back(piece.right);
    if (piece.next == Joint::separate && &piece != &pieces.back()) {
      x_.push_back(piece.right);
      if (!fixes_vertical(model.supports[static_cast<std::size_t>(piece.span) + 1])) steps_.push_back(piece.right);
    }
    joints_.resize(x_.size(), Joint::continuous);
    if (!piece.ends_span) continue;
    span_ends_.push_back(piece.right);
    nodes_at_.emplace_back(left, nodes() - 1);
  }
  if (ground_[1] && !level_with_ground(model, true)) steps_.push_back(x_.back());
  piece_ends_.push_back(x_.back());
  first_element_.push_back(elements());
  if (!model.torsion) return;
  const std::vector<Element> of_one_track = elements_;
  for (std::size_t track = 1; track < model.torsion->tracks.size(); ++track)
    elements_.insert(elements_.end(), of_one_track.begin(), of_one_track.end());
}

Station Mesh::locate(double x, bool from_left) const {
  x = std::clamp(x, start(), end());
  const auto after = std::upper_bound(piece_ends_.begin(), piece_ends_.end(), x);
  const auto piece = std::min<std::size_t>(after - piece_ends_.begin() - 1, piece_ends_.size() - 2);
  const int first = first_element_[piece], last = first_element_[piece + 1] - 1;
  const double h = elements_[first].length;
  int e = std::clamp(first + base::whole((x - piece_ends_[piece]) / h, last - first + 1), first, last);
  // The division may have rounded across a node.
  if (e < last && x >= elements_[e + 1].x) ++e;
  if (e > first && x < elements_[e].x) --e;
  if (from_left && e > 0 && x <= elements_[e].x) {
    --e;
    return {e, 1.0};
  }
  if (x == end()) return {e, 1.0};  // independent of the rounding of the last element's length
  return {e, std::clamp((x - elements_[e].x) / elements_[e].length, 0.0, 1.0)};
}

std::pair<double, double> Mesh::smooth_reach(int element) const {
  const double middle = elements_[element].x + 0.5 * elements_[element].length;
  const auto after = std::upper_bound(kinks_.begin(), kinks_.end(), middle);
  return {*std::prev(after), *after};
}

SupportLines::SupportLines(const BeamModel& model) {
  const double tolerance = same_place * model.length();
  std::vector<double> springs;
  for (const PointFoundation& point : model.foundation.vertical) springs.push_back(point.x);
  std::ranges::sort(springs);
  double x = model.start;
  for (std::size_t end = 0; end < model.supports.size(); ++end) {
    const auto spring = std::ranges::lower_bound(springs, x - tolerance);
    const bool has_spring = spring != springs.end() && *spring <= x + tolerance;
    if (fixes_vertical(model.supports[end]) || has_spring) bearings_.push_back({x, end});
    if (end < model.spans.size()) x += model.spans[end];
  }
  if (bearings_.empty()) return;
  level_before_ = fixes_rotation(model.supports[bearings_.front().end]);
  level_behind_ = fixes_rotation(model.supports[bearings_.back().end]);
}

SupportLine SupportLines::at(double x) const {
  if (bearings_.empty()) return {};
  const auto level = [](const Bearing& b) { return SupportLine{{b.end, b.end}, {1.0, 0.0}}; };
  if (bearings_.size() == 1 || (level_before_ && x < bearings_.front().x)) return level(bearings_.front());
  if (level_behind_ && x > bearings_.back().x) return level(bearings_.back());
  const auto after = std::ranges::upper_bound(bearings_, x, {}, &Bearing::x);
  const auto right = std::clamp(after, bearings_.begin() + 1, bearings_.end() - 1), left = right - 1;
  const double part = (x - left->x) / (right->x - left->x);
  return {{left->end, right->end}, {1.0 - part, part}};
}

}  // namespace traverse::beam
