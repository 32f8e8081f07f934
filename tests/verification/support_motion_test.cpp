// Bridges whose supports move, against modal series, statics and the integration of an oscillator that crosses
// meanwhile.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

constexpr double span = 20.0, EI = 8.0e9, mass = 9000.0, ratio = 0.02, pi = std::numbers::pi;
constexpr int modes = 24;
const std::string bridge =
    "beam: {spans: 20, EI: 8.0e9, mass: 9000, elements_per_span: 16, damping_ratios: [0.02, 0.02]}\n"
    "output: {interval: 0.01}\n";

/// Two triangular pulses of acceleration, m/s2.
double pulse(double t) {
  const double phase = std::fmod(t, 0.1);
  const double height = phase < 0.05 ? phase / 0.05 : 2.0 - phase / 0.05;
  return t < 0.1 ? height : t < 0.2 ? -height : 0.0;
}
const std::vector<double> pulse_times = {0.0, 0.05, 0.1, 0.15, 0.2, 3.0};

/// The file of the pulse, with the share of it that each support has.
std::string pulse_file(const TemporaryFolder& folder, const std::vector<double>& shares) {
  std::string rows;
  for (const double t : pulse_times) {
    rows += std::to_string(t);
    for (const double share : shares) rows += "," + std::to_string(share * pulse(t));
    rows += "\n";
  }
  return folder.write("pulse.csv", rows);
}

using Coordinates = Eigen::VectorXd;

/// A bridge of sine modes whose supports have shares of the pulse, and an oscillator that crosses it. The state has the
/// modes, the height of the oscillator and the displacement of the pulse, then their rates.
struct Model {
  std::array<double, 2> shares{1.0, 1.0};
  double carried = 0.0, stiffness = 0.0, damping = 0.0, speed = 0.0, start = 0.0;  // of the oscillator
  static constexpr int size = modes + 2;

  static double omega(int n) {
    const double wave = (n + 1) * pi / span;
    return wave * wave * std::sqrt(EI / mass);
  }
  double share_at(double x) const {
    const double s = std::clamp(x / span, 0.0, 1.0);
    return (1.0 - s) * shares[0] + s * shares[1];
  }

  Coordinates rate(double t, const Coordinates& s) const {
    Coordinates r = Coordinates::Zero(2 * size);
    r.head(size) = s.tail(size);
    const double b = 2.0 * ratio / (omega(0) + omega(1)), a = b * omega(0) * omega(1), ground = pulse(t);
    const double x = start + speed * t;
    const bool on = x > 0.0 && x < span;
    double height = share_at(x) * s[modes + 1], rise = share_at(x) * s[size + modes + 1];
    if (on) rise += speed / span * (shares[1] - shares[0]) * s[modes + 1];
    for (int n = 0; n < modes && on; ++n) {
      const double arc = (n + 1) * pi * x / span;
      height += std::sin(arc) * s[n];
      rise += std::sin(arc) * s[size + n] + (n + 1) * pi / span * speed * std::cos(arc) * s[n];
    }
    const double force = carried * 9.81 - stiffness * (s[modes] - height) - damping * (s[size + modes] - rise);
    for (int n = 0; n < modes; ++n) {
      const double k = n + 1, participation = 2.0 / (k * pi) * (shares[0] - std::cos(k * pi) * shares[1]);
      r[size + n] = -participation * ground - (a + b * omega(n) * omega(n)) * s[size + n] - omega(n) * omega(n) * s[n];
      if (on) r[size + n] -= 2.0 / (mass * span) * force * std::sin(k * pi * x / span);
    }
    if (carried > 0.0) r[size + modes] = force / carried - 9.81;
    r[size + modes + 1] = ground;
    return r;
  }

  /// Calls use(state) at each of the times.
  void run(const std::vector<double>& times, double h,
           const std::function<void(std::size_t, const Coordinates&)>& use) const {
    Coordinates s = Coordinates::Zero(2 * size);
    long steps = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      for (; static_cast<double>(steps) * h < times[i] - 1e-9; ++steps) {
        const double t = static_cast<double>(steps) * h;
        const Coordinates a1 = rate(t, s), a2 = rate(t + 0.5 * h, s + 0.5 * h * a1),
                          a3 = rate(t + 0.5 * h, s + 0.5 * h * a2), a4 = rate(t + h, s + h * a3);
        s += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      }
      use(i, s);
    }
  }
};

class ShakenBridge : public ::testing::TestWithParam<std::array<double, 2>> {};

