// Beams that shear, with rotary inertia: frequencies against exact ones, statics against closed forms, a moving force
// against the exact series, and what must not change the answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "modes/modes.hpp"
#include "support/beam_model.hpp"
#include "support/curve.hpp"
#include "support/exact_timoshenko.hpp"
#include "support/folders.hpp"
#include "support/scene_run.hpp"
#include "support/static_case.hpp"

namespace traverse::test {
namespace {

using beam::Support;

// A deep short span: 8 m long, 2.4 m high, concrete.
constexpr double length = 8.0, EI = 3.0e10, GA = 1.6e10, mass = 6.0e3, rotary = 2.9e3;
constexpr Support all_supports[] = {Support::free, Support::roller, Support::pinned, Support::clamped, Support::guided};

beam::BeamModel deep_span(int elements, Support left, Support right) {
  beam::BeamModel model = model_of({length}, elements, false);
  model.supports = {left, right};
  model.EI = EI;
  model.GA = GA;
  model.mass = mass;
  model.rotary_inertia = rotary;
  return model;
}

std::vector<double> elastic_frequencies(const beam::BeamModel& model, std::size_t count) {
  std::vector<double> omega =
      modes::natural_modes(beam::Beam(PETSC_COMM_WORLD, model), static_cast<int>(count) + 2, false).omega;
  std::erase(omega, 0.0);
  omega.resize(count);
  return omega;
}

double worst_error(const std::vector<double>& found, const std::vector<double>& exact) {
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, std::abs(found[i] / exact[i] - 1.0));
  return worst;
}

TEST(Timoshenko, FrequenciesOfAllPairsOfSupports) {
  double worst = 0.0;
  for (const Support left : all_supports)
    for (const Support right : all_supports) {
      const std::string which = std::to_string(static_cast<int>(left)) + std::to_string(static_cast<int>(right));
      const auto exact = exact::frequencies({length, EI, GA, mass, rotary}, left, right, 3);
      const double coarse = worst_error(elastic_frequencies(deep_span(36, left, right), 3), exact),
                   fine = worst_error(elastic_frequencies(deep_span(72, left, right), 3), exact);
      EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.2) << which;
      EXPECT_LT(fine, 1e-6) << which;
      worst = std::max(worst, fine);
    }
  RecordProperty("error", text(worst));
}

// Without rotary inertia one shear strain an element is all there is: the error falls with the square of its length.
TEST(Timoshenko, FrequenciesWithoutRotaryInertia) {
  double worst = 0.0;
  for (const Support left : all_supports)
    for (const Support right : all_supports) {
      const auto exact = exact::frequencies({length, EI, GA, mass, 0.0L}, left, right, 3);
      std::vector<double> found[2];
      for (const int i : {0, 1}) {
        beam::BeamModel model = deep_span(i == 0 ? 48 : 96, left, right);
        model.rotary_inertia = 0.0;
        found[i] = elastic_frequencies(model, 3);
      }
      EXPECT_NEAR(std::log2(worst_error(found[0], exact) / worst_error(found[1], exact)), 2.0, 0.02);
      worst = std::max(worst, worst_error(found[1], exact));
    }
  RecordProperty("error", text(worst));
  EXPECT_LT(worst, 5e-4);
}

// Shear alone makes the first frequency of this span 18 % lower: the test above can tell.
TEST(Timoshenko, ShearCounts) {
  beam::BeamModel slender = deep_span(16, Support::pinned, Support::roller);
  const double sheared = elastic_frequencies(slender, 1)[0];
  slender.GA.reset();
  EXPECT_LT(sheared, 0.9 * elastic_frequencies(slender, 1)[0]);
}

TEST(Timoshenko, GreatShearStiffnessIsBernoulliEuler) {
  beam::BeamModel model = model_of({20.0, 30.0}, 6, false);
  const std::vector<double> thin = elastic_frequencies(model, 6);
  Case plain(model);
  plain.load(7.3, -1e5).load(38.0, -2e5, 3e4).weight(9.81).solve();
  model.GA = 1e21;
  EXPECT_LT(worst_error(elastic_frequencies(model, 6), thin), 1e-9);
  Case sheared(model);
  sheared.load(7.3, -1e5).load(38.0, -2e5, 3e4).weight(9.81).solve();
  for (const double x : {2.0, 7.3, 11.0, 19.9, 37.0, 38.5, 44.0}) {
    const recovery::Response a = plain.at(x), b = sheared.at(x);
    EXPECT_NEAR(b.deflection, a.deflection, 1e-9 * 0.05) << x;
    EXPECT_NEAR(b.moment, a.moment, 1e-9 * 1e6) << x;
    EXPECT_NEAR(b.shear, a.shear, 1e-9 * 1e5) << x;
  }
}

