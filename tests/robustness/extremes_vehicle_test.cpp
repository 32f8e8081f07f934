// Wheels, masses and tracks at the edge, against runs at steps ten and twenty times as fine, and against limits.
#include "support/extremes.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

const char* const deflection = "/probes/deflection";
const char* const wheel_force = "/vehicles/0/wheel/normal_force";

/// The wheel of R4 with options on top, stored every 5 ms whatever the step.
Results crossing(const char* step, const Values& options) {
  return run_scene("r4_hertz_wheel",
                   Values{{"ts_dt", step}, {"output_interval", "5e-3"}, {"beam_elements_per_span", "10"}} + options);
}

struct Bounds {
  double deflection, force;
};

// Of the largest values of the run at a tenth of the step.
void expect_resolved(const Values& options, const char* step, const char* fine_step, const Bounds& bounds) {
  Results run = crossing(step, options), fine = crossing(fine_step, options);
  const double in_deflection = difference(run, fine, deflection), in_force = difference(run, fine, wheel_force);
  testing::Test::RecordProperty("deflection", text(in_deflection));
  testing::Test::RecordProperty("force", text(in_force));
  EXPECT_LT(in_deflection, bounds.deflection);
  EXPECT_LT(in_force, bounds.force);
}

// --- contacts --------------------------------------------------------------------------------------------------------

// As stiff as that the wheel is held on the beam: 1,000 kg on 1e12 oscillate within a tenth of a step, 2 % of the force
// at most, since the body's spring lets no more through (R4: 0.98 to 1.02).
TEST(Contact, OfTenToTheTwelve) {
  const Values hard = {{"vehicle_quarter_car_wheel_stiffness", "1e12"}};
  expect_resolved(hard, "1e-3", "1e-4", {1e-4, 1e-2});
  // A linear spring as stiff is the same limit.
  Results hertz = crossing("1e-3", hard),
          linear = crossing("1e-3", hard + Values{{"vehicle_quarter_car_wheel_law", "linear"}});
  EXPECT_LT(difference(hertz, linear, deflection), 1e-4);
}

// A car of 12 kg sinks to (m g/k)^(2/3) = 0.24 m of its wheel's 0.46 m; a full one cannot stand on it.
TEST(Contact, OfAThousand) {
  const Values soft = {{"vehicle_quarter_car_wheel_stiffness", "1e3"}};
  expect_refused([&] { crossing("1e-3", soft); }, {"no static equilibrium", "stiff enough"});
  const Values light = soft + Values{{"vehicle_quarter_car_body_mass", "10"}, {"vehicle_quarter_car_axle_mass", "2"}};
  expect_resolved(light, "1e-3", "1e-4", {1e-4, 1e-4});
  Results run = crossing("1e-3", light);
  EXPECT_NEAR(run("/vehicles/0/wheel/penetration")[0], std::pow(12.0 * 9.81 / 1e3, 2.0 / 3.0), 1e-6);
}

// The load presses the contact in by less than rounding of its radius: no force would be known to a thousandth.
TEST(Contact, ThatRoundingHides) {
  const Values linear = {{"vehicle_quarter_car_wheel_law", "linear"}};
  for (const char* stiffness : {"1e19", "1e22", "1e30"})
    expect_refused(
        [&] {
          crossing("1e-3", linear + Values{{"vehicle_quarter_car_wheel_stiffness", stiffness}});
        },
        {"vehicle_quarter_car_wheel_stiffness", "rounding hides", "allowed"});
  expect_refused(
      [&] {
        crossing("1e-3", {{"vehicle_quarter_car_wheel_stiffness", "1e30"}});
      },
      {"vehicle_quarter_car_wheel_stiffness", "rounding hides", "N/m^1.5"});
}

// --- masses ----------------------------------------------------------------------------------------------------------

// The wheel follows the beam at once: spring and contact in series, whatever the wheel's mass is.
TEST(Mass, OfAGrammeUnderFiftyTonnes) {
  const Values light = {{"vehicle_quarter_car_body_mass", "5e4"}, {"vehicle_quarter_car_axle_mass", "1e-3"}};
  expect_resolved(light, "1e-3", "1e-4", {1e-4, 1e-4});
  Results run = crossing("1e-3", light);
  Results kilogramme =
      crossing("1e-3", {{"vehicle_quarter_car_body_mass", "5e4"}, {"vehicle_quarter_car_axle_mass", "1"}});
  EXPECT_LT(difference(run, kilogramme, deflection), 1e-4);  // 1 kg in 50,000: 2e-5 of the load
}

