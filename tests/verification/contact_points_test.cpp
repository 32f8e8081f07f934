// The running surface under wheels: its position, velocity and acceleration along their paths.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/small_track.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

/// A quantity and its first and second rate.
using Path = std::array<double, 3>;

constexpr const char* rates[] = {"contact_position", "contact_velocity", "contact_acceleration"};

/// The largest difference of each rate of y from the exact path over the times, relative to the largest exact value.
template <class Exact>
std::array<double, 3> errors(Results& run, const std::string& wheel, Exact exact, double from, double to) {
  const std::vector<double> time = run.time();
  std::array<double, 3> error{}, largest{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double> y = run.column(wheel + rates[k], 1);
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (time[i] < from || time[i] > to) continue;
      const double value = exact(time[i])[k];
      error[k] = std::max(error[k], std::abs(y[i] - value));
      largest[k] = std::max(largest[k], std::abs(value));
    }
    EXPECT_GT(largest[k], 0.0);
    error[k] /= largest[k];
  }
  return error;
}

/// A mass of 10 t on a soft spring with its weight as preload, on a small wheel of 0.1 kg: the force is constant to
/// 1e-6.
constexpr double force = 1.00001e4 * 9.81, span = 25.0, stiffness = 8.323e9, mass = 2303.0, lag = 2e-5, speed = 40.0;

std::string constant_force(int elements) {
  return fmt::format(R"(
beam: {{spans: {}, EI: {}, mass: {}, rayleigh: [0.0, {}], elements_per_span: {}}}
support: {{types: [pinned, roller]}}
vehicle:
  mass:
    bodies: [axle, body]
    joints: [guide]
    springs: [spring]
    wheels: [wheel]
    drivers: [level]
    axle: {{mass: 0.1, inertia: 1.0, position: [0.0, 0.5]}}
    body: {{mass: 1.0e4, inertia: 1.0, position: [0.0, 1.5]}}
    guide: {{type: prismatic, bodies: [axle, body], point: [0.0, 1.0], axis: [0.0, 1.0]}}
    spring: {{bodies: [body, axle], from: [0.0, 1.5], to: [0.0, 0.5], stiffness: 1.0, preload: -9.81e4}}
    wheel: {{body: axle, radius: 0.02, law: linear, stiffness: 1.0e9}}
    level: {{body: axle, coordinate: phi}}
train: {{vehicles: mass, positions: 0.0, speed: {}}}
output: {{interval: 1.0e-3, contact_points: true}}
)",
                     span, stiffness, mass, lag, elements, speed);
}

/// The path under a constant force on a simple span with damping b K that is at rest before: modes driven by sines.
Path under_constant_force(double t) {
  using Complex = std::complex<double>;
  Path sum{};
  for (int n = 1; n <= 400; ++n) {
    const double beta = n * pi / span, omega2 = std::pow(beta, 4) * stiffness / mass, drive = beta * speed;
    const Complex root = std::sqrt(Complex(0.25 * lag * lag * omega2 * omega2 - omega2));
    const Complex l1 = -0.5 * lag * omega2 + root, l2 = -0.5 * lag * omega2 - root;
    const Complex steady = -2.0 * force / (mass * span) / Complex(omega2 - drive * drive, lag * omega2 * drive);
    // The imaginary part of steady*exp(i drive t), and free terms with the opposite value and rate at t = 0.
    const double value = -steady.imag(), rate = -drive * steady.real();
    const Complex a1 = (rate - l2 * value) / (l1 - l2), a2 = value - a1;
    Path q{};
    for (int k = 0; k < 3; ++k)
      q[k] = (steady * std::pow(Complex(0.0, drive), k) * std::exp(Complex(0.0, drive * t))).imag() +
             (a1 * std::pow(l1, k) * std::exp(l1 * t) + a2 * std::pow(l2, k) * std::exp(l2 * t)).real();
    const double s = std::sin(drive * t), c = drive * std::cos(drive * t);
    sum[0] += q[0] * s;
    sum[1] += q[1] * s + q[0] * c;
    sum[2] += q[2] * s + 2.0 * q[1] * c - q[0] * drive * drive * s;
  }
  return sum;
}

// By mechanisms and by linear vehicles, with the elements' deflection between their nodes. The damping delays it, which
// the wheel neglects: the error of the acceleration that remains decreases with the mesh.
TEST(ContactPoints, UnderAConstantForceOnASimpleSpan) {
  for (const char* vehicles : {"full", "linear"}) {
    SCOPED_TRACE(vehicles);
    double coarse = 0.0;
    for (const int elements : {40, 160}) {
      Results run = run_yaml(constant_force(elements),
                             {{"model_vehicles", vehicles}, {"ts_dt", "1e-4"}, {"contact_seats", "true"}});
      const std::array<double, 3> error = errors(run, "/vehicles/0/wheel/", under_constant_force, 0.05, 0.6);
      for (std::size_t k = 0; k < 3; ++k)
        RecordProperty(fmt::format("{}_{}_{}", rates[k], vehicles, elements), text(error[k]));
      EXPECT_LT(error[0], 1e-5);
      EXPECT_LT(error[1], 5e-5);
      if (elements == 40) coarse = error[2];
      if (elements == 160) {
        EXPECT_LT(error[2], 1e-4);
        EXPECT_LT(error[2], 0.5 * coarse);
      }
    }
  }
}

