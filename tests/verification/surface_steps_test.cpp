// Where the running surface steps: a wheel touches the floor below the step and its edge, from L - sqrt(2 R d) on.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "support/curve.hpp"
#include "support/runge_kutta.hpp"
#include "support/scene_run.hpp"

namespace traverse::test {
namespace {

constexpr double R = 0.46, mass = 1000.0, g = 9.81, k = 3.64e10;  // m, kg, m/s2, N/m^1.5

/// A wheelset without damping that rolls slowly to the right; the beams hardly bend.
std::string wheel_on(const std::string& beam, double from, double speed, double end) {
  return beam + fmt::format(R"(
vehicle:
  car:
    bodies: [axle]
    drivers: [level]
    wheels: [wheel]
    axle: {{mass: 1000.0, inertia: 100.0, position: [0.0, 0.46]}}
    level: {{body: axle, coordinate: phi}}
    wheel: {{body: axle, radius: 0.46, law: hertz, stiffness: 3.64e10}}
train: {{vehicles: car, speed: {}, positions: {}}}
ts: {{max_time: {}, dt: 2.0e-4}}
output: {{interval: 0.002}}
)",
                            speed, from, end);
}

const std::string settled =
    "beam: {spans: [4.0], EI: 1.0e12, mass: 1.0e4, elements_per_span: 4}\nsupport: {settlement: [0.0, 0.0]}\n";

struct Extremes {
  double force = 0.0, height = 0.0;  // N, m
};

/// The same wheel as a mass on two Hertz springs: the floor, and the edge of a step of d at x = 0, which it comes to
/// from the left with the speed v.
Extremes on_springs(double d, double v, double from, double end) {
  const auto law = [](double depth) { return depth > 0.0 ? k * std::pow(depth, 1.5) : 0.0; };
  const auto forces = [&](double x, double y) {
    const double aside = std::max(-x, 0.0), away = std::hypot(aside, y - d);  // of the edge, then of the upper floor
    const double floor = x < 0.0 ? law(R - y) : 0.0, edge = law(R - away);
    return std::pair{floor, std::pair{edge, edge * (y - d) / away}};
  };
  State<2> y(R - std::pow(mass * g / k, 2.0 / 3.0), 0.0);
  Extremes most;
  double x = from;
  const double h = 1e-5;
  for (double t = 0.0; t < end; t += h) {
    const auto rate = [&](const State<2>& s) {
      const auto [floor, edge] = forces(x, s[0]);
      return State<2>(s[1], (floor + edge.second) / mass - g);
    };
    runge_kutta<2>(rate, h, y);
    x += v * h;
    const auto [floor, edge] = forces(x, y[0]);
    most.force = std::max(most.force, floor + edge.first);
    most.height = std::max(most.height, y[0]);
  }
  return most;
}

// Seen before: 17.3, 67.3 and 5,322 kN, with energy from nowhere.
TEST(SurfaceSteps, WheelRisesOntoTheGroundBesideASettledEnd) {
  for (const double d : {0.001, 0.0024, 0.005}) {
    Results run = run_yaml(wheel_on(settled, 3.8, 0.2, 1.2), {{"support_settlement", fmt::format("{0},{0}", -d)}});
    const Extremes exact = on_springs(d, 0.2, -0.2, 1.2);
    const std::vector<double>& force = run("/vehicles/0/wheel/normal_force");
    const double greatest = run.attribute("/summary", "greatest_wheel_force");
    EXPECT_NEAR(greatest, exact.force, 0.01 * exact.force) << d;
    EXPECT_LE(*std::max_element(force.begin(), force.end()), greatest * (1.0 + 1e-9));
    const std::vector<double> y = run.column("/vehicles/0/axle/position", 1),
                              x = run.column("/vehicles/0/axle/position");
    EXPECT_LT(energy_error(run), 1e-3) << d;
    // Without damping it hops; while the edge alone carries it its centre is on a circle about the edge.
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double aside = std::max(4.0 - x[i], 0.0);
      const double least = aside * aside < 2.0 * R * d - d * d ? std::sqrt(R * R - aside * aside) : R - d;
      EXPECT_GT(y[i], least - 3e-4) << "x = " << x[i];
    }
  }
}

// Two slabs side by side on springs of their own, which yield by 2 mm under the wheel: it sinks with the first one and
// rolls up the edge of the second.
TEST(SurfaceSteps, EnergyBalancesWhereSlabsMeetOnYieldingBearings) {
  const std::string slabs = R"(
beam: {spans: [3.0, 3.0], EI: 1.0e9, mass: 1.0e3, elements_per_span: 4, continuity: simply_supported}
support: {types: [free, free, free]}
foundation: {vertical: {x: [0.0, 3.0, 6.0], k: 5.0e6, side: [right, both, right]}}
)";
  Results run = run_yaml(wheel_on(slabs, 2.9, 0.5, 0.3), {{"vehicle_car_wheel_damping", "1e5"}});
  EXPECT_LT(energy_error(run), 2e-3);
  EXPECT_LT(run.attribute("/summary", "greatest_wheel_force"), 2.5 * mass * g);
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), 0.0);
}

