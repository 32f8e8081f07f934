// Tuned mass dampers and point masses on a simply supported beam: against the receptance of the beam by its modes with
// what is attached, in steady motion and in natural frequencies; static forces; other engines and ranks.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double length = 30.0, EI = 1.0e9, mass = 761.5, ratio = 0.005;  // m, N m2, kg/m, 1
constexpr double damper_mass = 570.0, frequency = 1.9, damper_ratio = 0.13;
constexpr int modes = 400;

const std::string bridge =
    "beam: {spans: 30, EI: 1.0e9, mass: 761.5, damping_ratios: 0.005, elements_per_span: 16}\n"
    "support: {types: [pinned, roller]}\n";
const std::string damper = "beam_dampers: tmd\nbeam_tmd: {x: 15, mass: 570, frequency: 1.9, damping_ratio: 0.13}\n";

double omega_of(int n) { return std::pow(n * pi / length, 2) * std::sqrt(EI / mass); }

/// Deflection at one station per force at another one, m/N, at the angular frequency omega.
Complex receptance(double x, double at, double omega, double damping) {
  const double w1 = omega_of(1), w2 = omega_of(2), b = 2.0 * damping / (w1 + w2), a = w1 * w2 * b;
  Complex sum = 0.0;
  for (int n = 1; n <= modes; ++n) {
    const double w = omega_of(n);
    sum += std::sin(n * pi * x / length) * std::sin(n * pi * at / length) /
           Complex(w * w - omega * omega, omega * (a + b * w * w));
  }
  return sum / (0.5 * mass * length);
}

/// Force of the damper on the beam per deflection there, and its travel.
struct Attached {
  Complex force, travel;
  explicit Attached(double omega, double damping) {
    const double w = 2.0 * pi * frequency, k = damper_mass * w * w;
    const Complex carrier(k, omega * 2.0 * damping * w * damper_mass);
    travel = damper_mass * omega * omega / (carrier - damper_mass * omega * omega);
    force = carrier * travel;
  }
};

double largest_late(Results& run, const std::string& name) {
  const std::vector<double> time = run.time(), values = run.column(name);
  double largest = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] > 0.75 * time.back()) largest = std::max(largest, std::abs(values[i]));
  return largest;
}

// A force of 100 N at the first frequency of a footbridge, at midspan and beside it: the damper is at midspan.
TEST(MassDampers, SteadyMotion) {
  for (const double x : {15.0, 11.0}) {
    Results run = run_yaml(bridge + damper +
                               "load: {forces: 0, amplitude: 100, frequency: 2.0, speed: 0}\n"
                               "ts: {dt: 5.0e-3, max_time: 40}\noutput: {probes: 15, interval: 5.0e-3}\n",
                           {{"load_positions", text(x)}});
    const double omega = 2.0 * pi * 2.0;
    const Attached attached(omega, damper_ratio);
    const Complex deflection =
        100.0 * receptance(15.0, x, omega, ratio) / (1.0 - receptance(15.0, 15.0, omega, ratio) * attached.force);
    const double acceleration = omega * omega * std::abs(deflection);
    EXPECT_NEAR(largest_late(run, "/probes/acceleration"), acceleration, 1e-3 * acceleration) << x;
    const double travel = std::abs(attached.travel * deflection), force = std::abs(attached.force * deflection);
    EXPECT_NEAR(largest_late(run, "/dampers/travel"), travel, 1e-3 * travel) << x;
    EXPECT_NEAR(largest_late(run, "/dampers/force"), force, 1e-3 * force) << x;
    EXPECT_GE(run.attribute("/summary", "damper_tmd_travel"), travel * (1.0 - 1e-3));
    EXPECT_LT(energy_error(run), 1e-4);
  }
}

/// det of beam and attached mass, whose zeros are the natural frequencies: 1 - receptance * force.
double characteristic(double omega, double x, double force) {
  return 1.0 - receptance(x, x, omega, 0.0).real() * force;
}

TEST(MassDampers, NaturalFrequencies) {
  Results with = run_yaml(bridge + damper + "scene_analysis: modes\nmodes_count: 3\n",
                          {{"beam_tmd_damping_ratio", "0"}, {"beam_damping_ratios", "0"}});
  for (std::size_t i = 0; i < 3; ++i) {
    const double omega = 2.0 * pi * with("/modes/frequency")[i];
    const auto det = [&](double w) { return characteristic(w, 15.0, Attached(w, 0.0).force.real()); };
    if (i == 2) {  // the second mode of the beam has a node at the damper
      EXPECT_NEAR(omega, omega_of(2), 1e-4 * omega);
      continue;
    }
    EXPECT_LT(det(omega * (1.0 - 1e-5)) * det(omega * (1.0 + 1e-5)), 0.0) << omega / (2.0 * pi);
  }
}

