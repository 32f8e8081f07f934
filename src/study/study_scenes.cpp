#include "study/study_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "accuracy/trials.hpp"
#include "traverse/options/input.hpp"

namespace traverse::app {
namespace {

constexpr std::size_t most_runners = 8, some_seeds = 8;

bool names(const StudyDimension& dimension, const char* option) {
  return std::find(dimension.options.begin(), dimension.options.end(), option) != dimension.options.end();
}
bool is_speed(const StudyDimension& d) { return names(d, "train_speed") || names(d, "load_speed"); }
bool is_seed(const StudyDimension& d) { return names(d, "track_seed"); }

/// Train and forces that run together have one speed.
void check_speeds(const Scene& scene) {
  if (scene.vehicles.empty() || scene.load.forces.empty()) return;
  for (const StudyDimension& d : scene.study->dimensions)
    if (is_speed(d) && !(names(d, "train_speed") && names(d, "load_speed")))
      throw InputError(fmt::format("study_vary_{}: the train and the forces beside it run at one speed; add also: {}",
                                   d.name(), names(d, "train_speed") ? "load_speed" : "train_speed"));
  if (scene.train.speed != scene.load.speed)
    throw InputError("study_vary: train_speed and load_speed differ; in a study the train and the forces beside it run "
                     "at one speed");
}

}  // namespace

StudyScenes::StudyScenes(const Scene& scene) : scene_(scene), chosen_(scene) {
  check_speeds(scene);
  const Study& study = *scene.study;
  const double speed = scene.vehicles.empty() ? scene.load.speed : scene.train.speed;
  std::map<std::vector<double>, std::size_t> known;  // bases by what tells them apart
  std::set<double> speeds;
  for (std::size_t run = 0; run < study.runs(); ++run) {
    StudyRun one{0, {speed, {}}};
    std::vector<double> rest;
    for (const StudyDimension& d : study.dimensions) {
      const double value = study.value(run, d);
      if (is_speed(d))
        one.own.speed = value;
      else if (is_seed(d))
        one.own.seed = static_cast<std::uint64_t>(value);
      else
        rest.push_back(value);
    }
    if (!(one.own.speed > 0.0))
      throw InputError(fmt::format("study_vary: run {} has the speed {:g} m/s; allowed: above 0", run, one.own.speed));
    const auto [base, is_new] = known.try_emplace(rest, first_run_.size());
    if (is_new) first_run_.push_back(run);
    one.base = base->second;
    runs_.push_back(one);
    if (one.own.seed && seeds_.size() < some_seeds &&
        std::find(seeds_.begin(), seeds_.end(), *one.own.seed) == seeds_.end())
      seeds_.push_back(*one.own.seed);
    speeds.insert(one.own.speed);
  }
  speeds_.assign(speeds.begin(), speeds.end());
}

Scene StudyScenes::base(std::size_t base) const {
  Scene scene = read_scene_of_study(options::Options(options::in_force()), values_of_run(study(), first_run_[base]));
  if (scene.output.probes.size() != scene_.output.probes.size())
    throw InputError(fmt::format("output_probes: a run has {} probes, others have {}; name as many for all",
                                 scene.output.probes.size(), scene_.output.probes.size()));
  scene.sweep->speeds = speeds_;
  scene.sweep->runs = runs_.size();
  scene.sweep->seeds = seeds_;
  if (const auto& own = runs_[first_run_[base]].own.seed) std::erase(scene.sweep->seeds, *own);
  scene.name = scene_.name;
  scene.quiet = scene_.quiet;
  return scene;
}

std::vector<std::size_t> StudyScenes::extreme_bases() const {
  std::set<std::size_t> found = {0};
  if (bases() > 1)
    for (const StudyDimension& d : study().dimensions) {
      if (is_speed(d) || is_seed(d)) continue;
      const auto less = [&](std::size_t a, std::size_t b) {
        return study().value(first_run_[a], d) < study().value(first_run_[b], d);
      };
      std::vector<std::size_t> all(bases());
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
      const auto [least, greatest] = std::minmax_element(all.begin(), all.end(), less);
      found.insert({*least, *greatest});
    }
  return {found.begin(), found.end()};
}

CaseRunner& StudyScenes::runner(std::size_t base_of_run, std::vector<std::string>* notes) {
  for (auto& [known, runner] : runners_)
    if (known == base_of_run) return *runner;
  Scene scene = base(base_of_run);
  if (scene.mesh_open) set_mesh(scene, mesh_of(chosen_));
  if (!scene.time_step) scene.time_step = chosen_.time_step;
  if (scene.modes_open) scene.model_modes = chosen_.model_modes;
  scene.sweep->method = chosen_.sweep->method;
  scene.rest_tolerance = chosen_.rest_tolerance;
  scene.step_probes = chosen_.step_probes;
  scene.vehicle_model = chosen_.vehicle_model;
  scene.most_defect = chosen_.most_defect;
  if (runners_.size() == most_runners) {
    alone_ += runners_.front().second->alone();
    runners_.pop_front();
  }
  std::vector<std::string> ignored;
  auto made = std::make_unique<CaseRunner>(scene, notes != nullptr ? *notes : ignored);
  return *runners_.emplace_back(base_of_run, std::move(made)).second;
}

long StudyScenes::alone() const {
  long sum = alone_;
  for (const auto& one : runners_) sum += one.second->alone();
  return sum;
}

std::vector<std::vector<std::size_t>> StudyScenes::groups(std::size_t width) const {
  // So many tracks go together, so that each is made once and those in use fit into memory.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> blocks;  // by base and block of seeds
  std::map<std::uint64_t, std::size_t> seeds;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const std::size_t seed = runs_[i].own.seed ? seeds.try_emplace(*runs_[i].own.seed, seeds.size()).first->second : 0;
    blocks[{runs_[i].base, seed / width}].push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (const auto& block : blocks) {
    std::vector<CaseRun> own;
    for (const std::size_t i : block.second) own.push_back(runs_[i].own);
    for (std::vector<std::size_t>& group : group_runs(own, width)) {
      for (std::size_t& i : group) i = block.second[i];
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

}  // namespace traverse::app