// The response without traffic: a sum of modes, each under its share of the acceleration.
TEST_P(ShakenBridge, ModalSeries) {
  Model model;
  model.shares = GetParam();
  const TemporaryFolder folder;
  const std::string file = pulse_file(folder, {model.shares[0], model.shares[1]});
  Results run =
      run_yaml(bridge + "load: {forces: 0, speed: 0}\nts: {max_time: 1.0, dt: 1.0e-3}\n", {{"support_motion", file}});
  const std::vector<double> time = run.time(), deflection = run("/probes/deflection"), moment = run("/probes/moment"),
                            displacement = run("/supports/displacement"), relative = run("/probes/relative_deflection");
  double greatest_relative = 0.0, error_of_relative = 0.0;
  double greatest = 0.0, greatest_moment = 0.0, error = 0.0, error_of_moment = 0.0;
  model.run(time, 2e-5, [&](std::size_t i, const Coordinates& s) {
    double z = model.share_at(0.5 * span) * s[modes + 1], M = 0.0;
    const double line = z;
    for (int n = 0; n < modes; ++n) {
      const double shape = std::sin((n + 1) * pi / 2.0);
      z += shape * s[n];
      M -= EI * std::pow((n + 1) * pi / span, 2) * shape * s[n];
    }
    greatest = std::max(greatest, std::abs(z));
    greatest_moment = std::max(greatest_moment, std::abs(M));
    error = std::max(error, std::abs(deflection[i] - z));
    greatest_relative = std::max(greatest_relative, std::abs(z - line));
    error_of_relative = std::max(error_of_relative, std::abs(relative[i] - (z - line)));
    error_of_moment = std::max(error_of_moment, std::abs(moment[i] - M));
    for (std::size_t end : {0U, 1U}) EXPECT_NEAR(displacement[2 * i + end], model.shares[end] * s[modes + 1], 1e-9);
  });
  RecordProperty("error", text(error / greatest));
  RecordProperty("moment_error", text(error_of_moment / greatest_moment));
  EXPECT_LT(error, 5e-5 * greatest);
  EXPECT_LT(error_of_relative, 1e-4 * greatest_relative);
  const double peak = std::abs(run.attribute("/summary", "deflection"));  // between the samples, too
  EXPECT_GT(peak, greatest_relative * (1.0 - 1e-4));
  EXPECT_LT(peak, greatest_relative * 1.1);
  EXPECT_LT(error_of_moment, 1e-4 * greatest_moment);
  double unbalanced = 0.0, reaction = 0.0;
  for (const double force : run("/balance/residual")) unbalanced = std::max(unbalanced, std::abs(force));
  for (const double force : run("/supports/reaction")) reaction = std::max(reaction, std::abs(force));
  EXPECT_LT(unbalanced, 1e-9 * reaction);
  EXPECT_LT(energy_error(run), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(SupportMotion, ShakenBridge,
                         ::testing::Values(std::array{1.0, 1.0}, std::array{0.0, 1.0}, std::array{1.0, -0.5}));

/// One span whose supports move while a force creeps over it: with the deflection of statics, whatever they do.
Results crept(const std::string& motion, const std::string& limit = "1/3000") {
  const TemporaryFolder folder;
  return run_yaml(
      bridge + "load: {forces: 1.0e5, positions: -1, speed: 0.5}\nts: {max_time: 44, dt: 1.0e-2}\n",
      {{"support_motion", folder.write("motion.csv", motion)},
       {"support_motion_values", "displacement"},
       {"output_interval", "0.1"},
       {"limits", folder.write("limits.yml", "- {clause: A, quantity: deflection_over_span, value: " + limit +
                                                 "}\n- {clause: B, quantity: amplification, value: 2}\n")}});
}

// Supports that lift or tilt the span by 20 mm deflect nothing: the force alone does, P L^3/(48 EI).
TEST(SupportMotion, LiftAndTiltDeflectNothing) {
  constexpr double statics = 1.0e5 * span * span * span / (48.0 * EI);
  for (const char* motion : {"0,0,0\n1,0,0\n20,0.01,0.01\n39,0.02,0.02\n44,0.02,0.02\n",
                             "0,0,0\n1,0,0\n20,0.01,-0.01\n39,0.02,-0.02\n44,0.02,-0.02\n"}) {
    Results run = crept(motion);
    EXPECT_NEAR(std::abs(run.attribute("/summary", "deflection")), statics, 2e-3 * statics);
    EXPECT_NEAR(run.attribute("/summary", "static_deflection"), statics, 1e-6 * statics);
    EXPECT_NEAR(run.attribute("/summary", "amplification"), 1.0, 2e-3);
    EXPECT_NEAR(run("/envelope/deflection")[0], -statics, 2e-3 * statics);
    EXPECT_NEAR(run("/verdicts/value")[0], statics / span, 2e-3 * statics / span);
    EXPECT_GT(run("/verdicts/margin")[0], -1.0);
    EXPECT_NEAR(run("/verdicts/value")[1], 1.0, 2e-3);
    EXPECT_NEAR(peak(run("/shape/deflection")).first, -statics, 2e-3 * statics);
    EXPECT_GT(std::abs(peak(run("/supports/displacement")).first), 0.019);
  }
}

// An oscillator comes from the ground, which moves with the first support, crosses, and leaves onto the ground.
TEST(SupportMotion, OscillatorCrosses) {
  Model model;
  model.shares = {1.0, 0.6};
  model.carried = 5000.0;
  model.stiffness = 2.0e6;
  model.damping = 2.0e4;
  model.speed = 40.0;
  model.start = -2.0;
  const TemporaryFolder folder;
  const std::string file = pulse_file(folder, {1.0, 0.6});
  Results run =
      run_yaml(bridge +
                   "vehicle:\n  car:\n    bodies: [body]\n    drivers: [level]\n    wheels: [wheel]\n"
                   "    body: {mass: 5000, inertia: 1000, position: [0, 1]}\n    level: {body: body, coordinate: phi}\n"
                   "    wheel: {body: body, radius: 1, law: two_sided, stiffness: 2.0e6, damping: 2.0e4}\n"
                   "train: {vehicles: car, positions: -2, speed: 40}\nts: {max_time: 0.7, dt: 2.0e-4}\n",
               {{"support_motion", file}});
  const std::vector<double> time = run.time(), deflection = run("/probes/deflection"),
                            place = run("/vehicles/0/body/position"), force = run("/vehicles/0/wheel/normal_force");
  double greatest = 0.0;
  for (const double one : force) greatest = std::max(greatest, std::abs(one - 5000.0 * 9.81));
  EXPECT_GT(greatest, 500.0);
  double error = 0.0;
  model.run(time, 2e-5, [&](std::size_t i, const Coordinates& s) {
    double z = model.share_at(0.5 * span) * s[modes + 1];
    for (int n = 0; n < modes; ++n) z += std::sin((n + 1) * pi / 2.0) * s[n];
    error = std::max({error, std::abs(deflection[i] - z), std::abs(place[3 * i + 1] - place[1] - s[modes])});
  });
  RecordProperty("error", text(error));
  EXPECT_LT(error, 1e-5);
  EXPECT_LT(energy_error(run), 1e-5);
}

// A slow motion of the middle support of two spans: M = 3 EI u/L^2 over it.
TEST(SupportMotion, SlowMotionOfOneSupport) {
  const TemporaryFolder folder;
  const std::string file = folder.write("slow.csv", "0,0,0,0\n1,0,0,0\n20,0,5.0e-3,0\n39,0,1.0e-2,0\n40,0,1.0e-2,0\n");
  Results run = run_yaml(
      "beam: {spans: [20, 20], EI: 8.0e9, mass: 9000, elements_per_span: 6, damping_ratios: [0.05, 0.05]}\n"
      "load: {forces: 0, speed: 0}\nts: {max_time: 40, dt: 1.0e-2}\noutput: {interval: 1.0, probes: [10, 20]}\n",
      {{"support_motion", file}, {"support_motion_values", "displacement"}});
  EXPECT_NEAR(run.attribute("/summary", "deflection"), (0.6875 - 0.5) * 0.01, 1e-5);  // from the line to the support
  EXPECT_EQ(run.attribute("/summary", "deflection_place"), 10.0);
  const std::vector<double> moment = run("/probes/moment"), deflection = run("/probes/deflection"),
                            motion = run("/supports/displacement");
  for (std::size_t i = 2; i < run.time().size(); ++i) {
    const double u = motion[3 * i + 1];
    EXPECT_NEAR(moment[2 * i + 1], -3.0 * EI * u / (span * span), 2e-3 * 3.0 * EI * 0.01 / (span * span));
    EXPECT_NEAR(deflection[2 * i + 1], u, 1e-12);
    EXPECT_NEAR(deflection[2 * i], 0.6875 * u, 2e-3 * 0.01);
  }
}

// A bar held at its left end, whose support moves along it: a sum of the modes sin((2n - 1) pi x / 2 L) in x.
TEST(SupportMotion, AlongTheBeam) {
  constexpr double EA = 4.0e9, b = 1.0e-3, wave = std::numbers::pi / 2.0 / span, h = 2e-5;
  const TemporaryFolder folder;
  Results run = run_yaml(
      "beam: {spans: 20, EI: 8.0e9, EA: 4.0e9, mass: 9000, elements_per_span: 80, rayleigh: [0, 1.0e-3]}\n"
      "load: {forces: 0, speed: 0}\nts: {max_time: 0.6, dt: 2.0e-4}\noutput: {interval: 0.01, probes: [10, 20]}\n",
      {{"support_motion_along", pulse_file(folder, {1.0})}});
  const std::vector<double> time = run.time(), along = run("/probes/axial_displacement"),
                            reaction = run("/supports/reaction"), support = run("/supports/displacement_along");
  std::array<double, 2 * modes + 2> s{};  // modal coordinates, the support's displacement, and their rates
  const auto rate = [&](double t, const auto& now) {
    std::array<double, 2 * modes + 2> r{};
    for (std::size_t n = 0; n <= modes; ++n) {
      const double k = 2.0 * static_cast<double>(n) + 1.0, omega2 = k * k * wave * wave * EA / mass;
      r[n] = now[modes + 1 + n];
      r[modes + 1 + n] = n == modes ? pulse(t) : -4.0 / (k * pi) * pulse(t) - omega2 * (b * r[n] + now[n]);
    }
    return r;
  };
  const auto moved = [&](const auto& from, double step, const auto& by) {
    auto to = from;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += step * by[i];
    return to;
  };
  double greatest = 0.0, error = 0.0, greatest_force = 0.0, error_of_force = 0.0;
  for (std::size_t i = 0, step = 0; i < time.size(); ++i) {
    for (; static_cast<double>(step) * h < time[i] - 1e-9; ++step) {
      const double t = static_cast<double>(step) * h;
      const auto k1 = rate(t, s), k2 = rate(t + 0.5 * h, moved(s, 0.5 * h, k1)),
                 k3 = rate(t + 0.5 * h, moved(s, 0.5 * h, k2)), k4 = rate(t + h, moved(s, h, k3));
      s = moved(moved(moved(moved(s, h / 6.0, k1), h / 3.0, k2), h / 3.0, k3), h / 6.0, k4);
    }
    double force = mass * span * pulse(time[i]);  // the support accelerates all mass
    for (const std::size_t probe : {0U, 1U}) {
      double u = s[modes];
      for (std::size_t n = 0; n < modes; ++n)
        u += std::sin((2.0 * static_cast<double>(n) + 1.0) * pi / 4.0 * static_cast<double>(probe + 1)) * s[n];
      greatest = std::max(greatest, std::abs(u - s[modes]));
      error = std::max(error, std::abs(along[2 * i + probe] - u));
    }
    const auto now = rate(time[i], s);
    for (std::size_t n = 0; n < modes; ++n)
      force += mass * now[modes + 1 + n] / ((2.0 * static_cast<double>(n) + 1.0) * wave);
    greatest_force = std::max(greatest_force, std::abs(force));
    error_of_force = std::max(error_of_force, std::abs(reaction[6 * i] - force));
    EXPECT_NEAR(support[2 * i], s[modes], 1e-9);
  }
  RecordProperty("error", text(error / greatest));
  RecordProperty("force_error", text(error_of_force / greatest_force));
  EXPECT_LT(error, 3e-4 * greatest);
  EXPECT_LT(error_of_force, 3e-4 * greatest_force);
  EXPECT_LT(energy_error(run), 1e-6);
}

// A record that is cut while it accelerates: at its end the acceleration of the supports jumps. The step ends there,
// and the sample has the acceleration before the jump, of the supports and of the beam.
TEST(SupportMotion, RecordThatEndsWhileItAccelerates) {
  const TemporaryFolder folder;
  const std::string cut = folder.write("cut.csv", "0,0\n0.0503,2.0\n");
  const auto run = [&](const char* end, const Values& options) {
    return run_yaml(bridge + "load: {forces: 0, speed: 0}\n",
                    options + Values{{"support_motion", cut}, {"ts_max_time", end}});
  };
  Results exact = run("0.3", {{"ts_dt", "5e-5"}}), rough = run("0.3", {{"ts_dt", "1e-3"}}),
          fine = run("0.3", {{"ts_dt", "2.5e-4"}});
  const auto error = [&](Results& one) {
    return relative_difference(one("/probes/deflection"), exact("/probes/deflection"));
  };
  EXPECT_GT(std::log2(error(rough) / error(fine)) / 2.0, 3.5);
  Results at_end = run("0.1006", {{"ts_dt", "1e-4"}, {"output_interval", "0.0503"}}),
          before = run("0.0502", {{"ts_dt", "1e-4"}, {"output_interval", "0.0502"}});
  EXPECT_NEAR(at_end("/supports/acceleration")[2], 2.0, 1e-9);
  EXPECT_NEAR(at_end("/probes/acceleration")[1], before("/probes/acceleration")[1], 0.01);
}

// A table holds its last value. A displacement that would stop at once is refused, two equal rows let it rest.
TEST(SupportMotion, DisplacementHoldsItsLastValue) {
  const TemporaryFolder folder;
  const Values displacement = {{"support_motion_values", "displacement"}};
  const std::string scene = bridge + "load: {forces: 0, speed: 0}\nts: {max_time: 1.0, dt: 1.0e-3}\n";
  const std::string moving = folder.write("moving.csv", "0,0\n0.1,0.01\n0.3,-0.005\n0.5,0.01\n");
  const std::string message = message_of([&] { run_yaml(scene, displacement + Values{{"support_motion", moving}}); });
  EXPECT_TRUE(contains(message, "support_motion: the table ends at 0.5 s, where the displacement would stop at once"));
  Results rests = run_yaml(
      scene, displacement + Values{{"support_motion",
                                    folder.write("rests.csv", "0,0\n0.1,0.01\n0.3,-0.005\n0.5,0.01\n0.6,0.01\n")}});
  const std::vector<double> time = rests.time(), place = rests("/supports/displacement");
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] < 0.6) continue;
    EXPECT_NEAR(place[2 * i], 0.01, 1e-15);
  }
  EXPECT_LT(peak(place).first, 0.01 + 0.3 * 0.015);  // a little beyond the greatest row
  const std::string uneven = folder.write("uneven.csv", "0,0\n0.5,0\n0.501,0.01\n1,0.01\n");
  EXPECT_TRUE(contains(message_of([&] {
                         run_yaml(scene, displacement + Values{{"support_motion", uneven}});
                       }),
                       ": the cubic spline between the rows 1 and 2 reaches"));
}