/// A wheel on the bump of a rigid track.
std::string on_bump(const std::string& train) {
  return R"(
track: {profile: bump, bump_start: 5.0, bump_length: 10.0, bump_height: 0.02}
vehicle:
  mass:
    bodies: [axle]
    wheels: [wheel]
    drivers: [level]
    axle: {mass: 1.0e3, inertia: 1.0, position: [0.0, 0.5]}
    wheel: {body: axle, radius: 0.5, law: linear, stiffness: 1.0e8}
    level: {body: axle, coordinate: phi}
output: {interval: 5.0e-3, contact_points: true}
ts: {max_time: 0.9}
train: {vehicles: mass, positions: 0.0, )" +
         train + "}\n";
}

// A sine under a constant speed and under a constant deceleration, inside the bump: exact.
TEST(ContactPoints, OnASineOfARigidTrack) {
  constexpr double k = 2.0 * pi / 10.0, half = 0.01, v = 20.0;
  const TemporaryFolder folder;
  const std::string law = folder.write("law.csv", "0,20\n2.5,0\n");
  for (const double a : {0.0, -8.0}) {
    SCOPED_TRACE(a);
    const auto exact = [&](double t) {
      const double x = v * t + 0.5 * a * t * t - 5.0, rate = v + a * t;
      return Path{half * (1.0 - std::cos(k * x)), half * k * std::sin(k * x) * rate,
                  half * k * (k * std::cos(k * x) * rate * rate + std::sin(k * x) * a)};
    };
    Results run = run_yaml(on_bump(a == 0.0 ? "speed: 20" : "speed_file: " + law));
    const std::array<double, 3> of_rates = errors(run, "/vehicles/0/wheel/", exact, 0.27, 0.74);
    for (std::size_t rate = 0; rate < 3; ++rate) {
      const double error = of_rates[rate];
      RecordProperty(fmt::format("{}_{}", rates[rate], a == 0.0 ? "constant" : "slower"), text(error));
      EXPECT_LT(error, 1e-9);
    }
    const std::vector<double> time = run.time();
    const std::vector<double> x = run.column("/vehicles/0/wheel/contact_position"),
                              speed_x = run.column("/vehicles/0/wheel/contact_velocity"),
                              acceleration_x = run.column("/vehicles/0/wheel/contact_acceleration");
    for (std::size_t i = 0; i < time.size(); ++i) {
      EXPECT_NEAR(x[i], v * time[i] + 0.5 * a * time[i] * time[i], 1e-9);
      EXPECT_NEAR(speed_x[i], v + a * time[i], 1e-9);
      EXPECT_NEAR(acceleration_x[i], a, 1e-8);
    }
  }
}

/// The largest difference of the central differences of a series from its rate, over the largest rate, for 2 < x < 10
/// m.
double off_the_rate(const std::vector<double>& x, const std::vector<double>& series, const std::vector<double>& rate,
                    double h) {
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 2; i + 2 < rate.size(); ++i) {
    if (x[i] < 2.0 || x[i] > 10.0) continue;
    const double slope = (8.0 * (series[i + 1] - series[i - 1]) - (series[i + 2] - series[i - 2])) / (12.0 * h);
    worst = std::max(worst, std::abs(slope - rate[i]));
    largest = std::max(largest, std::abs(rate[i]));
  }
  return worst / largest;
}

/// A coach on a rough track, for 0.3 s. `track`: of its bridge.
std::string coach(const std::string& track) {
  return R"(
beam: {spans: 12.0, EI: 4.0e9, mass: 8.0e3, rayleigh: [0.5, 1.0e-4]}
vehicle:
  coach: {file: )" +
         source_folder() + R"(/options/vehicles/manchester.yml}
train: {vehicles: coach, positions: -9.0, speed: 60.0}
output: {interval: 5.0e-5, contact_points: true}
ts: {dt: 5.0e-5, max_time: 0.3}
)" + track;
}

/// Compares the rates of y of two wheels with central differences of the stored series.
void expect_rates(Results& run, const std::string& name, const std::array<double, 2>& bounds) {
  for (const std::string wheel : {"/vehicles/0/wheel_1/", "/vehicles/0/wheel_2/"})
    for (std::size_t k = 0; k < 2; ++k) {
      const double off = off_the_rate(run.column(wheel + rates[0]), run.column(wheel + rates[k], 1),
                                      run.column(wheel + rates[k + 1], 1), 5e-5);
      testing::Test::RecordProperty(name + wheel.substr(12, 7) + "_" + rates[k + 1], text(off));
      EXPECT_LT(off, bounds[k]) << wheel << rates[k + 1];
    }
}

