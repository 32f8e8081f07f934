// Bridges by given modes: against the program's own bridges, closed forms and independent integrations.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/runge_kutta.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

/// Sines of a simple span, as text; each track has the shapes times its factors, one a mode.
struct Sines {
  double length;
  std::vector<double> frequency, mass, ratio;  // Hz, kg, 1
  std::vector<int> waves;                      // half waves of each
  std::vector<std::vector<double>> factors;    // [track][mode]
  int stations = 200;
  bool slopes = true;
  std::string outputs = {};
};

std::string row(const std::string& word, const std::vector<double>& numbers) {
  std::string line = word;
  for (const double number : numbers) line += ", " + text(number);
  return line + "\n";
}

std::string as_text(const Sines& sines) {
  std::string all = row("frequency", sines.frequency) + row("modal_mass", sines.mass) +
                    row("damping_ratio", sines.ratio) + sines.outputs;
  for (std::size_t track = 0; track < sines.factors.size(); ++track) {
    all += row("track", {static_cast<double>(track + 1)});
    for (int i = 0; i <= sines.stations; ++i) {
      const double x = sines.length * i / sines.stations;
      std::vector<double> shapes, slopes;
      for (std::size_t m = 0; m < sines.waves.size(); ++m) {
        const double k = pi * sines.waves[m] / sines.length, factor = sines.factors[track][m];
        shapes.push_back(factor * std::sin(k * x));
        slopes.push_back(factor * k * std::cos(k * x));
      }
      if (sines.slopes) shapes.insert(shapes.end(), slopes.begin(), slopes.end());
      all += row(text(x), shapes);
    }
  }
  return all;
}

/// The first modes of Yang and Yau's beam, without damping.
Sines yang_yau(int modes) {
  const double length = 25.0, EI = 8.323e9, mass = 2303.0;
  Sines sines{length, {}, {}, {}, {}, {{}}};
  for (int n = 1; n <= modes; ++n) {
    sines.frequency.push_back(std::pow(n * pi / length, 2) * std::sqrt(EI / mass) / (2.0 * pi));
    sines.mass.push_back(0.5 * mass * length);
    sines.ratio.push_back(0.0);
    sines.waves.push_back(n);
    sines.factors[0].push_back(1.0);
  }
  return sines;
}

const std::string continuous =
    "beam: {spans: [32, 40, 32], EI: 3.795e11, mass: 3e4, damping_ratios: 0.02, elements_per_span: 6}\n"
    "support: {types: [pinned, roller, roller, roller]}\n";
const std::string coaches = "vehicle: {coach: {file: " + source_folder() +
                            "/options/vehicles/velaro.yml}}\n"
                            "train: {vehicles: coach*2, speed: 80}\n"
                            "ts: {dt: 5e-4, max_time: 2.0}\noutput: {interval: 5e-3, probes: [16, 52, 88]}\n"
                            "model: {vehicles: full}\n";

// The results file of the bridge's own modes is given back. The bridge by its elements adds what modes left out deflect
// by at rest (probes are at nodes, where loads inside elements add nothing); so wheels, which feel the modes alone,
// agree whatever their number, and deflections where all are taken.
TEST(GivenModes, OfTheProgramsOwnBridge) {
  for (const char* count : {"6", "1000"}) {
    const std::string all(count);
    Results modes = run_yaml(continuous, {{"scene_analysis", "modes"}, {"modes_count", count}});
    Results own = run_yaml(continuous + coaches, {{"model_modes", count}});
    Results given = run_yaml("bridge: {modes_file: " + modes.file() + "}\n" + coaches);
    for (const char* name : {"/vehicles/0/wheel_1/normal_force", "/vehicles/1/car/acceleration"}) {
      const double difference = relative_difference(given(name), own(name));
      RecordProperty(name + all, text(difference));
      EXPECT_LT(difference, 1e-9) << name << " by " << count;
    }
    const double shaken = relative_difference(given("/probes/acceleration"), own("/probes/acceleration"));
    const double deflected = relative_difference(given("/probes/deflection"), own("/probes/deflection"));
    RecordProperty("acceleration" + all, text(shaken));
    RecordProperty("deflection" + all, text(deflected));
    EXPECT_LT(shaken, 1e-9);
    EXPECT_LT(deflected, all == "1000" ? 1e-9 : 0.05);
    EXPECT_NEAR(given.attribute("/summary", "static_deflection"), own.attribute("/summary", "static_deflection"),
                (all == "1000" ? 1e-8 : 0.05) * own.attribute("/summary", "static_deflection"));
    EXPECT_LT(energy_error(given), 1e-8);
  }
}

