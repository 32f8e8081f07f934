#include "lanes/train_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "train/linearisation_residual.hpp"
#include "traverse/base/error.hpp"

namespace traverse::lanes {
namespace {

constexpr double same = 1e-9;  // of the largest entry: vehicles are alike, but for rounding
constexpr double stations_a_wave = 40.0, most_stations = 2e7;
constexpr double most_off = 2e-9;    // m: of a track between its stations; a wheel on steel feels a few N of that
constexpr int checked_places = 200;  // along the track

std::vector<double> by_rows(const Eigen::MatrixXd& A) {
  std::vector<double> numbers;
  const double none = 1e-14 * A.cwiseAbs().maxCoeff();  // what rounding leaves of a zero
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < A.cols(); ++j) numbers.push_back(std::abs(A(i, j)) > none ? A(i, j) : 0.0);
  return numbers;
}

bool alike(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  for (const double value : a) scale = std::max(scale, std::abs(value));
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](double x, double y) { return std::abs(x - y) <= same * scale; });
}

bool alike(const VehicleNumbers& a, const VehicleNumbers& b, double weight) {
  return a.freedom == b.freedom && a.wheels == b.wheels && alike(a.M, b.M, 0.0) && alike(a.C, b.C, 0.0) &&
         alike(a.K, b.K, 0.0) && alike(a.G, b.G, 0.0) && alike(a.G_along, b.G_along, 0.0) && alike(a.r0, b.r0, weight);
}

VehicleNumbers numbers_of(train::MovingVehicle& vehicle) {
  const train::LinearMatrices of = vehicle.dynamics->linear()->matrices();
  VehicleNumbers v;
  v.freedom = vehicle.freedom();
  v.wheels = static_cast<int>(vehicle.wheels.size());
  v.M = by_rows(of.M);
  v.C = by_rows(of.C);
  v.K = by_rows(of.K);
  v.r0.assign(of.r0.begin(), of.r0.end());
  const auto rows_of_wheels = [&](Eigen::Index coordinate) {
    Eigen::MatrixXd G(v.wheels, v.freedom);
    for (int j = 0; j < v.wheels; ++j)
      G.row(j) = of.B.row(3 * static_cast<Eigen::Index>(vehicle.wheels[static_cast<std::size_t>(j)].body) + coordinate);
    return by_rows(G);
  };
  v.G_along = rows_of_wheels(0);
  v.G = rows_of_wheels(1);
  v.bend = train::residual_roots(vehicle);
  v.driven.assign(of.driven.begin(), of.driven.end());
  return v;
}

/// Of every coordinate its rate at the start, but for the steady motion, over the speed.
std::vector<double> follow_of(const train::MovingVehicle& vehicle) {
  const Eigen::VectorXd& qd = vehicle.state.qd;
  const double speed = qd[3 * static_cast<Eigen::Index>(vehicle.wheels.front().body)];
  std::vector<double> follow(static_cast<std::size_t>(vehicle.freedom()), 0.0);
  for (std::size_t i = 0; i < follow.size() && speed != 0.0; ++i)
    follow[i] = (qd[vehicle.mechanism.partition().independent[i]] -
                 vehicle.dynamics->linear()->matrices().c[static_cast<Eigen::Index>(i)]) /
                speed;
  return follow;
}

/// The height of the lowest point of a wheel at x that rolls on the profile, whose height is h there, and its slope. It
/// touches `ahead` of its centre, where the profile's slope is that of the circle.
std::array<double, 2> rolled(const track::Profile& profile, double radius, double x, track::Height h) {
  double ahead = radius * h.slope / (1.0 - radius * h.curvature);
  double height = h.value + ahead * (h.slope + 0.5 * ahead * h.curvature), slope = h.slope + ahead * h.curvature;
  if (!profile.is_rough() || profile.has_dip(x - radius, x + radius)) {
    // Corners and short bumps: the profile itself, until the place is exact.
    for (int i = 0; i < 30; ++i) {
      h = profile.at(x + ahead);
      const double up = std::sqrt(radius * radius - ahead * ahead);
      const double step = (h.slope - ahead / up) / (radius * radius / (up * up * up) - h.curvature);
      if (std::abs(step) <= 1e-14) break;
      ahead = std::clamp(ahead + step, -0.5 * radius, 0.5 * radius);
    }
    height = h.value;
    slope = h.slope;
  }
  return {height + std::sqrt(radius * radius - ahead * ahead) - radius, slope};
}

std::array<double, 2> rolled(const track::Profile& profile, double radius, double x) {
  return rolled(profile, radius, x, profile.at(x));
}

/// By how much the cubic between the stations before and behind x may miss the wheel's height, m: in its middle, and in
/// its quarters, where it is off when a corner lies in the middle.
double off_at(const track::Profile& profile, double radius, const TrackNumbers& track, double x) {
  const double d = track.distance, left = track.start + std::floor((x - track.start) / d) * d;
  const auto a = rolled(profile, radius, left), b = rolled(profile, radius, left + d);
  double off = 0.0;
  for (const double u : {0.25, 0.5, 0.75}) {
    const double v = 1.0 - u;
    const double cubic =
        v * v * ((1.0 + 2.0 * u) * a[0] + u * d * a[1]) + u * u * ((1.0 + 2.0 * v) * b[0] - v * d * b[1]);
    off = std::max(off, std::abs(rolled(profile, radius, left + u * d)[0] - cubic));
  }
  return off;
}

