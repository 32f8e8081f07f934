// Beams that twist: natural frequencies, coupled bending and torsion, a force on a track beside the shear centre at
// rest and in motion, and vehicles on such a track by modes and by elements.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/record.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double L = 24.0, EI = 3.0e10, GJ = 1.1e10, mass = 9.0e3, inertia = 4.0e4, e = 2.25, F = 2.0e5;

/// A beam on forks with additional options of the block `beam`.
std::string bridge(const std::string& more = "", const std::string& rest = "") {
  return "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4" + more +
         "}\nsupport: {types: [pinned, roller]}\n" + rest;
}

double omega_of_bending(int n) { return std::pow(n * pi / L, 2) * std::sqrt(EI / mass); }
double omega_of_twist(int n) { return n * pi / L * std::sqrt(GJ / inertia); }

std::vector<double> frequencies_where(Results& run, const char* marks) {
  std::vector<double> found;
  for (std::size_t i = 0; i < run("/modes/frequency").size(); ++i)
    if (run(marks)[i] != 0.0) found.push_back(run("/modes/frequency")[i]);
  return found;
}

TEST(Torsion, FrequenciesBetweenForks) {
  std::array<double, 2> error{};
  for (const int fine : {0, 1}) {
    Results run = run_yaml(bridge(fine ? ", elements_per_span: 16" : ", elements_per_span: 8",
                                  "scene: {analysis: modes}\nmodes: {count: 8}\n"));
    const std::vector<double> found = frequencies_where(run, "/modes/twisting");
    ASSERT_GE(found.size(), 3U);
    for (int n = 1; n <= 3; ++n)
      EXPECT_NEAR(found[static_cast<std::size_t>(n - 1)] / (omega_of_twist(n) / (2.0 * pi)), 1.0, fine ? 2e-6 : 6e-5)
          << n;
    error[static_cast<std::size_t>(fine)] = std::abs(found[2] / (omega_of_twist(3) / (2.0 * pi)) - 1.0);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 6.0, 0.3) << "of sixth order";
}

TEST(Torsion, FrequenciesOfACantileverAndOfThreeSpans) {
  Results jib = run_yaml(
      "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4, elements_per_span: 40}\n"
      "support: {types: [clamped, free]}\nscene: {analysis: modes}\nmodes: {count: 8}\n");
  const std::vector<double> of_jib = frequencies_where(jib, "/modes/twisting");
  for (int n = 1; n <= 2; ++n)
    EXPECT_NEAR(of_jib[static_cast<std::size_t>(n - 1)], (2.0 * n - 1.0) / (4.0 * L) * std::sqrt(GJ / inertia), 1e-6)
        << n;
  // Inner forks hold the twist, single bearings do not.
  for (const bool forks : {true, false}) {
    Results run = run_yaml(
        "beam: {spans: [10, 14, 10], EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4, elements_per_span: "
        "40}\n"
        "support: {types: [pinned, roller, roller, roller], torsion: [held, " +
        std::string(forks ? "held, held" : "free, free") + ", held]}\nscene: {analysis: modes}\nmodes: {count: 10}\n");
    EXPECT_NEAR(frequencies_where(run, "/modes/twisting").front(),
                1.0 / (2.0 * (forks ? 14.0 : 34.0)) * std::sqrt(GJ / inertia), 1e-6);
  }
}

TEST(Torsion, TheDampingIsThatOfBending) {
  const std::string rest = "scene: {analysis: modes}\nmodes: {count: 8}\n";
  Results with = run_yaml(bridge(", damping_ratios: 0.02, elements_per_span: 16", rest)),
          without = run_yaml(
              "beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, damping_ratios: 0.02, elements_per_span: 16}\n"
              "support: {types: [pinned, roller]}\n" +
              rest);
  for (const char* name : {"rayleigh_a", "rayleigh_b"})
    EXPECT_EQ(with.attribute("/modes", name), without.attribute("/modes", name));
}

