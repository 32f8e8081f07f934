// The table of engines: which of them serve a scene, the reasons of the others, and their agreement on its runs.
#include "ensemble/engines.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene_helpers.hpp"

namespace traverse::ensemble {
namespace {

const std::string bridge = "beam: {spans: 20.0, EI: 8.3e9, mass: 2303.0, elements_per_span: 8, damping_ratios: 0.01}\n";
const std::string force = "load: {forces: 1e5, speed: 30}\n";
/// The car of scene_helpers, whose body moves at the start, or rests.
std::string car_with(const std::string& velocity) {
  std::string yaml = scene::vehicle_yaml;
  return yaml.replace(yaml.find("[0, 0.1, 0]"), 11, velocity);
}
const std::string car = car_with("[0, 0, 0]") + "train: {vehicles: car, speed: 30}\nmodel: {vehicles: linear}\n";

/// The engines that serve the runs of a scene, each with its results at two speeds, and the reasons of the others.
struct Served {
  std::vector<std::vector<CaseResult>> results{engines.size()};  // empty: it does not serve
  std::vector<std::string> why{engines.size()};

  explicit Served(const std::string& yaml) {
    scene::Scene scene = scene::read_scene_of_study(options::Options::from_yaml(yaml), {});
    scene.sweep->speeds = {30.0, 40.0};
    std::vector<std::string> notes;
    for (std::size_t row = 0; row < engines.size(); ++row) {
      CaseSet cases(scene, notes, nullptr);
      const std::unique_ptr<Engine> engine = engines[row].serve(cases, why[row]);
      EXPECT_EQ(engine == nullptr, !why[row].empty()) << engines[row].name;
      for (const double speed : scene.sweep->speeds) {
        if (!engine) continue;
        EXPECT_GT(engine->cost(), 0.0);
        const Engine::Member member{engine.get(), {speed, {}}};
        results[row].push_back(engine->run(0, {&member, 1}, {}).front());
      }
    }
  }

  /// The largest relative difference of a row's results to those of the last one, which serves all.
  double difference(std::size_t row) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < results.back().size(); ++i)
      for (std::size_t p = 0; p < results.back()[i].peaks.size(); ++p) {
        const base::ProbePeaks &one = results[row].at(i).peaks.at(p), &other = results.back()[i].peaks[p];
        for (const auto quantity : {&base::ProbePeaks::deflection, &base::ProbePeaks::moment})
          largest = std::max(largest, std::abs((one.*quantity).value / (other.*quantity).value - 1.0));
        largest = std::max(
            largest, std::abs(results[row][i].static_deflection[p] / results.back()[i].static_deflection[p] - 1.0));
      }
    return largest;
  }
};

enum Row : std::size_t { modes, batches, single };

TEST(Engines, OfForcesOnModes) {
  const Served served(bridge + force + "model: {modes: 6}\n");
  EXPECT_TRUE(served.why[modes].empty() && served.why[single].empty());
  EXPECT_LT(served.difference(modes), 1e-4);
  EXPECT_EQ(served.why[batches], "the scene has no vehicles");
}

TEST(Engines, OfLinearVehicles) {
  const Served served(bridge + car + "ts: {dt: 1e-3}\n");
  EXPECT_TRUE(served.why[batches].empty() && served.why[single].empty());
  EXPECT_LT(served.difference(batches), 1e-4);
  EXPECT_NE(served.why[modes], "");
}

TEST(Engines, OfVehiclesThatMoveAtTheStart) {
  const Served served(bridge + scene::vehicle_yaml +
                      "train: {vehicles: car, speed: 30}\nmodel: {vehicles: linear}\nts: {dt: 1e-3}\n");
  EXPECT_EQ(served.why[batches], "bodies of vehicles have velocities at the start");
}

TEST(Engines, OfMechanisms) {
  const Served served(bridge + scene::vehicle_yaml +
                      "train: {vehicles: car, speed: 30}\nmodel: {vehicles: full}\nts: {dt: 2e-3}\n");
  EXPECT_NE(served.why[batches].find("mechanisms"), std::string::npos);
  EXPECT_EQ(served.results[single].size(), 2u);
}

TEST(Engines, OfWhatIsNotAsked) {
  const Served served(bridge + car + "ts: {dt: 1e-3}\nsweep: {lanes: 0}\n");
  EXPECT_EQ(served.why[batches], "sweep_lanes is 0");
}

}  // namespace
}  // namespace traverse::ensemble
