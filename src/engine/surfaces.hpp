// The tables of surface_table.hpp for all wheels of a fleet.
#pragma once

#include <deque>
#include <vector>

#include "engine/surface_table.hpp"
#include "train/fleet.hpp"

namespace traverse::engine {

/// The patches where a wheel is placed now, as the fleet has found them.
PatchesThere patches_of(const train::WheelContact& c);
/// Puts a wheel there as Fleet::place_wheels does, but for the elements' numbers among those under all wheels.
void put_patches(const PatchesThere& there, train::WheelContact& c);

class Surfaces {
 public:
  /// Of wheels that never leave the surface and have one point of contact each.
  explicit Surfaces(const train::Fleet& fleet);

  /// One a radius.
  const std::vector<SurfaceTable>& tables() const { return tables_; }
  /// Which of them is that of wheels with such a radius, m.
  std::size_t number(double radius) const;

 private:
  void add(train::Fleet fleet, std::size_t entry);

  std::vector<double> radii_;
  std::deque<std::vector<PatchesThere>> there_;
  std::vector<SurfaceTable> tables_;
};

}  // namespace traverse::engine
