// Derivatives of peaks with respect to parameters of beam, foundation, vehicle and speed, from runs in the lanes of
// batches, against a theorem and against differences of other steps; fits by these runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/record.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::test {
namespace {

const std::string path = source_folder() + "/options/studies/gradient.yml";
const std::string scene = "options_file: " + path + "\n";

/// The scene without its study.
std::string single_run() {
  std::ifstream file(path);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  return all.substr(0, all.find("\nstudy:") + 1);
}

/// An elasticity of a quantity: row of /quantity, in the order of the peaks, and factor.
double elasticity(Results& study, std::size_t quantity, std::size_t factor, std::size_t factors) {
  return study("/sensitivity/elasticity").at(quantity * factors + factor);
}

// Displacements and accelerations do not change if all masses, stiffnesses and dampers are multiplied by one number;
// forces and moments are multiplied by it. By Euler's theorem on homogeneous functions the elasticities with respect to
// all of these parameters have the sums 0 and 1.
TEST(Gradient, SumsOfEulersTheorem) {
  const Values others = {{"study_vary_vehicle_car_axle_mass_normal", "1000,50"},
                         {"study_vary_vehicle_car_suspension_damping_normal", "2e4,1e3"},
                         {"study_vary_vehicle_car_wheel_stiffness_normal", "1e9,1e8"}};
  Results study = run_yaml(scene, others);
  constexpr std::size_t factors = 11, damping_ratio = 2, speed = 7;
  EXPECT_EQ(study("/study/shape"), std::vector<double>{1 + 2 * factors});
  const std::vector<double> degree = {0.0, 0.0, 1.0, 0.0, 1.0, 1.0};  // of the quantities
  double worst = 0.0;
  for (std::size_t q = 0; q < degree.size(); ++q) {
    double sum = 0.0;
    for (std::size_t i = 0; i < factors; ++i)
      if (i != damping_ratio && i != speed) sum += elasticity(study, q, i, factors);
    worst = std::max(worst, std::abs(sum - degree[q]));
  }
  record("sums of elasticities", worst);
  EXPECT_LT(worst, 1e-6);
}

// Also with respect to the speed, although 30 m/s more or less 0.1 % have steps of their own otherwise.
TEST(Gradient, AgreesWithDifferencesOfAThirdOfTheStep) {
  Results study = run_yaml(scene);
  constexpr std::size_t factors = 8;
  const char* const parameters[factors] = {"beam_EI",
                                           "beam_mass",
                                           "beam_damping_ratios",
                                           "foundation_vertical_k",
                                           "foundation_vertical_c",
                                           "vehicle_car_box_mass",
                                           "vehicle_car_suspension_stiffness",
                                           "train_speed"};
  const double nominal[factors] = {2e9, 2e3, 0.02, 1e7, 1e4, 5000.0, 1e6, 30.0};
  constexpr double step = 1e-5;
  double worst = 0.0;
  for (std::size_t i = 0; i < factors; ++i) {
    const std::string pair = text(nominal[i] * (1.0 - step)) + "," + text(nominal[i] * (1.0 + step));
    Results both = run_yaml(single_run(), {{"study_vary_" + std::string(parameters[i]), pair}, {"sweep_refine", "0"}});
    for (std::size_t q = 0; q < 3; ++q) {
      const char* const names[] = {"peak_deflection", "peak_acceleration", "peak_moment"};
      const std::vector<double>& peak = both(std::string("/study/") + names[q]);  // [run][probe]
      const double low = std::max(peak[0], peak[1]), high = std::max(peak[2], peak[3]);
      const double difference = (high - low) / (high + low) / step;
      worst = std::max(worst, std::abs(difference - elasticity(study, q, i, factors)) / (1.0 + std::abs(difference)));
    }
  }
  record("differences of other steps", worst);
  EXPECT_LT(worst, 1e-6);
}

// The record has the steps of a single run at its own speed; batches have steps in distance.
TEST(FitOfVehicles, InLanesAndOneByOne) {
  Results run = run_yaml(single_run(), {{"beam_EI", "1.9e9"}, {"vehicle_car_box_mass", "5300"}, {"train_speed", "31"}});
  const std::vector<double>&time = run("/time"), &deflection = run("/probes/deflection");
  const TemporaryFolder folder;
  std::ostringstream rows;
  rows.precision(17);
  for (std::size_t k = 0; k < time.size(); ++k) rows << time[k] << ", " << deflection[2 * k + 1] << "\n";
  folder.write("measured.csv", rows.str());
  const std::string fit =
      "fit: {vary: {beam_EI: [1.0e9, 4.0e9], vehicle_car_box_mass: [4.0e3, 7.0e3], train_speed: [28, 34]}, "
      "to: {span: {series: measured.csv, quantity: deflection, x: 15.0}}}\n";
  const double exact[] = {1.9e9, 5300.0, 31.0};
  const std::string path_of_scene = folder.write("scene.yml", single_run() + fit);
  Results lanes = run_scene(path_of_scene), single = run_scene(path_of_scene, {{"sweep_lanes", "0"}});
  double worst = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(single("/fit/estimate")[i] / exact[i], 1.0, 1e-6);
    worst = std::max(worst, std::abs(lanes("/fit/estimate")[i] / exact[i] - 1.0));
  }
  record("estimates in lanes", worst);
  EXPECT_LT(worst, 1e-6) << "estimates";
}

}  // namespace
}  // namespace traverse::test
