#include "traverse/beam/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::beam {

Mesh::Mesh(const BeamModel& model) : isolated_(model.isolated) {
  span_ends_.push_back(0.0);
  for (double span : model.spans) span_ends_.push_back(span_ends_.back() + span);
  for (int span = 0; span < spans(); ++span) {
    const double start = span_ends_[span], length = model.spans[span];
    const int n = model.elements[span];
    first_element_.push_back(elements());
    if (span == 0 || isolated_) x_.push_back(start);
    for (int i = 0; i < n; ++i) {
      elements_.push_back({nodes() - 1, span, x_.back(), length / n});
      x_.push_back(i + 1 < n ? start + length * (i + 1) / n : span_ends_[span + 1]);
    }
  }
  first_element_.push_back(elements());
}

std::pair<int, int> Mesh::nodes_at(int span_end) const {
  if (span_end == 0) return {0, 0};
  const int left = elements_[first_element_[span_end] - 1].left + 1;
  return {left, isolated_ && span_end < spans() ? left + 1 : left};
}

Station Mesh::locate(double x, bool from_left) const {
  x = std::clamp(x, 0.0, length());
  const auto end = std::upper_bound(span_ends_.begin(), span_ends_.end(), x);
  const int span = std::min(static_cast<int>(end - span_ends_.begin()) - 1, spans() - 1);
  const int first = first_element_[span], last = first_element_[span + 1] - 1;
  const double h = elements_[first].length;
  int e = std::clamp(first + static_cast<int>((x - span_ends_[span]) / h), first, last);
  // The division may have rounded across a node.
  if (e < last && x >= elements_[e + 1].x) ++e;
  if (e > first && x < elements_[e].x) --e;
  if (from_left && e > 0 && x <= elements_[e].x) {
    --e;
    return {e, 1.0};
  }
  if (x == length()) return {e, 1.0};  // whatever the rounding of the last element's length
  return {e, std::clamp((x - elements_[e].x) / elements_[e].length, 0.0, 1.0)};
}

}  // namespace traverse::beam
