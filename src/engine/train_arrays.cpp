// Stores vehicles and wheels in rows.
#include "engine/train_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "train/linear_dynamics.hpp"

namespace traverse::engine {
namespace {

constexpr double least_before =
    1e-3;  // least previous step relative to the present one: from a shorter one rounding would be extrapolated
constexpr double same = 1e-13;  // relative to the largest entry: entries are equal except for rounding

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

/// Sets entries that are rounding errors to zero.
Eigen::MatrixXd without_rounding(const Eigen::MatrixXd& A) {
  const double zero = 1e-14 * A.cwiseAbs().maxCoeff();
  return A.unaryExpr([zero](double x) { return std::abs(x) > zero ? x : 0.0; });
}

void fill(double (&row)[most_lanes], double value) { std::fill_n(row, most_lanes, value); }

void fill_rule(StageRows& to, std::size_t lane, double h, double w_in_v, const base::Weights& a_in_v,
               const base::Weights& a_in_w) {
  to.w_in_v[lane] = h * w_in_v;
  for (int j = 0; j < most_kept; ++j) {
    to.a_in_v[j][lane] = h * h * a_in_v[static_cast<std::size_t>(j)];
    to.a_in_w[j][lane] = h * a_in_w[static_cast<std::size_t>(j)];
  }
}

/// Times with known contact forces, and the index of their history.
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

std::vector<std::vector<const train::MovingVehicle*>> TrainArrays::side_by_side(
    std::span<const train::MovingVehicle> vehicles) {
  const std::size_t most = best_width();
  std::vector<std::vector<const train::MovingVehicle*>> blocks;
  for (const train::MovingVehicle& vehicle : vehicles) {
    auto block = std::find_if(blocks.begin(), blocks.end(), [&](const auto& candidates) {
      return candidates.size() < most && in_block_with(*candidates.front(), vehicle);
    });
    if (block == blocks.end()) block = blocks.emplace(block);
    block->push_back(&vehicle);
  }
  return blocks;
}

TrainArrays::TrainArrays(std::span<const std::vector<const train::MovingVehicle*>> vehicles, int per_node,
                         double surface_height) {
  task.per_node = per_node;
  task.surface_height = surface_height;
  blocks.resize(vehicles.size());
  for (std::size_t block = 0; block < blocks.size(); ++block) fill_block(block, vehicles[block]);
  task.blocks = static_cast<int>(blocks.size());
  task.block = blocks.data();
  make_rows(vehicles);
}

void TrainArrays::set_rules(const base::Method& method, std::span<const double> h) {
  task.stages = static_cast<int>(method.stages.size());
  task.known = method.step.known;
  for (std::size_t lane = 0; lane < h.size(); ++lane) {
    for (std::size_t s = 0; s < method.stages.size(); ++s) {
      const base::StageRule& rule = method.stages[s];
      StageRows& to = task.stage[s];
      fill_rule(to, lane, h[lane], rule.w_in_v, rule.a_in_v, rule.a_in_w);
      to.rate[lane] = h[lane] * rule.rate;
      to.displacement[lane] = h[lane] * h[lane] * rule.displacement;
    }
    fill_rule(task.end, lane, h[lane], method.step.w_in_v, method.step.a_in_v, method.step.a_in_w);
  }
  for (std::size_t j = 0; j < most_kept; ++j) task.a_next[j] = method.step.a_next[j];
}

void TrainArrays::set_guesses(const base::Method& method, double before) {
  for (std::size_t s = 0; s < method.stages.size(); ++s) {
    Instants known;
    for (std::size_t j = 0; j < s; ++j) known.add(method.stages[j].time, static_cast<int>(j));
    known.add(0.0, most_stages);
    if (s < 2 && before > least_before * method.stages.back().time) known.add(-before, most_stages + 1);
    for (auto& row : task.stage[s].guess) fill(row, 0.0);
    for (std::size_t i = 0; i < known.count; ++i)
      fill(task.stage[s].guess[known.history[i]], known.weight(i, method.stages[s].time));
  }
}

void TrainArrays::start_contact(std::size_t at, const train::WheelContact& c) {
  const double force = c.force.normal;
  task.normal[at] = force;
  task.normal_up[at] = -c.touch.normal_on_body.y();
  task.normal_along[at] = -c.touch.normal_on_body.x();
  task.force_up[at] = force * task.normal_up[at];
  task.force_along[at] = force * task.normal_along[at];
  task.ahead[at] = task.ahead_before[at] = c.touch.ahead;
  task.root[at] = force > 0.0 ? std::cbrt(force / c.law.stiffness) : 1e-3;
  for (const int j : {most_stages, most_stages + 1}) task.history[j][at] = force;
}

double* TrainArrays::add(std::size_t rows) {
  numbers_.push_back(std::make_unique<Aligned>(rows * lanes));
  return numbers_.back()->data();
}

int* TrainArrays::add_integers(std::size_t rows) {
  integers_.push_back(std::make_unique<std::vector<int>>(std::max<std::size_t>(rows, 1)));
  return integers_.back()->data();
}

/// The entries that are non-zero in some lane.
SparseRows TrainArrays::sparse(const std::vector<Eigen::MatrixXd>& of_lanes) {
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
    for (std::size_t l = 0; l < of_lanes.size(); ++l) value[e * lanes + l] = of_lanes[l](i, j);
  }
  to.row = row;
  to.column = column;
  to.value = value;
  return to;
}

PairedRows TrainArrays::paired(const std::vector<Eigen::MatrixXd>& A, const std::vector<Eigen::MatrixXd>& B) {
  const auto n = static_cast<std::size_t>(A.front().rows());
  std::vector<std::vector<Eigen::Index>> columns(n);
  std::size_t width = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const auto is_entry = [&](Eigen::Index j) {
      const auto is_nonzero = [&](const Eigen::MatrixXd& of) { return of(static_cast<Eigen::Index>(i), j) != 0.0; };
      return std::any_of(A.begin(), A.end(), is_nonzero) || std::any_of(B.begin(), B.end(), is_nonzero);
    };
    for (Eigen::Index j = 0; j < A.front().cols(); ++j)
      if (is_entry(j)) columns[i].push_back(j);
    width = std::max(width, columns[i].size());
  }
  int* column = add_integers(n * width);
  double *one = add(n * width), *other = add(n * width);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < columns[i].size(); ++k) {
      const std::size_t e = i * width + k;
      column[e] = static_cast<int>(columns[i][k]);
      for (std::size_t l = 0; l < A.size(); ++l) {
        one[e * lanes + l] = A[l](static_cast<Eigen::Index>(i), columns[i][k]);
        other[e * lanes + l] = B[l](static_cast<Eigen::Index>(i), columns[i][k]);
      }
    }
  return {static_cast<int>(width), column, one, other};
}