// A force anywhere on a simply supported span of three elements, and a moment: at nodes and between them. The moment
// makes a constant shear, whose strain the span turns away: it deflects as without shear.
TEST(Timoshenko, StaticsAreExactBetweenNodesToo) {
  constexpr double F = -2.0e6, a = 3.7, b = length - a, C = 8.0e5, c = 6.1;
  const beam::BeamModel model = deep_span(3, Support::pinned, Support::roller);
  Case force(model), moment(model);
  force.load(a, F).solve();
  moment.load(c, 0.0, C).solve();
  const double turn = -C / (EI * length) * (length * length / 6.0 - 0.5 * (length - c) * (length - c));
  for (const double x : {0.4, 8.0 / 3.0, 3.0, 3.7, 4.4, 16.0 / 3.0, 6.0, 7.9}) {
    const double y = x < a ? x : length - x, far = x < a ? b : a;
    const double v =
        F * far * y * (length * length - far * far - y * y) / (6.0 * length * EI) + F * far * y / (length * GA);
    EXPECT_NEAR(force.at(x).deflection, v, 1e-12) << x;
    EXPECT_NEAR(force.at(x).moment, -F * far * y / length, 1e-6) << x;
    EXPECT_NEAR(force.at(x).shear, x < a ? -F * b / length : F * a / length, 1e-6) << x;
    const double behind = std::max(0.0, x - c);
    const double turned = C / EI * (x * x * x / (6.0 * length) - 0.5 * behind * behind) + turn * x;
    EXPECT_NEAR(moment.at(x).deflection, turned, 1e-13) << x;
    EXPECT_NEAR(moment.at(x).moment, C * x / length - (x > c ? C : 0.0), 1e-6) << x;
  }
}

// Its own weight, clamped and simply supported: q x^2 (L - x)^2/(24 EI) and the like, and q x (L - x)/(2 GA) besides.
TEST(Timoshenko, OwnWeight) {
  Case clamped(deep_span(2, Support::clamped, Support::clamped)),
      simple(deep_span(3, Support::pinned, Support::roller));
  clamped.weight(9.81).solve();
  simple.weight(9.81).solve();
  const double q = 9.81 * mass, L = length;
  for (const double x : {0.9, 2.0, 4.0, 5.5}) {
    const double u = x * (L - x), by_shear = 0.5 * q * u / GA;
    EXPECT_NEAR(clamped.at(x).deflection, -q * u * u / (24.0 * EI) - by_shear, 1e-14) << x;
    EXPECT_NEAR(simple.at(x).deflection, -q * u * (L * L + u) / (24.0 * EI) - by_shear, 1e-14) << x;
    EXPECT_NEAR(clamped.at(x).moment, q * (0.5 * u - L * L / 12.0), 1e-7) << x;
  }
}

// A propped cantilever's reaction: 3/8 q L grows towards q L/2 as the beam shears.
TEST(Timoshenko, ProppedCantilever) {
  Case c(deep_span(1, Support::clamped, Support::roller));
  c.weight(9.81).solve();
  const double L = length, per_unit = L * L * L / (3.0 * EI) + L / GA, q = 9.81 * mass;
  const double by_weight = q * L * L * L * L / (8.0 * EI) + 0.5 * q * L * L / GA;
  EXPECT_NEAR(c.reactions()[1][1], by_weight / per_unit, 1e-9 * q * L);
}

// Springs inside elements: one element a span gives the deflection between its nodes that many give at theirs.
TEST(Timoshenko, HeldInsideAnElement) {
  beam::BeamModel coarse = deep_span(1, Support::clamped, Support::clamped),
                  fine = deep_span(80, Support::clamped, Support::clamped);
  for (beam::BeamModel* model : {&coarse, &fine}) {
    beam::PointFoundation spring;
    spring.x = 3.0;
    spring.k = 4.0e9;
    model->foundation.vertical.push_back(spring);
    spring.x = 5.0;
    spring.k = 2.0e9;
    model->foundation.rotational.push_back(spring);
  }
  Case one(coarse), many(fine);
  one.load(4.0, -1e6).solve();
  many.load(4.0, -1e6).solve();
  for (const double x : {1.0, 3.0, 3.6, 4.0, 5.0, 7.0}) {
    EXPECT_NEAR(one.at(x).deflection, many.at(x).deflection, 2e-11) << x;
  }
}

constexpr double drag = 2.0, lag = 2e-4;  // of Rayleigh's damping, 1/s and s