// 575,750 kg over 57,575 kg of beam. On a hard spring the car leaves the beam and lands again.
TEST(Mass, OfTenTimesTheBeam) {
  for (const char* spring : {"1e7", "1e8"}) {
    SCOPED_TRACE(spring);
    expect_resolved({{"vehicle_quarter_car_body_mass", "575750"}, {"vehicle_quarter_car_suspension_stiffness", spring}},
                    "1e-3", "1e-4", {1e-4, 1e-2});
  }
}

// --- speeds ----------------------------------------------------------------------------------------------------------

// At rest and creeping the beam bends under the weight, P L^3/(48 EI), up to the recovery of a contact's own place.
TEST(VehicleSpeed, NoneAndAMicrometreASecond) {
  const double weight = 6750.0 * 9.81, exact = weight * std::pow(25.0, 3) / (48.0 * 8.323e9);
  for (const char* speed : {"0", "1e-6"}) {
    Results run = crossing(
        "1e-2",
        {{"train_speed", speed}, {"train_positions", "12.5"}, {"ts_max_time", "0.5"}, {"output_interval", "1e-2"}});
    for (const double v : run.column(deflection)) ASSERT_NEAR(-v, exact, 1e-6 * exact);
    for (const double f : run(wheel_force)) ASSERT_NEAR(f, weight, 1e-6 * weight);
  }
}

// alpha = 1 and 3: 239 and 717 m/s. The wheel flies off the far end and meets the ground behind it with a blow, at
// instants that move with what is in the contact's oscillation: forces to a twentieth while it is on the beam.
TEST(VehicleSpeed, CriticalAndThreeTimes) {
  for (const double speed : {238.8927, 716.678}) {
    SCOPED_TRACE(speed);
    const Values fast = {{"train_speed", text(speed)},
                         {"output_interval", text(25.0 / speed / 50.0)},
                         {"ts_max_time", text(25.0 / speed)}};
    const std::string step = text(25.0 / speed / 1000.0), fine = text(25.0 / speed / 10000.0);
    Results run = crossing(step.c_str(), fast), reference = crossing(fine.c_str(), fast);
    EXPECT_LT(difference(run, reference, deflection), 1e-3);
    EXPECT_LT(difference(run, reference, wheel_force), 5e-2);
  }
}

// --- places ----------------------------------------------------------------------------------------------------------

// Begun a nanometre beside a node, a support or the last point, or just there: the same run.
TEST(Place, OnANodeASupportAndTheLastPoint) {
  for (const double x : {0.0, 5.0, 20.0, 40.0}) {
    SCOPED_TRACE(x);
    const auto from = [&](double start) {
      return run_yaml(small_scene(), {{"train_positions", text(start)}, {"ts_max_time", "0.1"}, {"ts_dt", "1e-3"}});
    };
    Results there = from(x), before = from(x - 1e-9), after = from(x + 1e-9);
    for (Results* beside : {&before, &after}) {
      EXPECT_LT(difference(there, *beside, wheel_force), 1e-6);
      EXPECT_LT(difference(there, *beside, deflection, 1e-3), 1e-6);
    }
  }
}

// Two wheels 1 m apart in elements of 2.5 m against elements of 0.5 m, in which they never share one. Eight cubic
// elements a span, with the correction for forces between nodes, give deflections to 1e-3 and contact forces to 1e-2.
TEST(Place, TwoWheelsInOneElement) {
  const auto with = [](const char* elements) {
    return run_yaml(small_scene(), {{"train_vehicles", "car*2"},
                                    {"train_positions", "4,3"},
                                    {"ts_dt", "1e-3"},
                                    {"beam_elements_per_span", elements}});
  };
  Results coarse = with("8"), fine = with("40");
  EXPECT_LT(difference(coarse, fine, deflection), 1e-3);
  EXPECT_LT(difference(coarse, fine, wheel_force), 1e-2);
}