// R2: sines against 80 modes by an adaptive Runge-Kutta method; twenty leave out 2e-5 of the deflection.
TEST(GivenModes, SprungMassOfR2) {
  TemporaryFolder folder;
  for (const bool slopes : {true, false}) {
    Sines sines = yang_yau(30);
    sines.slopes = slopes;
    const std::string file = folder.write(slopes ? "slopes.csv" : "splines.csv", as_text(sines));
    Results run =
        run_yaml("bridge: {modes_file: " + file +
                     "}\n"
                     "vehicle:\n  sprung_mass:\n    bodies: [body]\n    wheels: [spring]\n    drivers: [level]\n"
                     "    body: {mass: 5750.0, inertia: 1.0, position: [0.0, 0.1]}\n"
                     "    spring: {body: body, radius: 0.1, law: linear, stiffness: 1.595e6}\n"
                     "    level: {body: body, coordinate: phi}\n"
                     "train: {vehicles: sprung_mass, positions: 0.0, speed: 27.777777777777778}\n",
                 {{"ts_dt", "1e-3"}, {"output_interval", "1e-3"}});
    const auto reference = read_table(source_folder() + "/tests/data/r2.csv");
    const double difference = relative_difference(every(5, run.column("/probes/deflection")), column(reference, 1));
    const double force = relative_difference(every(5, run("/vehicles/0/spring/normal_force")), column(reference, 4));
    RecordProperty(slopes ? "slopes" : "splines", text(difference));
    EXPECT_LT(difference, 5e-5);
    EXPECT_LT(force, 1e-5);
  }
}

// A force over one mode without damping, in closed form (Fryba, ch. 1), and the mode's moment as an output.
TEST(GivenModes, MovingForceInClosedForm) {
  Sines sines = yang_yau(1);
  const double moment = 8.323e9 * std::pow(pi / 25.0, 2);  // at midspan, N m for 1 m
  sines.outputs = row("output, moment, N m", {moment});
  TemporaryFolder folder;
  const std::string file = folder.write("modes.csv", as_text(sines));
  const double speed = 60.0, force = 1e5, omega = 2.0 * pi * sines.frequency[0], driving = pi * speed / 25.0;
  Results run = run_yaml("bridge: {modes_file: " + file + "}\nload: {forces: 1e5, speed: 60}\n",
                         {{"ts_dt", "2e-4"}, {"output_interval", "2e-3"}, {"ts_max_time", "0.4"}});
  const std::vector<double> time = run.time();
  std::vector<double> exact, moments;
  for (const double t : time) {
    const double q = force / sines.mass[0] / (omega * omega - driving * driving) *
                     (std::sin(driving * t) - driving / omega * std::sin(omega * t));
    exact.push_back(-q);
    moments.push_back(-moment * q);
  }
  ASSERT_LT(time.back(), 25.0 / speed);
  const double difference = relative_difference(run.column("/probes/deflection"), exact);
  RecordProperty("error", text(difference));
  EXPECT_LT(difference, 1e-9);
  EXPECT_LT(relative_difference(run("/outputs/moment"), moments), 1e-9);
}

// Section forces are unknown: the jump of the shear beside a force that stands on a probe at the end of a step is no
// peak.
TEST(GivenModes, HaveNoSectionForces) {
  TemporaryFolder folder;
  const std::string file = folder.write("modes.csv", as_text(yang_yau(2)));
  Results run = run_yaml("bridge: {modes_file: " + file + "}\nload: {forces: 1e5, speed: 60}\noutput: {probes: 12.0}\n",
                         {{"ts_dt", "1e-3"}, {"ts_max_time", "0.4"}, {"step_probes", "true"}});
  EXPECT_GT(std::abs(run.attribute("/summary", "deflection")), 0.0);
  for (const char* name : {"moment", "shear", "axial_force"})
    EXPECT_TRUE(std::isnan(run.attribute("/summary", name))) << name;
  for (const char* name : {"/probes/moment", "/probes/shear", "/envelope/moment", "/envelope/shear"})
    EXPECT_THROW(run(name), std::runtime_error) << name;
}

