// Foundations that are one-sided or have a gap or a cubic term, against closed forms and exact piecewise solutions.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "integrate/stepper.hpp"
#include "support/beam_model.hpp"
#include "support/curve.hpp"
#include "support/record.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

// --- a beam that lifts off its bed ---------------------------------------------------------------------------------

constexpr double bed_k = 5.0e7, rail_EI = 1.3e7, rail_q = 120.0 * 9.81;  // N/m2, N m2, N/m

/// An infinite beam with weight q on a bed that only pushes, under a force P: it lifts off between x1 and x2 (and by
/// symmetry on the other side). Fourth-order equations on the three stretches, EI v'''' + k v = -q where it rests and
/// EI v'''' = -q where it does not, joined by v, v', v'', v'''; x1 and x2 are where v is zero.
class LiftedBeam {
 public:
  explicit LiftedBeam(double P) : P_(P), lambda_(std::pow(bed_k / (4.0 * rail_EI), 0.25)) {
    Eigen::Vector2d ends(2.0 / lambda_, 4.5 / lambda_);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d r = gaps(ends);
      Eigen::Matrix2d J;
      for (int j = 0; j < 2; ++j) {
        Eigen::Vector2d moved = ends;
        moved[j] += 1e-6;
        J.col(j) = (gaps(moved) - r) / 1e-6;
      }
      ends -= J.lu().solve(r);
    }
    EXPECT_LT(gaps(ends).norm(), 1e-15);
    x1 = ends[0];
    x2 = ends[1];
  }
  double x1 = 0.0, x2 = 0.0;
  double v(double x) const {
    if (x <= x1) return -rail_q / bed_k + resting(x, 0).head<4>().dot(c_.head<4>());
    if (x <= x2) return -rail_q / (24.0 * rail_EI) * std::pow(x, 4) + flying(x, 0).dot(c_.segment<4>(4));
    return -rail_q / bed_k + decaying(x, 0).dot(c_.tail<2>());
  }

 private:
  /// The n-th derivatives of e^{+-lx} cos lx, e^{+-lx} sin lx; of the decaying two measured from x1 on.
  Eigen::Vector4d resting(double x, int n) const {
    Eigen::Vector4d f;
    const std::complex<double> up(lambda_, lambda_), down(-lambda_, lambda_);
    const std::complex<double> a = std::pow(up, n) * std::exp(up * x), b = std::pow(down, n) * std::exp(down * x);
    f << a.real(), a.imag(), b.real(), b.imag();
    return f;
  }
  Eigen::Vector2d decaying(double x, int n) const { return resting(x, n).tail<2>() * std::exp(4.0); }
  static Eigen::Vector4d flying(double x, int n) {
    Eigen::Vector4d f;
    for (int i = 0; i < 4; ++i) {
      double factor = 1.0;
      for (int j = 0; j < n; ++j) factor *= i - j;
      f[i] = i < n ? 0.0 : factor * std::pow(x, i - n);
    }
    return f;
  }
  /// Deflection at the two ends, for these ends.
  Eigen::Vector2d gaps(const Eigen::Vector2d& ends) {
    Eigen::Matrix<double, 10, 10> A = Eigen::Matrix<double, 10, 10>::Zero();
    Eigen::Matrix<double, 10, 1> b = Eigen::Matrix<double, 10, 1>::Zero();
    A.row(0).head<4>() = resting(0.0, 1);
    A.row(1).head<4>() = resting(0.0, 3) * rail_EI;
    b[1] = -0.5 * P_;  // a downward force P makes EI v''' jump by -P
    const double rest = -rail_q / bed_k;
    const double polynomial[4] = {-1.0 / 24.0, -1.0 / 6.0, -0.5, -1.0};
    for (int side = 0; side < 2; ++side)
      for (int n = 0; n < 4; ++n) {
        const int row = 2 + 4 * side + n;
        const double x = ends[side];
        const double fly = rail_q / rail_EI * polynomial[n] * std::pow(x, 4 - n);
        A.row(row).segment<4>(4) = flying(x, n);
        if (side == 0)
          A.row(row).head<4>() = -resting(x, n);
        else
          A.row(row).tail<2>() = -decaying(x, n);
        b[row] = (n == 0 ? rest : 0.0) - fly;
      }
    const Eigen::Matrix<double, 10, 1> scale = A.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
    c_ = scale.asDiagonal() * (A * scale.asDiagonal()).fullPivLu().solve(b);
    return {rest + resting(ends[0], 0).dot(c_.head<4>()), rest + decaying(ends[1], 0).dot(c_.tail<2>())};
  }
  double P_, lambda_;
  Eigen::Matrix<double, 10, 1> c_;
};

