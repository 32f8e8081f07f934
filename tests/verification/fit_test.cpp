// Fits to frequencies and series that follow from formulas.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "support/message.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

constexpr double span = 25.0, mass = 1.2e4, EI = 9.1e9, ratio = 0.015, speed = 35.0, force = 2.0e5;

double omega(int n, double stiffness = EI, double per_length = mass) {
  return std::pow(n * pi / span, 2) * std::sqrt(stiffness / per_length);
}

/// The natural frequencies of a simply supported beam, (n pi/L)^2 sqrt(EI/m)/(2 pi).
std::string frequency(int n, double sd) {
  return "f" + std::to_string(n) + ": {frequency: " + std::to_string(n) +
         ", value: " + std::to_string(omega(n) / (2.0 * pi)) + ", sd: " + std::to_string(sd) + "}";
}

std::string beam() { return "beam: {spans: 25.0, EI: 8.0e9, mass: 1.2e4}\nsupport: {types: [pinned, roller]}\n"; }

/// Downward deflection of mode n at midspan under one force that is on the span from 0 to L/v, in closed form.
double modal_deflection(int n, double t) {
  const double w = omega(n), wd = w * std::sqrt(1.0 - ratio * ratio), d = ratio * w, W = n * pi * speed / span;
  const double D = std::pow(w * w - W * W, 2) + std::pow(2.0 * d * W, 2);
  const double a = (w * w - W * W) / D, b = -2.0 * d * W / D, end = span / speed;
  const auto free = [&](double s, double q, double rate) {
    return std::exp(-d * s) * (q * std::cos(wd * s) + (rate + d * q) / wd * std::sin(wd * s));
  };
  const auto free_rate = [&](double s, double q, double rate) {
    return std::exp(-d * s) * (rate * std::cos(wd * s) - (d * rate + w * w * q) / wd * std::sin(wd * s));
  };
  const auto loaded = [&](double s) { return a * std::sin(W * s) + b * std::cos(W * s) + free(s, -b, -a * W); };
  const auto rate = [&](double s) {
    return W * (a * std::cos(W * s) - b * std::sin(W * s)) + free_rate(s, -b, -a * W);
  };
  if (t <= 0.0) return 0.0;
  const double q = t <= end ? loaded(t) : free(t - end, loaded(end), rate(end));
  return 2.0 * force / (mass * span) * q * std::sin(0.5 * n * pi);
}

constexpr int modes = 60;  // of the record; the scene has the static correction of its omitted ones

/// A table of the deflection at midspan, in mm, downward positive, by a clock that shows `shift` at the start.
std::string table(double shift) {
  std::string text;
  char line[80];
  for (int i = 0; i < 400; ++i) {
    double sum = 0.0;
    for (int n = 1; n <= modes; ++n) sum += modal_deflection(n, 5e-3 * i - shift);
    std::snprintf(line, sizeof line, "%.17g, %.17g\n", 5e-3 * i, 1e3 * sum);
    text += line;
  }
  return text;
}

std::string passage(const std::string& vary, const std::string& measurement) {
  return beam() + "load: {forces: 2.0e5, speed: 35.0}\nmodel: {modes: 6, damping_ratios: 0.02}\n" + "fit: {vary: {" +
         vary + "}, to: {midspan: {series: measured.csv, quantity: deflection, x: 12.5, factor: -1.0e-3" + measurement +
         "}}}\n";
}

Results fit(const TemporaryFolder& folder, const std::string& scene, const Values& options = {}) {
  return run_scene(folder.write("scene.yml", scene), options);
}

TEST(Fit, StiffnessByTwoFrequencies) {
  Results results = run_yaml(beam() + "fit: {vary: {beam_EI: [4.0e9, 2.0e10]}, to: {" + frequency(1, 0.01) + ", " +
                             frequency(2, 0.04) + "}}\naccuracy: 1e-6\n");
  EXPECT_NEAR(results("/fit/estimate")[0] / EI, 1.0, 1e-5);
  // df/f = dEI/(2 EI) and equal relative errors of both frequencies: sd(EI)/EI = 2 (sd/f)/sqrt(2)
  const double relative = 0.01 / (omega(1) / (2.0 * pi));
  EXPECT_NEAR(results("/fit/standard_error")[0] / EI, std::sqrt(2.0) * relative, 1e-3 * relative);
  EXPECT_NEAR(results("/fit/frequencies/computed")[1] / (omega(2) / (2.0 * pi)), 1.0, 1e-5);
}

