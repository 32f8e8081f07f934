// Whole runs against published or independently computed results. Every reference below was computed without this
// program: closed-form modal series, or modal equations of motion with an adaptive Runge-Kutta method to 1e-10 with
// so many modes that the digits shown stand. The curves in tests/data carry their method in their first lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

// Beam of Yang and Yau 1997 (Eng. Struct. 19, 936-944): 25 m, E 2.87e9, I 2.90, 2,303 kg/m.
constexpr double length = 25.0, EI = 2.87e9 * 2.90, mass = 2303.0, gravity = 9.81;
double static_deflection(double force) { return force * std::pow(length, 3) / (48.0 * EI); }
// v = alpha L omega1/pi
double speed_for(double alpha) { return alpha * pi / length * std::sqrt(EI / mass); }

const std::string data = source_folder() + "/tests/data/";

// --- R1: a moving force, no damping ----------------------------------------------------------------------------------

// Closed-form series (Fryba, Vibration of Solids and Structures under Moving Loads, ch. 1) with 401 modes.
struct MovingForce {
  double alpha, amplification;
};
class R1 : public testing::TestWithParam<MovingForce> {};
INSTANTIATE_TEST_SUITE_P(ReferenceCases, R1,
                         testing::Values(MovingForce{0.1, 1.096454}, MovingForce{0.25, 1.257610},
                                         MovingForce{0.5, 1.705445}, MovingForce{0.617, 1.731674},
                                         MovingForce{1.0, 1.548074}));

TEST_P(R1, PeakWhileTheForceIsOnTheBeam) {
  const double speed = speed_for(GetParam().alpha);
  const double step = length / speed / 400.0;
  Results run = run_scene("r1_moving_force", {{"load_speed", text(speed)},
                                              {"beam_elements_per_span", "16"},
                                              {"ts_dt", text(step)},
                                              {"output_interval", text(step)}});
  const Peak largest = refined_peak(run.time(), run.column("/probes/deflection"));
  const double amplification = -largest.value / static_deflection(1e5);
  RecordProperty("error", text(amplification / GetParam().amplification - 1.0));
  EXPECT_NEAR(amplification, GetParam().amplification, 3e-4 * GetParam().amplification);
}

TEST(R1, CurveAtHalfTheCriticalSpeed) {
  const auto reference = read_table(data + "r1_alpha_0.5.csv");
  const double interval = reference[1][0];
  Results run = run_scene("r1_moving_force", {{"load_speed", "119.4463399"},
                                              {"beam_elements_per_span", "16"},
                                              {"ts_dt", text(interval)},
                                              {"output_interval", text(interval)}});
  ASSERT_EQ(run.time().size(), reference.size());
  EXPECT_LT(relative_difference(run.time(), column(reference, 0)), 1e-8);
  const double difference = relative_difference(run.column("/probes/deflection"), column(reference, 1));
  RecordProperty("error", text(difference));
  EXPECT_LT(difference, 3e-4);
}

// --- R2, R3: a sprung mass

const Values fine = {{"beam_elements_per_span", "24"}, {"ts_dt", "1e-3"}, {"output_interval", "1e-3"}};

TEST(R2, PeaksAndCurves) {
  Results run = run_scene("r2_sprung_mass", fine);
  const std::vector<double> deflection = run.column("/probes/deflection");
  const std::vector<double> acceleration = run.column("/vehicles/0/body/acceleration", 1);
  const Peak largest = refined_peak(run.time(), deflection);
  RecordProperty("error", text(largest.value / -2.40731635e-3 - 1.0));
  EXPECT_NEAR(largest.value, -2.40731635e-3, 2e-5 * 2.40731635e-3);
  EXPECT_NEAR(largest.time, 0.37112, 5e-4);  // half a sample; the crest is flat
  const Peak shaken = refined_peak(run.time(), acceleration);
  RecordProperty("acceleration_error", text(std::abs(shaken.value) / 0.147967 - 1.0));
  EXPECT_NEAR(std::abs(shaken.value), 0.147967, 1e-4 * 0.147967);

  const auto reference = read_table(data + "r2.csv");  // 80 modes
  ASSERT_EQ(every(5, deflection).size(), reference.size());
  EXPECT_LT(relative_difference(every(5, run.time()), column(reference, 0)), 1e-12);
  EXPECT_LT(relative_difference(every(5, deflection), column(reference, 1)), 2e-5);
  EXPECT_LT(relative_difference(every(5, acceleration), column(reference, 3)), 2e-4);
  const std::vector<double> force = every(5, run.column("/vehicles/0/spring/normal_force"));
  EXPECT_LT(relative_difference(force, column(reference, 4)), 1e-5);
}

TEST(R3, Peak) {
  Results run = run_scene("r3_sprung_mass", fine);
  const Peak largest = refined_peak(run.time(), run.column("/probes/deflection"));
  RecordProperty("error", text(largest.value / -4.18626809e-4 - 1.0));
  EXPECT_NEAR(largest.value, -4.18626809e-4, 2e-5 * 4.18626809e-4);
  EXPECT_NEAR(largest.time, 0.43615, 5e-4);
}

// --- R4: a wheel by Hertz