void TrainArrays::move(std::size_t block, std::size_t lane, const base::TimeFunction& travel, double t) {
  rate[block][lane] = travel.rate(t);
  distance[block][lane] = per_travel[block][lane] * travel.value(t);
  speed[block][lane] = per_travel[block][lane] * rate[block][lane];
  acceleration[block][lane] = travel.acceleration(t);
}

void TrainArrays::fill_block(std::size_t number, const std::vector<const train::MovingVehicle*>& vehicles) {
  VehicleBlock& b = blocks[number];
  const train::MovingVehicle& any = *vehicles.front();
  const auto f = static_cast<std::size_t>(any.freedom()), m = any.wheels.size();
  b.freedom = static_cast<int>(f);
  b.wheels = static_cast<int>(m);
  b.first_coordinate = task.coordinates;
  b.first_wheel = task.wheels;
  task.coordinates += b.freedom;
  task.wheels += b.wheels;
  double *M = add(f * f), *r0 = add(f), *driven = add(f), *driven_mass = add(1), *drive = add(1);
  for (auto* of : {&rate, &acceleration, &distance, &speed, &per_travel}) of->push_back(add(1));
  for (std::size_t i = 0; i < f; ++i)  // lanes without a vehicle
    std::fill_n(M + (i * f + i) * lanes, lanes, 1.0);
  std::vector<Eigen::MatrixXd> C, K, G, G_along;
  for (std::size_t l = 0; l < vehicles.size(); ++l) {
    const train::MovingVehicle& vehicle = *vehicles[l];
    const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
    C.push_back(without_rounding(of.C));
    K.push_back(without_rounding(of.K));
    G.push_back(without_rounding(rows_of_wheels(vehicle, 1)));
    G_along.push_back(without_rounding(rows_of_wheels(vehicle, 0)));
    const bool drives = !vehicle.mechanism.model().drivers.empty();
    per_travel[number][l] = of.u[3 * static_cast<Eigen::Index>(vehicle.wheels.front().body)];
    drive[l] = drives ? per_travel[number][l] : 0.0;
    driven_mass[l] = drives ? of.driven_mass : 0.0;
    move(number, l, vehicle.travel, 0.0);
    for (std::size_t i = 0; i < f; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      r0[i * lanes + l] = of.r0[row];
      driven[i * lanes + l] = drives ? of.driven[row] : 0.0;
      for (std::size_t j = 0; j < f; ++j) M[(i * f + j) * lanes + l] = of.M(row, static_cast<Eigen::Index>(j));
    }
  }
  b.C = sparse(C);
  b.K = sparse(K);
  b.G = sparse(G);
  b.G_along = sparse(G_along);
  b.K_and_C = paired(K, C);
  b.both_G = paired(G, G_along);
  b.M = M;
  b.r0 = r0;
  b.driven = driven;
  b.driven_mass = driven_mass;
  b.drive = drive;
  b.rate = rate.back();
  b.acceleration = acceleration.back();
  b.distance = distance.back();
  b.speed = speed.back();
  b.active = &active.emplace_back(1);
  const auto end_of_earlier = blocks.begin() + static_cast<std::ptrdiff_t>(number);
  const auto other = std::find_if(blocks.begin(), end_of_earlier,
                                  [&](const VehicleBlock& before) { return equal_matrices(before, b); });
  if (other != end_of_earlier) {
    b.same_as = static_cast<int>(other - blocks.begin());
    b.C = other->C;
    b.K_and_C = other->K_and_C;
    b.both_G = other->both_G;
    b.inverse = other->inverse;
    b.Y = other->Y;
    b.Y_along = other->Y_along;
    b.H = other->H;
    return;
  }
  b.inverse = add(f * f);
  b.Y = add(f * m);
  b.Y_along = add(f * m);
  b.H = add(4 * m * m);
}