// Mass beside the shear centre: v and twist are both sines, with (EI k^4 - m w^2)(GJ k^2 - (I + m c^2) w^2) = (m c
// w^2)^2.
TEST(Torsion, CoupledFrequencies) {
  constexpr double c = 0.8;
  Results run = run_yaml(bridge(", mass_centre: 1.1, shear_centre: 0.3, elements_per_span: 40",
                                "scene: {analysis: modes}\nmodes: {count: 8}\n"));
  std::vector<double> exact;
  for (int n = 1; n <= 4; ++n) {
    const double k = n * pi / L, a = mass * inertia;  // m (I + m c^2) - (m c)^2
    const double b = EI * std::pow(k, 4) * (inertia + mass * c * c) + GJ * k * k * mass,
                 d = EI * std::pow(k, 4) * GJ * k * k;
    for (const double sign : {-1.0, 1.0})
      exact.push_back(std::sqrt((b + sign * std::sqrt(b * b - 4.0 * a * d)) / (2.0 * a)) / (2.0 * pi));
  }
  std::sort(exact.begin(), exact.end());
  std::vector<double> found;
  for (std::size_t i = 0; i < run("/modes/frequency").size(); ++i)
    if (run("/modes/axial")[i] == 0.0) found.push_back(run("/modes/frequency")[i]);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(found[i] / exact[i], 1.0, 1e-5) << i;
}

// With stiffness against warping and free warping at the forks: I w^2 = k^2 (GJ + EC k^2), k = n pi/L.
TEST(Torsion, FrequenciesWithWarping) {
  constexpr double EC = 3.0e11;
  std::array<double, 2> error{};
  for (const int fine : {0, 1}) {
    Results run = run_yaml(bridge(std::string(", ECw: 3.0e11, elements_per_span: ") + (fine ? "16" : "8"),
                                  "scene: {analysis: modes}\nmodes: {count: 8}\n"));
    const std::vector<double> found = frequencies_where(run, "/modes/twisting");
    for (int n = 1; n <= 2; ++n) {
      const double k = n * pi / L, exact = k * std::sqrt((GJ + EC * k * k) / inertia) / (2.0 * pi);
      error[static_cast<std::size_t>(fine)] = std::abs(found[static_cast<std::size_t>(n - 1)] / exact - 1.0);
      EXPECT_LT(error[static_cast<std::size_t>(fine)], fine ? 2e-5 : 3e-4) << n;
    }
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 4.0, 0.2) << "of fourth order";
}

// A cantilever of Vlasov's theory, whose wall prevents warping, under a torque at its end: with b = (GJ/EC)^(1/2) the
// twist of the end is T/GJ (L - tanh(b L)/b). Without stiffness against warping it is T L/GJ.
TEST(Torsion, ACantileverThatWarps) {
  for (const bool warping : {true, false}) {
    Results run =
        run_yaml("beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4, elements_per_span: 24" +
                 std::string(warping ? ", ECw: 3.0e11" : "") +
                 "}\nsupport: {types: [clamped, free]}\ntrack: {eccentricity: 2.25}\n"
                 "load: {forces: 2.0e5, positions: 24, speed: 0}\nts_max_time: 1\noutput: {probes: [12, 24]}\n");
    const double b = std::sqrt(GJ / 3.0e11), T = -F * e;
    const double exact = T / GJ * (warping ? L - std::tanh(b * L) / b : L);
    EXPECT_NEAR(run.column("/probes/twist", 1).front(), exact, 2e-6 * std::abs(exact)) << warping;
    EXPECT_NEAR(run.column("/probes/torsional_moment", 0).front(), T, 1e-8 * std::abs(T)) << warping;
    EXPECT_NEAR(run("/supports/torque").front(), -T, 1e-8 * std::abs(T)) << warping;
  }
}

