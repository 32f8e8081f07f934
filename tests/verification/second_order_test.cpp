// The own integrators in second-order form, and what they leave out: against PETSc's ARKIMEX 4, whose numbers esdirk4
// has, and against runs that step every span.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/message.hpp"

namespace traverse::test {
namespace {

struct Case {
  const char* name;
  const char* scene;
  Values options;
  double bound = 1e-8;  // of each curve's peak
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class SameAsArkimex : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(
    SecondOrder, SameAsArkimex,
    testing::Values(
        // ARKIMEX's contact has a penetration that is a difference of places, whose last digit is 3.7e-8 N: the
        // bridge's 256 elements without damping ring of it
        Case{"hertz_wheel", "r4_hertz_wheel", {{"ts_dt", "1e-3"}}, 1.5e-8},
        Case{"free_half_cars_with_friction", "three_span_half_car", {{"ts_dt", "2e-3"}, {"ts_max_time", "2"}}},
        // a Hertz contact's rounding, 1e-7 N, on the few kg of a bay of rail
        Case{"layered_track",
             "r8_ballasted_bridge",
             {{"ts_dt", "2e-3"}, {"ts_max_time", "1"}, {"track_elements_per_bay", "1"}, {"output_interval", "0.02"}},
             2e-8},
        Case{"one_sided_foundation", "prop_with_gap", {{"ts_dt", "2e-3"}}, 1.5e-8},  // of the same digit
        Case{"forces_and_own_weight",
             "r6_three_spans",
             {{"ts_dt", "2e-3"}, {"beam_self_weight", "true"}, {"beam_damping_ratios", "0.02"}}},
        Case{"separate_spans",
             "three_span_train",
             {{"train_vehicles", "coach*2"},
              {"beam_continuity", "simply_supported"},
              {"beam_elements_per_span", "8"},
              {"model_window", "0"},
              {"model_vehicles", "full"},
              {"ts_dt", "4e-3"},
              {"ts_max_time", "1.2"}}}),
    [](const auto& which) { return which.param.name; });

TEST_P(SameAsArkimex, ToRounding) {
  const Case& c = GetParam();
  Results stock = run_scene(c.scene, c.options + Values{{"ts_type", "arkimex"}});
  Results own = run_scene(c.scene, c.options + Values{{"ts_type", "esdirk4"}});
  for (const char* curve : {"/probes/deflection", "/probes/velocity", "/probes/acceleration", "/probes/moment",
                            "/supports/reaction", "/energy/strain", "/energy/dissipated", "/energy/work"}) {
    const double difference = relative_difference(own(curve), stock(curve));
    RecordProperty(curve + 1, text(difference));
    // Of energies the quadrature differs: stages there, ends of steps here; the drivers' work is small and noisy.
    const bool integral = curve == std::string("/energy/dissipated") || curve == std::string("/energy/work");
    EXPECT_LE(difference, integral ? 1e-3 : c.bound) << curve;
  }
}

// --- what is left out ----------------------------------------------------------------------------------------------

constexpr const char* viaduct = R"(
beam:
  spans: 32.0*40
  elements_per_span: 6
  EI: 3.795e11
  mass: 3.0e4
  damping_ratios: 0.02
support: {types: roller}
vehicle:
  quarter:
    bodies: [body, wheel]
    joints: [guide]
    springs: [suspension]
    wheels: [tread]
    drivers: [level]
    body: {mass: 2.0e4, inertia: 1.0e5, position: [0, 2.0]}
    wheel: {mass: 2.0e3, inertia: 100, position: [0, 0.5]}
    guide: {type: prismatic, bodies: [body, wheel], point: [0, 1.0], axis: [0, 1]}
    level: {body: body, coordinate: phi, value: 0}
    suspension: {bodies: [body, wheel], from: [0, 2.0], to: [0, 0.5], stiffness: 1.0e6, damping: 2.0e4}
    tread: {body: wheel, radius: 0.5, law: hertz, stiffness: 3.6e10}
train: {vehicles: [quarter, quarter], positions: -5.0, spacing: 20.0, speed: 80.0}
ts: {dt: 5.0e-3, max_time: 14.0}
output: {interval: 0.02, probes: [48.0, 336.0, 656.0]}
)";

// Spans apart: what has not been reached is left out exactly; what has died away below 1e-9 of the largest motion, too.
TEST(Window, OfSeparateSpansChangesNothing) {
  const Values apart = {{"beam_continuity", "simply_supported"}};
  Results full = run_yaml(viaduct, apart + Values{{"model_window", "0"}});
  Results window = run_yaml(viaduct, apart);
  for (const char* curve : {"/probes/deflection", "/probes/velocity", "/probes/moment", "/supports/reaction",
                            "/vehicles/1/tread/normal_force"}) {
    const double difference = relative_difference(window(curve), full(curve));
    RecordProperty(curve + 1, text(difference));
    EXPECT_LE(difference, 1e-8) << curve;
  }
}

// The same with axial unknowns and a damper at midspan, so that the damping is not Rayleigh's alone.
TEST(Window, OfSeparateSpansWithDampers) {
  const Values apart = {{"beam_continuity", "simply_supported"},
                        {"beam_EA", "2e11"},
                        {"model_axial", "true"},
                        {"foundation_vertical_x", "48"},
                        {"foundation_vertical_k", "1e7"},
                        {"foundation_vertical_c", "1e6"},
                        {"ts_max_time", "6"}};
  Results full = run_yaml(viaduct, apart + Values{{"model_window", "0"}});
  Results window = run_yaml(viaduct, apart);
  for (const char* curve : {"/probes/deflection", "/probes/velocity", "/supports/reaction"})
    EXPECT_LE(relative_difference(window(curve), full(curve)), 1e-8) << curve;
}

// Rail, sleepers and bridge rest where the train is far.
TEST(Window, OfALayeredTrack) {
  const Values far = {
      {"track_approach", "150"}, {"track_elements_per_bay", "1"}, {"ts_dt", "2e-3"}, {"ts_max_time", "0.8"}};
  Results full = run_scene("r8_ballasted_bridge", far + Values{{"model_window", "0"}});
  for (const char* tolerance : {"1e-4", "1e-6"}) {
    Results window = run_scene("r8_ballasted_bridge", far + Values{{"model_window", tolerance}});
    EXPECT_GT(window.attribute("/summary", "rest_error"), 0.0);
    for (const char* curve : {"/probes/deflection", "/rail/deflection", "/vehicles/0/wheel_1/normal_force"})
      EXPECT_LE(relative_difference(window(curve), full(curve)), 2.0 * std::stod(tolerance)) << curve;
    EXPECT_LE(relative_difference(window("/energy/dissipated"), full("/energy/dissipated")),
              2.0 * std::stod(tolerance));
  }
}

// The same with the spans' own weight, under which they rest deflected.
TEST(Window, AroundSpansUnderTheirOwnWeight) {
  const Values apart = {{"beam_continuity", "simply_supported"}, {"beam_self_weight", "true"}, {"ts_max_time", "6"}};
  Results full = run_yaml(viaduct, apart + Values{{"model_window", "0"}});
  Results window = run_yaml(viaduct, apart + Values{{"model_window", "1e-6"}});
  for (const char* curve : {"/probes/deflection", "/probes/velocity", "/supports/reaction"})
    EXPECT_LE(relative_difference(window(curve), full(curve)), 1e-5) << curve;
}

// A continuous bridge: waves are followed until they are below the tolerance; deflections keep it, and what has left
// falls with it.
TEST(Window, OfAContinuousBridgeKeepsItsTolerance) {
  Results full = run_yaml(viaduct, {{"model_window", "0"}});
  double before = 1.0;
  for (const char* tolerance : {"1e-3", "1e-4", "1e-5"}) {
    Results window = run_yaml(viaduct, {{"model_window", tolerance}});
    const double deflection = relative_difference(window("/probes/deflection"), full("/probes/deflection"));
    const double estimate = window.attribute("/summary", "rest_error");
    RecordProperty(std::string("deflection_") + tolerance, text(deflection));
    RecordProperty(std::string("velocity_") + tolerance,
                   text(relative_difference(window("/probes/velocity"), full("/probes/velocity"))));
    RecordProperty(std::string("moment_") + tolerance,
                   text(relative_difference(window("/probes/moment"), full("/probes/moment"))));
    RecordProperty(std::string("estimate_") + tolerance, text(estimate));
    EXPECT_LE(deflection, 2.0 * std::stod(tolerance));
    EXPECT_GT(estimate, 0.0);
    EXPECT_LT(estimate, 0.2 * before);
    before = estimate;
  }
}

}  // namespace
}  // namespace traverse::test