/// The largest of these at the profile's kinks and sharpest place and at some places between.
double off_between_stations(const track::Profile& profile, double radius, const TrackNumbers& track, double to) {
  double off = 0.0;
  std::vector<double> kinks = profile.kinks();
  kinks.push_back(profile.sharpest_place(track.start, to));
  for (const double kink : kinks)
    for (const double beside : {-0.5, 0.0, 0.5})
      if (kink > track.start && kink < to)
        off = std::max(off, off_at(profile, radius, track, kink + beside * track.distance));
  for (int i = 0; i < checked_places; ++i)
    off = std::max(off, off_at(profile, radius, track, track.start + (to - track.start) * (i + 0.5) / checked_places));
  return off;
}

}  // namespace

std::string obstacle(const train::Fleet& fleet) {
  if (!fleet.pairs.empty()) return "bodies of its vehicles touch each other";
  for (const train::MovingVehicle& vehicle : fleet.vehicles) {
    const auto no = [&](const std::string& why) { return fmt::format("vehicle '{}': {}", vehicle.name(), why); };
    if (vehicle.dynamics->linear() == nullptr) return no("it is not taken as linear");
    if (!vehicle.mechanism.model().actuators.empty()) return no("actuators act on it");
    for (const train::Wheel& wheel : vehicle.wheels) {
      const auto its = [&](const char* why) { return no(fmt::format("its wheel '{}' {}", wheel.name, why)); };
      if (wheel.law.damping != 0.0 || wheel.law.hysteresis) return its("has a contact with damping");
      if (wheel.law.friction != 0.0) return its("has a contact with friction");
      if (!wheel.shape.round()) return its("is out of round");
      if (wheel.radius != fleet.vehicles.front().wheels.front().radius) return its("has another radius than others");
    }
  }
  for (const train::WheelContact& wheel : fleet.wheels)
    if (wheel.sharp) return "a wheel may touch the track at several points";
  return {};
}

TrainNumbers train_numbers(train::Fleet& fleet) {
  TrainNumbers train;
  for (train::MovingVehicle& vehicle : fleet.vehicles) {
    const std::vector<double> follow = follow_of(vehicle);
    train.follow.insert(train.follow.end(), follow.begin(), follow.end());
    VehicleNumbers own = numbers_of(vehicle);
    const auto kind = std::find_if(train.kinds.begin(), train.kinds.end(),
                                   [&](const VehicleNumbers& known) { return alike(known, own, vehicle.scale); });
    train.vehicles.push_back(
        {static_cast<std::size_t>(kind - train.kinds.begin()), vehicle.offset, static_cast<int>(train.x.size())});
    if (kind == train.kinds.end()) train.kinds.push_back(std::move(own));
    for (std::size_t j = 0; j < vehicle.wheels.size(); ++j) {
      const train::WheelContact& contact = fleet.wheels[static_cast<std::size_t>(vehicle.first_wheel) + j];
      train.x.push_back(fleet.coordinates(contact).x());
      train.penetration.push_back(contact.kinematics.penetration);
      train.arm.push_back(vehicle.wheels[j].radius - contact.kinematics.penetration);
      train.stiffness.push_back(contact.law.stiffness);
      train.hertz.push_back(contact.law.kind == contact::LawKind::hertz ? 1 : 0);
      train.force_scale = std::max(train.force_scale, contact.force.normal);
    }
  }
  train.coordinates = fleet.freedom();
  train.radius = fleet.vehicles.front().wheels.front().radius;
  return train;
}

double defect(train::Fleet& fleet, const std::vector<double>& x) {
  double largest = 0.0;
  for (train::MovingVehicle& vehicle : fleet.vehicles)
    largest = std::max(largest, train::linearisation_residual_at(vehicle, x.data() + vehicle.offset));
  return largest;
}

double track_distance(const track::Profile& profile, double radius, double from, double to) {
  TrackNumbers track;
  if (profile.level()) return track.distance;
  track.start = from;
  track.distance = std::min(profile.resolution(), profile.shortest_wave() / stations_a_wave);
  while (off_between_stations(profile, radius, track, to) > most_off) {
    track.distance *= 0.5;
    if ((to - from) / track.distance > most_stations)
      throw InputError("sweep_lanes: the track has corners that runs side by side cannot follow; allowed: 0");
  }
  if (!((to - from) / track.distance + 2.0 < most_stations))
    throw InputError("sweep_lanes: so long and so fine a track does not fit into memory beside others; allowed: 0");
  return track.distance;
}

TrackNumbers track_numbers(const track::Profile& profile, double radius, double from, double to, double distance) {
  TrackNumbers track;
  if (profile.level()) return track;
  track.start = from;
  track.distance = distance;
  const double stations = std::ceil((to - from) / distance) + 1.0;
  const std::vector<track::Height> heights = profile.along(from, distance, static_cast<std::size_t>(stations));
  track.values.reserve(2 * heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = from + static_cast<double>(i) * distance;
    const auto [height, slope] = rolled(profile, radius, x, heights[i]);
    track.values.push_back(height);
    track.values.push_back(slope * distance);
  }
  return track;
}

}  // namespace traverse::lanes