// In equilibrium where it stands, the wheel sets off: at midspan, where the beam is level.
TEST(Place, StartOnTheBridge) {
  const double weight = 6750.0 * 9.81, exact = weight * std::pow(25.0, 3) / (48.0 * 8.323e9);
  const Values middle = {{"train_positions", "12.5"}};
  Results run = crossing("1e-3", middle);
  EXPECT_NEAR(-run.column(deflection)[0], exact, 1e-6 * exact);
  EXPECT_NEAR(run(wheel_force)[0], weight, 1e-3 * weight);
  expect_resolved(middle, "1e-3", "1e-4", {1e-4, 1e-2});
}

// --- a step of the track ---------------------------------------------------------------------------------------------

/// 1 mm up from x = 0 to 4 mm, level and straight at both ends.
double step_at(double x) {
  const double s = std::clamp(x / 4e-3, 0.0, 1.0);
  return 1e-3 * s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

/// That every 0.5 mm.
std::string step_file(const TemporaryFolder& folder) {
  std::string lines;
  for (int i = -40; i <= 48; ++i) lines += text(i * 0.5e-3) + ", " + text(step_at(i * 0.5e-3)) + "\n";
  return folder.write("step.csv", lines);
}

// A step of two lines and nothing beside it is none that a spline goes through: it would swing by metres.
TEST(TrackStep, OfFourLinesIsRefusedAsASpline) {
  const TemporaryFolder folder;
  for (const char* lines :
       {"-100, 0\n10, 0\n10.001, 0.001\n100, 0.001\n", "-100, 0\n10, 0\n10.001, -0.001\n100, -0.001\n"}) {
    const std::string file = folder.write("step.csv", lines);
    expect_refused(
        [&] {
          run_yaml(small_scene(), {{"track_profile", file}, {"track_profile_shape", "spline"}});
        },
        {"step.csv", "beside a jump", "give lines as close together"});
  }
  const std::string twice = folder.write("twice.csv", "-100, 0\n10, 0\n10, 0.001\n100, 0.001\n");
  expect_refused([&] { run_yaml(small_scene(), {{"track_profile", twice}}); }, {"twice.csv", "must increase strictly"});
}

// Slowly, the wheel's centre follows the roll-over curve, max over s of h(s) + sqrt(R^2 - (x - s)^2) - R, but for the
// contact's own 3.3 um, of which it shares some where it touches at two points.
TEST(TrackStep, IsRolledOverSlowly) {
  const TemporaryFolder folder;
  const std::string ground = std::string(quarter_car) + "ts_dt: 2.0e-3\nts_max_time: 2.5\noutput: {interval: 0.05}\n";
  Results run = run_yaml(ground, {{"track_profile", step_file(folder)},
                                  {"train_positions", "-0.04"},
                                  {"train_speed", "0.02"},
                                  {"vehicle_car_wheel_stiffness", "1e13"}});
  const std::vector<double> x = run.column("/vehicles/0/axle/position", 0),
                            y = run.column("/vehicles/0/axle/position", 1);
  constexpr double R = 0.5, h = 1e-3;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double rolled = 0.0;
    for (double s = -0.05; s < 0.06; s += 1e-5)
      rolled = std::max(rolled, step_at(s) + std::sqrt(R * R - (x[i] - s) * (x[i] - s)) - R);
    EXPECT_NEAR(y[i] - y[0], rolled, 1e-2 * h) << x[i];
  }
}

// At 10 m/s the edge throws the wheel up: the first blow against a run at a tenth of the step.
TEST(TrackStep, IsHitFast) {
  const TemporaryFolder folder;
  const std::string file = step_file(folder);
  const auto hit = [&](const char* step) {
    return run_yaml(std::string(quarter_car) + "ts_max_time: 0.01\noutput: {interval: 2.0e-4}\n",
                    {{"track_profile", file}, {"train_speed", "10.0"}, {"train_positions", "-0.05"}, {"ts_dt", step}});
  };
  Results run = hit("4e-5"), fine = hit("4e-6");
  EXPECT_GT(highest(fine(wheel_force)), 3.0 * quarter_car_weight);
  EXPECT_LT(difference(run, fine, wheel_force), 1e-2);
}

}  // namespace
}  // namespace traverse::test
