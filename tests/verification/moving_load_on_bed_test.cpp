// R10: a constant force moves along a long beam on a damped bed, below, at and above the critical speed
// v_cr = (4 k EI/m^2)^(1/4). Whole runs against the steady state of an infinite beam.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

// A track: two rails with sleepers, on ballast.
constexpr double EI = 1.3e7, m = 400.0, k = 5.0e7, P = 1.0e5;
const double critical = std::pow(4.0 * k * EI / (m * m), 0.25);  // 357 m/s
const double lambda = std::pow(k / (4.0 * EI), 0.25);            // 1/1.01 m

double damping(double ratio) { return ratio * 2.0 * std::sqrt(k * m); }

/// What moves with the force: v(xi) in m, xi = x - V t, of
///   EI v'''' + m V^2 v'' - c V v' + k v = -P delta(xi)
/// (d/dt = -V d/dxi). Inverse Fourier transform by residues (Fryba, Vibration of Solids and Structures under Moving
/// Loads, ch. 13): with p(r) = EI r^4 + m V^2 r^2 - c V r + k, ahead of the force v = -P sum exp(r xi)/p'(r) over the
/// roots with Re r < 0, behind it +P times the sum over those with Re r > 0.
class Steady {
 public:
  Steady(double speed, double c) {
    // The roots by Durand and Kerner, then Newton.
    const double scale = std::pow(k / EI, 0.25);
    std::complex<double> roots[4];
    for (int i = 0; i < 4; ++i) roots[i] = scale * std::pow(std::complex<double>(0.4, 0.9), i);
    for (int sweep = 0; sweep < 200; ++sweep) {
      for (int i = 0; i < 4; ++i) {
        const std::complex<double> r = roots[i];
        std::complex<double> change = (((EI * r * r + m * speed * speed) * r - c * speed) * r + k) / EI;
        for (int j = 0; j < 4; ++j) {
          if (j != i) change /= r - roots[j];
        }
        roots[i] -= change;
      }
    }
    for (std::complex<double> r : roots) {
      const auto value = [&] { return ((EI * r * r + m * speed * speed) * r - c * speed) * r + k; };
      const auto slope = [&] { return (4.0 * EI * r * r + 2.0 * m * speed * speed) * r - c * speed; };
      for (int i = 0; i < 5; ++i) r -= value() / slope();
      terms_.push_back({r, slope()});
    }
  }
  /// The derivative of v of some order at xi.
  double operator()(double xi, int derivative = 0) const {
    std::complex<double> sum = 0.0;
    for (const Term& t : terms_) {
      const bool ahead = t.root.real() < 0.0;
      if (ahead == (xi >= 0.0))
        sum += (ahead ? -P : P) * std::pow(t.root, derivative) * std::exp(t.root * xi) / t.slope;
    }
    return sum.real();
  }

 private:
  struct Term {
    std::complex<double> root, slope;
  };
  std::vector<Term> terms_;
};

// The residues against the transform itself, integrated by brute force: (1/2 pi) int -P exp(i s xi)/p(i s) ds.
TEST(SteadyState, ResiduesAreTheFourierIntegral) {
  for (const double ratio : {0.5, 1.0, 1.3}) {
    const double speed = ratio * critical, c = damping(0.1);
    const Steady exact(speed, c);
    for (const double xi : {-7.3, -1.0, 0.0, 0.4, 5.0}) {
      std::complex<double> sum = 0.0;
      const double step = 1e-3, end = 200.0;  // 1/m; the rest is P/(3 pi EI end^3) = 1e-10 m
      for (double s = -end + 0.5 * step; s < end; s += step) {
        const std::complex<double> r(0.0, s);
        const std::complex<double> p = ((EI * r * r + m * speed * speed) * r - c * speed) * r + k;
        sum += -P * std::exp(r * xi) / p * step / (2.0 * M_PI);
      }
      EXPECT_NEAR(exact(xi), sum.real(), 1e-9) << "of 1e-3 m, at " << xi;
    }
  }
}

TEST(SteadyState, AtRestItIsHetenyi) {
  const Steady exact(0.0, 0.0);
  EXPECT_NEAR(exact(0.0), -P * lambda / (2.0 * k), 1e-15);
  EXPECT_NEAR(exact(2.0), -P * lambda / (2 * k) * std::exp(-2 * lambda) * (std::cos(2 * lambda) + std::sin(2 * lambda)),
              1e-15);
}

// --- runs ------------------------------------------------------------------------------------------------------------

constexpr double length = 240.0, mid = 150.0;

/// Stations around the force, at and between nodes.
std::vector<double> stations(double half) {
  std::vector<double> x;
  for (double xi = -half; xi <= half + 1e-9; xi += 0.2) x.push_back(mid + xi);
  return x;
}

