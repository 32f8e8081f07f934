// The moment under a passing force, on a beam with stiffness-proportional damping: it follows b behind the force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "recovery/load_movement.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double EI = 2e10, mass = 1e4, L = 25.0, F = 2e5, v = 60.0, a = 0.5, b = 1e-3;

/// Moment in the middle of a simple span when the force is at x = v t, by modes, with C = a M + b K.
double exact_moment(double t) {
  double sum = 0.0;
  for (int n = 1; n < 4000; n += 2) {
    const double k = n * pi / L, forcing = k * v, omega2 = std::pow(k, 4) * EI / mass, c = a + b * omega2;
    const Complex steady = 2.0 * F / (mass * L) / Complex(omega2 - forcing * forcing, c * forcing);
    const Complex root = std::sqrt(Complex(0.25 * c * c - omega2, 0.0));
    const Complex s1 = -omega2 / (0.5 * c + root), s2 = -0.5 * c - root;  // s1 without cancellation
    const double q0 = -steady.imag(), rate0 = -(Complex(0.0, forcing) * steady).imag();
    const Complex c1 = (rate0 - s2 * q0) / (s1 - s2), c2 = q0 - c1;
    const double q =
        (steady * std::exp(Complex(0.0, forcing * t))).imag() + (c1 * std::exp(s1 * t) + c2 * std::exp(s2 * t)).real();
    sum += EI * k * k * q * (n % 4 == 1 ? 1.0 : -1.0);
  }
  return sum;
}

// Whatever the mesh.
TEST(ViscousLag, MomentUnderAPassingForce) {
  double exact = 0.0;
  const double middle = 0.5 * L / v;
  for (int i = -40; i <= 40; ++i) exact = std::max(exact, exact_moment(middle + i * 1e-4));
  for (const char* elements : {"20", "80", "320"}) {
    Results run = run_yaml(
        "beam: {spans: 25.0, EI: 2.0e10, mass: 1.0e4, rayleigh: [0.5, 1.0e-3]}\n"
        "support: {types: [pinned, roller]}\n"
        "load: {forces: 2.0e5, positions: 0.0, speed: 60.0}\n",
        {{"ts_dt", "2e-4"},
         {"beam_elements_per_span", elements},
         {"step_probes", "true"},
         {"output_interval", "2e-4"}});
    EXPECT_NEAR(run.attribute("/summary", "moment") / exact, 1.0, 2e-5) << elements;
    const std::vector<double> time = run.time(), moment = run.column("/probes/moment");
    double worst = 0.0;
    for (std::size_t i = 0; i < time.size() && time[i] < L / v; i += 16)
      worst = std::max(worst, std::abs(moment[i] - exact_moment(time[i])));
    EXPECT_LT(worst, 1e-3 * exact) << elements;
  }
}

recovery::Recovery middle_of(const beam::Beam& beam) { return {beam, {0.5 * L}, 0.0}; }

beam::Beam simple_span(int elements) {
  beam::BeamModel model;
  model.spans = {L};
  model.elements = {elements};
  model.supports = {beam::Support::pinned, beam::Support::roller};
  model.EI = EI;
  model.mass = mass;
  model.axial = false;
  return {PETSC_COMM_SELF, model};
}

// m + b dm/dt = c for c that rises and falls along straight lines, with any intervals, is followed exactly.
TEST(ViscousLag, FollowsStraightLines) {
  const beam::Beam beam = simple_span(4);
  const recovery::Recovery recovery = middle_of(beam);
  recovery::LoadMovement movement(recovery);
  recovery::ViscousLag lag(recovery, movement, 0.3);
  std::vector<recovery::Response> response(1);
  const auto c = [](double t) { return t < 1.0 ? 2.0 * t : 3.0 - t; };
  const auto m = [](double t) {
    const double at_one = 2.0 - 0.6 + 0.6 * std::exp(-1.0 / 0.3);
    return t < 1.0 ? 2.0 * t - 0.6 + 0.6 * std::exp(-t / 0.3)
                   : 3.0 - t + 0.3 + (at_one - 2.3) * std::exp(-(t - 1.0) / 0.3);
  };
  for (const double t : {0.0, 0.2, 0.21, 0.9, 1.0, 1.001, 2.5, 2.5, 4.0}) {
    response[0].moment = 5.0 + c(t);
    response[0].shear = 1.0;
    response[0].nodal_moment = 5.0;
    response[0].nodal_moment_rate = 7.0;
    movement.advance(t, {});
    lag.apply(response);
    EXPECT_NEAR(response[0].moment, 5.0 + m(t), 1e-14) << t;
    EXPECT_NEAR(response[0].moment_rate, 7.0 + (c(t) - m(t)) / 0.3, 1e-13) << t;
    EXPECT_DOUBLE_EQ(response[0].shear, 1.0);
  }
}

// A force that passes the station's element within an interval is followed as with intervals a hundred times shorter.
TEST(ViscousLag, FollowsAForceWithinAnInterval) {
  const beam::Beam beam = simple_span(4);
  const recovery::Recovery recovery = middle_of(beam);
  const auto moment_at = [&](int intervals) {
    recovery::LoadMovement movement(recovery);
    recovery::ViscousLag lag(recovery, movement, 0.01);
    std::vector<recovery::Response> response(1);
    const double from = 0.5 * L - 2.0, to = 0.5 * L + 4.0;
    for (int i = 0; i <= intervals; ++i) {
      const double t = 0.1 * i / intervals, x = from + (to - from) * i / intervals;
      const beam::Station s = beam.mesh().locate(x);
      const recovery::ElementLoad load{s.element, s.xi, 0.0, -F, 0.0, 60.0, 0.0, 0};
      response[0] = {};
      response[0].moment = recovery.inside(0, x, load)[0];
      movement.advance(t, {load});
      lag.apply(response);
    }
    return response[0].moment;
  };
  const double exact = moment_at(6400);
  EXPECT_GT(std::abs(exact), 0.01 * F);
  EXPECT_NEAR(moment_at(64), exact, 2e-6 * std::abs(exact));
  EXPECT_NEAR(moment_at(4), exact, 1e-3 * std::abs(exact));
}