// On a layered track, whose rail deflects between its nodes. Its highest vibrations, at some kilohertz, and the jumps
// of its curvature at nodes disturb the differences of velocities.
TEST(ContactPoints, RatesOfSeriesOnALayeredTrack) {
  const std::string track = track_of(zhai_layers, "  profile: german_low\n  approach: 40.0\n  elements_per_bay: 4\n");
  for (const char* vehicles : {"full", "linear"}) {
    SCOPED_TRACE(vehicles);
    Results run = run_yaml(coach(track), {{"model_vehicles", vehicles}});
    expect_rates(run, vehicles, {1e-4, 5e-2});
  }
}

TEST(ContactPoints, RatesOfSeriesOnABridgeByModes) {
  Results run = run_yaml(coach("track: {profile: german_low}\n"),
                         {{"model_modes", "6"}, {"model_vehicles", "linear"}, {"beam_elements_per_span", "48"}});
  expect_rates(run, "modes", {1e-6, 5e-4});
}

// On a level track the wheel at a station of the rail, here 14 m before the bridge, has the deflection that is stored
// for this station, which contains that under the wheel's force.
TEST(ContactPoints, AreTheRailAtItsStations) {
  const std::string track = track_of(zhai_layers, "  approach: 40.0\n  offset: 0.1\n  elements_per_bay: 4\n");
  Results run = run_yaml(coach(track), {{"train_positions", "-9.22"},  // the last wheel at -20 m
                                        {"output_rail", "-14.0,20.0"},
                                        {"output_interval", "0.02"},
                                        {"ts_dt", "1e-4"}});
  const std::size_t sample = 5;
  const std::vector<double> x = run.column("/vehicles/0/wheel_4/contact_position"),
                            y = run.column("/vehicles/0/wheel_4/contact_position", 1),
                            rail = run.column("/rail/stations/deflection");
  EXPECT_EQ(run("/rail/stations/x"), std::vector<double>({-14.0, 20.0}));
  ASSERT_NEAR(x[sample], -14.0, 1e-4);  // the bogie has turned a little
  EXPECT_LT(rail[sample], -3e-4);
  RecordProperty("difference", text(y[sample] / rail[sample] - 1.0));
  EXPECT_NEAR(y[sample], rail[sample], 1e-5 * std::abs(rail[sample]));
}

TEST(ContactPoints, AreUnknownBeyondAFreeEnd) {
  Results run = run_scene("launcher", {{"output_contact_points", "true"}});
  const double end = run("/supports/x").back();
  const std::vector<double> x = run.column("/vehicles/0/rear/contact_position"),
                            y = run.column("/vehicles/0/rear/contact_position", 1);
  EXPECT_GT(x.back(), end);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(std::isnan(y[i]), x[i] > end) << x[i];
}

// The stored profile of the track and of trains with surfaces of their own: exact heights, where their wheels have run.
TEST(StoredProfiles, AreThoseUnderTheWheels) {
  Results run = run_yaml(on_bump("speed: 20"), {{"output_profile", "0.25"}});
  const std::vector<double> x = run("/track/profile/x"), height = run("/track/profile/height");
  EXPECT_NEAR(x.front(), -2.0, 1e-12);
  EXPECT_NEAR(x.back(), 20.0 * 0.9 + 2.0, 0.25);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i], x.front() + 0.25 * static_cast<double>(i), 1e-12);
    const double inside = x[i] > 5.0 && x[i] < 15.0 ? 0.01 * (1.0 - std::cos(2.0 * pi * (x[i] - 5.0) / 10.0)) : 0.0;
    EXPECT_NEAR(height[i], inside, 1e-15);
  }
  const std::string bumps = on_bump("speed: 20");
  Results two = run_yaml(bumps.substr(0, bumps.find("train:")) +
                             "trains: [up, down]\n"
                             "up: {vehicles: mass, positions: 0.0, speed: 20}\n"
                             "down: {vehicles: mass, positions: 30.0, speed: -10, profile: bump, bump_start: 22.0,"
                             " bump_length: 4.0, bump_height: -0.004}\n",
                         {{"output_profile", "auto"}});
  const std::vector<double> of_track = two("/track/profile/height"), of_train = two("/track/profile_of/down/height");
  EXPECT_NEAR(*std::max_element(of_track.begin(), of_track.end()), 0.02, 1e-12);
  EXPECT_NEAR(*std::min_element(of_train.begin(), of_train.end()), -0.004, 1e-6);
  EXPECT_NEAR(two("/track/profile_of/down/x").front(), 30.0 - 10.0 * 0.9 - 2.0, 1e-9);
}

}  // namespace
}  // namespace traverse::test
