// Springs with play, on one side, by tables, and dampers that blow off, against exact piecewise solutions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/newton_law.hpp"
#include "support/temporary_folder.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double mass = 2.0, stiffness = 800.0, gap = 0.05, speed = 1.5;  // kg, N/m, m, m/s
const double omega = std::sqrt(stiffness / mass);

// A body on a guide along x at a spring of 3 m that is without force at the start, 1.5 m/s fast.
constexpr const char* slider = R"(
vehicle:
  slider:
    bodies:  [body]
    joints:  [guide]
    springs: [spring]
    body:   {mass: 2.0, inertia: 0.1, position: [0.0, 0.0], velocity: [1.5, 0.0, 0.0]}
    guide:  {type: prismatic, bodies: [ground, body], point: [0.0, 0.0], axis: [1.0, 0.0]}
    spring: {bodies: [ground, body], from: [-3.0, 0.0], to: [0.0, 0.0]}
train: {vehicles: slider}
scene: {start: given}
gravity: 0.0
)";

// The same body turning about its centre on a torsion spring, its inertia 2 kg m2, at 1.5 rad/s.
constexpr const char* rotor = R"(
vehicle:
  slider:
    bodies:  [body]
    joints:  [guide]
    torsion_springs: [spring]
    body:   {mass: 1.0, inertia: 2.0, position: [0.0, 0.0], velocity: [0.0, 0.0, 1.5]}
    guide:  {type: revolute, bodies: [ground, body], point: [0.0, 0.0]}
    spring: {bodies: [ground, body]}
train: {vehicles: slider}
scene: {start: given}
gravity: 0.0
)";

const std::string spring = "vehicle_slider_spring_";
Values every_step(double step, double end) {
  return {{"ts_dt", text(step)}, {"output_interval", text(step)}, {"ts_max_time", text(end)}};
}

// Position and force of the oscillator with play: straight flights and half sines in turn.
struct Play {
  double position, force;  // m, N (tension)
};
Play play(double t) {
  const double flight = 2.0 * gap / speed, half = pi / omega;
  t += 0.5 * flight;  // since the play's lower end
  const auto turn = static_cast<long>(t / (flight + half));
  const double side = turn % 2 == 0 ? 1.0 : -1.0, since = t - static_cast<double>(turn) * (flight + half);
  if (since < flight) return {side * (since * speed - gap), 0.0};
  const double beyond = speed / omega * std::sin(omega * (since - flight));
  return {side * (gap + beyond), side * stiffness * beyond};
}

struct Differences {
  double position = 0.0, force = 0.0;  // m, N
};
Differences of_play(Results run, const std::string& coordinate, std::size_t column, const std::string& force,
                    double sign) {
  Differences largest;
  const std::vector<double> t = run.time(), x = run.column(coordinate, column), f = run(force);
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Play exact = play(t[i]);
    largest.position = std::max(largest.position, std::abs(x[i] - exact.position));
    largest.force = std::max(largest.force, std::abs(sign * f[i] - exact.force));
  }
  EXPECT_LT(newton_imbalance(run).force, 1e-9);
  EXPECT_LT(newton_imbalance(run).moment, 1e-9);
  return largest;
}

const double turns = 3.0 * (4.0 * gap / speed + 2.0 * pi / omega);  // s

TEST(SpringWithPlay, ThreeTurnsOfAnOscillator) {
  const auto differences = [](double step) {
    return of_play(run_yaml(slider, every_step(step, turns) +
                                        Values{{spring + "stiffness", text(stiffness)}, {spring + "gap", text(gap)}}),
                   "/vehicles/0/body/position", 0, "/vehicles/0/spring/force", 1.0);
  };
  const Differences coarse = differences(4e-4), fine = differences(1e-4);
  RecordProperty("error", text(fine.position / gap));
  RecordProperty("force_error", text(fine.force / (speed * std::sqrt(stiffness * mass))));
  EXPECT_LT(fine.position, 3e-6 * gap);
  EXPECT_LT(fine.force, 3e-6 * speed * std::sqrt(stiffness * mass));
  EXPECT_LT(fine.position, 0.2 * coarse.position) << "at least second order, with corners inside steps";
}

TEST(SpringWithPlay, ThreeTurnsOfARotor) {
  const Differences d =
      of_play(run_yaml(rotor, every_step(1e-4, turns) +
                                  Values{{spring + "stiffness", text(stiffness)}, {spring + "gap", text(gap)}}),
              "/vehicles/0/body/position", 2, "/vehicles/0/spring/moment", -1.0);
  RecordProperty("error", text(d.position / gap));
  EXPECT_LT(d.position, 3e-6 * gap);
  EXPECT_LT(d.force, 3e-6 * speed * std::sqrt(stiffness * mass));
}

