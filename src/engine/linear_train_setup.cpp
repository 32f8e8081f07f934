// What a linear train is set up from.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/linear_train.hpp"
#include "train/linearisation_residual.hpp"

namespace traverse::engine {
namespace {

constexpr int most_freedom = 64;  // of a vehicle; larger ones are matrices that are mostly zeros

bool in_block_with(const train::MovingVehicle& a, const train::MovingVehicle& b) {
  const auto same_law = [](const train::Wheel& x, const train::Wheel& y) { return x.law.kind == y.law.kind; };
  return a.freedom() == b.freedom() &&
         std::equal(a.wheels.begin(), a.wheels.end(), b.wheels.begin(), b.wheels.end(), same_law);
}

Eigen::MatrixXd rows_of_wheels(const train::MovingVehicle& vehicle, Eigen::Index coordinate) {
  const Eigen::MatrixXd& B = vehicle.dynamics->linear()->matrices().B;
  Eigen::MatrixXd G(static_cast<Eigen::Index>(vehicle.wheels.size()), B.cols());
  for (Eigen::Index j = 0; j < G.rows(); ++j)
    G.row(j) = B.row(3 * static_cast<Eigen::Index>(vehicle.wheels[static_cast<std::size_t>(j)].body) + coordinate);
  return G;
}

/// What rounding has left of a zero is one.
Eigen::MatrixXd cleaned(const Eigen::MatrixXd& A) {
  const double none = 1e-14 * A.cwiseAbs().maxCoeff();
  return A.unaryExpr([none](double x) { return std::abs(x) > none ? x : 0.0; });
}

}  // namespace

std::string LinearTrain::obstacle(const train::Fleet& fleet) {
  if (fleet.vehicles.empty()) return "no vehicles run";
  if (!fleet.pairs.empty()) return "bodies of its vehicles touch each other";
  for (const train::MovingVehicle& vehicle : fleet.vehicles) {
    const auto no = [&](const std::string& why) { return fmt::format("vehicle '{}': {}", vehicle.name(), why); };
    if (vehicle.dynamics->linear() == nullptr) return no("it is not taken as linear");
    if (!vehicle.mechanism.model().actuators.empty()) return no("actuators act on it");
    if (vehicle.freedom() > most_freedom || vehicle.wheels.size() > most_wheels) return no("it has too many parts");
    for (const train::Wheel& wheel : vehicle.wheels) {
      const auto its = [&](const char* why) { return no(fmt::format("its wheel '{}' {}", wheel.name, why)); };
      if (wheel.law.damping != 0.0 || wheel.law.hysteresis) return its("has a contact with damping");
      if (wheel.law.friction != 0.0) return its("has a contact with friction");
      if (!wheel.shape.round()) return its("is out of round");
    }
  }
  for (const train::WheelContact& wheel : fleet.wheels)
    if (wheel.sharp) return "a wheel may touch the track at several points";
  return {};
}

LinearTrain::LinearTrain(const train::Fleet& fleet, const beam::Mesh* mesh, int per_node, double surface_height)
    : mesh_(mesh) {
  task_.per_node = per_node;
  task_.surface_height = surface_height;
  for (int e = 0; mesh_ != nullptr && e < mesh_->elements(); ++e)
    task_.shears = task_.shears || mesh_->element(e).shear != 0.0;
  make_blocks(fleet);
  make_rows(fleet);
  find_borders(fleet);
}

double* LinearTrain::add(std::size_t rows) {
  numbers_.push_back(std::make_unique<Aligned>(rows * lanes_));
  return numbers_.back()->data();
}

int* LinearTrain::add_integers(std::size_t rows) {
  integers_.push_back(std::make_unique<std::vector<int>>(std::max<std::size_t>(rows, 1)));
  return integers_.back()->data();
}

void LinearTrain::make_blocks(const train::Fleet& fleet) {
  std::vector<std::vector<int>> members;  // vehicles of each block
  places_.resize(fleet.vehicles.size());
  for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) {
    const auto fits = [&](const std::vector<int>& block) {
      return block.size() < lanes_ &&
             in_block_with(fleet.vehicles[static_cast<std::size_t>(block.front())], fleet.vehicles[k]);
    };
    auto block = std::find_if(members.begin(), members.end(), fits);
    if (block == members.end()) block = members.insert(block, std::vector<int>());
    places_[k] = {static_cast<std::size_t>(block - members.begin()), static_cast<int>(block->size())};
    block->push_back(static_cast<int>(k));
  }
  blocks_.resize(members.size());
  for (std::size_t block = 0; block < blocks_.size(); ++block) fill_block(fleet, block, members[block]);
  task_.blocks = static_cast<int>(blocks_.size());
  task_.block = blocks_.data();
}

