#include "engine/linear_train.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "train/linear_dynamics.hpp"
#include "traverse/base/error.hpp"

namespace traverse::engine {

// Compiled from train_kernel.cpp, once for each kind of processor.
TRAVERSE_LANES_DECLARE(void set_train_step(const TrainTask& task);
                       void predict_train(const TrainTask& task, int stage, double* work);
                       bool train_in_place(const TrainTask& task); void load_by_train(const TrainTask& task);
                       double renew_train_contacts(const TrainTask& task);
                       void take_train_forces(const TrainTask& task, int stage, bool kinematics);
                       void finish_train_step(const TrainTask& task);)

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double tolerance = 1e-12;  // of a vehicle's weight: changes of forces still to come
constexpr double rounding = 1e-9;    // of the weight: below this a change that stays is taken as rounding
constexpr int most_passes = 60;      // of a stage
constexpr double best_contraction = 1e-3;
constexpr double measurable = 1e-10;   // of the weight: changes above it tell a contraction
constexpr double growth = 1.1;         // of a contraction that is trusted without having been measured again
constexpr double near_look_up = 2e-5;  // m: as far the profile's parabola is exact
constexpr double no_surface = -1e3;    // m: height of what is under a wheel with no surface
constexpr int most_freedom = 64;       // of a vehicle; larger ones are matrices that are mostly zeros

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
Eigen::MatrixXd cleaned(Eigen::MatrixXd A) {
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

// --- set-up ----------------------------------------------------------------------------------------------------------

double* LinearTrain::add(std::size_t rows) {
  numbers_.push_back(std::make_unique<Aligned>(rows * block_lanes));
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
      return block.size() < block_lanes &&
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
    for (std::size_t l = 0; l < of_lanes.size(); ++l) value[e * block_lanes + l] = of_lanes[l](i, j);
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
    std::fill_n(M + (i * f + i) * block_lanes, block_lanes, 1.0);
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
      r0[i * block_lanes + l] = of.r0[row];
      driven[i * block_lanes + l] = drives ? of.driven[row] : 0.0;
      for (std::size_t j = 0; j < f; ++j) M[(i * f + j) * block_lanes + l] = of.M(row, static_cast<Eigen::Index>(j));
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
  task_.active = add_integers(wheels * block_lanes);
  task_.lost = add(most_kept);
  task_.given = add(most_kept);
  hertz_.assign(wheels, 1);
  second_.assign(wheels, 0);
  // Lanes without a vehicle: far above a level ground.
  for (std::size_t i = 0; i < wheels * block_lanes; ++i) {
    radius[i] = stiffness[i] = scale[i] = 1.0;
    task_.h[i] = no_surface;
    task_.from[i] = -infinite;
    task_.to[i] = infinite;
    task_.root[i] = 1e-3;
    task_.normal_up[i] = 1.0;
  }
  for (SurfacePatch& p : task_.patch) {
    p.slot = add_integers(wheels * block_lanes);
    for (double** of : {&p.x, &p.length, &p.shear, &p.yield, &p.low, &p.high}) *of = add(wheels);
    for (double*& entry : p.compliance) entry = add(wheels);
    std::fill_n(p.length, wheels * block_lanes, 1.0);
    const bool first = &p == task_.patch;
    std::fill_n(p.low, wheels * block_lanes, first ? -infinite : 1.0);
    std::fill_n(p.high, wheels * block_lanes, first ? infinite : -1.0);
  }
  coordinate_.resize(static_cast<std::size_t>(fleet.freedom()));
  shift_.assign(coordinate_.size(), 0.0);
  for (std::size_t k = 0; k < fleet.vehicles.size(); ++k) {
    const train::MovingVehicle& vehicle = fleet.vehicles[k];
    const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
    const VehicleBlock& b = blocks_[places_[k].block];
    const auto lane = static_cast<std::size_t>(places_[k].lane);
    for (int i = 0; i < b.freedom; ++i)
      coordinate_[static_cast<std::size_t>(vehicle.offset + i)] =
          static_cast<std::size_t>(b.first_coordinate + i) * block_lanes + lane;
    for (std::size_t j = 0; j < vehicle.wheels.size(); ++j) {
      const train::Wheel& wheel = vehicle.wheels[j];
      const std::size_t row = static_cast<std::size_t>(b.first_wheel) + j, number = row * block_lanes + lane;
      const auto body = 3 * static_cast<Eigen::Index>(wheel.body);
      place[number] = of.q0[body];
      height[number] = of.q0[body + 1] - wheel.radius;
      radius[number] = wheel.radius;
      stiffness[number] = wheel.law.stiffness;
      scale[number] = vehicle.scale;
      hertz_[row] = wheel.law.kind == contact::LawKind::hertz ? 1 : 0;
    }
  }
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
    wheel_.push_back(static_cast<std::size_t>(b.first_wheel + c.wheel) * block_lanes +
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

// --- steps -----------------------------------------------------------------------------------------------------------

void LinearTrain::write(const double* rows, double* coordinates) const {
  for (std::size_t i = 0; i < coordinate_.size(); ++i) coordinates[i] = rows[coordinate_[i]];
}

namespace {

void fill(double (&row)[block_lanes], double value) { std::fill_n(row, block_lanes, value); }

void fill_rule(StageRows& to, double w_in_v, const structure::Weights& a_in_v, const structure::Weights& a_in_w) {
  fill(to.w_in_v, w_in_v);
  for (int j = 0; j < most_kept; ++j) {
    fill(to.a_in_v[j], a_in_v[static_cast<std::size_t>(j)]);
    fill(to.a_in_w[j], a_in_w[static_cast<std::size_t>(j)]);
  }
}

/// Instants at which contact forces are known, and which of their histories has them.
struct Instants {
  std::array<double, most_stages + 2> time{};
  std::array<int, most_stages + 2> history{};
  std::size_t count = 0;
  void add(double t, int of) {
    time[count] = t;
    history[count++] = of;
  }
  /// The weight of instant i in the polynomial through all of them, at t.
  double weight(std::size_t i, double t) const {
    double weight = 1.0;
    for (std::size_t j = 0; j < count; ++j)
      if (j != i) weight *= (t - time[j]) / (time[i] - time[j]);
    return weight;
  }
};

}  // namespace

void LinearTrain::set_method(const structure::Method& method, double h) {
  method_ = method;
  length_ = h;
  task_.stages = static_cast<int>(method.stages.size());
  task_.known = method.step.known;
  for (std::size_t s = 0; s < method.stages.size(); ++s) {
    const structure::StageRule& rule = method.stages[s];
    StageRows& to = task_.stage[s];
    fill_rule(to, rule.w_in_v, rule.a_in_v, rule.a_in_w);
    fill(to.rate, rule.rate);
    fill(to.displacement, rule.displacement);
  }
  fill_rule(task_.end, method.step.w_in_v, method.step.a_in_v, method.step.a_in_w);
  for (std::size_t j = 0; j < most_kept; ++j) task_.a_next[j] = method.step.a_next[j];
  const structure::StageRule& last = method.stages.back();
  ends_with_stage_ = std::abs(last.time - h) <= 1e-9 * h;
  TRAVERSE_LANES_CALL(set_train_step(task_));
  placed_ = false;  // the structure yields otherwise
}

void LinearTrain::begin_step() {
  std::fill_n(task_.largest, static_cast<std::size_t>(task_.wheels) * block_lanes, 0.0);
  for (std::size_t s = 0; s < method_.stages.size(); ++s) {
    Instants known;
    for (std::size_t j = 0; j < s; ++j) known.add(method_.stages[j].time, static_cast<int>(j));
    known.add(0.0, most_stages);
    if (s < 2 && length_before_ > 0.0) known.add(-length_before_, most_stages + 1);
    for (auto& row : task_.stage[s].guess) fill(row, 0.0);
    for (std::size_t i = 0; i < known.count; ++i)
      fill(task_.stage[s].guess[known.history[i]], known.weight(i, method_.stages[s].time));
  }
}

void LinearTrain::restart(const train::Fleet& fleet, const double* p, const double* pd, const double* pdd) {
  for (std::size_t k = 0; k < coordinate_.size(); ++k) {
    const std::size_t at = coordinate_[k];
    task_.x[at] = p[k] + shift_[k];
    task_.w[at] = pd[k];
    task_.a[0][at] = pdd[k];
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    const train::WheelContact& c = fleet.wheels[entry_[i]];
    const std::size_t at = wheel_[i];
    const double force = c.force.normal;
    task_.normal[at] = force;
    task_.normal_up[at] = -c.touch.normal_on_body.y();
    task_.normal_along[at] = -c.touch.normal_on_body.x();
    task_.force_up[at] = force * task_.normal_up[at];
    task_.force_along[at] = force * task_.normal_along[at];
    task_.ahead[at] = task_.ahead_before[at] = c.touch.ahead;
    task_.root[at] = force > 0.0 ? std::cbrt(force / c.law.stiffness) : 1e-3;
    for (const int j : {most_stages, most_stages + 1}) task_.history[j][at] = force;
  }
  length_before_ = last_time_ = time_before_ = 0.0;
  placed_ = false;
}

void LinearTrain::predict(std::size_t stage, double t) {
  stage_ = stage;
  passes_ = 0;
  task_.onward = last_time_ > time_before_ ? std::clamp((t - last_time_) / (last_time_ - time_before_), 0.0, 2.0) : 0.0;
  time_before_ = std::exchange(last_time_, t);
  settled_ = false;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int l = 0; l < block_lanes; ++l) distance_[b][l] = blocks_[b].speed[l] * t;
  TRAVERSE_LANES_CALL(predict_train(task_, static_cast<int>(stage), work_));
}

// Anew for wheels whose contacts have moved farther than `within` (m); whether there were any.
bool LinearTrain::look_up_profiles(double within) {
  bool moved = false;
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    if (profile_[i] == nullptr) continue;
    const std::size_t at = wheel_[i];
    if (task_.h[at] == no_surface || std::abs(task_.station[at] - task_.looked_up[at]) <= within) continue;
    moved = true;
    task_.looked_up[at] = task_.station[at];
    const track::Height height = profile_[i]->at(task_.station[at]);
    task_.h[at] = height.value;
    task_.h_x[at] = height.slope;
    task_.h_xx[at] = height.curvature;
  }
  return moved;
}

LinearTrain::Placing LinearTrain::place(train::Fleet& fleet) {
  if (placed_ && !always_places_ && TRAVERSE_LANES_CALL(train_in_place(task_))) {
    look_up_profiles(0.0);
    return Placing::as_before;
  }
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    train::WheelContact& c = fleet.wheels[entry_[i]];
    fleet.x(c) = task_.along[wheel_[i]];
    fleet.vehicles[static_cast<std::size_t>(c.vehicle)].state.q[3 * static_cast<Eigen::Index>(c.body) + 1] =
        task_.up[wheel_[i]] + task_.radius[wheel_[i]];
  }
  placed_ = false;
  fleet.place_wheels();
  const auto points = [&](const train::WheelContact& c) { return c.further > 0 && fleet.has_points(c); };
  if (std::any_of(fleet.wheels.begin(), fleet.wheels.end(), points)) return Placing::several_points;
  elements_ = fleet.elements();
  task_.slots = static_cast<int>(elements_.size()) + 1;
  const std::size_t size = 2 * static_cast<std::size_t>(task_.per_node * task_.slots);
  for (std::vector<double>* nodal : {&nodal_, &nodal_rate_, &load_}) nodal->assign(size, 0.0);
  loads_.resize(size - 2 * static_cast<std::size_t>(task_.per_node));
  task_.nodal = nodal_.data();
  task_.nodal_rate = nodal_rate_.data();
  task_.load = load_.data();
  std::fill(second_.begin(), second_.end(), 0);
  for (std::size_t i = 0; i < wheel_.size(); ++i) place_wheel(fleet.wheels[entry_[i]], wheel_[i]);
  look_up_profiles(0.0);
  placed_ = true;
  return Placing::anew;
}

void LinearTrain::place_wheel(const train::WheelContact& c, std::size_t at) {
  for (int k = 0; k < 2; ++k) {
    SurfacePatch& p = task_.patch[k];
    const bool there = k < c.candidates;
    const train::Patch& patch = c.patches[static_cast<std::size_t>(k)];
    const bool on_beam = there && patch.element >= 0;
    p.slot[at] = on_beam ? c.slots[static_cast<std::size_t>(k)] : task_.slots - 1;
    p.x[at] = on_beam ? patch.x : 0.0;
    p.length[at] = on_beam ? patch.length : 1.0;
    p.shear[at] = on_beam ? patch.shear : 0.0;
    p.yield[at] = on_beam ? patch.yield : 0.0;
    for (double* entry : p.compliance) entry[at] = 0.0;
    p.low[at] = there ? patch.low : k == 0 ? -infinite : 1.0;
    p.high[at] = there ? patch.high : k == 0 ? infinite : -1.0;
  }
  if (c.candidates > 1) second_[at / block_lanes] = 1;
  if (task_.active[at] >= c.candidates) task_.active[at] = 0;
  task_.h[at] = c.candidates > 0 ? 0.0 : no_surface;
  task_.h_x[at] = task_.h_xx[at] = 0.0;
  const double x = task_.along[at];
  const auto next = std::upper_bound(borders_.begin(), borders_.end(), x);
  task_.to[at] = next == borders_.end() ? infinite : *next;
  task_.from[at] = next == borders_.begin() ? -infinite : next[-1];
}

void LinearTrain::set_compliance(const structure::ElementCompliance& compliance) {
  const int m = 2 * task_.per_node, o = task_.per_node - 2;
  for (const std::size_t at : wheel_)
    for (SurfacePatch& p : task_.patch) {
      const int slot = p.slot[at];
      if (slot == task_.slots - 1) continue;
      const double* block = compliance.block(slot, slot);
      const int place[4] = {o, o + 1, task_.per_node + o, task_.per_node + o + 1};
      for (int i = 0, k = 0; i < 4; ++i)
        for (int j = i; j < 4; ++j, ++k) p.compliance[k][at] = (j > i ? 2.0 : 1.0) * block[place[i] + m * place[j]];
    }
}

const std::vector<double>& LinearTrain::find_loads() {
  TRAVERSE_LANES_CALL(load_by_train(task_));
  std::copy_n(load_.begin(), loads_.size(), loads_.begin());
  return loads_;
}

bool LinearTrain::pass(const std::vector<double>& v) {
  std::copy(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(loads_.size()), nodal_.begin());
  const double before = change_;
  change_ = TRAVERSE_LANES_CALL(renew_train_contacts(task_));
  if (!(change_ >= 0.0) || !std::isfinite(change_) || ++passes_ > most_passes) return false;
  if (passes_ > 1 && before > measurable) contraction_ = std::clamp(change_ / before, best_contraction, 1.0);
  settled_ = !look_up_profiles(near_look_up) && change_ * contraction_ <= tolerance;
  settled_ = settled_ || (passes_ > 1 && change_ <= rounding && change_ > 0.1 * before);
  if (settled_ && passes_ == 1) contraction_ = std::min(growth * contraction_, 1.0);
  return true;
}

void LinearTrain::take(const std::vector<double>& w) {
  std::copy(w.begin(), w.begin() + static_cast<std::ptrdiff_t>(loads_.size()), nodal_rate_.begin());
  const bool last = stage_ + 1 == method_.stages.size();
  TRAVERSE_LANES_CALL(take_train_forces(task_, static_cast<int>(stage_), last));
}

namespace {

double sum_of(const double* row) {
  double sum = 0.0;
  for (int l = 0; l < block_lanes; ++l) sum += row[l];
  return sum;
}

}  // namespace

double LinearTrain::lost() const { return sum_of(task_.lost + (stage_ + 1) * block_lanes); }
double LinearTrain::given() const { return sum_of(task_.given + (stage_ + 1) * block_lanes); }

void LinearTrain::finish_step(double* p, double* pd, double* pdd) {
  TRAVERSE_LANES_CALL(finish_train_step(task_));
  length_before_ = length_;
  write(task_.x, p);
  write(task_.w, pd);
  write(task_.a[0], pdd);
  for (std::size_t i = 0; i < shift_.size(); ++i) p[i] -= shift_[i];
}

void LinearTrain::tell(train::Fleet& fleet) const {
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    train::WheelContact& c = fleet.wheels[entry_[i]];
    const std::size_t at = wheel_[i];
    train::MovingVehicle& vehicle = fleet.vehicles[static_cast<std::size_t>(c.vehicle)];
    const auto body = 3 * static_cast<Eigen::Index>(c.body);
    vehicle.state.q[body] = task_.station[at] - task_.ahead[at];
    vehicle.state.qd[body] = task_.along_rate[at];
    c.kinematics = c.touch.kinematics = {task_.penetration[at], task_.penetration_rate[at], 0.0};
    c.law.seat = c.touch.seat = task_.seat[at];
    c.touch.ahead = task_.ahead[at];
    c.touch.station = task_.station[at];
    c.touch.normal_on_body = {-task_.normal_along[at], -task_.normal_up[at], 0.0};
    c.active = task_.active[at];
    c.force = {};
    c.force.normal = task_.normal[at];
    c.touched = c.touched || task_.largest[at] > 0.0;
  }
}

void LinearTrain::keep(base::Bytes& bytes) {
  const auto rows = [&](double* numbers, int count) {
    std::vector<double> list(numbers, numbers + static_cast<std::ptrdiff_t>(count) * block_lanes);
    const std::size_t size = list.size();
    bytes(list);
    if (list.size() != size) throw FileError("the checkpoint does not fit this scene");
    std::copy(list.begin(), list.end(), numbers);
  };
  for (double* of : {task_.x, task_.w, task_.a[0]}) rows(of, task_.coordinates);
  for (double* of :
       {task_.normal, task_.root, task_.normal_up, task_.normal_along, task_.force_up, task_.force_along, task_.ahead,
        task_.ahead_before, task_.turn, task_.history[most_stages], task_.history[most_stages + 1]})
    rows(of, task_.wheels);
  std::vector<int> active(task_.active, task_.active + static_cast<std::ptrdiff_t>(task_.wheels) * block_lanes);
  bytes(active);
  std::copy_n(active.begin(), static_cast<std::size_t>(task_.wheels) * block_lanes, task_.active);
  bytes(length_before_, contraction_, last_time_, time_before_);
  if (bytes.reads()) placed_ = false;
}

}  // namespace traverse::engine
