// The set-up of a linear train: its vehicles and wheels in rows, and the surfaces under its wheels.
#include <algorithm>
#include <utility>

#include "engine/linear_train.hpp"
#include "train/linear_dynamics.hpp"

namespace traverse::engine {

std::string LinearTrain::obstacle(const train::Fleet& fleet) {
  return fleet.vehicles.empty() ? "no vehicles run" : TrainArrays::obstacle(fleet);
}

std::shared_ptr<const Surfaces> LinearTrain::surfaces_of(const train::Fleet& fleet, const beam::Mesh* mesh) {
  const bool leaves = mesh != nullptr && !(mesh->ground_before() && mesh->ground_behind());
  const auto several_points = [](const train::WheelContact& c) { return c.further > 0; };
  if (leaves || std::any_of(fleet.wheels.begin(), fleet.wheels.end(), several_points)) return nullptr;
  return std::make_shared<const Surfaces>(fleet);
}

LinearTrain::LinearTrain(const train::Fleet& fleet, std::size_t first, std::size_t past,
                         std::shared_ptr<const Surfaces> surfaces, const beam::Mesh* mesh, int per_node,
                         double surface_height)
    : LinearTrain(fleet, TrainArrays::side_by_side(std::span(fleet.vehicles).subspan(first, past - first)), first, past,
                  std::move(surfaces), mesh, per_node, surface_height) {}

LinearTrain::LinearTrain(const train::Fleet& fleet, const Blocks& blocks, std::size_t first, std::size_t past,
                         std::shared_ptr<const Surfaces> surfaces, const beam::Mesh* mesh, int per_node,
                         double surface_height)
    : arrays_(blocks, per_node, surface_height), vehicles_{first, past}, mesh_(mesh), surfaces_(std::move(surfaces)) {
  for (int e = 0; mesh_ != nullptr && e < mesh_->elements(); ++e)
    task_.shears = task_.shears || mesh_->element(e).shear != 0.0;
  work_ = arrays_.add(2 * static_cast<std::size_t>(task_.coordinates));
  find_indices(fleet, blocks, first, past);
  find_surfaces(fleet);
  of_wheels_ = {task_.normal,
                task_.root,
                task_.normal_up,
                task_.normal_along,
                task_.force_up,
                task_.force_along,
                task_.ahead,
                task_.ahead_before,
                task_.turn,
                task_.station,
                task_.along_rate,
                task_.penetration,
                task_.least,
                task_.largest,
                task_.penetration_rate,
                task_.local_compliance,
                task_.history[most_stages],
                task_.history[most_stages + 1]};
  numbers_.resize(6 + 2 * wheel_.size());
}

// Determines the indices of the coordinates and wheels of the vehicles [first, past) in the arrays of rows.
void LinearTrain::find_indices(const train::Fleet& fleet, const Blocks& blocks, std::size_t first, std::size_t past) {
  place_.resize(past - first);
  for (std::size_t block = 0; block < blocks.size(); ++block)
    for (std::size_t lane = 0; lane < blocks[block].size(); ++lane)
      place_[static_cast<std::size_t>(blocks[block][lane] - &fleet.vehicles[first])] = {block, lane};
  first_coordinate_ = fleet.vehicles[first].offset;
  largest_departure_.assign(place_.size(), 0.0);
  acceleration_.assign(place_.size(), 0.0);
  for (std::size_t k = 0; k < place_.size(); ++k) {
    const train::MovingVehicle& vehicle = fleet.vehicles[first + k];
    first_entry_.push_back(roots_.size());
    const std::vector<double> roots = train::residual_roots(vehicle);
    roots_.insert(roots_.end(), roots.begin(), roots.end());
    const VehicleBlock& b = arrays_.blocks[place_[k].block];
    for (int i = 0; i < b.freedom; ++i)
      coordinate_.push_back(static_cast<std::size_t>(b.first_coordinate + i) * arrays_.lanes + place_[k].lane);
  }
  first_entry_.push_back(roots_.size());
  for (std::size_t i = 0; i < fleet.wheels.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[i];
    const auto vehicle = static_cast<std::size_t>(c.vehicle);
    if (c.is_further || vehicle < first || vehicle >= past) continue;
    const Place& place = place_[vehicle - first];
    entry_.push_back(i);
    wheel_.push_back(static_cast<std::size_t>(arrays_.blocks[place.block].first_wheel + c.wheel) * arrays_.lanes +
                     place.lane);
    speed_.push_back(arrays_.speed[place.block] + place.lane);
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
  if (surfaces_) {
    interval_.assign(wheel_.size(), 0);
    for (const std::size_t entry : entry_) {
      const train::WheelContact& c = fleet.wheels[entry];
      table_.push_back(surfaces_->number(fleet.wheel(c).radius, c.track));
    }
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
