// The shares of the ends at jumps in height of the surface in a static equilibrium (train::WheelContact). The forces
// jump where two ends are level, so that Newton's method would alternate between both sides of the jump. Each
// equilibrium is computed with held shares; if the heights of the ends contradict them, new shares follow by regula
// falsi.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "train/fleet.hpp"

namespace traverse::coupling {

class EdgeShares {
 public:
  explicit EdgeShares(train::Fleet& fleet) : fleet_(fleet) {}
  ~EdgeShares() {
    for (const Edge& edge : edges_) edge.contact->share_held = false;
  }
  EdgeShares(const EdgeShares&) = delete;
  EdgeShares& operator=(const EdgeShares&) = delete;

  /// Holds the shares that the fleet has at the evaluated state.
  void hold() {
    for (train::WheelContact& c : fleet_.wheels) {
      if (!c.at_height_jump || c.candidates == 0) continue;
      c.share_held = true;
      edges_.push_back({&c});
    }
  }
  bool any() const { return !edges_.empty(); }
  /// Whether the equilibrium agrees with the held shares; otherwise other shares are held.
  bool settle() {
    bool settled = true;
    for (Edge& edge : edges_) settled = settle(edge) && settled;
    return settled;
  }

 private:
  /// A jump whose right end has been higher with the share `low` of the left end, and lower with the share `high`.
  struct Edge {
    train::WheelContact* contact = nullptr;
    double low = 0.0, high = 1.0;
    double above = std::numeric_limits<double>::quiet_NaN(), below = above;  // m
    int side = 0;                                                            // of the last equilibrium
  };

  static bool settle(Edge& edge) {
    double& share = edge.contact->share;
    const double height = edge.contact->jump;
    if (std::abs(height) <= 0.1 * train::level || (height > 0.0 ? share == 1.0 : share == 0.0)) return true;
    const int side = height > 0.0 ? 1 : -1;
    (side > 0 ? edge.low : edge.high) = share;
    (side > 0 ? edge.above : edge.below) = height;
    // Where one end of the interval remains, the height there is halved: the Illinois method.
    if (side == edge.side) (side > 0 ? edge.below : edge.above) *= 0.5;
    edge.side = side;
    const double other = side > 0 ? edge.below : edge.above;
    if (std::isnan(other))
      share = side > 0 ? 1.0 : 0.0;
    else
      share = edge.low + (edge.high - edge.low) * edge.above / (edge.above - edge.below);
    return false;
  }

  train::Fleet& fleet_;
  std::vector<Edge> edges_;
};

}  // namespace traverse::coupling