// The shear behind a force that stood exactly on a station at a node when a step ended there: rounding gives the force
// to the element on one side or the other, and nothing depends on it. c jumps from 0 to about F; m relaxes within b.
TEST(ViscousLag, AForceThatStoodOnTheStation) {
  constexpr double lag_b = 1e-4, h = 3e-4;
  const beam::Beam beam = simple_span(4);
  const recovery::Recovery recovery = middle_of(beam);
  for (const double speed : {60.0, -60.0})
    for (const bool left : {true, false}) {
      recovery::LoadMovement movement(recovery);
      recovery::ViscousLag lag(recovery, movement, lag_b);
      std::vector<recovery::Response> response(1);
      const auto shear_with = [&](double t, const recovery::ElementLoad& load) {
        response[0] = recovery.inside_response(0, load);
        movement.advance(t, {load});
        lag.apply(response);
        return response[0].shear;
      };
      const auto at = [&](double x) {
        const beam::Station s = beam.mesh().locate(x);
        return recovery::ElementLoad{s.element, s.xi, 0.0, -F, 0.0, speed, 0.0, 0};
      };
      shear_with(0.0, at(0.5 * L - speed * h));
      const double before = shear_with(h, {left ? 1 : 2, left ? 1.0 : 0.0, 0.0, -F, 0.0, speed, 0.0, 0});
      const double behind = shear_with(2.0 * h, at(0.5 * L + speed * h));
      EXPECT_NEAR(before, speed > 0.0 ? 0.0 : F, 1e-3 * F) << speed << left;
      EXPECT_NEAR(behind, before + (speed > 0.0 ? F : -F) * (1.0 - std::exp(-h / lag_b)), 1e-3 * F) << speed << left;
      EXPECT_NEAR(response[0].unrelaxed_shear, (speed > 0.0 ? -F : F) * std::exp(-h / lag_b), 1e-9 * F);
    }
}

// A load that does not go as its speed says has passed no station: one at rest, whose position and speed are rounding
// errors, and one at an edge, about which its wheel turns before it leaves the beam.
TEST(ViscousLag, ALoadThatStandsOrTurnsAboutAnEdge) {
  const beam::Beam beam = simple_span(4);
  const recovery::Recovery recovery = middle_of(beam);
  for (const auto& [x, speed] : {std::pair{0.2 * L, 1e-13}, std::pair{0.7 * L, -1e-13}, std::pair{L, 60.0}}) {
    recovery::LoadMovement movement(recovery);
    recovery::ViscousLag lag(recovery, movement, 1e-3);
    std::vector<recovery::Response> response(1);
    double first = 0.0;
    for (int i = 0; i < 40; ++i) {
      const double sign = i % 2 == 0 ? 1.0 : -1.0;
      const beam::Station s = beam.mesh().locate(x + (x < L ? sign * 1e-14 : 0.0));
      std::vector<recovery::ElementLoad> loads = {
          {s.element, s.xi, 0.0, -F, 0.0, x < L ? sign * speed : speed, 0.0, 0}};
      if (x == L && i > 30) loads.clear();
      response[0] = loads.empty() ? recovery::Response() : recovery.inside_response(0, loads[0]);
      movement.advance(1e-4 * i, loads);
      lag.apply(response);
      if (i == 0) first = response[0].shear;
      EXPECT_NEAR(response[0].shear, first, 1e-9 * F) << x << " " << i;
      EXPECT_TRUE(movement.passages().empty()) << x << " " << i;
    }
  }
}

// A load at a station is on one side of it, whatever the rounding, and has passed it once, in the interval in which it
// was there, also if it enters, leaves or turns back.
TEST(LoadMovement, FindsPassages) {
  const beam::Beam beam = simple_span(4);
  const recovery::Recovery recovery(beam, {0.75 * L, 0.25 * L, 0.5 * L}, 0.0);
  recovery::LoadMovement movement(recovery);
  const auto load_at = [&](double x, double speed, int source) {
    const beam::Station s = beam.mesh().locate(x);
    return recovery::ElementLoad{s.element, s.xi, 0.0, -F, 0.0, speed, 0.0, source};
  };
  movement.advance(0.0, {load_at(0.2 * L, v, 1)});
  EXPECT_EQ(movement.interval(), 0.0);
  movement.advance(0.1 * L / v, {load_at(0.3 * L, v, 1), load_at(0.05 * L, v, 0)});
  ASSERT_EQ(movement.passages().size(), 1U);
  EXPECT_EQ(movement.passages()[0].station, 1U);
  EXPECT_NEAR(movement.passages()[0].time, 0.05 * L / v, 1e-12);
  movement.advance(0.6 * L / v, {load_at(0.5 * L * (1.0 + 1e-15), v, 0), load_at(0.8 * L, v, 1)});
  ASSERT_EQ(movement.passages().size(), 3U);  // that of the load at 0.5 L is still to come
  EXPECT_EQ(movement.passages()[0].station, 0U);
  EXPECT_EQ(movement.passages()[1].station, 1U);
  EXPECT_EQ(movement.passages()[2].station, 2U);
  movement.advance(0.7 * L / v, {load_at(0.45 * L, -v, 0)});  // it turns back; the other one is gone
  EXPECT_TRUE(movement.passages().empty());
}

}  // namespace
}  // namespace traverse::test
