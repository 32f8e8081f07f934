// The shear on both sides of a force that passes, by elements, against the modes with the exact static part.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double L = 28.0, EI = 2.6e11, mass = 19.0e3, F = 1.7e5, a = 0.753603, b = 8.68751e-05;
constexpr double speed = 41.6666666666667;

struct Range {
  double least = 0.0, greatest = 0.0;
};

/// While the force is on the span, V = V_static - b dV_static/dt + EI sum k^3 cos(k x) (q - q_static + b dq_static/dt),
/// where V_static jumps by F as the force passes, and damping lets V follow that jump within b: without F exp(-s/b), s
/// after it. The sum, less what b does to the static part, converges as 1/n^3.
Range exact_shear(double x) {
  Range range;
  const auto note = [&](double value) {
    range.least = std::min(range.least, value);
    range.greatest = std::max(range.greatest, value);
  };
  const auto at = [&](double t, bool passed) {
    double sum = 0.0;
    for (int n = 1; n <= 18; ++n) {
      const double k = n * pi / L, w = k * k * std::sqrt(EI / mass), z = 0.5 * (a / w + b * w), o = k * speed;
      const double d = std::pow(w * w - o * o, 2) + std::pow(2.0 * z * w * o, 2);
      const double s = (w * w - o * o) / d, c = -2.0 * z * w * o / d, damped = w * std::sqrt(1.0 - z * z);
      const double free =
          std::exp(-z * w * t) * (-c * std::cos(damped * t) - (s * o + z * w * c) / damped * std::sin(damped * t));
      const double q = 2.0 * F / (mass * L) * (s * std::sin(o * t) + c * std::cos(o * t) + free);
      const double at_rest = 2.0 * F / (mass * L) * std::sin(o * t) / (w * w);
      const double rate_at_rest = 2.0 * F / (mass * L) * o * std::cos(o * t) / (w * w);
      sum += k * k * k * std::cos(k * x) * (q - at_rest + b * rate_at_rest);
    }
    const double place = speed * t, jump = passed ? F * (1.0 - std::exp(-(t - x / speed) / b)) : 0.0;
    return EI * sum - F * place / L + F * b * speed / L + jump;
  };
  const double passage = x / speed, end = L / speed;
  constexpr int parts = 4000;
  for (int i = 0; i <= parts; ++i) {
    note(at(passage * i / parts, false));
    note(at(passage + (end - passage) * i / parts, true));
  }
  return range;
}

// Steps end where the force is on probes, which are nodes: rounding has it in the element on one side or the other.
TEST(PassingShear, BothSidesAreRightWhateverTheRounding) {
  for (const double v : {speed, 41.666666666666664}) {
    Results run = run_yaml(
        "beam: {spans: 28.0, EI: 2.6e11, mass: 19.0e3, rayleigh: [0.753603, 8.68751e-05], elements_per_span: 20}\n"
        "support: {types: [pinned, roller]}\nload: {forces: 1.7e5, positions: 0.0}\n"
        "ts: {dt: 3.3e-4}\nstep: {probes: true}\noutput: {probes: [2.8, 5.6, 12.6, 23.8], interval: 0.01}\n",
        {{"load_speed", text(v)}});
    const std::vector<double>& x = run("/probes/x");
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Range exact = exact_shear(x[i]);
      EXPECT_NEAR(run("/envelope/shear")[2 * i] / F, exact.least / F, 1e-4) << x[i];
      EXPECT_NEAR(run("/envelope/shear")[2 * i + 1] / F, exact.greatest / F, 1e-4) << x[i];
    }
  }
}

// The peaks of the summary are the largest of the envelopes.
TEST(PassingShear, EnvelopesHoldTheSummarysPeaks) {
  for (const char* dt : {"2e-3", "3.3e-4"}) {
    Results run = run_yaml(
        "beam: {spans: 28.0, EI: 2.6e11, mass: 19.0e3, rayleigh: [0.753603, 8.68751e-05], elements_per_span: 8}\n"
        "support: {types: [pinned, roller]}\nload: {forces: [1.7e5, 1.7e5], positions: [0.0, -11.0], speed: 70.0}\n"
        "output: {probes: [7.0, 14.0, 21.0], interval: 0.01}\n",
        {{"ts_dt", dt}});
    for (const char* name : {"deflection", "acceleration", "moment", "shear"}) {
      const std::vector<double>& envelope = run(std::string("/envelope/") + name);
      EXPECT_EQ(peak(envelope).first, run.attribute("/summary", name)) << name << " " << dt;
    }
  }
}

}  // namespace
}  // namespace traverse::test
