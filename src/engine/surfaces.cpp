// Tables of the patches under wheels, and conversion of patches from and to the fleet.
#include "engine/surfaces.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace traverse::engine {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

WheelPatches patches_of(const train::WheelContact& c) {
  WheelPatches patches;
  patches.candidates = c.candidates;
  if (c.candidates == 0) patches.patch[0] = {-1, 0.0, 1.0, 0.0, 0.0, -infinite, infinite};
  for (int k = 0; k < c.candidates; ++k) {
    const train::Patch& p = c.patches[static_cast<std::size_t>(k)];
    patches.patch[k] = p.element < 0
                           ? WheelPatches::Patch{-1, 0.0, 1.0, 0.0, 0.0, p.low, p.high}
                           : WheelPatches::Patch{p.element, p.x, p.length, p.shear, p.compliance, p.low, p.high};
  }
  return patches;
}

void copy_patches(const WheelPatches& patches, train::WheelContact& c) {
  c.candidates = patches.candidates;
  for (std::size_t k = 0; k < c.patches.size(); ++k) {
    const WheelPatches::Patch& from = patches.patch[k];
    train::Patch& p = c.patches[k];
    p.element = from.element;
    p.x = from.x;
    p.length = from.length;
    p.shear = from.shear;
    p.compliance = from.flexibility;
    p.low = from.low;
    p.high = from.high;
    p.start = c.touch.station;
    c.slots[k] = from.element < 0 ? -1 : 0;
  }
}

Surfaces::Surfaces(const train::Fleet& fleet) {
  for (std::size_t i = 0; i < fleet.wheels.size(); ++i) {
    const std::pair wheel(fleet.wheel(fleet.wheels[i]).radius, fleet.wheels[i].track);
    if (std::find(wheels_.begin(), wheels_.end(), wheel) != wheels_.end()) continue;
    wheels_.push_back(wheel);
    add(fleet, i);
    tables_.push_back({static_cast<int>(patches_.back().size()), patches_.back().data()});
  }
}

std::size_t Surfaces::number(double radius, int track) const {
  return static_cast<std::size_t>(std::find(wheels_.begin(), wheels_.end(), std::pair(radius, track)) -
                                  wheels_.begin());
}

// Determines the patches as a fleet with this wheel only does, from border to border.
void Surfaces::add(train::Fleet fleet, std::size_t entry) {
  constexpr double above = 10.0;  // m
  fleet.wheels = {fleet.wheels[entry]};
  train::WheelContact& c = fleet.wheels.front();
  c.further = 0;
  std::vector<double> borders = fleet.borders_of_patches(c);
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  fleet.vehicles[static_cast<std::size_t>(c.vehicle)].state.q[3 * static_cast<Eigen::Index>(c.body) + 1] = above;
  std::vector<WheelPatches>& all = patches_.emplace_back();
  for (std::size_t i = 0; i <= borders.size(); ++i) {
    const double from = i == 0 ? -infinite : borders[i - 1], to = i == borders.size() ? infinite : borders[i];
    fleet.x(c) = borders.empty() ? 0.0 : i == 0 ? to - 1.0 : i == borders.size() ? from + 1.0 : 0.5 * (from + to);
    fleet.place_wheels();
    WheelPatches patches = patches_of(c);
    patches.from = from;
    patches.to = to;
    all.push_back(patches);
  }
}

}  // namespace traverse::engine