const std::string cantilever =
    "beam: {spans: [4.0], EI: 1.0e14, mass: 1.0e4, elements_per_span: 4}\nsupport: {types: [clamped, free]}\n"
    "surface: {right: none}\n";

// Faster than sqrt(g R) it flies from the tip. The circle about the tip falls away by v^2 t^2/(2 R), so that the
// contact is relieved of its penetration d in sqrt(2 R d)/v: with N/N0 = (1 - t^2)^1.5 over that time it gives the
// wheel the velocity 3 pi/16 g sqrt(2 R d)/v.
TEST(SurfaceSteps, WheelFliesWhereTheSurfaceEnds) {
  Results run = run_yaml(wheel_on(cantilever, 3.0, 10.0, 0.5));
  const double d = std::pow(mass * g / k, 2.0 / 3.0);
  const double up = 3.0 * std::acos(-1.0) / 16.0 * g * std::sqrt(2.0 * R * d) / 10.0;
  const std::vector<double> y = run.column("/vehicles/0/axle/position", 1), t = run.time();
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double flight = std::max(0.0, t[i] - 0.1);
    EXPECT_NEAR(y[i], R - d + up * flight - 0.5 * g * flight * flight, 2e-5) << t[i];
  }
  EXPECT_EQ(run("/vehicles/0/wheel/normal_force").back(), 0.0);
  EXPECT_EQ(run.attribute("/summary", "contact_losses"), 1.0);
  EXPECT_LT(energy_error(run), 1e-6);
}

// Slower it turns about the tip, x^2 + y^2 = R^2 at constant x' = v, until y'' = -v^2 R^2/y^3 is -g.
TEST(SurfaceSteps, WheelTurnsAboutTheCornerWhereTheSurfaceEnds) {
  const double v = 0.5, y_off = std::cbrt(v * v * R * R / g), x_off = std::sqrt(R * R - y_off * y_off);
  const double fall = v * x_off / y_off;  // m/s
  Results run = run_yaml(wheel_on(cantilever, 3.9, v, 1.3));
  const std::vector<double> y = run.column("/vehicles/0/axle/position", 1), x = run.column("/vehicles/0/axle/position");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double beyond = std::max(0.0, x[i] - 4.0), flight = std::max(0.0, beyond - x_off) / v;
    const double circle = std::sqrt(R * R - std::pow(std::min(beyond, x_off), 2));
    EXPECT_NEAR(y[i], circle - flight * (fall + 0.5 * g * flight), 2e-3) << x[i];
  }
  EXPECT_LT(energy_error(run), 1e-4);
}

/// A wheel of 5 t on a beam with a soft bearing at one end; the ground begins beside it.
constexpr double span = 16.0, r = 0.5, weight = 5000.0 * g, bearing = 6.0e6;  // m, N, N/m
const std::string soft_end = R"(
beam: {spans: [16.0], EI: 1.0e13, mass: 2500.0, elements_per_span: 4}
vehicle:
  q:
    bodies: [b]
    drivers: [level]
    wheels: [w]
    b: {mass: 5000.0, inertia: 10.0, position: [0.0, 0.5]}
    level: {body: b, coordinate: phi, value: 0.0}
    w: {body: b, radius: 0.5}
train: {vehicles: q, speed: 10.0}
scene: {analysis: static}
output: {probes: [0.0, 16.0]}
)";

struct Resting {
  double sinking = 0.0, force = 0.0;  // of the beam's end, m; of the wheel, N
};

