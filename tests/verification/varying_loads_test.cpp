// Forces that vary over time, line loads and moments against closed forms: the modal series of a simply supported beam
// without damping (Fryba), and statics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "support/message.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;
constexpr double length = 20.0, EI = 8.0e9, mass = 9000.0;  // m, N m2, kg/m
constexpr int modes = 60;

std::string beam_of(const std::string& rest) {
  return "beam: {spans: 20, EI: 8.0e9, mass: 9000, elements_per_span: 20}\n"
         "support: {types: [pinned, roller]}\n"
         "scene: {start: given}\n"
         "output: {probes: [10.0, 5.3], interval: 0.01}\n"
         "ts: {dt: 5.0e-4, max_time: 1.0}\n" +
         rest;
}

double omega_of(int n) { return std::pow(n * pi / length, 2) * std::sqrt(EI / mass); }

/// The deflection at x, m, upward: minus the sum of the modes' responses to forces that act from rest. response(n,
/// omega) is q of q'' + omega^2 q = f_n(t)/(m L/2).
double series(double x, const std::function<double(int, double)>& response) {
  double sum = 0.0;
  for (int n = 1; n <= modes; ++n) sum -= std::sin(n * pi * x / length) * response(n, omega_of(n));
  return sum / (0.5 * mass * length);
}

/// q of q'' + w^2 q = sin(W t + phase) from rest.
double harmonic(double w, double W, double phase, double t) {
  const double a = 1.0 / (w * w - W * W);
  return a * (std::sin(W * t + phase) - std::sin(phase) * std::cos(w * t) - W / w * std::cos(phase) * std::sin(w * t));
}

void expect_deflections(Results& run, double tolerance, const std::function<double(double x, double t)>& exact,
                        double energy_tolerance = 1e-6) {
  const std::vector<double> time = run.time(), found = run("/probes/deflection");
  double largest = 0.0, error = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i)
    for (std::size_t p = 0; p < 2; ++p) {
      const double value = exact(p == 0 ? 10.0 : 5.3, time[i]);
      largest = std::max(largest, std::abs(value));
      error = std::max(error, std::abs(found[2 * i + p] - value));
    }
  EXPECT_GT(largest, 1e-5);
  EXPECT_LT(error, tolerance * largest);
  EXPECT_LT(energy_error(run), energy_tolerance);
}

TEST(VaryingLoads, HarmonicForceAtItsPlace) {
  Results run =
      run_yaml(beam_of("load: {forces: 0, positions: 7.0, speed: 0, frequency: 3.1, amplitude: [4.0e4, 1.5e4], "
                       "phase: [0.4, -1.0]}\n"));
  expect_deflections(run, 2e-5, [](double x, double t) {
    return series(x, [&](int n, double w) {
      return std::sin(n * pi * 7.0 / length) *
             (4.0e4 * harmonic(w, 2.0 * pi * 3.1, 0.4, t) + 1.5e4 * harmonic(w, 2.0 * pi * 6.2, -1.0, t));
    });
  });
}

// A force A sin(W t) at v t: sin(n pi v t/L) sin(W t) = (cos((W - k) t) - cos((W + k) t))/2.
TEST(VaryingLoads, MovingHarmonicForce) {
  Results run = run_yaml(beam_of("load: {forces: 0, positions: 0, speed: 18, frequency: 4.0, amplitude: 5.0e4}\n"));
  expect_deflections(run, 1e-4, [](double x, double t) {
    return series(x, [&](int n, double w) {
      const double W = 2.0 * pi * 4.0, k = n * pi * 18.0 / length;
      return 0.5 * 5.0e4 * (harmonic(w, W - k, 0.5 * pi, t) - harmonic(w, W + k, 0.5 * pi, t));
    });
  });
}

// The force m e (2 pi f)^2 of a rotating unbalance.
TEST(VaryingLoads, Unbalance) {
  Results run = run_yaml(beam_of("load: {forces: 1000, positions: 10.0, speed: 0, frequency: 5.0, unbalance: 20.0}\n"));
  expect_deflections(run, 2e-5, [](double x, double t) {
    return series(x, [&](int n, double w) {
      const double W = 2.0 * pi * 5.0;
      return std::sin(n * pi * 0.5) *
             (20.0 * W * W * harmonic(w, W, 0.0, t) + 1000.0 * (1.0 - std::cos(w * t)) / (w * w));
    });
  });
}

// A ramp that ends: F' t until 0.3 s, then the constant F' 0.3.
TEST(VaryingLoads, TableOverTime) {
  const TemporaryFolder folder;
  const std::string table = folder.write("ramp.csv", "# t,F\n0,0\n0.3,6e4\n2,6e4\n");
  Results run = run_yaml(beam_of("load: {forces: 0, positions: 7.0, speed: 0, table: " + table + "}\n"));
  expect_deflections(run, 2e-5, [](double x, double t) {
    return series(x, [&](int n, double w) {
      const auto ramp = [&](double s) { return s > 0.0 ? (s - std::sin(w * s) / w) / (w * w) : 0.0; };
      return std::sin(n * pi * 7.0 / length) * 2e5 * (ramp(t) - ramp(t - 0.3));
    });
  });
}

