// The tables of train_task.hpp for all wheels of a fleet.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "engine/train_task.hpp"
#include "train/fleet.hpp"

namespace traverse::engine {

/// The patches of a wheel that the fleet has determined.
WheelPatches patches_of(const train::WheelContact& c);
/// Sets a wheel's patches as Fleet::place_wheels does, without the elements' indices among all elements under wheels.
void copy_patches(const WheelPatches& patches, train::WheelContact& c);

class Surfaces {
 public:
  /// The tables of wheels that never leave the surface and have one contact point each.
  explicit Surfaces(const train::Fleet& fleet);

  /// One table for each radius on each track.
  const std::vector<SurfaceTable>& tables() const { return tables_; }
  /// The index of the table for a radius, m, on a track.
  std::size_t number(double radius, int track) const;

 private:
  void add(train::Fleet fleet, std::size_t entry);

  std::vector<std::pair<double, int>> wheels_;  // radius and track
  std::deque<std::vector<WheelPatches>> patches_;
  std::vector<SurfaceTable> tables_;
};

}  // namespace traverse::engine