/// A slab of 20 m: two modes of bending and two of torsion, which move the tracks at 2.2 m on either side.
Sines slab() {
  const double arm = 2.2;
  return {20.0,
          {6.0, 9.5, 24.0, 30.0},
          {1.5e5, 1.1e6, 1.5e5, 1.1e6},
          {0.02, 0.015, 0.02, 0.015},
          {1, 1, 2, 2},
          {{1.0, arm, 1.0, arm}, {1.0, -arm, 1.0, -arm}}};
}

const std::string mass_on_spring =
    "vehicle:\n  wagon:\n    bodies: [body]\n    wheels: [spring]\n    drivers: [level]\n"
    "    body: {mass: 2e4, inertia: 1.0, position: [0.0, 0.06]}\n"
    "    spring: {body: body, radius: 0.06, law: linear, stiffness: 4e6}\n"
    "    level: {body: body, coordinate: phi}\ntrain: {vehicles: wagon, positions: 0.0, speed: 50}\n"
    "output: {probes: 10.0}\n";

// One track loaded, both seen: the modes and the mass by the Runge-Kutta method.
TEST(GivenModes, SlabWithTorsionUnderOneTrack) {
  const Sines sines = slab();
  TemporaryFolder folder;
  const std::string file = folder.write("slab.csv", as_text(sines));
  const double h = 1e-3, speed = 50.0, mass = 2e4, stiffness = 4e6, g = 9.81;
  const std::string bridge = "bridge: {modes_file: " + file + ", track: 2}\n";
  Results run =
      run_yaml(bridge + mass_on_spring, {{"ts_dt", "2.5e-4"}, {"output_interval", text(h)}, {"ts_max_time", "0.6"}});

  using Y = State<11>;  // q, q', y, y', t
  const auto shape = [&](std::size_t m, double x, std::size_t track) {
    return x < 0.0 || x > 20.0 ? 0.0 : sines.factors[track][m] * std::sin(pi * sines.waves[m] * x / 20.0);
  };
  const auto rate = [&](const Y& y) {
    Y out;
    const double x = speed * y[10];
    double surface = 0.0;
    for (std::size_t m = 0; m < 4; ++m) surface += shape(m, x, 1) * y[static_cast<Eigen::Index>(m)];
    const double force = std::max(0.0, stiffness * (surface - y[8]));
    for (Eigen::Index m = 0; m < 4; ++m) {
      const auto i = static_cast<std::size_t>(m);
      const double omega = 2.0 * pi * sines.frequency[i];
      out[m] = y[4 + m];
      out[4 + m] =
          -force * shape(i, x, 1) / sines.mass[i] - 2.0 * sines.ratio[i] * omega * y[4 + m] - omega * omega * y[m];
    }
    out[8] = y[9];
    out[9] = force / mass - g;
    out[10] = 1.0;
    return out;
  };
  Y y = Y::Zero();
  y[8] = -mass * g / stiffness;
  std::vector<double> deflection = {0.0}, acceleration;
  const int fine = 20, samples = 400;  // until the mass is about to leave
  for (int i = 1; i <= samples; ++i) {
    for (int k = 0; k < fine; ++k) runge_kutta<11>(rate, h / fine, y);
    deflection.push_back(shape(0, 10.0, 1) * y[0] + shape(1, 10.0, 1) * y[1]);
  }
  std::vector<double> found = run.column("/probes/deflection");
  found.resize(deflection.size());
  const double difference = relative_difference(found, deflection);
  RecordProperty("error", text(difference));
  EXPECT_LT(difference, 1e-6);

  // The other track rises on the far side of the torsion: as a check that tracks differ.
  Results other = run_yaml("bridge: {modes_file: " + file + ", track: 1}\n" + mass_on_spring,
                           {{"ts_dt", "2.5e-4"}, {"output_interval", text(h)}, {"ts_max_time", "0.6"}});
  EXPECT_LT(relative_difference(other.column("/probes/deflection"), run.column("/probes/deflection")),
            1e-9);  // symmetric
  const std::string lopsided = [&] {
    Sines without = slab();
    without.factors = {{1.0, 0.0, 1.0, 0.0}};
    return folder.write("bending.csv", as_text(without));
  }();
  Results bending = run_yaml("bridge: {modes_file: " + lopsided + "}\n" + mass_on_spring,
                             {{"ts_dt", "2.5e-4"}, {"output_interval", text(h)}, {"ts_max_time", "0.6"}});
  EXPECT_GT(relative_difference(bending.column("/probes/deflection"), run.column("/probes/deflection")), 0.05);
}