/// At rest on the track, at a node and within an element: modes with static correction, and elements.
TEST(Torsion, AForceBesideTheAxis) {
  for (const auto& [x, modes] : {std::pair(12.0, "6"), {11.3, "6"}, {12.0, "0"}, {11.3, "0"}}) {
    Results run = run_yaml(bridge(", elements_per_span: 12",
                                  "track: {eccentricity: 2.25}\nsupport_bearing_spacing: 3\n"
                                  "load: {forces: 2.0e5, speed: 0}\nts_max_time: 1\noutput: {probes: [6, 12, 11.3]}\n"),
                           {{"load_positions", text(x)}, {"output_interval", "1"}, {"model_modes", modes}});
    const auto last = [&](const char* name, std::size_t i) { return run.column(name, i).back(); };
    const double twist = -F * e * (L - x) * 6.0 / (GJ * L), under = -F * e * (L - x) * x / (GJ * L);
    EXPECT_NEAR(last("/probes/twist", 0), twist, 1e-6 * std::abs(twist)) << x;
    const std::size_t here = x == 12.0 ? 1 : 2;
    EXPECT_NEAR(last("/probes/twist", here), under, 1e-6 * std::abs(under)) << x;
    const double bent = -F * x * x * (L - x) * (L - x) / (3.0 * EI * L);
    EXPECT_NEAR(last("/probes/deflection", here), bent + e * under, 1e-6 * std::abs(bent)) << x;
    EXPECT_NEAR(last("/probes/torsional_moment", 0), -F * e * (L - x) / L, 1e-6 * F * e) << x;
    EXPECT_NEAR(last("/probes/moment", here), F * x * (L - x) / L, 1e-6 * F * L) << x;
    // The left support carries the part (L - x)/L of force and torque.
    const double part = (L - x) / L;
    EXPECT_NEAR(last("/supports/torque", 0), F * e * part, 1e-6 * F * e) << x;
    EXPECT_NEAR(last("/supports/left_bearing", 0), F * part * (0.5 + e / 3.0), 1e-6 * F) << x;
    EXPECT_NEAR(last("/supports/right_bearing", 0), F * part * (0.5 - e / 3.0), 1e-6 * F) << x;
  }
}

/// The coordinate of a damped mode and its acceleration under amplitude*sin(W t) from rest; a mode that creeps is at
/// rest under the force.
std::array<double, 2> coordinate(double omega, double zeta, double W, double amplitude, double t) {
  if (zeta >= 1.0) return {amplitude / (omega * omega) * std::sin(W * t), 0.0};
  const double below = omega * omega - W * W, drag = 2.0 * zeta * omega * W, D = below * below + drag * drag;
  const double a = below / D, b = -drag / D, d = zeta * omega, damped = omega * std::sqrt(1.0 - zeta * zeta);
  const double c = (a * W + d * b) / damped, decay = std::exp(-d * t);
  const double C = std::cos(damped * t), S = std::sin(damped * t);
  const double q = a * std::sin(W * t) + b * std::cos(W * t) - decay * (b * C + c * S);
  const double rate =
      W * (a * std::cos(W * t) - b * std::sin(W * t)) + decay * (d * (b * C + c * S) - damped * (c * C - b * S));
  return {amplitude * q, amplitude * (std::sin(W * t) - 2.0 * d * rate - omega * omega * q)};
}

constexpr int modes = 20;  // of bending and torsion

/// Deflection and acceleration of the track, and twist, at midspan under a force at the speed v from the left end, by
/// the modal series with the Rayleigh damping of 2 % in the first two modes of bending. The acceleration is that of the
/// lowest modes: that of all has a peak without an end under the force.
std::array<double, 3> series(double v, double t) {
  const double w1 = omega_of_bending(1), w2 = omega_of_bending(2), b = 2.0 * 0.02 / (w1 + w2), a = w1 * w2 * b;
  const auto zeta = [&](double omega) { return 0.5 * (a / omega + b * omega); };
  std::vector<double> omegas;
  for (int n = 1; n <= modes; ++n) omegas.insert(omegas.end(), {omega_of_bending(n), omega_of_twist(n)});
  std::sort(omegas.begin(), omegas.end());
  const double last = 0.5 * (omegas[modes - 1] + omegas[modes]);
  std::array<double, 3> sum{};
  for (int n = 1; n <= 3001; n += 2) {
    const double W = n * pi * v / L, shape = std::sin(0.5 * n * pi), bent = omega_of_bending(n),
                 turned = omega_of_twist(n);
    const auto of_axis = coordinate(bent, zeta(bent), W, -2.0 * F / (mass * L), t),
               twist = coordinate(turned, zeta(turned), W, -2.0 * F * e / (inertia * L), t);
    sum[0] += shape * (of_axis[0] + e * twist[0]);
    if (bent < last) sum[1] += shape * of_axis[1];
    if (turned < last) sum[1] += shape * e * twist[1];
    sum[2] += shape * twist[0];
  }
  return sum;
}