std::string track(double ratio, const std::vector<double>& probes) {
  std::string list;
  for (double x : probes) list += (list.empty() ? "" : ",") + text(x);
  return "beam: {spans: " + text(length) + ", EI: " + text(EI) + ", mass: " + text(m) +
         "}\nsupport: {types: free}\nfoundation: {vertical_bed: {k: " + text(k) + ", c: " + text(damping(ratio)) +
         "}}\nload: {forces: " + text(P) + "}\noutput: {probes: [" + list + "]}\n";
}

struct MovingLoad {
  double speed, damping;  // over the critical ones
};
void PrintTo(const MovingLoad& load, std::ostream* out) { *out << load.speed << " v_cr, damping " << load.damping; }
class R10 : public testing::TestWithParam<MovingLoad> {};
INSTANTIATE_TEST_SUITE_P(ReferenceCases, R10,
                         testing::Values(MovingLoad{0.5, 0.1}, MovingLoad{0.9, 0.1}, MovingLoad{1.0, 0.1},
                                         MovingLoad{1.3, 0.1}, MovingLoad{1.0, 0.3}));

// The force enters the free left end at t = 0; what that stirs up decays by exp(-0.1*354*t), to 1e-5 and less when the
// force is in the middle. Elements of 0.3 m: lambda h = 0.3.
TEST_P(R10, SteadyShape) {
  const double speed = GetParam().speed * critical, arrival = mid / speed;
  const auto x = stations(15.0);
  Results run = run_yaml(track(GetParam().damping, x), {{"beam_elements_per_span", "800"},
                                                        {"load_speed", text(speed)},
                                                        {"ts_dt", text(0.15 / speed)},
                                                        {"ts_max_time", text(arrival)},
                                                        {"output_interval", text(arrival)}});
  ASSERT_NEAR(run.time().back(), arrival, 1e-12);
  const Steady exact(speed, damping(GetParam().damping));
  const std::vector<double> deflection = run("/probes/deflection"), moment = run("/probes/moment");
  double largest = 0.0, largest_moment = 0.0, error = 0.0, moment_error = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t at = deflection.size() - x.size() + i;
    const double v = exact(x[i] - mid), M = EI * exact(x[i] - mid, 2);
    largest = std::max(largest, std::abs(v));
    largest_moment = std::max(largest_moment, std::abs(M));
    error = std::max(error, std::abs(deflection[at] - v));
    moment_error = std::max(moment_error, std::abs(moment[at] - M));
  }
  RecordProperty("error", text(error / largest));
  RecordProperty("moment_error", text(moment_error / largest_moment));
  RecordProperty("amplification", text(largest / (P * lambda / (2.0 * k))));
  EXPECT_LT(error, 2e-3 * largest);
  EXPECT_LT(moment_error, 1e-2 * largest_moment);
}

TEST(R10, AtRest) {
  const auto x = stations(15.0);
  Results run = run_yaml(track(0.1, x), {{"beam_elements_per_span", "800"},
                                         {"load_positions", text(mid)},
                                         {"load_speed", "0"},
                                         {"scene_analysis", "static"}});
  const Steady exact(0.0, 0.0);
  const std::vector<double> deflection = run("/probes/deflection"), moment = run("/probes/moment");
  const double peak = P * lambda / (2.0 * k), peak_moment = P / (4.0 * lambda);
  EXPECT_NEAR(deflection[x.size() / 2], -peak, 1e-4 * peak);
  EXPECT_NEAR(moment[x.size() / 2], peak_moment, 1e-3 * peak_moment);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(deflection[i], exact(x[i] - mid), 1e-4 * peak) << x[i];
    EXPECT_NEAR(moment[i], EI * exact(x[i] - mid, 2), 1e-3 * peak_moment) << x[i];
  }
}

// Without damping a force slower than critical has a symmetric steady state of its own; with it the deflection lags.
TEST(R10, CreepingForceIsStatic) {
  const auto x = stations(6.0);
  Results run = run_yaml(track(0.1, x), {{"beam_elements_per_span", "800"},
                                         {"load_positions", text(mid - 1.0)},
                                         {"load_speed", "5"},
                                         {"ts_dt", "2e-3"},
                                         {"ts_max_time", "0.2"},
                                         {"output_interval", "0.2"}});
  const Steady exact(5.0, damping(0.1)), at_rest(0.0, 0.0);
  const std::vector<double> deflection = run("/probes/deflection");
  const double peak = P * lambda / (2.0 * k);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double v = deflection[deflection.size() - x.size() + i];
    EXPECT_NEAR(v, exact(x[i] - mid), 1e-4 * peak) << x[i];
    EXPECT_NEAR(v, at_rest(x[i] - mid), 5e-3 * peak) << x[i];
  }
}

}  // namespace
}  // namespace traverse::test
