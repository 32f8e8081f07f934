// Tables of the patches under wheels, and their way from and to the fleet.
#include "engine/surfaces.hpp"

#include <algorithm>
#include <limits>

namespace traverse::engine {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

PatchesThere patches_of(const train::WheelContact& c) {
  PatchesThere there;
  there.candidates = c.candidates;
  if (c.candidates == 0) there.patch[0] = {-1, 0.0, 1.0, 0.0, 0.0, -infinite, infinite};
  for (int k = 0; k < c.candidates; ++k) {
    const train::Patch& p = c.patches[static_cast<std::size_t>(k)];
    there.patch[k] = p.element < 0
                         ? PatchesThere::Patch{-1, 0.0, 1.0, 0.0, 0.0, p.low, p.high}
                         : PatchesThere::Patch{p.element, p.x, p.length, p.shear, p.compliance, p.low, p.high};
  }
  return there;
}

void put_patches(const PatchesThere& there, train::WheelContact& c) {
  c.candidates = there.candidates;
  for (std::size_t k = 0; k < c.patches.size(); ++k) {
    const PatchesThere::Patch& from = there.patch[k];
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
    const double radius = fleet.wheel(fleet.wheels[i]).radius;
    if (std::find(radii_.begin(), radii_.end(), radius) != radii_.end()) continue;
    radii_.push_back(radius);
    add(fleet, i);
    tables_.push_back({static_cast<int>(there_.back().size()), there_.back().data()});
  }
}

std::size_t Surfaces::number(double radius) const {
  return static_cast<std::size_t>(std::find(radii_.begin(), radii_.end(), radius) - radii_.begin());
}

// As a fleet of this wheel alone finds its patches, from border to border.
void Surfaces::add(train::Fleet fleet, std::size_t entry) {
  constexpr double above = 10.0;  // m
  fleet.wheels = {fleet.wheels[entry]};
  train::WheelContact& c = fleet.wheels.front();
  c.further = 0;
  std::vector<double> borders = fleet.borders_of_patches(c);
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  fleet.vehicles[static_cast<std::size_t>(c.vehicle)].state.q[3 * static_cast<Eigen::Index>(c.body) + 1] = above;
  std::vector<PatchesThere>& all = there_.emplace_back();
  for (std::size_t i = 0; i <= borders.size(); ++i) {
    const double from = i == 0 ? -infinite : borders[i - 1], to = i == borders.size() ? infinite : borders[i];
    fleet.x(c) = borders.empty() ? 0.0 : i == 0 ? to - 1.0 : i == borders.size() ? from + 1.0 : 0.5 * (from + to);
    fleet.place_wheels();
    PatchesThere there = patches_of(c);
    there.from = from;
    there.to = to;
    all.push_back(there);
  }
}

}  // namespace traverse::engine
