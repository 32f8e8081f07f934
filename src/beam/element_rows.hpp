// K and M of a beam with two unknowns a node (v, theta), element by element and many elements at a time: the products
// that a time step needs, on a few nodes in the cache. Where elements repeat along the beam their numbers are kept
// once.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"

namespace traverse::beam {

/// Deflections and rotations of consecutive nodes, each of its own array.
struct NodalPair {
  double* v = nullptr;
  double* theta = nullptr;
};

class ElementRows {
 public:
  /// Most nodes of one call.
  static constexpr int tile = 128;

  /// Whether a beam is of this kind: v and theta its only unknowns, damping by Rayleigh's a and b alone.
  static bool fit(const Beam& beam);
  explicit ElementRows(const Beam& beam);

  /// r = K x + M y (null: without M) for this rank's nodes [first, past), at most `tile`. x and y begin at node first -
  /// 1 and end at node past; what they hold beyond the beam has no effect but has to be finite. `r` begins at node
  /// first.
  void multiply(int first, int past, NodalPair x, NodalPair y, NodalPair r) const;

 private:
  struct Coefficients;
  void append(const Coefficients& c);
  template <bool with_mass>
  void products(int first, int past, NodalPair x, NodalPair y, NodalPair r) const;

  // Of an element from (v1, theta1) to (v2, theta2) the entries of K in terms of rise and turn (internal_forces.hpp)
  // and the upper triangle of M, row by row; element j leads from local node j - 1 to j.
  static constexpr int stiffnesses = 5, masses = 10;
  std::array<std::vector<double>, stiffnesses> K_;
  std::array<std::vector<double>, masses> M_;
  int nodes_;                           // of this rank
  bool begins_ = false, ends_ = false;  // no element before the first node, behind the last
  int period_ = 1;                      // element j is that at j % period
};

}  // namespace traverse::beam