/// Whether two blocks have the same matrices except for rounding.
bool TrainArrays::equal_matrices(const VehicleBlock& a, const VehicleBlock& b) const {
  const auto nearly_equal = [&](const double* x, const double* y, int rows) {
    const std::size_t n = static_cast<std::size_t>(rows) * lanes;
    double largest = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      largest = std::max(largest, std::abs(x[i]));
      difference = std::max(difference, std::abs(x[i] - y[i]));
    }
    return difference <= same * largest;
  };
  const auto equal_entries = [&](const SparseRows& x, const SparseRows& y) {
    return x.count == y.count && std::equal(x.row, x.row + x.count, y.row) &&
           std::equal(x.column, x.column + x.count, y.column) && nearly_equal(x.value, y.value, x.count);
  };
  return a.same_as < 0 && a.freedom == b.freedom && a.wheels == b.wheels &&
         nearly_equal(a.M, b.M, a.freedom * a.freedom) && equal_entries(a.C, b.C) && equal_entries(a.K, b.K) &&
         equal_entries(a.G, b.G) && equal_entries(a.G_along, b.G_along);
}

void TrainArrays::make_rows(std::span<const std::vector<const train::MovingVehicle*>> vehicles) {
  const auto coordinates = static_cast<std::size_t>(task.coordinates), wheels = static_cast<std::size_t>(task.wheels);
  for (double** of : {&task.x, &task.w, &task.w_predicted, &task.a_free}) *of = add(coordinates);
  for (double*& a : task.a) a = add(coordinates);
  double *place = add(wheels), *height = add(wheels), *radius = add(wheels), *stiffness = add(wheels),
         *per_scale = add(wheels);
  for (double** of : {&task.up,
                      &task.along,
                      &task.from,
                      &task.to,
                      &task.h,
                      &task.h_x,
                      &task.h_xx,
                      &task.profile_station,
                      &task.normal,
                      &task.root,
                      &task.normal_up,
                      &task.normal_along,
                      &task.force_up,
                      &task.force_along,
                      &task.turn,
                      &task.local_compliance,
                      &task.ahead,
                      &task.ahead_before,
                      &task.station,
                      &task.penetration,
                      &task.penetration_rate,
                      &task.up_rate,
                      &task.along_rate,
                      &task.least,
                      &task.largest})
    *of = add(wheels);
  for (double*& history : task.history) history = add(wheels);
  task.active = add_integers(wheels * lanes);
  task.dissipated = add(most_kept);
  task.drive_power = add(most_kept);
  hertz_.assign(wheels, 1);
  touches_two_patches.assign(wheels, 0);
  level.assign(wheels, 1);
  // Lanes without a vehicle: wheels far above level ground.
  for (std::size_t i = 0; i < wheels * lanes; ++i) {
    radius[i] = stiffness[i] = per_scale[i] = 1.0;
    task.h[i] = no_surface;
    task.from[i] = -infinite;
    task.to[i] = infinite;
    task.root[i] = 1e-3;
    task.normal_up[i] = 1.0;
  }
  for (SurfacePatch& p : task.patch) {
    p.slot = add_integers(wheels * lanes);
    p.slot_order = add_integers(wheels);
    for (double** of : {&p.x, &p.length, &p.per_length, &p.shear, &p.flexibility, &p.low, &p.high}) *of = add(wheels);
    for (double*& entry : p.compliance) entry = add(wheels);
    for (double* of : {p.length, p.per_length}) std::fill_n(of, wheels * lanes, 1.0);
    const bool first = &p == task.patch;
    std::fill_n(p.low, wheels * lanes, first ? -infinite : 1.0);
    std::fill_n(p.high, wheels * lanes, first ? infinite : -1.0);
  }
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const VehicleBlock& b = blocks[k];
    for (std::size_t lane = 0; lane < vehicles[k].size(); ++lane) {
      const train::MovingVehicle& vehicle = *vehicles[k][lane];
      const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
      for (std::size_t j = 0; j < vehicle.wheels.size(); ++j) {
        const train::Wheel& wheel = vehicle.wheels[j];
        const std::size_t row = static_cast<std::size_t>(b.first_wheel) + j, number = row * lanes + lane;
        const auto body = 3 * static_cast<Eigen::Index>(wheel.body);
        place[number] = of.q0[body];
        height[number] = of.q0[body + 1] - wheel.radius;
        radius[number] = wheel.radius;
        stiffness[number] = wheel.law.stiffness;
        per_scale[number] = 1.0 / vehicle.scale;
        hertz_[row] = wheel.law.kind == contact::LawKind::hertz ? 1 : 0;
      }
    }
  }
  task.place = place;
  task.height = height;
  task.radius = radius;
  task.stiffness = stiffness;
  task.per_scale = per_scale;
  task.hertz = hertz_.data();
  task.touches_two_patches = touches_two_patches.data();
  task.level = level.data();
}

}  // namespace traverse::engine
