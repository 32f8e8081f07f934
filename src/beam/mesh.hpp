// Nodes and elements along x. Where two spans are separate there is a node for each of them.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"

namespace traverse::beam {

struct Element {
  int left = 0;  // its left node; the right one is left + 1
  int span = 0;
  double x = 0.0;       // of the left node, m
  double length = 0.0;  // m
  double EI = 0.0;      // in its middle, N m2
  double shear = 0.0;   // 12 EI/(GA length^2) there; 0: it does not shear
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
  double start() const { return x_.front(); }
  double end() const { return x_.back(); }
  int spans() const { return static_cast<int>(span_ends_.size()) - 1; }
  /// Span ends x_0, ..., x_spans.
  const std::vector<double>& span_ends() const { return span_ends_; }
  /// Nodes at span end i: {left span's, right span's}; equal but where two spans are separate.
  std::pair<int, int> nodes_at(int span_end) const { return nodes_at_[span_end]; }
  /// Whether the slope may jump at a node: it has a rotation for either side.
  bool hinged(int node) const { return joints_[node] == Joint::hinge || joints_[node] == Joint::cracked; }
  /// Whether the displacement along x may jump: it has one for either side.
  bool parted(int node) const { return joints_[node] == Joint::expansion; }

  /// The element that holds x (clamped into [start, end]); at a node shared by two elements the right one,
  /// except at the end of the beam. `from_left`: the left one. Costs O(log spans).
  Station locate(double x, bool from_left = false) const;

  /// Stations where the beam's slope or deflection may jump: its ends, separate joints, hinges; ascending.
  const std::vector<double>& kinks() const { return kinks_; }
  /// Those where the surface may be higher on one side than on the other, as nothing rigid holds both at one height.
  const std::vector<double>& steps() const { return steps_; }
  /// Whether the rigid surface goes on before its start and behind its end.
  bool ground_before() const { return ground_[0]; }
  bool ground_behind() const { return ground_[1]; }
  /// The kinks on either side of an element: the reach of the smooth surface that it belongs to.
  std::pair<double, double> smooth_reach(int element) const;

 private:
  std::array<bool, 2> ground_;
  std::vector<double> x_;
  std::vector<Joint> joints_;  // at each node
  std::vector<Element> elements_;
  std::vector<double> span_ends_, kinks_, steps_;
  std::vector<std::pair<int, int>> nodes_at_;
  std::vector<double> piece_ends_;  // left end of each run of equal elements, and the beam's end
  std::vector<int> first_element_;  // of each of them, and one past the last
};

}  // namespace traverse::beam