// The runs of a study have the motion, too, also with linear vehicles.
TEST(SupportMotion, InAStudy) {
  const TemporaryFolder folder;
  const std::string file = pulse_file(folder, {1.0, 0.6});
  const std::string coach =
      bridge + "vehicle: {coach: {file: " + source_folder() +
      "/options/vehicles/velaro.yml}}\ntrain: {vehicles: coach, positions: -1}\nts: {max_time: 0.5, dt: 1.0e-3}\n"
      "model: {vehicles: linear}\n";
  Results study = run_yaml(coach, {{"support_motion", file}, {"study_vary_train_speed", "40,50"}}),
          single = run_yaml(coach, {{"support_motion", file}, {"train_speed", "50"}});
  const double peak = single.attribute("/summary", "deflection");
  EXPECT_NEAR(study("/study/peak_deflection")[1], std::abs(peak), 1e-9);
}

TEST(SupportMotion, RefusedWhereTheGroundWouldMoveToo) {
  const TemporaryFolder folder;
  const std::string file = pulse_file(folder, {1.0});
  const std::string rest = "load: {forces: 0, speed: 0}\nts: {max_time: 1.0, dt: 1.0e-3}\n";
  const auto message = [&](const std::string& text) {
    return message_of([&] { run_yaml(text, {{"support_motion", file}}); });
  };
  EXPECT_NE(message(bridge + rest + "foundation: {vertical_bed_k: 1.0e6}\n").find("support_motion"), std::string::npos);
  EXPECT_NE(message(bridge + rest + "support: {stiffness: 1.0e8}\n").find("support_motion"), std::string::npos);
  EXPECT_NE(message(bridge + rest + "scene: {analysis: static}\n").find("support_motion"), std::string::npos);
  const std::string without_EA = message_of([&] { run_yaml(bridge + rest, {{"support_motion_along", file}}); });
  EXPECT_NE(without_EA.find("beam_EA"), std::string::npos);
  const auto along = [&](const std::string& text) {
    return message_of([&] { run_yaml(text, {{"support_motion_along", file}, {"beam_EA", "4e9"}}); });
  };
  EXPECT_NE(along(bridge + rest + "support: {types: [roller, roller]}\n").find("support_types"), std::string::npos);
}

}  // namespace
}  // namespace traverse::test
