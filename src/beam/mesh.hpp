// Nodes and elements along x. Two separate spans have one node each at their common station. Also the line through the
// supports of a bridge: straight between neighbouring supports, which may have settled or move. Deflections are judged
// relative to it, because a motion of the supports that bends no span deflects none.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "traverse/beam/model.hpp"

namespace traverse::beam {

struct Element {
  int left = 0;  // left node; the right one is left + 1
  int span = 0;
  double x = 0.0;       // station of the left node, m
  double length = 0.0;  // m
  double EI = 0.0;      // at its middle, N m2
  double shear = 0.0;   // 12 EI/(GA length^2) at its middle; 0: no shear deformation
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
  int elements() const { return count_; }
  double x(int node) const { return x_[node]; }
  /// Element e of the beam. For what stands on one of several tracks, the elements are numbered track by track: numbers
  /// from elements() on are the same elements for the second track, and so on.
  const Element& element(int e) const { return elements_[e]; }
  /// The station for what stands on this track, counted from 0.
  Station on_track(Station s, int track) const { return {s.element + track * count_, s.xi}; }
  double start() const { return x_.front(); }
  double end() const { return x_.back(); }
  int spans() const { return static_cast<int>(span_ends_.size()) - 1; }
  /// Span ends x_0, ..., x_spans.
  const std::vector<double>& span_ends() const { return span_ends_; }
  /// Nodes at span end i: {left span's, right span's}; they differ only between separate spans.
  std::pair<int, int> nodes_at(int span_end) const { return nodes_at_[span_end]; }
  /// Whether the slope may jump at a node, which then has two rotations.
  bool hinged(int node) const { return joints_[node] == Joint::hinge || joints_[node] == Joint::cracked; }
  /// Whether the displacement along x may jump at a node, which then has two.
  bool has_expansion_device(int node) const { return joints_[node] == Joint::expansion; }

  /// The element that contains x (limited to [start, end]). At a node shared by two elements it is the right one,
  /// except at the end of the beam, or the left one with `from_left`. Costs O(log spans).
  Station locate(double x, bool from_left = false) const;

  /// Stations at which the beam's slope or deflection may jump: its ends, separate joints, hinges; ascending.
  const std::vector<double>& kinks() const { return kinks_; }
  /// Kinks at which the surface may have a jump in height, because no rigid support holds both sides at one height.
  const std::vector<double>& steps() const { return steps_; }
  /// Whether the rigid surface continues before the beam's start and behind its end.
  bool ground_before() const { return ground_[0]; }
  bool ground_behind() const { return ground_[1]; }
  /// The kinks on either side of an element, between which the running surface is smooth.
  std::pair<double, double> smooth_reach(int element) const;

 private:
  std::array<bool, 2> ground_;
  std::vector<double> x_;
  std::vector<Joint> joints_;  // at each node
  int count_ = 0;
  std::vector<Element> elements_;  // repeated for each track
  std::vector<double> span_ends_, kinks_, steps_;
  std::vector<std::pair<int, int>> nodes_at_;
  std::vector<double> piece_ends_;  // left end of each range of equal elements, and the beam's end
  std::vector<int> first_element_;  // first element of each range; the last entry is the number of elements
};

/// The height of the line at a station as a linear combination of the displacements of two span ends.
struct SupportLine {
  std::array<std::size_t, 2> end{};  // span ends
  std::array<double, 2> share{};     // both 0 if nothing supports the bridge vertically

  /// The height, m. displacements: upward displacement of the ground at each span end, m; empty: none.
  double height(std::span<const double> displacements) const {
    return displacements.empty() ? 0.0 : share[0] * displacements[end[0]] + share[1] * displacements[end[1]];
  }
};

/// The lines between neighbouring supports of a bridge. The supports are those that hold the deflection, and the
/// vertical springs at span ends. Beyond the outermost supports the line goes on as a rigid overhang does: straight on,
/// but level behind a support that holds the rotation and beside a single support.
class SupportLines {
 public:
  explicit SupportLines(const BeamModel& model);
  /// The line at a station x, m.
  SupportLine at(double x) const;

 private:
  struct Bearing {
    double x = 0.0;
    std::size_t end = 0;  // span end
  };
  std::vector<Bearing> bearings_;  // ascending
  bool level_before_ = false, level_behind_ = false;
};

}  // namespace traverse::beam