/// The entries that are not zero in all lanes.
SparseRows LinearTrain::sparse(const std::vector<Eigen::MatrixXd>& of_lanes) {
  const Eigen::MatrixXd& first = of_lanes.front();
  std::vector<std::pair<Eigen::Index, Eigen::Index>> entries;
  for (Eigen::Index i = 0; i < first.rows(); ++i)
    for (Eigen::Index j = 0; j < first.cols(); ++j)
      if (std::any_of(of_lanes.begin(), of_lanes.end(), [&](const Eigen::MatrixXd& A) { return A(i, j) != 0.0; }))
        entries.emplace_back(i, j);
  SparseRows to;
  to.count = static_cast<int>(entries.size());
  int* row = add_integers(entries.size());
  int* column = add_integers(entries.size());
  double* value = add(entries.size());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto [i, j] = entries[e];
    row[e] = static_cast<int>(i);
    column[e] = static_cast<int>(j);
    for (std::size_t l = 0; l < of_lanes.size(); ++l) value[e * lanes_ + l] = of_lanes[l](i, j);
  }
  to.row = row;
  to.column = column;
  to.value = value;
  return to;
}

void LinearTrain::fill_block(const train::Fleet& fleet, std::size_t number, const std::vector<int>& vehicles) {
  VehicleBlock& b = blocks_[number];
  const train::MovingVehicle& any = fleet.vehicles[static_cast<std::size_t>(vehicles.front())];
  const auto f = static_cast<std::size_t>(any.freedom()), m = any.wheels.size();
  b.freedom = static_cast<int>(f);
  b.wheels = static_cast<int>(m);
  b.first_coordinate = task_.coordinates;
  b.first_wheel = task_.wheels;
  task_.coordinates += b.freedom;
  task_.wheels += b.wheels;
  double *M = add(f * f), *r0 = add(f), *driven = add(f), *speed = add(1), *drive = add(1);
  for (std::size_t i = 0; i < f; ++i)  // lanes without a vehicle
    std::fill_n(M + (i * f + i) * lanes_, lanes_, 1.0);
  std::vector<Eigen::MatrixXd> C, K, G, G_along;
  for (std::size_t l = 0; l < vehicles.size(); ++l) {
    const train::MovingVehicle& vehicle = fleet.vehicles[static_cast<std::size_t>(vehicles[l])];
    const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
    C.push_back(cleaned(of.C));
    K.push_back(cleaned(of.K));
    G.push_back(cleaned(rows_of_wheels(vehicle, 1)));
    G_along.push_back(cleaned(rows_of_wheels(vehicle, 0)));
    const bool drives = !vehicle.mechanism.model().drivers.empty();
    speed[l] = of.u[3 * static_cast<Eigen::Index>(vehicle.wheels.front().body)];
    drive[l] = drives ? speed[l] : 0.0;
    for (std::size_t i = 0; i < f; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      r0[i * lanes_ + l] = of.r0[row];
      driven[i * lanes_ + l] = drives ? of.driven[row] : 0.0;
      for (std::size_t j = 0; j < f; ++j) M[(i * f + j) * lanes_ + l] = of.M(row, static_cast<Eigen::Index>(j));
    }
  }
  b.C = sparse(C);
  b.K = sparse(K);
  b.G = sparse(G);
  b.G_along = sparse(G_along);
  b.M = M;
  b.r0 = r0;
  b.driven = driven;
  b.speed = speed;
  b.drive = drive;
  distance_.push_back(add(1));
  b.distance = distance_.back();
  b.inverse = add(f * f);
  b.Y = add(f * m);
  b.Y_along = add(f * m);
  b.H = add(4 * m * m);
}