// A line load longer than the beam comes onto it: f_n = q L/(n pi) (1 - cos(n pi v t/L)).
TEST(VaryingLoads, LineLoadThatComesOntoTheBeam) {
  Results run = run_yaml(beam_of("load: {distributed: [-60, 0, 3.0e4], speed: 18}\n"));
  expect_deflections(run, 2e-5, [](double x, double t) {
    return series(x, [&](int n, double w) {
      const double k = n * pi * 18.0 / length;
      return 3.0e4 * length / (n * pi) * ((1.0 - std::cos(w * t)) / (w * w) - harmonic(w, k, 0.5 * pi, t));
    });
  });
}

// One that varies with the harmonics of a crowd and stays over a part of the beam.
TEST(VaryingLoads, LineLoadThatVaries) {
  Results run = run_yaml(beam_of("load: {distributed: [3.3, 12.7, 0], speed: 0, frequency: 2.0, amplitude: 2.0e3}\n"));
  expect_deflections(run, 2e-5, [](double x, double t) {
    return series(x, [&](int n, double w) {
      const double part = (std::cos(n * pi * 3.3 / length) - std::cos(n * pi * 12.7 / length)) * length / (n * pi);
      return 2.0e3 * part * harmonic(w, 4.0 * pi, 0.0, t);
    });
  });
}

struct Statics {
  double deflection, moment;
};

/// A simply supported beam under q from a to b: the moment at x by equilibrium, the deflection by the modes' series.
Statics under_line_load(double q, double a, double b, double x) {
  const double sum = q * (b - a), left = sum * (length - 0.5 * (a + b)) / length;
  const double over = std::max(0.0, std::min(x, b) - a);
  const double moment = left * x - q * over * (x - a - 0.5 * over);
  double deflection = 0.0;
  for (int n = 1; n <= 400; ++n) {
    const double f = q * length / (n * pi) * (std::cos(n * pi * a / length) - std::cos(n * pi * b / length));
    deflection -= std::sin(n * pi * x / length) * f / (0.5 * mass * length * std::pow(omega_of(n), 2));
  }
  return {deflection, moment};
}

TEST(VaryingLoads, StaticLineLoadBetweenNodes) {
  Results run = run_yaml(
      "beam: {spans: 20, EI: 8.0e9, mass: 9000, elements_per_span: 3}\nsupport: {types: [pinned, roller]}\n"
      "scene: {analysis: static}\noutput: {probes: [2.2, 5.3, 11.0, 17.0]}\n"
      "load: {distributed: [3.3, 12.7, 2.5e4], speed: 0}\n");
  const std::vector<double> deflection = run("/probes/deflection"), moment = run("/probes/moment");
  const double probes[] = {2.2, 5.3, 11.0, 17.0};
  for (std::size_t p = 0; p < 4; ++p) {
    const Statics exact = under_line_load(2.5e4, 3.3, 12.7, probes[p]);
    EXPECT_NEAR(deflection[p], exact.deflection, 1e-8 * std::abs(exact.deflection)) << probes[p];
    EXPECT_NEAR(moment[p], exact.moment, 1e-9 * std::abs(exact.moment)) << probes[p];
  }
  const std::vector<double> supports = run("/supports/reaction");
  EXPECT_NEAR(std::accumulate(supports.begin(), supports.end(), 0.0), 2.5e4 * 9.4, 1e-6);
}

// A moment M0 at a: M = M0 x/L to its left and M0 (x - L)/L to its right.
TEST(VaryingLoads, StaticMoment) {
  Results run = run_yaml(
      "beam: {spans: 20, EI: 8.0e9, mass: 9000, elements_per_span: 3}\nsupport: {types: [pinned, roller]}\n"
      "scene: {analysis: static}\noutput: {probes: [2.2, 5.3, 11.0, 17.0]}\n"
      "load: {moments: 3.0e5, positions: 8.1, speed: 0}\n");
  const std::vector<double> deflection = run("/probes/deflection"), moment = run("/probes/moment");
  const double probes[] = {2.2, 5.3, 11.0, 17.0}, a = 8.1, M0 = 3.0e5;
  for (std::size_t p = 0; p < 4; ++p) {
    const double x = probes[p];
    EXPECT_NEAR(moment[p], x < a ? M0 * x / length : M0 * (x - length) / length, 1e-9 * M0);
    const double b = length - a;  // EI v = M0 (x^3 + (3 b^2 - L^2) x)/(6 L) left of it
    const auto left = [&](double s, double from) {
      return M0 * s * (s * s + 3.0 * from * from - length * length) / (6.0 * length * EI);
    };
    const double exact = x < a ? left(x, b) : -left(length - x, a);
    EXPECT_NEAR(deflection[p], exact, 1e-9 * std::abs(exact)) << x;
  }
}