TEST(Fit, MassAndStiffnessCannotBeToldApartByFrequencies) {
  for (const std::string& to : {frequency(1, 0.01), frequency(1, 0.01) + ", " + frequency(2, 0.01)}) {
    const Workplace workplace(beam() + "fit: {vary: {beam_EI: [4.0e9, 2.0e10], beam_mass: [6.0e3, 2.4e4]}, to: {" + to +
                              "}}\n");
    const Outcome outcome = workplace.run({"-output_file", "fit.h5"});
    expect_success(outcome);
    EXPECT_PRED2(contains, outcome.out, "The data cannot tell beam_EI and beam_mass apart");
    EXPECT_PRED2(contains, outcome.out, "beam_EI by +1 % and beam_mass by +1 %");
    Results results(workplace.path("fit.h5"));
    EXPECT_TRUE(std::isinf(results("/fit/standard_error")[0]));
    const std::vector<double>& found = results("/fit/estimate");
    EXPECT_NEAR(omega(1, found[0], found[1]) / omega(1), 1.0, 1e-3);  // their ratio is known
  }
}

TEST(Fit, PassageDeterminesStiffnessMassAndDamping) {
  const TemporaryFolder folder;
  folder.write("measured.csv", table(0.0));
  const std::string vary = "beam_EI: [4.0e9, 2.0e10], beam_mass: [6.0e3, 2.4e4], model_damping_ratios: [0.001, 0.05]";
  for (const char* type : {"brgn", "pounders"}) {
    Results results = fit(folder, passage(vary, ""), {{"tao_type", type}});
    const double tolerance = std::string(type) == "brgn" ? 1e-4 : 1e-3;  // a method without derivatives ends earlier
    EXPECT_NEAR(results("/fit/estimate")[0] / EI, 1.0, tolerance) << type;
    EXPECT_NEAR(results("/fit/estimate")[1] / mass, 1.0, tolerance) << type;
    EXPECT_NEAR(results("/fit/estimate")[2] / ratio, 1.0, tolerance) << type;
  }
}

TEST(Fit, AlignsTheClocksAndFindsTheOffset) {
  const TemporaryFolder folder;
  folder.write("measured.csv", table(0.3217));
  Results results = fit(folder, passage("beam_EI: [4.0e9, 2.0e10]", ", align: true, offset: true"));
  EXPECT_NEAR(results("/fit/estimate")[0] / EI, 1.0, 1e-2);  // the damping is not that of the measurement
  EXPECT_NEAR(results("/fit/estimate")[1], 0.3217, 1e-3);
  const std::string all = "beam_EI: [4.0e9, 2.0e10], model_damping_ratios: [0.001, 0.05]";
  Results exact = fit(folder, passage(all, ", align: true, offset: true"));
  EXPECT_NEAR(exact("/fit/estimate")[0] / EI, 1.0, 1e-4);
  EXPECT_NEAR(exact("/fit/estimate")[2], 0.3217, 1e-5);
  EXPECT_NEAR(exact("/fit/estimate")[3], 0.0, 1e-7);  // m
}

// The gauge gives 2.5 times what it should, in 1/m: shape and frequency of the record still determine the stiffness.
TEST(Fit, EstimatesAnUnknownGaugeFactor) {
  const TemporaryFolder folder;
  folder.write("measured.csv", table(0.0));
  Results results = fit(
      folder, passage("beam_EI: [4.0e9, 2.0e10], model_damping_ratios: [0.001, 0.05]", ", gain: true, offset: true"),
      {{"fit_to_midspan_factor", "-2.5e-3"}});
  EXPECT_NEAR(results("/fit/estimate")[0] / EI, 1.0, 1e-4);
  EXPECT_NEAR(results("/fit/estimate")[1] / ratio, 1.0, 1e-3);
  EXPECT_NEAR(results("/fit/estimate")[2], 0.0, 1e-8) << "the offset";
  EXPECT_NEAR(results("/fit/estimate")[3], 2.5, 1e-4);
}

