// Set-up of a linear train.
#include <algorithm>
#include <utility>

#include "engine/linear_train.hpp"
#include "train/linearisation_residual.hpp"

namespace traverse::engine {

std::string LinearTrain::obstacle(const train::Fleet& fleet) {
  return fleet.vehicles.empty() ? "no vehicles run" : TrainArrays::obstacle(fleet);
}

LinearTrain::LinearTrain(const train::Fleet& fleet, const beam::Mesh* mesh, int per_node, double surface_height)
    : arrays_(TrainArrays::side_by_side(fleet), per_node, surface_height), mesh_(mesh) {
  for (int e = 0; mesh_ != nullptr && e < mesh_->elements(); ++e)
    task_.shears = task_.shears || mesh_->element(e).shear != 0.0;
  work_ = arrays_.add(2 * static_cast<std::size_t>(task_.coordinates));
  find_indices(fleet);
  find_surfaces(fleet);
}

// Determines the indices of the fleet's coordinates and wheels in the arrays of rows.
void LinearTrain::find_indices(const train::Fleet& fleet) {
  const auto blocks = TrainArrays::side_by_side(fleet);
  struct Place {
    std::size_t block = 0, lane = 0;
  };
  std::vector<Place> places(fleet.vehicles.size());
  for (std::size_t block = 0; block < blocks.size(); ++block)
    for (std::size_t lane = 0; lane < blocks[block].size(); ++lane)
      places[static_cast<std::size_t>(blocks[block][lane] - fleet.vehicles.data())] = {block, lane};
  coordinate_.resize(static_cast<std::size_t>(fleet.freedom()));
  largest_departure_.assign(fleet.vehicles.size(), 0.0);
  for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) {
    const train::MovingVehicle& vehicle = fleet.vehicles[k];
    first_entry_.push_back(roots_.size());
    const std::vector<double> roots = train::residual_roots(vehicle);
    roots_.insert(roots_.end(), roots.begin(), roots.end());
    const VehicleBlock& b = arrays_.blocks[places[k].block];
    for (int i = 0; i < b.freedom; ++i)
      coordinate_[static_cast<std::size_t>(vehicle.offset + i)] =
          static_cast<std::size_t>(b.first_coordinate + i) * arrays_.lanes + places[k].lane;
  }
  first_entry_.push_back(roots_.size());
  for (std::size_t i = 0; i < fleet.wheels.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[i];
    if (c.is_further) continue;
    const Place& place = places[static_cast<std::size_t>(c.vehicle)];
    entry_.push_back(i);
    wheel_.push_back(static_cast<std::size_t>(arrays_.blocks[place.block].first_wheel + c.wheel) * arrays_.lanes +
                     place.lane);
    speed_.push_back(arrays_.speed[place.block][place.lane]);
    const track::Profile& profile = fleet.profile(c);
    profile_.push_back(profile.level() ? nullptr : &profile);
    if (!profile.level()) arrays_.level[wheel_.back() / arrays_.lanes] = 0;
  }
}

void LinearTrain::find_surfaces(const train::Fleet& fleet) {
  found_.resize(wheel_.size());
  patches_.resize(wheel_.size());
  moved_.assign(wheel_.size(), 0);
  always_places_ = mesh_ != nullptr && !(mesh_->ground_before() && mesh_->ground_behind());
  const bool several_points =
      std::any_of(fleet.wheels.begin(), fleet.wheels.end(), [](const auto& c) { return c.further > 0; });
  if (!always_places_ && !several_points) {
    surfaces_.emplace(fleet);
    interval_.assign(wheel_.size(), 0);
    for (const std::size_t entry : entry_) table_.push_back(surfaces_->number(fleet.wheel(fleet.wheels[entry]).radius));
    return;
  }
  if (mesh_ == nullptr) return;
  std::vector<double> radii;
  for (const train::WheelContact& c : fleet.wheels) {
    const double radius = fleet.wheel(c).radius;
    if (std::find(radii.begin(), radii.end(), radius) != radii.end()) continue;
    radii.push_back(radius);
    const std::vector<double> more = fleet.borders_of_patches(c);
    borders_.insert(borders_.end(), more.begin(), more.end());
  }
  std::sort(borders_.begin(), borders_.end());
}

}  // namespace traverse::engine