// A linear spring as a table of three lines, its damper as one of two: the same run to rounding.
TEST(SpringByTable, StraightTablesAreALinearSpring) {
  const TemporaryFolder folder;
  const std::string law = folder.write("law.csv", "# m, N\n-0.1, -80\n0.02, 16\n0.03, 24\n1.0, 800\n");
  const std::string damper = folder.write("damper.csv", "-1.0, -6\n0.0, 0.0\n0.5, 3\n");
  const Values common = every_step(1e-3, 1.0);
  Results table = run_yaml(slider, common + Values{{spring + "table", law}, {spring + "damper_table", damper}});
  Results linear = run_yaml(slider, common + Values{{spring + "stiffness", "800"}, {spring + "damping", "6"}});
  for (const char* name : {"body/position", "body/velocity", "body/acceleration", "spring/force"}) {
    const std::string set = std::string("/vehicles/0/") + name;
    EXPECT_LT(relative_difference(table(set), linear(set)), 1e-11) << set;
  }
  EXPECT_LT(relative_difference(table("/energy/strain"), linear("/energy/strain")), 1e-11);
  EXPECT_LT(relative_difference(table("/energy/dissipated"), linear("/energy/dissipated")), 1e-11);
}

// A spring and a damper on one side only, parted from the body where they would pull: with zeta = sin(theta) the
// blow lasts (pi - 2 theta)/(omega cos(theta)) and gives back exp(-zeta omega duration) of the speed.
TEST(BumpStop, GivesBackWhatItsDamperLeaves) {
  const double zeta = 0.2, theta = std::asin(zeta), blow = (pi - 2.0 * theta) / (omega * std::cos(theta));
  const double restitution = std::exp(-zeta * omega * blow), reach = gap / speed, end = reach + blow + 0.1;
  Results run = run_yaml(slider, every_step(2e-5, end) + Values{{"output_interval", "1e-3"},
                                                                {spring + "stiffness", text(stiffness)},
                                                                {spring + "damping", text(2.0 * zeta * omega * mass)},
                                                                {spring + "gap", text(gap)},
                                                                {spring + "side", "compression"},
                                                                {"vehicle_slider_body_velocity", "-1.5, 0, 0"}});
  const double v = run.column("/vehicles/0/body/velocity").back();
  const double leaves =
      -gap - speed / (omega * std::cos(theta)) * std::exp(-zeta * omega * blow) * std::sin(2.0 * theta);
  const double x = leaves + restitution * speed * (run.time().back() - reach - blow);
  RecordProperty("error", text(v / (restitution * speed) - 1.0));
  RecordProperty("position_error", text((run.column("/vehicles/0/body/position").back() - x) / gap));
  EXPECT_NEAR(v, restitution * speed, 1e-4 * speed);
  EXPECT_NEAR(run.column("/vehicles/0/body/position").back(), x, 1e-4 * gap);
  const std::vector<double> force = run("/vehicles/0/spring/force");
  EXPECT_LE(*std::max_element(force.begin(), force.end()), 0.0) << "it never pulls";
  EXPECT_LT(*std::min_element(force.begin(), force.end()), -40.0);
  const double lost = 0.5 * mass * speed * speed * (1.0 - restitution * restitution);
  EXPECT_NEAR(run("/energy/dissipated").back(), lost, 1e-4 * lost);
  EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 1e-4 * lost);
}

TEST(CheckRope, HoldsOneWayOnly) {
  Results run = run_yaml(slider, every_step(1e-4, turns) + Values{{spring + "stiffness", text(stiffness)},
                                                                  {spring + "gap", text(gap)},
                                                                  {spring + "side", "tension"}});
  // thrown back by the first half sine, the body never sees the spring again
  EXPECT_NEAR(run.column("/vehicles/0/body/velocity").back(), -speed, 1e-6 * speed);
  const std::vector<double> force = run("/vehicles/0/spring/force");
  EXPECT_GE(*std::min_element(force.begin(), force.end()), 0.0);
  EXPECT_NEAR(*std::max_element(force.begin(), force.end()), speed * std::sqrt(stiffness * mass), 1e-2);
}