// Two axles of unknown weight from the record of another scene's bending moment (weighing in motion).
TEST(Fit, EstimatesTheEntriesOfAList) {
  const TemporaryFolder folder;
  const std::string bridge = "beam: {spans: 25.0, EI: 9.1e9, mass: 1.2e4}\nmodel: {modes: 6, damping_ratios: 0.015}\n";
  Results truth = run_yaml(bridge +
                           "load: {forces: [1.1e5, 0.7e5, 1.6e5], positions: [0, -4, -9], speed: 20}\n"
                           "output: {probes: 10, interval: 0.02}\n");
  std::string record;
  const std::vector<double> time = truth.time(), moment = truth.column("/probes/moment");
  for (std::size_t i = 0; i < time.size(); ++i)
    record += std::to_string(time[i]) + "," + std::to_string(moment[i]) + "\n";
  folder.write("measured.csv", record);
  Results results =
      fit(folder, bridge +
                      "load: {forces: [1.0e5, 0.7e5, 1.0e5], positions: [0, -4, -9], speed: 20}\n"
                      "fit: {vary: {load_forces_1: [2.0e4, 3.0e5], load_forces_3: [2.0e4, 3.0e5]}, to: {gauge: "
                      "{series: measured.csv, quantity: moment, x: 10}}}\n");
  EXPECT_NEAR(results("/fit/estimate")[0], 1.1e5, 1e-3 * 1.1e5);
  EXPECT_NEAR(results("/fit/estimate")[1], 1.6e5, 1e-3 * 1.6e5);
  EXPECT_PRED2(contains, message_of([&] {
                 fit(folder, bridge +
                                 "load: {forces: [1.0e5], speed: 20}\nfit: {vary: {load_forces_2: [1, 2e5]}, "
                                 "to: {gauge: {series: measured.csv, quantity: moment, x: 10}}}\n");
               }),
               "load_forces has 1 entries only");
}

// A spring under one end: the frequency depends on EI and on the spring, the shape on their ratio.
TEST(Fit, AShapeTellsApartWhatAFrequencyDoesNot) {
  const TemporaryFolder folder;
  const std::string bridge =
      "beam: {spans: 25.0, EI: 9.1e9, mass: 1.2e4}\nsupport: {types: [pinned, free]}\n"
      "foundation: {vertical: {x: 25.0, k: 2.0e7}}\n";
  Results truth = run_yaml(bridge + "scene: {analysis: modes}\nmodes: {count: 3}\n");
  const std::vector<double>&x = truth("/modes/x"), &shape = truth("/modes/shape");
  std::string record;
  for (const double place : {5.0, 10.0, 15.0, 20.0, 25.0}) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::abs(x[i] - place) < std::abs(x[nearest] - place)) nearest = i;
    record += std::to_string(x[nearest]) + "," + std::to_string(-37.0 * shape[nearest]) + "\n";
  }
  folder.write("shape.csv", record);
  const std::string first =
      "first: {frequency: 1, value: " + std::to_string(truth("/modes/frequency")[0]) + ", sd: 0.001";
  const auto estimate = [&](const std::string& more) {
    return fit(folder, bridge + "fit: {vary: {beam_EI: [4.0e9, 2.0e10], foundation_vertical_k: [5.0e6, 8.0e7]}, to: {" +
                           first + more + "}}}\naccuracy: 1e-5\n");
  };
  Results both = estimate(", shape: shape.csv, shape_sd: 1e-3");
  EXPECT_NEAR(both("/fit/estimate")[0] / EI, 1.0, 1e-3);
  EXPECT_NEAR(both("/fit/estimate")[1] / 2.0e7, 1.0, 1e-3);
  EXPECT_NEAR(both("/fit/frequencies/mac")[0], 1.0, 1e-8);
  EXPECT_NEAR(both("/fit/shapes/first/computed")[2], both("/fit/shapes/first/measured")[2], 0.02);
  Results one = estimate("");
  EXPECT_TRUE(std::isinf(one("/fit/standard_error")[0])) << "from the frequency alone";
}

TEST(Fit, SpeedOfThePassage) {
  const TemporaryFolder folder;
  folder.write("measured.csv", table(0.0));
  const std::string vary = "beam_EI: [4.0e9, 2.0e10], model_damping_ratios: [0.001, 0.05], load_speed: [110 km/h, 40]";
  Results results = fit(folder, passage(vary, ""));
  EXPECT_NEAR(results("/fit/estimate")[2], speed, 1e-3);
}

// The filter is applied to both, so that the estimate remains exact for a record without noise.
TEST(Fit, FilteredSeries) {
  const TemporaryFolder folder;
  folder.write("measured.csv", table(0.0));
  const std::string vary = "beam_EI: [4.0e9, 2.0e10], model_damping_ratios: [0.001, 0.05]";
  Results results = fit(folder, passage(vary, ", lowpass: 8"));
  EXPECT_NEAR(results("/fit/estimate")[0] / EI, 1.0, 1e-4);
}

}  // namespace
}  // namespace traverse::test
