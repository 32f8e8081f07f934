// What must not matter: left and right, where x begins, how a list is written, the unit of force; and what must add up
// or stay as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"

namespace traverse::test {
namespace {

using Matrix = std::vector<std::vector<double>>;

// Every column of a dataset.
Matrix columns(Results& run, const std::string& name) {
  const std::size_t count = run(name).size() / run.time().size();
  Matrix result;
  for (std::size_t c = 0; c < count; ++c) result.push_back(run.column(name, c));
  return result;
}

Matrix reversed(Matrix m) {
  std::reverse(m.begin(), m.end());
  return m;
}

std::vector<double> scaled(double factor, std::vector<double> values) {
  for (double& value : values) value *= factor;
  return values;
}

// Largest |a - factor*b| over largest |b|, over all columns.
double difference(const Matrix& a, const Matrix& b, double factor = 1.0) {
  std::vector<double> left, right;
  for (const auto& column : a) left.insert(left.end(), column.begin(), column.end());
  for (const auto& column : b)
    for (double value : column) right.push_back(factor * value);
  return relative_difference(left, right);
}

// --- left and right

// A half car, rubbing on its wheels, dropped on a bridge with nothing symmetric about it; `side` is 1 or -1.
std::string dropped_car(int side, double friction) {
  auto x = [side](double value) { return text(side * value); };
  const double length = 75.0;
  auto station = [&](double value) { return text(side > 0 ? value : length - value); };
  const std::string spans = side > 0 ? "[20.0, 30.0, 25.0]" : "[25.0, 30.0, 20.0]";
  const std::string types = side > 0 ? "[pinned, roller, roller, clamped]" : "[clamped, roller, roller, pinned]";
  return "beam: {spans: " + spans +
         ", elements_per_span: 5, EI: 8.33e9, EA: 1.2e10, mass: 2303.0, rayleigh: [0.5, 5.0e-4]}\n" +
         "support: {types: " + types + "}\n" + "foundation: {vertical: {x: " + station(40.0) +
         ", k: 2.0e7, c: 1.0e4}, rotational: {x: " + station(20.0) + ", k: 1.0e8, c: 0.0}}\n" + R"(
vehicle:
  car:
    bodies:  [body, front_axle, rear_axle]
    joints:  [front_guide, rear_guide]
    springs: [front_suspension, rear_suspension]
    wheels:  [front_wheel, rear_wheel]
    body:       {mass: 17735.0, inertia: 1.47e5, position: [0.0, 1.5], angle: )" +
         x(0.002) + R"(}
    front_axle: {mass: 1500.0, inertia: 100.0, position: [)" +
         x(2.0) + R"(, 0.5]}
    rear_axle:  {mass: 1000.0, inertia: 100.0, position: [)" +
         x(-2.0) + R"(, 0.5]}
    front_guide: {type: slot, bodies: [body, front_axle], point: [)" +
         x(2.0) + R"(, 0.5], axis: [0.0, 1.0]}
    rear_guide:  {type: slot, bodies: [body, rear_axle], point: [)" +
         x(-2.0) + R"(, 0.5], axis: [0.0, 1.0]}
    front_suspension: {bodies: [body, front_axle], from: [)" +
         x(2.0) + R"(, 1.5], to: [)" + x(2.0) + R"(, 0.5], stiffness: 2.47e6, damping: 3.0e4}
    rear_suspension:  {bodies: [body, rear_axle], from: [)" +
         x(-2.0) + R"(, 1.5], to: [)" + x(-2.0) + R"(, 0.5], stiffness: 4.23e6, damping: 4.0e4}
    front_wheel: {body: front_axle, radius: 0.5, law: hertz, stiffness: 1.0e9, friction: )" +
         text(friction) + R"(, transition_speed: 0.05}
    rear_wheel:  {body: rear_axle, radius: 0.5, law: linear, stiffness: 3.0e7, friction: )" +
         text(friction) + R"(, transition_speed: 0.05}
train: {vehicles: car, speed: 0.0, positions: )" +
         station(33.3) + R"(}
scene: {start: given}
ts: {max_time: 0.6, dt: 1.0e-3}
output: {interval: 5.0e-3, probes: )" +
         (side > 0 ? "[10.0, 27.0, 35.0, 48.0, 62.5]" : "[12.5, 27.0, 40.0, 48.0, 65.0]") + "}\n";
}

class Mirror : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Invariance, Mirror, testing::Values(0.0, 0.3),
                         [](const auto& friction) { return friction.param > 0.0 ? "friction" : "smooth"; });

TEST_P(Mirror, LeftIsRight) {
  Results a = run_yaml(dropped_car(1, GetParam()));
  Results b = run_yaml(dropped_car(-1, GetParam()));
  EXPECT_GT(std::abs(peak(a("/probes/deflection")).first), 1e-3);
  for (const char* name : {"deflection", "velocity", "acceleration", "moment"}) {
    const std::string dataset = std::string("/probes/") + name;
    EXPECT_LT(difference(columns(a, dataset), reversed(columns(b, dataset))), 1e-10) << name;
  }
  EXPECT_LT(difference(columns(a, "/probes/shear"), reversed(columns(b, "/probes/shear")), -1.0), 1e-10);
  for (const char* body : {"body", "front_axle", "rear_axle"}) {
    const std::string velocity = std::string("/vehicles/0/") + body + "/velocity";
    EXPECT_LT(relative_difference(a.column(velocity, 1), b.column(velocity, 1)), 1e-10) << velocity;
    EXPECT_LT(relative_difference(a.column(velocity, 2), scaled(-1.0, b.column(velocity, 2))), 1e-9) << velocity;
  }
  for (const char* wheel : {"front_wheel", "rear_wheel"}) {
    const std::string dataset = std::string("/vehicles/0/") + wheel;
    EXPECT_LT(relative_difference(a(dataset + "/normal_force"), b(dataset + "/normal_force")), 1e-10);
    const std::vector<double> rubbing = b(dataset + "/friction_force");
    if (GetParam() > 0.0) {
      EXPECT_GT(std::abs(peak(rubbing).first), 1e2);
      EXPECT_LT(relative_difference(a(dataset + "/friction_force"), scaled(-1.0, rubbing)), 1e-9);
    }
  }
  for (std::size_t support = 0; support < 4; ++support) {
    const std::size_t other = 3 - support;
    for (std::size_t c = 0; c < 3; ++c) {
      const double sign = c == 1 ? 1.0 : -1.0;  // fy stays, fx and the moment turn
      const std::vector<double> mirrored = scaled(sign, b.column("/supports/reaction", 3 * other + c));
      if (std::abs(peak(mirrored).first) > 1.0) {
        EXPECT_LT(relative_difference(a.column("/supports/reaction", 3 * support + c), mirrored), 1e-9);
      }
    }
  }
}

// --- at rest

constexpr const char* standing_wheel = R"(
beam: {elements_per_span: 4, EI: 8.0e9, mass: 2000.0, damping_ratios: [0.01, 0.01]}
vehicle:
  mass:
    bodies:  [body]
    wheels:  [wheel]
    drivers: [level]
    body:    {mass: 10000.0, inertia: 1.0, position: [0.0, 0.5]}
    wheel:   {body: body, radius: 0.5, law: hertz, stiffness: 1.0e9}
    level:   {body: body, coordinate: phi}
train: {vehicles: mass, speed: 0.0, positions: 10.0}
ts: {max_time: 0.5, dt: 1.0e-3}
output: {interval: 0.01}
)";
constexpr double P = 10000.0 * 9.81, EI = 8.0e9, L = 20.0;

void expect_constant(Results& run, const std::string& dataset, std::size_t c, double value, double tolerance) {
  for (double found : run.column(dataset, c)) ASSERT_NEAR(found, value, tolerance) << dataset << " column " << c;
}

// Simply supported span, force in the middle: P L^3/(48 EI), P L/4, P/2 (any beam table, e.g. Roark, table 8.1).
TEST(Standing, SimplySupportedSpan) {
  Results run = run_yaml(standing_wheel, {{"beam_spans", "20"}, {"support_types", "pinned,roller"}});
  const double v = -P * L * L * L / (48.0 * EI);
  expect_constant(run, "/probes/deflection", 0, v, 1e-9 * std::abs(v));
  expect_constant(run, "/probes/velocity", 0, 0.0, 1e-9 * std::abs(v));
  expect_constant(run, "/probes/moment", 0, P * L / 4.0, 1e-8 * P * L);
  for (std::size_t support : {0u, 1u}) expect_constant(run, "/supports/reaction", 3 * support + 1, P / 2.0, 1e-8 * P);
  expect_constant(run, "/vehicles/0/wheel/normal_force", 0, P, 1e-8 * P);
}

// Two equal spans, force in the middle of the first: reactions 13/32, 22/32, -3/32 P, moment 13/64 P L under the force
// and -3/32 P L over the middle support, deflection 23 P L^3/(1536 EI) under the force (three-moment equation). The
// wheel is small: on a slope a wheel touches beside its centre, by its radius times the slope.
TEST(Standing, TwoSpans) {
  Results run = run_yaml(standing_wheel, {{"beam_spans", "20*2"},
                                          {"support_types", "pinned,roller,roller"},
                                          {"vehicle_mass_body_position", "0,1e-4"},
                                          {"vehicle_mass_wheel_radius", "1e-4"},
                                          {"vehicle_mass_wheel_law", "linear"},
                                          {"vehicle_mass_wheel_stiffness", "1e10"},
                                          {"output_probes", "10,20,30"}});
  const double v = P * L * L * L / EI;
  expect_constant(run, "/probes/deflection", 0, -23.0 / 1536.0 * v, 1e-9 * v);
  expect_constant(run, "/probes/deflection", 1, 0.0, 1e-12 * v);
  expect_constant(run, "/probes/deflection", 2, 3.0 / 512.0 * v, 1e-9 * v);
  expect_constant(run, "/probes/moment", 0, 13.0 / 64.0 * P * L, 1e-8 * P * L);
  expect_constant(run, "/probes/moment", 1, -3.0 / 32.0 * P * L, 1e-8 * P * L);
  const double reactions[] = {13.0 / 32.0, 22.0 / 32.0, -3.0 / 32.0};
  for (std::size_t i = 0; i < 3; ++i) expect_constant(run, "/supports/reaction", 3 * i + 1, reactions[i] * P, 1e-8 * P);
}

// The same wheels standing anywhere, at the first sample, at the last, and by the static analysis.
TEST(Standing, IsTheStaticAnalysis) {
  const Values where = {{"beam_spans", "20,25,20"},           {"train_vehicles", "mass*3"},
                        {"train_positions", "51.3,29.9,3.1"}, {"track_profile", "bump"},
                        {"track_bump_start", "28"},           {"track_bump_length", "4"},
                        {"track_bump_height", "0.02"}};
  Results standing = run_yaml(standing_wheel, where);
  Results predicted = run_yaml(standing_wheel, where + Values{{"scene_analysis", "static"}});
  ASSERT_EQ(predicted.time().size(), 1u);
  std::vector<std::string> names = {"/probes/deflection", "/probes/moment", "/probes/shear", "/supports/reaction"};
  for (const char* k : {"0", "1", "2"}) names.push_back(std::string("/vehicles/") + k + "/wheel/normal_force");
  for (const std::string& name : names) {
    const std::vector<double> expected = predicted(name), all = standing(name);
    ASSERT_EQ(all.size() % expected.size(), 0u);
    std::vector<double> repeated;
    while (repeated.size() < all.size()) repeated.insert(repeated.end(), expected.begin(), expected.end());
    EXPECT_LT(relative_difference(all, repeated), 1e-8) << name;
  }
}

TEST(Standing, NothingActsNothingMoves) {
  Results run =
      run_yaml(standing_wheel,
               {{"beam_spans", "20,25"}, {"train_positions", "-50"}, {"train_speed", "30"}, {"ts_max_time", "1.0"}});
  for (const char* name : {"deflection", "velocity", "acceleration", "moment", "shear"})
    EXPECT_EQ(peak(run(std::string("/probes/") + name)).first, 0.0) << name;
  EXPECT_EQ(peak(run("/supports/reaction")).first, 0.0);
}

// 5 q L^4/(384 EI) and q L^2/8.
TEST(Standing, UnderItsOwnWeight) {
  Results run =
      run_yaml(standing_wheel, {{"beam_spans", "20"}, {"beam_self_weight", "true"}, {"train_positions", "-50"}});
  const double q = 2000.0 * 9.81, v = -5.0 * q * std::pow(L, 4) / (384.0 * EI);
  expect_constant(run, "/probes/deflection", 0, v, 1e-9 * std::abs(v));
  expect_constant(run, "/probes/velocity", 0, 0.0, 1e-9 * std::abs(v));
  expect_constant(run, "/probes/moment", 0, q * L * L / 8.0, 1e-8 * q * L * L);
}

// --- where x and t begin

// Without friction: wheels that do not turn would begin to rub at t = 0, and the car to pitch.
TEST(Origin, LongerApproach) {
  const double speed = 25.0, delay = 2.0;
  const Values common = {{"beam_elements_per_span", "6"},
                         {"ts_dt", "1e-3"},
                         {"output_interval", "1e-2"},
                         {"train_speed", text(speed)},
                         {"scene_tail", "0.1"},
                         {"train_vehicles", "half_car"},
                         {"vehicle_half_car_front_wheel_friction", "0"}};
  Results near = run_scene("three_span_half_car", common + Values{{"train_positions", "-5"}});
  Results far = run_scene("three_span_half_car", common + Values{{"train_positions", text(-5.0 - delay * speed)}});
  const std::size_t shift = 200;  // samples in the delay
  ASSERT_EQ(near.time().size() + shift, far.time().size());
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/moment", "/supports/reaction",
                           "/vehicles/0/car/acceleration", "/vehicles/0/front_wheel/normal_force"}) {
    const std::vector<double> early = near(name), late = far(name);
    const std::size_t width = early.size() / near.time().size();
    const std::vector<double> moved(late.begin() + static_cast<std::ptrdiff_t>(shift * width), late.end());
    EXPECT_LT(relative_difference(moved, early), 1e-8) << name;
  }
}

TEST(Origin, TailOfNoLength) {
  const Values common = {{"beam_elements_per_span", "6"}, {"ts_dt", "1e-3"}, {"output_interval", "1e-2"}};
  Results none = run_scene("r2_sprung_mass", common);
  Results zero = run_scene("r2_sprung_mass", common + Values{{"scene_tail", "0"}});
  Results some = run_scene("r2_sprung_mass", common + Values{{"scene_tail", "0.2"}});
  EXPECT_NEAR(zero.time().back(), 0.9, 1e-12);  // 25 m at 100 km/h
  EXPECT_NEAR(some.time().back(), 1.1, 1e-12);
  EXPECT_EQ(none("/probes/deflection"), zero("/probes/deflection"));
  std::vector<double> begin = some("/probes/deflection");
  begin.resize(zero.time().size());
  EXPECT_LT(relative_difference(begin, zero("/probes/deflection")), 1e-12);
}

// --- sums

constexpr const char* two_forces = R"(
beam: {spans: [20.0, 25.0], elements_per_span: 5, EI: 8.33e9, mass: 2303.0, damping_ratios: [0.01, 0.012]}
load: {forces: [1.0e5, 4.0e4], positions: [0.0, -5.0], speed: 25.0}
ts: {max_time: 2.5, dt: 1.0e-3}
output: {interval: 0.01}
)";

TEST(Superposition, TwoForces) {
  Results both = run_yaml(two_forces);
  Results first = run_yaml(two_forces, {{"load_forces", "1e5"}, {"load_positions", "0"}});
  Results second = run_yaml(two_forces, {{"load_forces", "4e4"}, {"load_positions", "-5"}});
  for (const char* name : {"/probes/deflection", "/probes/velocity", "/probes/acceleration", "/probes/moment",
                           "/probes/shear", "/supports/reaction"}) {
    std::vector<double> sum = first(name);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += second(name)[i];
    EXPECT_LT(relative_difference(both(name), sum), 1e-10) << name;
  }
}

// Spans that do not talk to each other: each one's motion as if it stood alone, its forces arriving when they do.
TEST(Superposition, IsolatedSpansAreSingleSpans) {
  const Values isolated = {{"beam_continuity", "simply_supported"}, {"beam_rayleigh", "0.3,1e-3"}};
  std::string scene = two_forces;
  scene.replace(scene.find(", damping_ratios: [0.01, 0.012]"), 31, "");
  Results both = run_yaml(scene, isolated);
  Results first = run_yaml(scene, isolated + Values{{"beam_spans", "20"}});
  Results second = run_yaml(scene, isolated + Values{{"beam_spans", "25"}, {"load_positions", "-20,-25"}});
  for (const char* name : {"/probes/deflection", "/probes/velocity", "/probes/acceleration", "/probes/moment"}) {
    EXPECT_LT(relative_difference(both.column(name, 0), first.column(name)), 1e-10) << name;
    EXPECT_LT(relative_difference(both.column(name, 1), second.column(name)), 1e-10) << name;
  }
}

// --- how it is written

void expect_same(Results& a, Results& b, double tolerance) {
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/moment", "/supports/reaction"})
    EXPECT_LE(relative_difference(a(name), b(name)), tolerance) << name;
}

TEST(Writing, ListsAndCounts) {
  Results one = run_yaml(two_forces, {{"beam_spans", "20,20,20"}});
  Results list = run_yaml(two_forces, {{"beam_spans", "20*3"}, {"beam_elements_per_span", "5,5,5"}});
  Results counted = run_yaml(two_forces, {{"beam_spans", "20,20*2"}, {"beam_elements_per_span", "5*3"}});
  expect_same(list, one, 0.0);
  expect_same(counted, one, 0.0);
}

TEST(Writing, OrderOfTheTrain) {
  const Values common = {
      {"beam_elements_per_span", "6"}, {"ts_dt", "2e-3"}, {"output_interval", "1e-2"}, {"ts_max_time", "2"}};
  Results a = run_scene("three_span_half_car", common + Values{{"train_positions", "-5,-15"}});
  Results b = run_scene("three_span_half_car", common + Values{{"train_positions", "-15,-5"}});
  expect_same(a, b, 1e-9);
  EXPECT_LT(relative_difference(a("/vehicles/0/car/acceleration"), b("/vehicles/1/car/acceleration")), 1e-8);
}

// All masses, stiffnesses and dampers 1,000 times as large: the same motion under 1,000 times the forces.
TEST(Writing, UnitOfForce) {
  const double k = 1000.0;
  Values larger;
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, double>>{{"beam_EI", 8.33e9}, {"beam_EA", 1.2e10}, {"beam_mass", 2303.0}})
    larger.emplace_back(name, text(k * value));
  for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{{"car_mass", 17735.0},
                                                                               {"car_inertia", 1.47e5},
                                                                               {"front_axle_mass", 1500.0},
                                                                               {"front_axle_inertia", 100.0},
                                                                               {"rear_axle_mass", 1000.0},
                                                                               {"rear_axle_inertia", 100.0},
                                                                               {"front_suspension_stiffness", 2.47e6},
                                                                               {"front_suspension_damping", 3.0e4},
                                                                               {"rear_suspension_stiffness", 4.23e6},
                                                                               {"rear_suspension_damping", 4.0e4},
                                                                               {"front_wheel_stiffness", 1.0e9},
                                                                               {"rear_wheel_stiffness", 3.0e6}})
    larger.emplace_back("vehicle_half_car_" + name, text(k * value));
  const Values common = {{"beam_elements_per_span", "6"}, {"ts_dt", "2e-3"}, {"output_interval", "1e-2"}};
  Results one = run_scene("three_span_half_car", common);
  Results many = run_scene("three_span_half_car", common + larger);
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/vehicles/0/car/acceleration"})
    EXPECT_LT(relative_difference(many(name), one(name)), 1e-9) << name;
  for (const char* name : {"/probes/moment", "/supports/reaction", "/vehicles/0/front_wheel/normal_force"})
    EXPECT_LT(relative_difference(many(name), scaled(k, one(name))), 1e-9) << name;
}

}  // namespace
}  // namespace traverse::test