/// q and its rate for q'' + 2 sigma q' + w^2 q = cos(W t) from rest.
std::array<double, 2> driven(double w, double sigma, double W, double t) {
  const double in = w * w - W * W, out = 2.0 * sigma * W, a = in / (in * in + out * out),
               b = out / (in * in + out * out), wd = std::sqrt(w * w - sigma * sigma);  // a cos(W t) + b sin(W t)
  const double c = -a, s = (sigma * c - b * W) / wd, e = std::exp(-sigma * t);
  const double free = e * (c * std::cos(wd * t) + s * std::sin(wd * t)),
               free_rate = -sigma * free + e * wd * (s * std::cos(wd * t) - c * std::sin(wd * t));
  return {a * std::cos(W * t) + b * std::sin(W * t) + free,
          W * (b * std::cos(W * t) - a * std::sin(W * t)) + free_rate};
}

// A moment comes onto the beam, crosses and leaves: each mode is driven by M n pi/L cos(n pi v t/L), then free. Its end
// is a jump of the load, which fast modes answer at once: the energies balance at any step, but for the share of the
// modes that are faster than the step, which integrators damp.
TEST(VaryingLoads, MomentThatCrossesAndLeaves) {
  constexpr double M = 2.0e5, v = 25.0, b = 4.0e-4, leaves = length / v;
  const auto exact = [&](double x, double t) {
    return -series(x, [&](int n, double w) {
      const double sigma = 0.5 * b * w * w, k = n * pi / length;
      if (sigma > w) return 0.0;  // 1/15^3 of the first mode, at most
      std::array<double, 2> q = driven(w, sigma, k * v, std::min(t, leaves));
      if (t > leaves) {
        const double since = t - leaves, wd = std::sqrt(w * w - sigma * sigma);
        q[0] = std::exp(-sigma * since) *
               (q[0] * std::cos(wd * since) + (q[1] + sigma * q[0]) / wd * std::sin(wd * since));
      }
      return M * k * q[0];
    });
  };
  const std::array<std::tuple<const char*, const char*, double>, 3> cases = {
      {{"esdirk4", "5e-4", 1e-3}, {"esdirk4", "4e-3", 2e-3}, {"genalpha", "1e-3", 5e-3}}};
  for (const auto& [type, step, tolerance] : cases) {
    Results run = run_yaml(
        "beam: {spans: 20, EI: 8.0e9, mass: 9000, elements_per_span: 20, rayleigh: [0, 4.0e-4]}\n"
        "support: {types: [pinned, roller]}\nscene: {start: given}\n"
        "output: {probes: [10.0, 5.3], interval: 0.05}\nts: {max_time: 1.5}\n"
        "load: {moments: 2.0e5, speed: 25}\n",
        {{"ts_type", type}, {"ts_dt", step}});
    SCOPED_TRACE(fmt::format("{} {}", type, step));
    expect_deflections(run, tolerance, exact, 0.05);
  }
}

/// The greatest difference of the deflections of two runs.
double difference(Results& a, Results& b) {
  return relative_difference(a("/probes/deflection"), b("/probes/deflection"));
}

class LoadsThatEnterAndLeave : public testing::TestWithParam<std::tuple<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(VaryingLoads, LoadsThatEnterAndLeave,
                         testing::Combine(testing::Values("load: {moments: 2.0e5, speed: 25}\n",
                                                          "load: {distributed: [-2.6, 0, 2.0e4], speed: 25}\n"),
                                          testing::Values("0", "4")));

// Steps end where a moment passes a node and where an end of a line load passes an end of the beam: the error of
// fourth order is not disturbed.
TEST_P(LoadsThatEnterAndLeave, ConvergeAtFourthOrder) {
  const std::string load = std::get<0>(GetParam()), of_model = std::get<1>(GetParam());
  const auto run = [&](const char* step) {
    return run_yaml(
        "beam: {spans: 24, EI: 3.0e9, mass: 2500, elements_per_span: 6, damping_ratios: 0.02}\n"
        "scene: {start: given}\noutput: {probes: [9.0], interval: 0.024}\n"
        "ts: {max_time: 1.2}\n" +
            load,
        {{"ts_dt", step}, {"model_modes", of_model}});
  };
  Results exact = run("1e-4"), rough = run("1.2e-3"), fine = run("4e-4");
  const double order = std::log(difference(rough, exact) / difference(fine, exact)) / std::log(3.0);
  RecordProperty("order", std::to_string(order));
  EXPECT_GT(order, 3.5);
}

TEST(VaryingLoads, RefuseWhatMakesNoSense) {
  const auto refused = [](const std::string& load) { return message_of([&] { run_yaml(beam_of(load)); }); };
  EXPECT_TRUE(contains(refused("load: {forces: 1, speed: 0, amplitude: 3}\n"), "needs load_frequency"));
  EXPECT_TRUE(
      contains(refused("load: {forces: 1, speed: 0, frequency: 3}\n"), "needs load_amplitude or load_unbalance"));
  EXPECT_TRUE(contains(refused("load: {distributed: [3, 2, 1], speed: 1}\n"), "a second end beyond the first"));
  EXPECT_TRUE(contains(refused("load: {distributed: [3, 2], speed: 1}\n"), "three for each line load"));
}

}  // namespace
}  // namespace traverse::test