/// Where a sampled function crosses zero between a and b, linear between samples.
double crossing(const std::vector<double>& x, const std::vector<double>& y, double near) {
  double best = 1e9;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (y[i - 1] * y[i] > 0.0) continue;
    const double at = x[i - 1] + (x[i] - x[i - 1]) * y[i - 1] / (y[i - 1] - y[i]);
    if (std::abs(at - near) < std::abs(best - near)) best = at;
  }
  return best;
}

TEST(OneSidedBed, LiftOffOfAnInfiniteBeam) {
  const double P =
      4.0 * 2.0 * rail_q * std::exp(pi) / std::pow(bed_k / (4.0 * rail_EI), 0.25);  // Weitsman's, four times
  const LiftedBeam exact(P);
  std::vector<double> x;
  for (int i = 0; i <= 1600; ++i) x.push_back(20.0 + 0.005 * i);
  std::string probes;
  for (double at : x) probes += (probes.empty() ? "" : ",") + text(at);
  std::vector<double> errors;
  for (int elements : {100, 200, 400}) {
    Results run = run_yaml(
        R"(
beam: {spans: 40.0, EI: 1.3e7, mass: 120.0, self_weight: true}
support: {types: [free, free]}
foundation: {vertical_bed: {k: 5.0e7, one_sided: true}}
load: {positions: 20.0, speed: 0.0}
scene: {analysis: static}
)",
        {{"beam_elements_per_span", std::to_string(elements)}, {"load_forces", text(P)}, {"output_probes", probes}});
    const std::vector<double> v = run("/probes/deflection");
    double worst = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, std::abs(v[i] - exact.v(x[i] - 20.0)));
    errors.push_back(worst / std::abs(exact.v(0.0)));
    if (elements < 400) continue;
    EXPECT_NEAR(crossing(x, v, 20.0 + exact.x1) - 20.0, exact.x1, 1e-3);
    EXPECT_NEAR(crossing(x, v, 20.0 + exact.x2) - 20.0, exact.x2, 1e-2);
    record("lift_off_from", exact.x1);
    record("lift_off_to", exact.x2);
    record("lift_off_error", std::abs(crossing(x, v, 20.0 + exact.x2) - 20.0 - exact.x2));
  }
  for (double e : errors) record("deflection_error", e);
  EXPECT_LT(errors.back(), 5e-5);
  EXPECT_LT(errors.back(), 0.1 * errors.front());  // second order where an element has lifted off in part
}

// Below Weitsman's force nothing lifts off, and the bed is linear: P lambda/(2 k) under the force and the weight's q/k.
TEST(OneSidedBed, IsLinearBelowTheForceThatLiftsIt) {
  const double lambda = std::pow(bed_k / (4.0 * rail_EI), 0.25);
  const double P = 0.9 * 2.0 * rail_q * std::exp(pi) / lambda;
  Results run = run_yaml(R"(
beam: {spans: 40.0, elements_per_span: 400, EI: 1.3e7, mass: 120.0, self_weight: true}
support: {types: [free, free]}
foundation: {vertical_bed: {k: 5.0e7, one_sided: true}}
load: {positions: 20.0, speed: 0.0}
scene: {analysis: static}
output: {probes: 20.0}
)",
                         {{"load_forces", text(P)}});
  const double exact = -P * lambda / (2.0 * bed_k) - rail_q / bed_k;
  EXPECT_NEAR(run("/probes/deflection")[0], exact, 1e-6 * std::abs(exact));
}