/// The exact answer to a downward force F moving over the simply supported span with `speed`: with sines of v and
/// cosines of theta, two equations for each number n, in closed form; while the force is on the span. Deflection and
/// moment.
std::pair<double, double> exact_response(double F, double speed, double x, double t) {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  double deflection = 0.0, moment = 0.0;
  for (int n = 1; n <= 2000; ++n) {
    const double k = n * std::numbers::pi / length, drive = k * speed;
    const double K11 = GA * k * k / mass, K22 = (EI * k * k + GA) / rotary, K12 = -GA * k / std::sqrt(mass * rotary);
    const double mean = 0.5 * (K11 + K22), split = std::hypot(0.5 * (K11 - K22), K12);
    for (const double sign : {-1.0, 1.0}) {  // of both frequencies, with masses scaled to one
      const double w2 = mean + sign * split, norm = std::hypot(K12, w2 - K11), damping = drag + lag * w2;
      const double of_v = K12 / norm / std::sqrt(mass), of_theta = (w2 - K11) / norm / std::sqrt(rotary);
      const Complex forced = -2.0 * F / length * of_v / (w2 - drive * drive + i * damping * drive);
      const Complex root = std::sqrt(Complex(0.25 * damping * damping - w2));
      const Complex s1 = -0.5 * damping + root, s2 = -0.5 * damping - root;
      const double start = forced.imag(), rate = (forced * i * drive).imag();
      const Complex A = -(rate - s2 * start) / (s1 - s2), B = -start - A;
      const double q = (forced * std::exp(i * drive * t)).imag() + (A * std::exp(s1 * t) + B * std::exp(s2 * t)).real();
      deflection += of_v * q * std::sin(k * x);
      moment -= EI * k * of_theta * q * std::sin(k * x);
    }
  }
  return {deflection, moment};
}

const std::string moving_force = R"(
beam: {spans: 8.0, EI: 3.0e10, GA: 1.6e10, mass: 6.0e3, rotary_inertia: 2.9e3, rayleigh: [2.0, 2.0e-4]}
support: {types: [pinned, roller]}
load: {forces: 1.0e6, speed: 80.0}
scene: {tail: 0.0}
ts: {dt: 2.0e-5}
output: {interval: 5.0e-3, probes: [2.0, 4.0]}
)";

/// Errors of deflection and moment over their largest values, away from the force's kink.
std::pair<double, double> errors_of(Results& run) {
  const std::vector<double> time = run.time();
  std::pair<double, double> off;
  for (std::size_t i = 0; i < time.size() && time[i] < 0.099; ++i)
    for (const std::size_t probe : {0U, 1U}) {
      const double x = probe == 0 ? 2.0 : 4.0;
      if (std::abs(80.0 * time[i] - x) < 0.3) continue;
      const auto [v, M] = exact_response(1e6, 80.0, x, time[i]);
      off.first = std::max(off.first, std::abs(run.column("/probes/deflection", probe)[i] - v) / 5e-4);
      off.second = std::max(off.second, std::abs(run.column("/probes/moment", probe)[i] - M) / 1.9e6);
    }
  return off;
}

TEST(Timoshenko, MovingForce) {
  Results coarse = run_yaml(moving_force, {{"beam_elements_per_span", "32"}}),
          fine = run_yaml(moving_force, {{"beam_elements_per_span", "128"}, {"ts_dt", "1e-5"}});
  const auto off_coarse = errors_of(coarse), off = errors_of(fine);
  RecordProperty("error", text(off.first));
  RecordProperty("moment_error", text(off.second));
  EXPECT_LT(off.first, 1e-5);
  EXPECT_LT(off.second, 1e-4);
  EXPECT_LT(off.first, off_coarse.first / 14.0);
  EXPECT_LT(energy_error(fine), 1e-6);
}

TEST(Timoshenko, ModesAndElementsAgree) {
  const Values mesh = {{"beam_elements_per_span", "32"}, {"beam_rayleigh", "2.0,2.0e-6"}};
  Values by_modes = mesh;
  by_modes.emplace_back("model_modes", "62");
  Results elements = run_yaml(moving_force, mesh), modes = run_yaml(moving_force, by_modes);
  EXPECT_LT(relative_difference(modes.column("/probes/deflection", 1), elements.column("/probes/deflection", 1)), 1e-6);
  EXPECT_LT(relative_difference(modes.column("/probes/moment", 1), elements.column("/probes/moment", 1)), 1e-5);
}

// A wheel over the span: its path has no kink at nodes, so that the force hardly changes with the mesh.
TEST(Timoshenko, WheelsMeetNoKinkAtNodes) {
  const std::string scene = std::string(R"(
beam: {spans: 8.0, EI: 3.0e10, GA: 4.0e9, mass: 6.0e3, rayleigh: [2.0, 1.0e-4]}
vehicle: {coach: {file: )") +
                            source_folder() +
                            R"(/options/vehicles/velaro.yml}}
train: {vehicles: coach, speed: 40.0}
ts: {dt: 5.0e-5}
output: {interval: 1.0e-3}
)";
  Results coarse = run_yaml(scene, {{"beam_elements_per_span", "32"}}),
          fine = run_yaml(scene, {{"beam_elements_per_span", "128"}});
  const double weight = coarse("/vehicles/0/wheel_1/normal_force")[0];
  double apart = 0.0;
  const std::vector<double> a = coarse("/vehicles/0/wheel_1/normal_force"),
                            b = fine("/vehicles/0/wheel_1/normal_force");
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) apart = std::max(apart, std::abs(a[i] - b[i]));
  RecordProperty("apart", text(apart / weight));
  EXPECT_LT(apart, 0.01 * weight);
  EXPECT_LT(energy_error(coarse), 1e-4);
}

}  // namespace
}  // namespace traverse::test