/// The largest errors of these three, relative to the largest values.
std::array<double, 3> errors_of_passage(int elements) {
  const std::string beam = ", damping_ratios: 0.02, elements_per_span: " + std::to_string(elements);
  Results run = run_yaml(bridge(beam, "model: {modes: " + std::to_string(modes) +
                                          "}\ntrack: {eccentricity: 2.25}\n"
                                          "load: {forces: 2.0e5, speed: 40}\nts_max_time: 0.6\n"
                                          "output: {probes: 12, interval: 0.002}\n"));
  const std::vector<double> time = run.time();
  const std::array computed = {run.column("/probes/deflection"), run.column("/probes/acceleration"),
                               run.column("/probes/twist")};
  std::array<double, 3> worst{}, largest{};
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::array<double, 3> exact = series(40.0, time[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      worst[k] = std::max(worst[k], std::abs(computed[k][i] - exact[k]));
      largest[k] = std::max(largest[k], std::abs(exact[k]));
    }
  }
  for (std::size_t k = 0; k < 3; ++k) worst[k] /= largest[k];
  return worst;
}

TEST(Torsion, AMovingForceBesideTheAxis) {
  const std::array fine = errors_of_passage(64), coarse = errors_of_passage(16);
  record("deflection", fine[0]);
  record("acceleration", fine[1]);
  record("twist", fine[2]);
  EXPECT_LT(fine[0], 3e-4);
  EXPECT_LT(fine[1], 3e-3);
  EXPECT_LT(fine[2], 1e-3);
  EXPECT_LT(coarse[0], 1e-3);
  EXPECT_LT(coarse[1], 8e-2);
}

/// Vehicles on the track, linear and as mechanisms, on two meshes.
TEST(Torsion, AVehicleBesideTheAxis) {
  const std::string rest =
      "track: {eccentricity: 2.25}\nmodel: {modes: 20}\nvehicle:\n  coach:\n    file: " + source_folder() +
      "/options/vehicles/manchester.yml\ntrain: {vehicles: coach, speed: 60}\n"
      "output: {probes: [6, 12], interval: 2e-3}\nts: {max_time: 0.9, dt: 1e-4}\n";
  const std::string beam = ", elements_per_span: 96, damping_ratios: 0.02";
  Results linear = run_yaml(bridge(beam, rest)), full = run_yaml(bridge(beam, rest), {{"model_vehicles", "full"}}),
          finer = run_yaml(bridge(beam, rest), {{"beam_elements_per_span", "192"}});
  for (const char* name : {"/probes/deflection", "/probes/twist"}) {
    EXPECT_LT(relative_difference(full(name), linear(name)), 1e-4) << name;
    EXPECT_LT(relative_difference(finer(name), linear(name)), 3e-4) << name;
  }
  EXPECT_LT(relative_difference(finer("/probes/acceleration"), linear("/probes/acceleration")), 1e-2);
  EXPECT_LT(energy_error(full), 1e-4);
  EXPECT_LT(energy_error(linear), 1e-4);
  // On the line of shear centres nothing twists, and the track is that of a beam that cannot.
  const Values centred = {{"track_eccentricity", "0"}};
  Results there = run_yaml(bridge(beam, rest), centred);
  EXPECT_EQ(peak(there("/probes/twist")).first, 0.0);
}

TEST(Torsion, Refusals) {
  const auto refused = [](const std::string& yaml) { return message_of([&] { run_yaml(yaml); }); };
  EXPECT_EQ(refused("beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10}\n").find("beam_GJ"), 0U);
  EXPECT_NE(refused("beam: {spans: 24, EI: 3.0e10, mass: 9.0e3, GJ: 1.1e10, polar_inertia: 4.0e4}\n"
                    "support: {torsion: free}\nload: {forces: 1, speed: 1}\n")
                .find("can twist"),
            std::string::npos);
}

}  // namespace
}  // namespace traverse::test
