// Nodes and elements along x. Isolated spans have two nodes at each inner span end.
#pragma once

#include <vector>

#include "traverse/beam/model.hpp"

namespace traverse::beam {

struct Element {
  int left = 0;  // its left node; the right one is left + 1
  int span = 0;
  double x = 0.0;       // of the left node, m
  double length = 0.0;  // m
};

/// A station inside an element.
struct Station {
  int element = 0;
  double xi = 0.0;  // 0..1
};

class Mesh {
 public:
  explicit Mesh(const BeamModel& model);

  int nodes() const { return static_cast<int>(x_.size()); }
  int elements() const { return static_cast<int>(elements_.size()); }
  double x(int node) const { return x_[node]; }
  const Element& element(int e) const { return elements_[e]; }
  double length() const { return x_.back(); }
  int spans() const { return static_cast<int>(span_ends_.size()) - 1; }
  /// Span ends x_0 = 0, ..., x_spans = length.
  const std::vector<double>& span_ends() const { return span_ends_; }
  /// Nodes at span end i: {left span's, right span's}; equal on a continuous beam and at the outer ends.
  std::pair<int, int> nodes_at(int span_end) const;

  /// The element that holds x (clamped into [0, length]); at a node shared by two elements the right one,
  /// except at the end of the beam. `from_left`: the left one. Costs O(log spans).
  Station locate(double x, bool from_left = false) const;

 private:
  std::vector<double> x_;
  std::vector<Element> elements_;
  std::vector<double> span_ends_;
  std::vector<int> first_element_;  // of each span, and one past the last
  bool isolated_ = false;
};

}  // namespace traverse::beam