void LinearTrain::make_rows(const train::Fleet& fleet) {
  const auto coordinates = static_cast<std::size_t>(task_.coordinates), wheels = static_cast<std::size_t>(task_.wheels);
  for (double** of : {&task_.x, &task_.w, &task_.w_predicted, &task_.a_free}) *of = add(coordinates);
  for (double*& a : task_.a) a = add(coordinates);
  work_ = add(2 * coordinates);
  double *place = add(wheels), *height = add(wheels), *radius = add(wheels), *stiffness = add(wheels),
         *scale = add(wheels);
  for (double** of : {&task_.up,       &task_.along,       &task_.from,
                      &task_.to,       &task_.h,           &task_.h_x,
                      &task_.h_xx,     &task_.looked_up,   &task_.normal,
                      &task_.root,     &task_.normal_up,   &task_.normal_along,
                      &task_.force_up, &task_.force_along, &task_.turn,
                      &task_.seat,     &task_.ahead,       &task_.ahead_before,
                      &task_.station,  &task_.penetration, &task_.penetration_rate,
                      &task_.up_rate,  &task_.along_rate,  &task_.largest})
    *of = add(wheels);
  for (double*& history : task_.history) history = add(wheels);
  task_.active = add_integers(wheels * lanes_);
  task_.lost = add(most_kept);
  task_.given = add(most_kept);
  hertz_.assign(wheels, 1);
  second_.assign(wheels, 0);
  // Lanes without a vehicle: far above a level ground.
  for (std::size_t i = 0; i < wheels * lanes_; ++i) {
    radius[i] = stiffness[i] = scale[i] = 1.0;
    task_.h[i] = no_surface;
    task_.from[i] = -infinite;
    task_.to[i] = infinite;
    task_.root[i] = 1e-3;
    task_.normal_up[i] = 1.0;
  }
  for (SurfacePatch& p : task_.patch) {
    p.slot = add_integers(wheels * lanes_);
    for (double** of : {&p.x, &p.length, &p.shear, &p.yield, &p.low, &p.high}) *of = add(wheels);
    for (double*& entry : p.compliance) entry = add(wheels);
    std::fill_n(p.length, wheels * lanes_, 1.0);
    const bool first = &p == task_.patch;
    std::fill_n(p.low, wheels * lanes_, first ? -infinite : 1.0);
    std::fill_n(p.high, wheels * lanes_, first ? infinite : -1.0);
  }
  coordinate_.resize(static_cast<std::size_t>(fleet.freedom()));
  farthest_.assign(fleet.vehicles.size(), 0.0);
  for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) {
    const train::MovingVehicle& vehicle = fleet.vehicles[k];
    first_entry_.push_back(roots_.size());
    const std::vector<double> roots = train::residual_roots(vehicle);
    roots_.insert(roots_.end(), roots.begin(), roots.end());
    const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
    const VehicleBlock& b = blocks_[places_[k].block];
    const auto lane = static_cast<std::size_t>(places_[k].lane);
    for (int i = 0; i < b.freedom; ++i)
      coordinate_[static_cast<std::size_t>(vehicle.offset + i)] =
          static_cast<std::size_t>(b.first_coordinate + i) * lanes_ + lane;
    for (std::size_t j = 0; j < vehicle.wheels.size(); ++j) {
      const train::Wheel& wheel = vehicle.wheels[j];
      const std::size_t row = static_cast<std::size_t>(b.first_wheel) + j, number = row * lanes_ + lane;
      const auto body = 3 * static_cast<Eigen::Index>(wheel.body);
      place[number] = of.q0[body];
      height[number] = of.q0[body + 1] - wheel.radius;
      radius[number] = wheel.radius;
      stiffness[number] = wheel.law.stiffness;
      scale[number] = vehicle.scale;
      hertz_[row] = wheel.law.kind == contact::LawKind::hertz ? 1 : 0;
    }
  }
  first_entry_.push_back(roots_.size());
  task_.place = place;
  task_.height = height;
  task_.radius = radius;
  task_.stiffness = stiffness;
  task_.scale = scale;
  task_.hertz = hertz_.data();
  task_.second = second_.data();
  for (std::size_t i = 0; i < fleet.wheels.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[i];
    if (c.is_further) continue;
    const VehicleBlock& b = blocks_[places_[static_cast<std::size_t>(c.vehicle)].block];
    entry_.push_back(i);
    wheel_.push_back(static_cast<std::size_t>(b.first_wheel + c.wheel) * lanes_ +
                     static_cast<std::size_t>(places_[static_cast<std::size_t>(c.vehicle)].lane));
    const track::Profile& profile = fleet.profile(c);
    profile_.push_back(profile.level() ? nullptr : &profile);
  }
}

// Of wheels of all radii.
void LinearTrain::find_borders(const train::Fleet& fleet) {
  if (mesh_ == nullptr) return;
  always_places_ = !(mesh_->ground_before() && mesh_->ground_behind());
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