// --- a stop with a gap ---------------------------------------------------------------------------------------------

constexpr const char* stop = R"(
beam: {spans: 20.0, elements_per_span: 8, EI: 1.0e9, mass: 2000.0}
support: {types: [roller, roller]}
foundation: {vertical: {x: 10.0, k: 1.0e8, gap: 1.0e-3}}
)";

TEST(Gap, StaticForceOnAStop) {
  const double flexibility = std::pow(20.0, 3) / (48.0 * 1.0e9);
  for (const double force : {5.0e3, 3.0e5, -3.0e5}) {  // within the gap, beyond it, beyond it upward
    Results run = run_yaml(
        stop,
        {{"load_forces", text(force)}, {"load_positions", "10"}, {"load_speed", "0"}, {"scene_analysis", "static"}});
    const double free = -force * flexibility, gap = std::copysign(1.0e-3, free);
    const double push = std::abs(free) > 1.0e-3 ? (free - gap) / (flexibility + 1.0e-8) : 0.0;
    EXPECT_NEAR(run("/probes/deflection")[0], free - push * flexibility, 1e-10 * std::abs(free));
    // Half of what the stop leaves goes to either support: moment at midspan.
    EXPECT_NEAR(run("/probes/moment")[0], (force + push) * 20.0 / 4.0, 1e-8 * std::abs(force) * 20.0);
    const std::vector<double> r = run("/supports/reaction");
    EXPECT_NEAR(r[1], 0.5 * (force + push), 1e-8 * std::abs(force));
  }
}

/// The largest energy missing, over the largest stored, of a force that passes and the bouncing it leaves.
double missing_energy(const std::string& scene, const Values& options) {
  Results run = run_yaml(scene, options);
  double scale = 0.0;
  for (const char* term : {"/energy/kinetic", "/energy/strain", "/energy/work"})
    scale = std::max(scale, std::abs(peak(run(term)).first));
  return std::abs(peak(run("/energy/residual")).first) / scale;
}

TEST(Gap, BouncingKeepsItsEnergy) {
  std::vector<double> missing;
  for (const char* step : {"8e-4", "4e-4", "2e-4", "1e-4"})
    missing.push_back(missing_energy(stop, {{"load_forces", "2e5"},
                                            {"load_speed", "30"},
                                            {"scene_tail", "0.6"},
                                            {"output_interval", "4e-3"},
                                            {"ts_dt", step}}));
  for (double m : missing) record("energy_missing", m);
  EXPECT_LT(missing.back(), 2e-7);
  // Events fall where they will within a step: second order at least, on the whole.
  EXPECT_LT(missing.back(), missing.front() / 32.0);
}

// --- a cubic spring ------------------------------------------------------------------------------------------------