// Nothing but a damper of 30 N s/m that blows off at 0.4 m/s to 5 N s/m: two exponentials.
TEST(BlowOffDamper, DecaysByTwoExponentials) {
  const TemporaryFolder folder;
  const std::string table = folder.write("damper.csv", "-5, -35\n-0.4, -12\n0.4, 12\n5.0, 35\n");
  const double first = 30.0, second = 5.0, knee = 0.4, knee_force = 12.0;
  const double level = knee_force / second - knee;  // m/s: the second line's force is second*(v + level)
  const double turn = mass / second * std::log((speed + level) / (knee + level));
  Results run = run_yaml(slider, every_step(1e-4, turn + 0.3) + Values{{spring + "damper_table", table}});
  const std::vector<double> t = run.time(), v = run.column("/vehicles/0/body/velocity");
  const std::vector<double> x = run.column("/vehicles/0/body/position"), force = run("/vehicles/0/spring/force");
  double worst = 0.0, worst_position = 0.0, worst_force = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const bool early = t[i] < turn;
    const double c = early ? second : first, base = early ? level : 0.0, from = early ? speed : knee;
    const double since = early ? t[i] : t[i] - turn, decay = std::exp(-c * since / mass);
    const double before = early ? 0.0 : mass / second * (speed - knee) - level * turn;
    const double exact = (from + base) * decay - base;
    worst = std::max(worst, std::abs(v[i] - exact));
    worst_position =
        std::max(worst_position, std::abs(x[i] - before - (mass / c * (from + base) * (1.0 - decay) - base * since)));
    worst_force = std::max(worst_force, std::abs(force[i] - c * (exact + base)));
  }
  RecordProperty("error", text(worst / speed));
  EXPECT_LT(worst, 1e-7 * speed);
  EXPECT_LT(worst_position, 1e-7 * speed);
  EXPECT_LT(worst_force, 1e-5 * 2.0 * knee_force);
  EXPECT_LT(std::abs(peak(run("/energy/residual")).first), 1e-7 * mass * speed * speed);
}

TEST(SpringLaws, PreloadSetsTheFreeLength) {
  const TemporaryFolder folder;
  const std::string table = folder.write("law.csv", "-1, -300\n0, 0\n1, 600\n");
  const Values options = every_step(1e-3, 0.01) + Values{{spring + "table", table}, {spring + "gap", text(gap)}};
  for (const double preload : {-60.0, 150.0}) {
    Results run = run_yaml(slider, options + Values{{spring + "preload", text(preload)}});
    EXPECT_NEAR(run("/vehicles/0/spring/force")[0], preload, 1e-10);
  }
}

// --- what is refused -------------------------------------------------------------------------------------------------

std::string refusal(const Values& options) {
  try {
    run_yaml(slider, every_step(1e-3, 0.01) + options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SpringLaws, Refusals) {
  const TemporaryFolder folder;
  const auto expect = [](const Values& options, const std::vector<std::string>& parts) {
    const std::string message = refusal(options);
    for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << ": " << message;
  };
  const std::string good = folder.write("good.csv", "-1 -1\n1 1\n"), back = folder.write("back.csv", "1 1\n-1 -1\n");
  const std::string gains = folder.write("gains.csv", "-1 -1\n0 0\n1 -2\n"),
                    off = folder.write("off.csv", "0 1\n1 2\n");
  expect({}, {spring + "stiffness", "missing", "a table"});
  expect({{spring + "table", good}, {spring + "stiffness", "1"}},
         {spring + "table = ", "give either this or " + spring + "stiffness"});
  expect({{spring + "damper_table", good}, {spring + "damping", "1"}}, {spring + "damper_table = ", "either"});
  expect({{spring + "table", back}}, {spring + "table = ", "increase strictly", "row 2"});
  expect({{spring + "damper_table", gains}}, {spring + "damper_table = ", "dissipates energy", "-2 at 1"});
  expect({{spring + "table", off}, {spring + "gap", "0.1"}}, {spring + "table = ", "sign of the elongation", "1 at 0"});
  expect({{spring + "stiffness", "1"}, {spring + "gap", "-0.1"}}, {spring + "gap = -0.1", "not below 0"});
  expect({{spring + "stiffness", "1"}, {spring + "side", "left"}}, {"side = left", "both, compression, tension"});
  expect({{spring + "stiffness", "1"}, {spring + "side", "tension"}, {spring + "preload", "-5"}},
         {spring + "preload = -5", "free_length"});
  expect({{spring + "table", "nowhere.csv"}}, {spring + "table = nowhere.csv"});
}

}  // namespace
}  // namespace traverse::test
