// A bed that holds the slope of the beam, k in N m/rad per m: EI v'''' - k v'' + m d2v/dt2 = q.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "modes/modes.hpp"
#include "support/curve.hpp"
#include "support/message.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double EI = 1.96e9, m = 1000.0, L = 20.0, k = 6e7;
const double a = std::sqrt(k / EI);

/// omega_n^2 = (EI b^4 + k b^2)/m with b = n pi/L.
double exact_omega(int n) {
  const double b = n * pi / L;
  return std::sqrt((EI * std::pow(b, 4) + k * b * b) / m);
}

std::vector<double> frequencies(int elements) {
  beam::BeamModel model;
  model.spans = {L};
  model.elements = {elements};
  model.supports = {beam::Support::pinned, beam::Support::roller};
  model.EI = EI;
  model.mass = m;
  model.axial = false;
  model.foundation.rotational_bed = beam::Bed{k, 0.0};
  return modes::natural_modes(beam::Beam(PETSC_COMM_WORLD, model), 3, false).omega;
}

TEST(RotationalBed, FrequenciesOfAPinnedBeamWithOrderFour) {
  const std::vector<double> coarse = frequencies(8), fine = frequencies(16);
  for (int n = 1; n <= 3; ++n) {
    const double exact = exact_omega(n), bending_alone = std::sqrt(EI / m) * std::pow(n * pi / L, 2);
    EXPECT_GT(exact, 1.05 * bending_alone);  // the bed counts
    const auto i = static_cast<std::size_t>(n - 1);
    const double error = coarse[i] / exact - 1.0, less = fine[i] / exact - 1.0;
    EXPECT_LT(std::abs(error), std::pow(n * pi / 8.0, 4) / 1000.0);
    EXPECT_NEAR(std::log2(error / less), 4.0, 0.1) << n;
  }
}

const std::string beam_options = "beam: {spans: 20.0, elements_per_span: 20, EI: 1.96e9, mass: 1000.0}\n";

// With theta = v' of a cantilever under a force F at its end: theta = -F/k (1 - cosh(a (L - x))/cosh(a L)).
TEST(RotationalBed, CantileverAtRest) {
  const double F = 1e5, tip = -F / k * (L - std::tanh(a * L) / a);
  // Elements of length h are off by (a h)^4/1440 = 7e-7. Then the same by a law with a cubic term that is nothing: it
  // acts at the points of integration, where the moment jumps, so that it is not smooth within an element.
  for (const char* cubic : {"0", "1"}) {
    Results run = run_yaml(beam_options + R"(
support: {types: [clamped, free]}
foundation: {rotational_bed: {k: 6e7}}
load: {forces: 1e5, positions: 20.0}
scene: {analysis: static}
output: {probes: [0.0, 5.0, 5.5, 20.0]}
)",
                           {{"foundation_rotational_bed_cubic", cubic}});
    const double x[] = {0.0, 5.0, 5.5, 20.0};
    for (std::size_t i = 0; i < 4; ++i) {
      const double fading = std::sinh(a * (L - x[i])) / std::cosh(a * L);
      EXPECT_NEAR(run("/probes/deflection")[i], -F / k * (x[i] - (std::tanh(a * L) - fading) / a), 7e-7 * -tip);
      EXPECT_NEAR(run("/probes/moment")[i], -F / a * fading,
                  (std::string(cubic) == "1" && x[i] == 5.5 ? 1e-4 : 2e-6) * F / a)
          << x[i];
    }
    const double moment = run("/foundation/rotational_bed/moment")[0];
    EXPECT_NEAR(moment, -k * run("/probes/deflection")[3], 1e-9 * moment);  // -k times the integral of v'
    EXPECT_NEAR(run("/supports/reaction")[2] + moment, F * L, 1e-9 * F * L);
  }
}

// A force that crosses a pinned beam: the modes n answer with 2 F/(m L) (sin W t - W/omega sin(omega t))/(omega^2 -
// W^2), W = n pi v/L.
TEST(RotationalBed, ForceThatCrossesAPinnedBeam) {
  Results run = run_yaml(beam_options + R"(
support: {types: [pinned, roller]}
foundation: {rotational_bed: {k: 6e7}}
load: {forces: 1e5, positions: 0.0, speed: 50.0}
ts: {dt: 2.5e-4, max_time: 0.4}
output: {probes: 10.0}
)",
                         {{"beam_elements_per_span", "40"}});
  std::vector<double> exact;
  for (const double t : run.time()) {
    double sum = 0.0;
    for (int n = 1; n <= 199; n += 2) {
      const double omega = exact_omega(n), W = n * pi * 50.0 / L, sign = n % 4 == 1 ? 1.0 : -1.0;
      sum += sign * (std::sin(W * t) - W / omega * std::sin(omega * t)) / (omega * omega - W * W);
    }
    exact.push_back(-2.0 * 1e5 / (m * L) * sum);
  }
  EXPECT_LT(relative_difference(run("/probes/deflection"), exact), 1e-5);
  EXPECT_LT(energy_error(run), 1e-6);
}