/// cn(u | m) by the descending Landen transformation (Abramowitz and Stegun, 16.4).
double cn(double u, double m) {
  std::vector<double> a{1.0}, c{std::sqrt(m)};
  double b = std::sqrt(1.0 - m);
  while (std::abs(c.back()) > 1e-16) {
    const double mean = 0.5 * (a.back() + b);
    c.push_back(0.5 * (a.back() - b));
    b = std::sqrt(a.back() * b);
    a.push_back(mean);
  }
  double phi = std::ldexp(a.back() * u, static_cast<int>(a.size()) - 1);
  for (std::size_t n = a.size() - 1; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  return std::cos(phi);
}

/// Runs a beam from a start that `set` writes, (unknown, value), into displacements and rates; calls check(t, value of
/// an unknown of the middle node, energies) at every tenth step.
using Set = std::function<void(const std::function<void(int, double)>& v, const std::function<void(int, double)>& w)>;
void run_from(const beam::BeamModel& model, const Set& set, int which, double step, double end,
              const std::function<void(double, double, const coupling::Energy&)>& check) {
  beam::Beam beam(PETSC_COMM_WORLD, model);
  beam.set_rayleigh({});
  base::check(PetscOptionsClear(nullptr));
  coupling::System system(PETSC_COMM_WORLD, &beam, {});
  integrate::Stepper stepper(system, {end, step, 10.0 * step, {}});
  double* y = stepper.state();
  system.start(false, y);
  const auto writer = [&](int offset, int kind) {
    return [&beam, y, offset, kind](int node, double value) {
      const int local = beam.local(beam.bridge().unknown(node, kind));
      if (local >= 0) y[offset + local] = value;
    };
  };
  set(writer(0, which), writer(system.structure_unknowns(), which));
  stepper.restore_state(&y);
  coupling::Observation seen;
  stepper.run(
      [&](const integrate::Instant& now) {
        system.observe(now.time, now.y, now.acceleration, seen);
        check(now.time, now.y[beam.local(beam.bridge().unknown(1, which))], seen.energy);
      },
      [](double, long) { return true; });
}

/// A stiff beam that can only move up and down, on two springs with a cubic term: Duffing's oscillator.
void swing(double k, double c, double cubic, double amplitude, double step, double end,
           const std::function<void(double, double, const coupling::Energy&)>& check) {
  beam::BeamModel m = model_of({10.0}, 2, false);
  m.supports = {beam::Support::guided, beam::Support::guided};
  m.EI = 1.0e15;
  m.mass = 1000.0;
  m.foundation.vertical = {{0.0, k, c, false, {false, 0.0, cubic}}, {10.0, k, c, false, {false, 0.0, cubic}}};
  const Set start = [&](const auto& v, const auto&) {
    for (int node = 0; node < 3; ++node) v(node, amplitude);
  };
  run_from(m, start, 1, step, end, check);
}

TEST(Cubic, FreeVibrationIsDuffings) {
  const double M = 1.0e4, k = 1.0e5, cubic = 3.0e7;
  for (const double amplitude : {0.01, 0.1, 0.3}) {
    const double stiffness = 2.0 * (k + cubic * amplitude * amplitude), omega = std::sqrt(stiffness / M);
    const double m = cubic * amplitude * amplitude / (2.0 * (k + cubic * amplitude * amplitude));
    const double period = 4.0 * std::comp_ellint_1(std::sqrt(m)) / omega;
    const double exact = 2.0 * (0.5 * k + 0.25 * cubic * amplitude * amplitude) * amplitude * amplitude;
    std::vector<double> worst;
    for (const double steps : {50.0, 100.0, 200.0}) {
      double error = 0.0, missing = 0.0, first = -1.0;
      swing(k, 0.0, cubic, amplitude, period / steps, 3.0 * period, [&](double t, double d, const coupling::Energy& e) {
        error = std::max(error, std::abs(d - amplitude * cn(omega * t, m)) / amplitude);
        if (first < 0.0) first = e.strain;
        missing = std::max(missing, std::abs(e.strain + e.kinetic - first) / first);
      });
      EXPECT_NEAR(first, exact, 1e-7 * exact);  // of a beam 1e9 times as stiff
      record("duffing_error", error);
      EXPECT_LT(missing, steps < 200.0 ? 1e-3 : 1e-6);
      worst.push_back(error);
    }
    EXPECT_LT(worst.back(), 1e-6);
    EXPECT_NEAR(std::log2(worst[0] / worst[1]), 4.0, 0.6);
  }
}

TEST(Cubic, DamperTakesWhatIsMissing) {
  double first = -1.0, missing = 0.0, lost = 0.0;
  swing(1.0e5, 5.0e3, 3.0e7, 0.2, 1e-3, 2.0, [&](double, double, const coupling::Energy& e) {
    if (first < 0.0) first = e.strain;
    missing = std::max(missing, std::abs(e.strain + e.kinetic + e.dissipated - first) / first);
    lost = e.dissipated;
  });
  EXPECT_GT(lost, 0.8 * first);
  EXPECT_LT(missing, 1e-6);
}

// At midspan of a simply supported beam: d/f + k d + cubic d^3 = P.
TEST(Cubic, StaticForce) {
  const double flexibility = std::pow(20.0, 3) / (48.0 * 1.0e9), P = 1.0e6;
  for (const double k : {0.0, 1.0e7}) {
    for (const double cubic : {1.0e8, 1.0e12, 1.0e18}) {
      Results run = run_yaml(R"(
beam: {spans: 20.0, elements_per_span: 2, EI: 1.0e9, mass: 2000.0}
support: {types: [roller, roller]}
foundation: {vertical: {x: 10.0}}
load: {forces: 1.0e6, positions: 10.0, speed: 0.0}
scene: {analysis: static}
)",
                             {{"foundation_vertical_k", text(k)}, {"foundation_vertical_cubic", text(cubic)}});
      const double d = -run("/probes/deflection")[0];
      EXPECT_NEAR(d / flexibility + k * d + cubic * d * d * d, P, 1e-9 * P) << k << " " << cubic;
    }
  }
}