TEST(MassDampers, PointMasses) {
  Results with = run_yaml(bridge + "beam_point_masses: {x: 11, mass: 3000}\nscene_analysis: modes\nmodes_count: 3\n");
  for (std::size_t i = 0; i < 3; ++i) {
    const double omega = 2.0 * pi * with("/modes/frequency")[i];
    const auto det = [&](double w) { return characteristic(w, 11.0, 3000.0 * w * w); };
    EXPECT_LT(det(omega * (1.0 - 1e-4)) * det(omega * (1.0 + 1e-4)), 0.0) << omega / (2.0 * pi);
  }
}

// The supports carry both kinds of masses; at rest a damper has no travel.
TEST(MassDampers, Weight) {
  Results run =
      run_yaml(bridge + damper +
               "beam_self_weight: true\nbeam_point_masses: {x: 10, mass: 3000}\n"
               "load: {forces: 1, positions: -5, speed: 10}\nts: {dt: 0.01, max_time: 0.02}\noutput: {probes: 15}\n");
  double sum = 0.0;
  for (std::size_t support = 0; support < 2; ++support) sum += run("/supports/reaction")[3 * support + 1];
  const double weight = 9.81 * (mass * length + damper_mass + 3000.0);
  EXPECT_NEAR(sum, weight, 1e-9 * weight);
  EXPECT_NEAR(run("/dampers/travel")[0], 0.0, 1e-12);
}

// The damping ratios are those of the beam without the damper.
TEST(MassDampers, LeaveTheBeamItsDamping) {
  const Values modes_of = {{"scene_analysis", "modes"}, {"modes_count", "2"}};
  Results with = run_yaml(bridge + damper, modes_of), without = run_yaml(bridge, modes_of);
  for (const char* name : {"rayleigh_a", "rayleigh_b"})
    EXPECT_NEAR(with.attribute("/modes", name), without.attribute("/modes", name),
                1e-9 * without.attribute("/modes", name));
}

const std::string coach = "vehicle_coach_file: " + source_folder() +
                          "/options/vehicles/s300.yml\ntrain: {vehicles: coach*2, spacing: 25.0}\n"
                          "model: {vehicles: linear}\nscene: {tail: 1}\noutput: {probes: [11, 15]}\n";

// Vehicles in batches and one by one.
TEST(MassDampers, InBatches) {
  const auto peaks = [&](const char* lanes) {
    Results sweep = run_yaml(bridge + damper + coach + "sweep: {speed: [40, 60, 10], refine: 0}\nts_dt: 2.5e-4\n",
                             {{"sweep_lanes", lanes}});
    return sweep("/sweep/peak_deflection");
  };
  EXPECT_LT(relative_difference(peaks("8"), peaks("0")), 1e-4);
}

// Moving forces by modes that the damper couples, and by elements.
TEST(MassDampers, ByModes) {
  const std::string forces = bridge + damper +
                             "load: {forces: [1.0e4, 1.0e4], positions: [0, -10], speed: 20}\n"
                             "scene: {tail: 5}\noutput: {probes: 15, interval: 0.01}\n";
  Results by_modes = run_yaml(forces + "model_modes: 12\n"), by_elements = run_yaml(forces + "ts_dt: 1.0e-3\n");
  EXPECT_LT(relative_difference(by_modes("/probes/deflection"), by_elements("/probes/deflection")), 2e-3);
  EXPECT_LT(relative_difference(by_modes("/dampers/travel"), by_elements("/dampers/travel")), 2e-3);
}

TEST(MassDampers, Refusals) {
  const auto expect = [](const Values& options, const std::string& part) {
    const std::string message =
        message_of([&] { run_yaml(bridge + damper + "load: {forces: 1, speed: 1}\n", options); });
    EXPECT_TRUE(contains(message, part)) << message;
  };
  expect({{"beam_tmd_x", "31"}}, "beam_tmd_x");
  expect({{"beam_tmd_k", "1e5"}}, "give either this or beam_tmd_k");
  expect({{"beam_tmd_mas", "5"}}, "beam_tmd_mass");
  expect({{"beam_dampers", "tmd,other"}, {"beam_other_x", "3"}, {"beam_other_mass", "5"}},
         "needs beam_other_frequency or beam_other_k");
}

}  // namespace
}  // namespace traverse::test