/// The wheel at rest at a distance before the soft end of a rigid beam, by bisection. It touches the beam and the edge
/// of the ground beside it; what both overlap, down to the beam's lower end, counts once.
Resting at_rest(double before, const std::function<double(double)>& law) {
  const double x = span - before;
  struct Sum {
    double up = 0.0, on_end = 0.0, all = 0.0;  // on the wheel, on the beam's end, of all magnitudes; N
  };
  const auto forces = [&](double d, double y) {
    Sum sum;
    const auto add = [&](double sign, double at, double height, double arm) {
      const double away = std::hypot(x - at, y - height), f = sign * law(r - away);
      sum.up += f * (y - height) / away;
      sum.on_end += arm * f * (y - height) / away;
      sum.all += f;
    };
    const double slope = d / span, station = std::min((x - y * slope) / (1.0 + slope * slope), span);
    add(1.0, station, -slope * station, station / span);
    add(1.0, span, 0.0, 0.0);
    add(-1.0, span, -d, 1.0);
    return sum;
  };
  const auto zero_of = [](double low, double high, const auto& falling) {
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (falling(middle) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  const auto height = [&](double d) {
    return zero_of(0.5 * r, 1.1 * r, [&](double y) { return forces(d, y).up - weight; });
  };
  const double d = zero_of(0.0, 0.02, [&](double one) { return forces(one, height(one)).on_end - bearing * one; });
  return {d, forces(d, height(d)).all};
}

TEST(SurfaceSteps, WheelsStandBesideASoftEnd) {
  const auto linear = [](double depth) { return depth > 0.0 ? 2.0e6 * depth : 0.0; };
  const auto hertz = [](double depth) { return depth > 0.0 ? 1.0e9 * std::pow(depth, 1.5) : 0.0; };
  for (const bool is_hertz : {false, true})
    for (const bool at_left : {false, true})
      for (const double before : {0.05, 0.03, 0.02, 0.005, 0.001, 1e-4, 1e-6, 0.0, -1e-6, -1e-4, -0.001, -0.02})
        for (const char* vehicles : {"full", "linear"}) {
          Resting exact = {0.0, weight};
          if (before > 0.0) exact = is_hertz ? at_rest(before, hertz) : at_rest(before, linear);
          Results run = run_yaml(soft_end, {{"support_types", at_left ? "roller,pinned" : "pinned,roller"},
                                            {"support_stiffness", at_left ? "6e6,0" : "0,6e6"},
                                            {"train_positions", fmt::format("{}", at_left ? before : span - before)},
                                            {"vehicle_q_w_law", is_hertz ? "hertz" : "linear"},
                                            {"vehicle_q_w_stiffness", is_hertz ? "1e9" : "2e6"},
                                            {"model_vehicles", vehicles}});
          EXPECT_NEAR(run.column("/probes/deflection", at_left ? 0 : 1).back(), -exact.sinking,
                      1e-3 * exact.sinking + 1e-10)
              << before << vehicles << is_hertz << at_left;
          EXPECT_NEAR(run("/vehicles/0/w/normal_force").back(), exact.force, 1e-5 * weight) << before << vehicles;
        }
}

// Two rigid slabs with beds of their own meet at 8 m. A wheel above the joint presses on both ends, which stay level:
// each slab carries a half. With another wheel at 7.7 m, of which 7.7/8 acts on the left end, each end carries half of
// the sum.
TEST(SurfaceSteps, WheelsAboveTheJointOfTwoSlabsStandOnBoth) {
  const Values slabs = {{"beam_spans", "8,8"},
                        {"beam_continuity", "simply_supported"},
                        {"support_types", "free,free,free"},
                        {"foundation_vertical_x", "0,8,16"},
                        {"foundation_vertical_k", "5e6"},
                        {"foundation_vertical_side", "right,both,right"},
                        {"output_probes", "8"}};
  for (const bool is_hertz : {false, true})
    for (const bool two : {false, true}) {
      Values options = slabs;
      options.insert(options.end(), {{"train_vehicles", two ? "q,q" : "q"},
                                     {"train_positions", two ? "8,7.7" : "8"},
                                     {"vehicle_q_w_law", is_hertz ? "hertz" : "linear"},
                                     {"vehicle_q_w_stiffness", is_hertz ? "1e9" : "2e6"}});
      Results run = run_yaml(soft_end, options);
      const double on_each = 0.5 * weight * (two ? 1.0 + 7.7 / 8.0 : 1.0);
      EXPECT_NEAR(run.column("/probes/deflection").back(), -on_each / 5.0e6, 1e-3 * on_each / 5.0e6) << two;
      EXPECT_NEAR(run("/vehicles/0/w/normal_force").back(), weight, 1e-5 * weight) << two;
    }
}

// A wheel that has passed a step touches at one point again. Seen before: the force of its last second point was added
// to those of all later steps of linear vehicles, 101 kN between stored samples.
TEST(SurfaceSteps, LinearVehiclesForgetPointsThatTheyHaveLeft) {
  const std::string passing = soft_end + "support: {types: [pinned, roller], stiffness: [0, 5.0e7]}\n";
  for (const bool leftwards : {false, true})
    for (const char* step : {"5e-4", "3e-4", "2e-4"}) {
      Values options = {{"scene_analysis", "transient"},
                        {"model_vehicles", "linear"},
                        {"ts_dt", step},
                        {"vehicle_q_w_law", "linear"},
                        {"vehicle_q_w_stiffness", "2e6"},
                        {"scene_tail", "0.1"},
                        {"train_speed", leftwards ? "-19" : "19"},
                        {"train_positions", leftwards ? "1" : "15"}};
      if (leftwards)
        options.insert(options.end(), {{"support_types", "roller,pinned"}, {"support_stiffness", "5e7,0"}});
      Results run = run_yaml(passing, options);
      const std::vector<double>& force = run("/vehicles/0/w/normal_force");
      const double greatest = *std::max_element(force.begin(), force.end()),
                   least = *std::min_element(force.begin(), force.end());
      EXPECT_NEAR(run.attribute("/summary", "greatest_wheel_force"), greatest, 1e-3 * weight) << step << leftwards;
      EXPECT_NEAR(run.attribute("/summary", "least_wheel_force"), least, 1e-3 * weight) << step << leftwards;
      EXPECT_LT(greatest, 1.1 * weight);
    }
}

}  // namespace
}  // namespace traverse::test