// --- along x, and in rotation ----------------------------------------------------------------------------------------

// A stiff beam slides between two buffers: free over the gap, half a sine in each.
TEST(Gap, BeamBetweenBuffers) {
  const double M = 1.0e4, k = 4.0e6, gap = 0.02, speed = 0.5;
  beam::BeamModel m = model_of({10.0}, 2);
  m.supports = {beam::Support::roller, beam::Support::roller};
  m.EA = 1.0e13;
  m.mass = 1000.0;
  m.foundation.longitudinal = {{4.0, k, 0.0, false, {false, gap, 0.0}}};
  const double omega = std::sqrt(k / M), flight = gap / speed, push = pi / omega;
  const auto exact = [&](double t) {  // from the middle, towards the right
    t = std::fmod(t, 2.0 * (2.0 * flight + push));
    const double side = t > 2.0 * flight + push ? -1.0 : 1.0;
    t = std::fmod(t, 2.0 * flight + push);
    if (t < flight) return side * speed * t;
    if (t < flight + push) return side * (gap + speed / omega * std::sin(omega * (t - flight)));
    return side * (gap - speed * (t - flight - push));
  };
  const Set start = [&](const auto&, const auto& w) {
    for (int node = 0; node < 3; ++node) w(node, speed);
  };
  double worst = 0.0, missing = 0.0;
  run_from(m, start, 0, 1e-4, 0.6, [&](double t, double u, const coupling::Energy& e) {
    worst = std::max(worst, std::abs(u - exact(t)) / gap);
    missing = std::max(missing, std::abs(e.kinetic + e.strain - 0.5 * M * speed * speed));
  });
  record("buffer_error", worst);
  EXPECT_LT(worst, 1e-5);
  EXPECT_LT(missing, 1e-6 * 0.5 * M * speed * speed);
}

// The end of a simply supported beam turns through a gap before a rotational spring takes a moment.
TEST(Gap, RotationAtAnEnd) {
  const double P = 3.0e5, L = 20.0, EI = 1.0e9, k = 2.0e8, gap = 2.0e-3;
  Results run = run_yaml(R"(
beam: {spans: 20.0, elements_per_span: 2, EI: 1.0e9, mass: 2000.0}
support: {types: [roller, roller]}
foundation: {rotational: {x: 0.0, k: 2.0e8, gap: 2.0e-3}}
load: {forces: 3.0e5, positions: 10.0, speed: 0.0}
scene: {analysis: static}
output: {probes: [0.0, 10.0]}
)");
  const double turn = P * L * L / (16.0 * EI);  // clockwise
  const double moment = (turn - gap) / (L / (3.0 * EI) + 1.0 / k);
  EXPECT_GT(turn, gap);
  EXPECT_NEAR(run("/probes/moment")[0], -moment, 1e-8 * moment);
  EXPECT_NEAR(run("/probes/moment")[1], P * L / 4.0 - 0.5 * moment, 1e-8 * P * L);
}

}  // namespace
}  // namespace traverse::test