// Its damper takes what is missing from the energy.
TEST(RotationalBed, DamperTakesEnergy) {
  const auto deflection_left = [](const char* c) {
    Results run = run_yaml(beam_options + R"(
support: {types: [pinned, roller]}
foundation: {rotational_bed: {k: 6e7}}
load: {forces: 1e5, positions: 0.0, speed: 50.0}
ts: {dt: 5e-4, max_time: 1.4}
output: {probes: 10.0}
)",
                           {{"foundation_rotational_bed_c", c}});
    EXPECT_LT(energy_error(run), 1e-6);
    const std::vector<double> v = run("/probes/deflection"), t = run.time();
    double most = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i)
      if (t[i] > 1.2) most = std::max(most, std::abs(v[i]));
    return most;
  };
  // The first mode's m s^2 + c b^2 s + ... = 0 fades with c b^2/(2 m): over about 0.8 s by exp(-2).
  const double free = deflection_left("0"), damped = deflection_left("2e5");
  EXPECT_LT(damped, 0.35 * free);
  EXPECT_GT(damped, 0.03 * free);
}

// A tension acts as a rotational bed: a force that moves over a tensioned pinned beam, by the series of its modes.
TEST(Tension, MovingForce) {
  constexpr double F = 1e5, v = 60.0;
  Results run = run_yaml(
      "beam: {spans: 20.0, elements_per_span: 24, EI: 1.96e9, mass: 1000.0, tension: 6.0e7}\n"
      "support: {types: [pinned, roller]}\nload: {forces: 1.0e5, speed: 60.0}\nts: {dt: 2.0e-4, max_time: 0.33}\n"
      "output: {probes: [10.0], interval: 0.005}\n");
  const std::vector<double> time = run.time(), found = run.column("/probes/deflection");
  double largest = 0.0, error = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    double exact = 0.0;
    for (int n = 1; n <= 60; ++n) {
      const double w = exact_omega(n), W = n * pi * v / L;
      exact -= std::sin(0.5 * n * pi) * 2.0 * F / (m * L * (w * w - W * W)) *
               (std::sin(W * time[i]) - W / w * std::sin(w * time[i]));
    }
    largest = std::max(largest, std::abs(exact));
    error = std::max(error, std::abs(found[i] - exact));
  }
  EXPECT_LT(error, 1e-4 * largest);
  EXPECT_LT(energy_error(run), 1e-6);
}

// A contact wire: omega_n = n pi/L sqrt((T + EI (n pi/L)^2)/m).
TEST(Tension, FrequenciesOfAWire) {
  Results run = run_yaml(
      "beam: {spans: 50.0, elements_per_span: 1000, EI: 150.0, mass: 1.35, tension: 2.0e4}\n"
      "support: {types: pinned}\nscene: {analysis: modes}\nmodes: {count: 4}\n");
  const std::vector<double> frequency = run("/modes/frequency");
  for (int n = 1; n <= 4; ++n) {
    const double b = n * pi / 50.0;
    EXPECT_NEAR(2.0 * pi * frequency[static_cast<std::size_t>(n - 1)] / (b * std::sqrt((2.0e4 + 150.0 * b * b) / 1.35)),
                1.0, 1e-7)
        << n;
  }
}

// omega_n^2 = (n pi/L)^2 (EI (n pi/L)^2 - N)/m below Euler's load.
TEST(Compression, FrequenciesBelowTheBucklingLoad) {
  const double euler = EI * std::pow(pi / L, 2);
  Results run = run_yaml(
      "beam: {spans: 20.0, elements_per_span: 24, EI: 1.96e9, mass: 1000.0}\nsupport: {types: [pinned, roller]}\n"
      "scene: {analysis: modes}\nmodes: {count: 3}\n",
      {{"beam_tension", text(-0.9 * euler)}});
  const std::vector<double> frequency = run("/modes/frequency");
  for (int n = 1; n <= 3; ++n) {
    const double b = n * pi / L, exact = b * std::sqrt((EI * b * b - 0.9 * euler) / m);
    EXPECT_NEAR(2.0 * pi * frequency[static_cast<std::size_t>(n - 1)] / exact, 1.0, 1e-4) << n;
  }
}

// Two spans of 20 m buckle at Euler's load of one, a beam clamped at one end and free at the other at a quarter of it.
TEST(Compression, BucklingLoad) {
  const double euler = EI * std::pow(pi / L, 2);
  const auto load_of = [&](const std::string& spans, const std::string& types) {
    const std::string message = message_of([&] {
      run_yaml("beam: {elements_per_span: 24, EI: 1.96e9, mass: 1000.0, tension: -1.0e9, spans: " + spans +
               "}\nsupport: {types: " + types + "}\nload: {forces: 1.0e5, speed: 30}\nts: {dt: 1.0e-3}\n");
    });
    const std::size_t at = message.find("buckling load is ");
    return at == std::string::npos ? 0.0 : std::stod(message.substr(at + 17));
  };
  EXPECT_NEAR(load_of("20", "[pinned, roller]") / euler, 1.0, 1e-5);
  EXPECT_NEAR(load_of("[20, 20]", "[pinned, roller, roller]") / euler, 1.0, 1e-5);
  EXPECT_NEAR(load_of("20", "[clamped, free]") / euler, 0.25, 1e-5);
}

// A shear layer is a rotational bed.
TEST(ShearLayer, AsRotationalBed) {
  const std::string beam =
      "beam: {spans: 20.0, elements_per_span: 12, EI: 1.96e9, mass: 1000.0}\nsupport: {types: [pinned, roller]}\n"
      "scene: {analysis: modes}\nmodes: {count: 2}\nfoundation: {vertical_bed_k: 1.0e5}\n";
  Results layer = run_yaml(beam, {{"foundation_shear_layer", "3e7"}}),
          bed = run_yaml(beam, {{"foundation_rotational_bed_k", "3e7"}});
  EXPECT_EQ(layer("/modes/frequency"), bed("/modes/frequency"));
}

}  // namespace
}  // namespace traverse::test