// Forces side by side and coaches by the kernel of linear vehicles, against the general way.
TEST(GivenModes, SweepsAndKernels) {
  TemporaryFolder folder;
  const std::string bridge = "bridge: {modes_file: " + folder.write("slab.csv", as_text(slab())) + "}\n";
  const std::string forces =
      "load: {forces: [1e5, 1.2e5, 1e5], positions: [0, -8, -16]}\noutput: {probes: [5, 10]}\n"
      "ts: {max_time: 1.2}\n";
  Results sweep = run_yaml(bridge + forces, {{"sweep_speed", "40,50,5"}});
  const std::vector<double> deflections = sweep("/sweep/peak_deflection"),
                            accelerations = sweep("/sweep/peak_acceleration");
  for (std::size_t i = 0; i < 3; ++i) {
    Results run = run_yaml(
        bridge + forces,
        {{"load_speed", text(40.0 + 5.0 * static_cast<double>(i))}, {"ts_dt", "2e-4"}, {"output_interval", "2e-4"}});
    for (std::size_t p = 0; p < 2; ++p) {
      const double alone = std::abs(refined_peak(run.time(), run.column("/probes/deflection", p)).value);
      EXPECT_NEAR(deflections[2 * i + p], alone, 2e-4 * alone);
      const double shaken = std::abs(refined_peak(run.time(), run.column("/probes/acceleration", p)).value);
      EXPECT_NEAR(accelerations[2 * i + p], shaken, 2e-2 * shaken);
    }
  }
  for (const double moment : sweep("/sweep/peak_moment")) EXPECT_TRUE(std::isnan(moment));  // not known

  const std::string coach = "vehicle: {coach: {file: " + source_folder() +
                            "/options/vehicles/velaro.yml}}\n"
                            "train: {vehicles: coach*2, speed: 70}\nts: {dt: 5e-4}\noutput: {interval: 5e-3}\n";
  Results full = run_yaml(bridge + coach, {{"model_vehicles", "full"}});
  Results linear = run_yaml(bridge + coach, {{"model_vehicles", "linear"}});
  const Values speeds = {{"model_vehicles", "linear"}, {"sweep_speed", "70,72,2"}, {"step_probes", "true"}};
  Results beside = run_yaml(bridge + coach, speeds);
  Results by_themselves = run_yaml(bridge + coach, speeds + Values{{"sweep_lanes", "0"}});
  for (const char* name : {"peak_deflection", "peak_acceleration", "least_wheel_force", "greatest_wheel_force"}) {
    const std::string path = std::string("/sweep/") + name;
    const double difference = relative_difference(beside(path), by_themselves(path));
    RecordProperty(name, text(difference));
    EXPECT_LT(difference, 3e-4) << name;
  }
  for (Results* other : {&linear}) {
    const double difference = relative_difference((*other)("/probes/deflection"), full("/probes/deflection"));
    RecordProperty("linear", text(difference));
    EXPECT_LT(difference, 1e-4);
  }
  EXPECT_NEAR(beside("/sweep/peak_deflection")[0], std::abs(linear.attribute("/summary", "deflection")),
              1e-4 * std::abs(linear.attribute("/summary", "deflection")));
}

}  // namespace
}  // namespace traverse::test