TEST(R4, PeaksAndCurves) {
  // The wheel on its contact rings at 820 rad/s, and its force shows every element under it.
  Results run = run_scene("r4_hertz_wheel",
                          {{"beam_elements_per_span", "40"}, {"ts_dt", "2.5e-4"}, {"output_interval", "2.5e-4"}});
  const std::vector<double> deflection = run.column("/probes/deflection");
  const Peak largest = refined_peak(run.time(), deflection);
  RecordProperty("error", text(largest.value / -2.8324443e-3 - 1.0));
  EXPECT_NEAR(largest.value, -2.8324443e-3, 1e-4 * 2.8324443e-3);
  EXPECT_NEAR(largest.time, 0.3735, 5e-4);

  const std::vector<double> force = run.column("/vehicles/0/wheel/normal_force");
  const double at_rest = 6750.0 * gravity;
  EXPECT_NEAR(*std::min_element(force.begin(), force.end()) / at_rest, 0.98124, 1e-4);
  EXPECT_NEAR(*std::max_element(force.begin(), force.end()) / at_rest, 1.01654, 1e-4);

  const auto reference = read_table(data + "r4.csv");  // 60 modes, good to 1e-5
  const auto at_reference = [](const std::vector<double>& values) { return every(20, values); };
  ASSERT_EQ(at_reference(deflection).size(), reference.size());
  EXPECT_LT(relative_difference(at_reference(run.time()), column(reference, 0)), 1e-12);
  EXPECT_LT(relative_difference(at_reference(deflection), column(reference, 1)), 5e-5);
  const std::vector<double> acceleration = run.column("/vehicles/0/body/acceleration", 1);
  EXPECT_LT(relative_difference(at_reference(acceleration), column(reference, 2)), 2e-4);
  EXPECT_LT(relative_difference(at_reference(force), column(reference, 3)), 1e-4);
  const std::vector<double> penetration = run.column("/vehicles/0/wheel/penetration");
  EXPECT_LT(relative_difference(at_reference(penetration), column(reference, 4)), 1e-4);
}

// --- R5: a moving mass

// Peak midspan deflection over static for a mass held on the beam, all convective terms, 30 modes. The wheel is the
// mass; a stiff linear contact holds it as long as the contact is closed.
struct MovingMass {
  double ratio, alpha, amplification;
};
class R5 : public testing::TestWithParam<MovingMass> {};
INSTANTIATE_TEST_SUITE_P(ReferenceCases, R5,
                         testing::Values(MovingMass{0.1, 0.25, 1.28719}, MovingMass{0.25, 0.25, 1.33431},
                                         MovingMass{0.5, 0.25, 1.41790}, MovingMass{0.1, 0.5, 1.76290},
                                         MovingMass{0.25, 0.5, 1.85387}, MovingMass{0.5, 0.5, 2.02213}));

TEST_P(R5, PeakWhileTheContactIsClosed) {
  const double moving = GetParam().ratio * mass * length;
  const double speed = speed_for(GetParam().alpha);
  const double step = length / speed / 400.0;
  const std::string scene = R"(
beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0, elements_per_span: 20}
support: {types: [pinned, roller]}
vehicle:
  moving_mass:
    bodies:  [body]
    wheels:  [contact]
    drivers: [level]
    body:    {inertia: 1.0, position: [0.0, 0.1]}
    contact: {body: body, radius: 0.1, law: linear, stiffness: 1.0e11}
    level:   {body: body, coordinate: phi}
train: {vehicles: moving_mass, positions: 0.0}
)";
  Results run = run_yaml(scene, {{"vehicle_moving_mass_body_mass", text(moving)},
                                 {"train_speed", text(speed)},
                                 {"ts_dt", text(step)},
                                 {"output_interval", text(step)}});
  const std::vector<double> deflection = run.column("/probes/deflection");
  const Peak largest = refined_peak(run.time(), deflection);
  const double amplification = -largest.value / static_deflection(moving * gravity);
  RecordProperty("error", text(amplification / GetParam().amplification - 1.0));
  EXPECT_NEAR(amplification, GetParam().amplification, 1e-3 * GetParam().amplification);
  const std::vector<double> force = run.column("/vehicles/0/contact/normal_force");
  const auto end = force.begin() + static_cast<std::ptrdiff_t>(peak(deflection).second) + 1;
  EXPECT_GT(*std::min_element(force.begin(), end), 0.0) << "contact lost before the peak";
}

// --- R6: a force on three spans

TEST(R6, Frequencies) {
  Results run = run_scene("r6_three_spans",
                          {{"scene_analysis", "modes"}, {"modes_count", "6"}, {"beam_elements_per_span", "64"}});
  const std::vector<double> reference = {5.49779, 7.04549, 10.28788, 21.99116, 25.06237, 30.74769};
  const std::vector<double> f = run("/modes/frequency");
  ASSERT_GE(f.size(), reference.size());
  for (std::size_t i = 0; i < reference.size(); ++i) EXPECT_NEAR(f[i], reference[i], 1e-6 * reference[i]);
}

TEST(R6, PeaksAtTheMidspans) {
  Results run =
      run_scene("r6_three_spans", {{"beam_elements_per_span", "12"}, {"ts_dt", "2e-3"}, {"output_interval", "2e-3"}});
  const std::vector<double> reference = {-6.194956e-4, -4.688925e-4, -6.519558e-4};
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Peak largest = refined_peak(run.time(), run.column("/probes/deflection", i));
    RecordProperty("error_" + std::to_string(i), text(largest.value / reference[i] - 1.0));
    EXPECT_NEAR(largest.value, reference[i], 3e-4 * std::abs(reference[i]));
  }
}

}  // namespace
}  // namespace traverse::test
