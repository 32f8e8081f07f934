// Sensors on bodies of vehicles, and the forces of wheels that pass places of the track.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/message.hpp"

namespace traverse::test {
namespace {

/// Two coaches over three spans, the first one already near the bridge.
std::string train(const std::string& more) {
  return "beam: {spans: [32, 40, 32], EI: 3.795e11, mass: 3e4, damping_ratios: 0.02, elements_per_span: 8}\n"
         "support: {types: [pinned, roller, roller, roller]}\n"
         "vehicle:\n  coach:\n    file: " +
         source_folder() +
         "/options/vehicles/velaro.yml\n"
         "    sensors: [floor, frame, middle]\n"
         "    floor: {body: car, point: [10.0, 1.3]}\n    frame: {body: front_bogie, point: [7.4, 0.7]}\n"
         "    middle: {body: rear_bogie}\n"
         "train: {vehicles: coach*2, speed: 80, positions: [-15, -40.835]}\n"
         "ts: {dt: 5e-4, max_time: 1.0}\n" +
         more;
}

struct Place {
  const char *sensor, *body;
  double x, y;  // from the centre of mass, m
};
constexpr Place places[] = {{"floor", "car", 10.0, 1.3 - 2.191},
                            {"frame", "front_bogie", 7.4 - 8.6875, 0.7 - 0.556},
                            {"middle", "rear_bogie", 0.0, 0.0}};

/// The largest difference of a sensor's numbers from the rigid body's motion, over their largest.
double off_the_body(Results& run, const Place& place) {
  const std::string sensor = std::string("/vehicles/1/") + place.sensor + "/",
                    body = std::string("/vehicles/1/") + place.body + "/";
  const auto of = [&](const char* name, std::size_t c) { return run.column(body + name, c); };
  const std::vector<double> x = of("position", 0), y = of("position", 1), phi = of("position", 2);
  const std::vector<double> rate = of("velocity", 2), ax = of("acceleration", 0), ay = of("acceleration", 1),
                            turning = of("acceleration", 2);
  std::vector<double> px, py, sx, sy;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double rx = std::cos(phi[i]) * place.x - std::sin(phi[i]) * place.y;
    const double ry = std::sin(phi[i]) * place.x + std::cos(phi[i]) * place.y;
    px.push_back(x[i] + rx);
    py.push_back(y[i] + ry);
    sx.push_back(ax[i] - turning[i] * ry - rate[i] * rate[i] * rx);
    sy.push_back(ay[i] + turning[i] * rx - rate[i] * rate[i] * ry);
  }
  EXPECT_EQ(run(sensor + "pitch_rate"), rate);
  return std::max({relative_difference(run(sensor + "position_x"), px),
                   relative_difference(run(sensor + "position_y"), py),
                   relative_difference(run(sensor + "acceleration_y"), sy),
                   peak(sx).first == 0.0 ? 0.0 : relative_difference(run(sensor + "acceleration_x"), sx)});
}

// By mechanisms, by linear vehicles, and by these over modes, which a kernel of its own steps.
TEST(Sensors, MoveWithTheirRigidBodies) {
  const std::pair<const char*, const char*> ways[] = {{"mechanisms", ""},
                                                      {"linear", "model: {vehicles: linear}\n"},
                                                      {"over_modes", "model: {vehicles: linear, modes: 6}\n"}};
  for (const auto& [name, way] : ways) {
    SCOPED_TRACE(name);
    Results run = run_yaml(train(way), {{"output_interval", "5e-3"}});
    for (const Place& place : places) {
      const double difference = off_the_body(run, place);
      testing::Test::RecordProperty(std::string(place.sensor) + "_" + name, text(difference));
      EXPECT_LT(difference, 1e-10) << place.sensor;
    }
  }
}

/// The integral from the first sample on, of the cubics through four neighbours each.
std::vector<double> integral(const std::vector<double>& rate, double h) {
  std::vector<double> sum = {0.0};
  for (std::size_t i = 0; i + 1 < rate.size(); ++i) {
    const double before = i > 0 ? rate[i - 1] : rate[0], after = i + 2 < rate.size() ? rate[i + 2] : rate[i + 1];
    sum.push_back(sum.back() + h / 24.0 * (13.0 * (rate[i] + rate[i + 1]) - before - after));
  }
  return sum;
}

// What is stored of a point's acceleration, integrated twice, is its path: samples close enough for the wheels on their
// contacts, which vibrate at 187 Hz. The first sample is at rest. Where wheels come onto the bridge between two samples
// the acceleration has a kink, which the cubics pass over.
TEST(Sensors, AccelerationIsThatOfThePath) {
  for (const char* sensor : {"floor", "frame"}) {
    double off = 0.0;
    for (const double interval : {1e-3, 1.25e-4}) {
      Results run = run_yaml(train(""), {{"output_interval", text(interval)}, {"ts_dt", "1.25e-4"}});
      const std::string group = std::string("/vehicles/0/") + sensor + "/";
      std::vector<double> path = run(group + "position_y");
      const double start = path.front();
      for (double& y : path) y -= start;
      const double before = off;
      off = relative_difference(integral(integral(run(group + "acceleration_y"), interval), interval), path);
      testing::Test::RecordProperty(sensor + ("_" + text(interval)), text(off));
      if (before > 0.0) {
        EXPECT_LT(off, 0.5 * before) << sensor;
      }
    }
    EXPECT_LT(off, 1e-5) << sensor;
  }
}

/// The cubic through the four samples around the `at`-th.
double between(const std::vector<double>& series, double at) {
  const auto k = static_cast<std::size_t>(std::floor(at));
  const double s = at - static_cast<double>(k);
  return -s * (s - 1.0) * (s - 2.0) / 6.0 * series.at(k - 1) + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * series[k] -
         (s + 1.0) * s * (s - 2.0) / 2.0 * series[k + 1] + (s + 1.0) * s * (s - 1.0) / 6.0 * series.at(k + 2);
}

// Places that wheels reach between samples, and at one.
TEST(AxleLoadRecords, HaveTimeSpeedAndForce) {
  const double speed = 80.0, interval = 2.5e-4;
  // The first wheel is at -15 + 9.9375 m; after 0.4 s at 26.9375 m.
  const std::string wanted = "output: {passages: [-4.0, 26.9375]}\n";
  Results run = run_yaml(train(wanted), {{"output_interval", text(interval)}, {"ts_dt", text(interval)}});
  const std::vector<double> time = run("/passages/time"), x = run("/passages/x"), force = run("/passages/normal_force"),
                            rest = run("/passages/force_at_start");
  ASSERT_EQ(time.size(), 16U);
  EXPECT_TRUE(std::is_sorted(time.begin(), time.end()));
  const double axles[] = {9.9375, 7.4375, -7.4375, -9.9375};
  double worst_place = 0.0, worst_force = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    bool found = false;  // some wheel is due there then
    for (const double origin : {-15.0, -40.835})
      for (std::size_t w = 0; w < 4; ++w) {
        const double due = (x[i] - origin - axles[w]) / speed;
        if (std::abs(due - time[i]) > 1e-5) continue;
        found = true;
        const std::string vehicle = std::string("/vehicles/") + (origin == -15.0 ? "0" : "1"),
                          number = std::to_string(w + 1);
        const double at = time[i] / interval;
        const double there = between(run.column(vehicle + "/wheelset_" + number + "/position", 0), at);
        worst_place = std::max(worst_place, std::abs(there - x[i]));
        const double pressed = between(run(vehicle + "/wheel_" + number + "/normal_force"), at);
        worst_force = std::max(worst_force, std::abs(pressed - force[i]) / rest[i]);
      }
    EXPECT_TRUE(found) << time[i];
    if (x[i] < 0.0) {  // before the bridge nothing moves up or down
      EXPECT_NEAR(force[i], rest[i], 1e-3 * rest[i]);
    }
  }
  RecordProperty("place", text(worst_place));
  EXPECT_LT(worst_place, 1e-8);
  RecordProperty("force", text(worst_force));
  EXPECT_LT(worst_force, 1e-4);
  for (const double v : run("/passages/speed")) EXPECT_NEAR(v, speed, 1e-4 * speed);
}

