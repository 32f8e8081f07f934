// Converts the static wheel loads of a scene to load models for the rules of EN 1991-2, and copies the peaks of its
// runs for the comparison.
#include "run/norm_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "norm/en1991.hpp"
#include "results/stage.hpp"
#include "run/simulation.hpp"

namespace traverse::run {

norm::LoadModel static_train(std::string name, const std::vector<coupling::StaticLoad>& weights) {
  std::vector<double> forces, x;
  for (const coupling::StaticLoad& weight : weights) {
    forces.push_back(weight.force);
    x.push_back(weight.x);
  }
  return norm::train_of(std::move(name), forces, x);
}

std::vector<norm::LoadModel> static_trains(const scene::Scene& given, const SharedBeam& shared) {
  scene::Scene scene = given;
  std::vector<norm::LoadModel> trains;
  const std::size_t count = given.sweep && !given.sweep->loads.empty() ? given.sweep->loads.size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    std::string name = "train";
    if (given.sweep && !given.sweep->loads.empty()) {
      scene.load.forces = given.sweep->loads[i].forces;
      scene.load.positions = given.sweep->loads[i].positions;
      name = fmt::format("A{}", given.sweep->trains[i]);
    }
    if (scene.vehicles.empty()) {
      if (!scene.load.forces.empty())
        trains.push_back(norm::train_of(std::move(name), scene.load.forces, scene.load.positions));
      continue;
    }
    std::vector<std::string> ignored;
    Simulation at_start(scene, shared, {}, ignored);
    trains.push_back(static_train(std::move(name), at_start.system().weights().all()));
  }
  return trains;
}

norm::NormCheck norm_check(const scene::Scene& scene, std::vector<norm::LoadModel> trains) {
  const results::Stage stage("static effects of trains and load models");
  for (norm::LoadModel& train : trains) {
    if (train.forces.empty()) continue;
    const auto is_behind = [](const norm::LoadModel::Force& a, const norm::LoadModel::Force& b) { return a.x < b.x; };
    const double front = std::max_element(train.forces.begin(), train.forces.end(), is_behind)->x;
    if (scene.norm->range) {
      train.first = (*scene.norm->range)[0] - front;
      train.last = (*scene.norm->range)[1] - front;
    }
    if (scene.norm->lane_load == 0.0) continue;
    train.free_load = scene.norm->lane_load;
    train.free_from = front + scene.norm->lane_gap_from;
    train.free_to = front + scene.norm->lane_gap_to;
  }
  return {*scene.beam, *scene.norm, std::move(trains), scene.output.probes, scene.output.eccentricities};
}

norm::ComputedPeaks peaks_of_run(const scene::Scene& scene, const ResponseExtremes& peaks) {
  norm::ComputedPeaks computed{{scene::greatest_speed(scene)}, scene.output.probes, {{}}};
  for (const Extreme& peak : peaks.largest_of_each(deflection))
    computed.trains[0].deflection.push_back(std::abs(peak.value));
  for (const Extreme& peak : peaks.largest_of_each(moment)) computed.trains[0].moment.push_back(std::abs(peak.value));
  return computed;
}

bool compares_with_lm71(const scene::Scene& scene) {
  const std::vector<std::string>& models = scene.norm->load_models;
  return !scene.self_weight && !scene.beam->strained() && !scene.output.probes.empty() &&
         std::find(models.begin(), models.end(), "lm71") != models.end();
}

}  // namespace traverse::run