TEST(AxleLoadRecords, ChangeNothingElse) {
  Results without = run_yaml(train(""), {{"output_interval", "5e-3"}});
  Results with = run_yaml(train("output: {passages: 20.013}\n"), {{"output_interval", "5e-3"}});
  const double difference = relative_difference(with("/probes/deflection"), without("/probes/deflection"));
  RecordProperty("difference", text(difference));
  EXPECT_LT(difference, 1e-6);
}

// The kernels that step linear vehicles know nothing of places: then they are not taken.
TEST(AxleLoadRecords, OfLinearVehiclesOverModes) {
  const Values options = {
      {"model_vehicles", "linear"}, {"model_modes", "6"}, {"output_passages", "20.013"}, {"output_interval", "5e-3"}};
  Results linear = run_yaml(train(""), options),
          full =
              run_yaml(train(""), {{"output_passages", "20.013"}, {"model_modes", "6"}, {"output_interval", "5e-3"}});
  EXPECT_EQ(linear("/passages/time").size(), 8U);
  EXPECT_LT(relative_difference(linear("/passages/normal_force"), full("/passages/normal_force")), 1e-5);
}

TEST(AxleLoadRecords, NeedAPrescribedSpeed) {
  const std::string message = message_of([] {
    run_yaml(train("output: {passages: 20}\n"), {{"train_drive", "free"}});
  });
  EXPECT_TRUE(contains(message, "output_passages")) << message;
  EXPECT_TRUE(contains(message, "train_drive constant")) << message;
}

}  // namespace
}  // namespace traverse::test
