// Groups runs by scene or bridge, train, seed and speed, and stores a limited number of assembled models for them.
#include "study/study_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "error_control/model_choice.hpp"
#include "results/sweep.hpp"
#include "traverse/options/input.hpp"

namespace traverse::study {
namespace {

constexpr std::size_t max_runners = 12, max_seeds = 8;

bool names(const options::StudyDimension& dimension, const char* option) {
  return std::find(dimension.options.begin(), dimension.options.end(), option) != dimension.options.end();
}
bool is_speed(const options::StudyDimension& d) {
  return names(d, "train_speed") || names(d, "load_speed") || names(d, results::speed_of_sweep);
}
bool is_seed(const options::StudyDimension& d) { return names(d, "track_seed"); }
bool is_of_traffic(const options::StudyDimension& d) {
  return std::all_of(d.options.begin(), d.options.end(), [](const std::string& option) {
    return option.starts_with("vehicle_") || option.starts_with("load_");
  });
}

bool is_local(const options::Study& study) {
  return study.sensitivity && study.sensitivity->method == options::Sensitivity::Method::local;
}

options::Study study_of_sweep(const scene::Scene& scene) {
  std::vector<double> speeds = scene.sweep->speeds;
  if (speeds.empty()) speeds = {scene::moving_speed(scene)};
  options::Study study = results::sweep_study(scene.sweep->trains, std::move(speeds));
  study.refine = scene.sweep->refine;
  return study;
}

/// A train and forces that move in one scene must have one speed.
void check_speeds(const scene::Scene& scene) {
  if (scene.vehicles.empty() || scene.load.forces.empty()) return;
  if (!scene.train.courses.empty() || !scene.load.courses.empty()) return;  // each course has its own speed
  if (scene.train.speed == 0.0 || scene.load.speed == 0.0) return;          // what stands is not varied
  for (const options::StudyDimension& d : scene.study->dimensions)
    if (is_speed(d) && !(names(d, "train_speed") && names(d, "load_speed")))
      throw InputError(
          fmt::format("study_vary_{}: the train and the additional forces have the same speed; vary also {}", d.name(),
                      names(d, "train_speed") ? "load_speed" : "train_speed"));
  if (scene.train.speed != scene.load.speed)
    throw InputError(
        "study_vary: train_speed and load_speed differ; in a study the train and the additional forces have the same "
        "speed");
}

}  // namespace

StudyScenes::StudyScenes(const scene::Scene& scene, Read read) : scene_(scene), read_(std::move(read)) {
  if (!read_)
    read_ = [this](const auto& values) { return scene::read_scene_of_study(options::Options(*scene_.given), values); };
  if (scene.study) check_speeds(scene);
  enumerate(scene.study ? *scene.study : study_of_sweep(scene));
}

void StudyScenes::enumerate(const options::Study& study) {
  study_ = study;
  runs_.clear();
  first_run_.clear();
  values_of_bases_.clear();
  first_of_bridge_.clear();
  const double speed = scene::moving_speed(scene_);
  std::map<std::vector<double>, std::size_t> known,
      bridges;  // indices of bases and bridges by the values that define them
  std::set<double> speeds;
  const bool local = is_local(study);
  enum class Sets { own_speed, own_seed, traffic, bridge };
  std::vector<Sets> sets;  // of each dimension
  for (const options::StudyDimension& d : study.dimensions)
    sets.push_back(is_speed(d)        ? Sets::own_speed
                   : is_seed(d)       ? Sets::own_seed
                   : is_of_traffic(d) ? Sets::traffic
                                      : Sets::bridge);
  const bool varies_speed = std::ranges::any_of(study.dimensions, is_speed);
  for (std::size_t run = 0; run < study.runs(); ++run) {
    StudyRun one{0, study.sweep ? study.place(run, 0) : 0, 0, {speed, {}}};
    std::vector<double> of_base, of_bridge;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const options::StudyDimension& d = study.dimensions[i];
      const double value = study.value(run, d);
      if (sets[i] == Sets::own_speed) {
        one.own.speed = value;
        if (local && d.axis == study.sensitivity->axis) one.own.step_speed = d.values.front();
      } else if (sets[i] == Sets::own_seed) {
        one.own.seed = static_cast<std::uint64_t>(value);
      } else if (!study.sweep) {
        of_base.push_back(value);
        if (sets[i] == Sets::bridge) of_bridge.push_back(value);
      }
    }
    const bool stands = !scene_.vehicles.empty() && one.own.speed == 0.0 && !varies_speed;
    if (!(one.own.speed > 0.0 || stands))
      throw InputError(fmt::format("study_vary: run {} has the speed {:g} m/s; allowed: above 0", run, one.own.speed));
    const auto [base, is_new] = known.try_emplace(of_base, first_run_.size());
    if (is_new) {
      first_run_.push_back(run);
      values_of_bases_.push_back(base->first);
    }
    one.base = base->second;
    const auto [bridge, new_bridge] = bridges.try_emplace(of_bridge, first_of_bridge_.size());
    if (new_bridge) first_of_bridge_.push_back(one.base);
    one.bridge = bridge->second;
    runs_.push_back(one);
    if (one.own.seed && seeds_.size() < max_seeds &&
        std::find(seeds_.begin(), seeds_.end(), *one.own.seed) == seeds_.end())
      seeds_.push_back(*one.own.seed);
    speeds.insert(one.own.speed);
  }
  const bool same_range = !speeds_.empty() && speeds_.front() == *speeds.begin() && speeds_.back() == *speeds.rbegin();
  speeds_.assign(speeds.begin(), speeds.end());
  if (!same_range) runners_.clear();  // their tracks have the range that the fastest run needs
}

scene::Scene StudyScenes::base(std::size_t base) const {
  if (study_.sweep) return scene_;
  scene::Scene scene = read_(scene::values_of_run(study(), first_run_[base]));
  if (scene.output.probes.size() != scene_.output.probes.size())
    throw InputError(fmt::format("output_probes: a run has {} probes, others have {}; name as many for all",
                                 scene.output.probes.size(), scene_.output.probes.size()));
  scene.sweep->speeds = speeds_;
  scene.sweep->runs = runs_.size();
  scene.sweep->seeds = seeds_;
  if (const auto& own = runs_[first_run_[base]].own.seed) std::erase(scene.sweep->seeds, *own);
  scene.limits = scene_.limits;
  scene.name = scene_.name;
  scene.quiet = scene_.quiet;
  return scene;
}

std::vector<std::size_t> StudyScenes::extreme_bases() const {
  std::set<std::size_t> found = {0};
  if (bases() > 1)
    for (const options::StudyDimension& d : study().dimensions) {
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

std::vector<std::size_t> StudyScenes::bases_of_model() const {
  const bool only_factors = std::all_of(study_.dimensions.begin(), study_.dimensions.end(), [&](const auto& d) {
    return is_speed(d) || is_seed(d) || (study_.sensitivity && d.axis == study_.sensitivity->axis);
  });
  return is_local(study_) && only_factors ? std::vector<std::size_t>{0} : extreme_bases();
}

StudyScenes::Runner StudyScenes::runner(std::size_t wanted, std::vector<std::string>* notes) {
  for (Runner& known : runners_)
    if (known.values == values_of_bases_[wanted]) {
      known.base = wanted;
      return known;
    }
  // All bases of a bridge use the model of its first base and can be computed in one batch with it. Bridges that differ
  // in parameter values only can be computed in one batch with the bridge of the first base.
  const std::size_t first = first_of_bridge_[runs_[first_run_[wanted]].bridge];
  const std::size_t with = wanted != first ? first : 0;
  const std::optional<Runner> other = wanted != 0 ? std::optional(runner(with)) : std::nullopt;
  const scene::Scene scene = chosen_ ? error_control::completed(base(wanted), *chosen_) : base(wanted);
  if (runners_.size() == max_runners) {
    const auto oldest = std::find_if(runners_.begin(), runners_.end(), [&](const Runner& one) {
      // The cost of runs is estimated with the first base.
      return one.values != values_of_bases_[0] && one.values != values_of_bases_[first];
    });
    separate_runs_ += oldest->runs->separate_runs();
    runners_.erase(oldest);
  }
  std::vector<std::string> ignored;
  const bool same_beam = wanted != first && scene.beam->axial == other->runs->axial();
  auto made = std::make_shared<ensemble::CaseRunner>(scene, notes != nullptr ? *notes : ignored,
                                                     same_beam ? other->runs->beam() : nullptr, notes != nullptr);
  const std::vector<double>& values = values_of_bases_[wanted];
  const bool merged = other && made->merge(*other->runs);
  return runners_.emplace_back(Runner{wanted, std::move(made), values, merged ? other->batch : values});
}

long StudyScenes::separate_runs() const {
  long sum = separate_runs_;
  for (const Runner& one : runners_) sum += one.runs->separate_runs();
  return sum;
}

StudyScenes::Mixing StudyScenes::mixing() {
  const ensemble::CaseRunner& any = *runner(0).runs;
  const std::size_t width = any.width(), bridges = first_of_bridge_.size();
  if (!any.has_lanes() || width == 1) return Mixing::nothing;
  if (bridges > 1 && runs_.size() < width * bridges) return Mixing::vehicles_and_bridges;
  return bases() > bridges && runs_.size() < width * bases() ? Mixing::vehicles : Mixing::nothing;
}

std::vector<std::vector<std::size_t>> StudyScenes::groups(const std::vector<char>& excluded) {
  const Mixing mixing = this->mixing();
  const std::size_t width = runner(0).runs->width();
  // The part of the study whose runs may be in one batch. Each part with several runs of a bridge has few bridges, so
  // that their models are assembled once.
  const auto part = [&](const StudyRun& run) {
    if (mixing == Mixing::nothing) return run.base;
    if (mixing == Mixing::vehicles) return run.bridge;
    return runs_.size() > first_of_bridge_.size() ? run.bridge / width : 0;
  };
  // Blocks of `width` seeds are computed together: each track is generated once, and the tracks in use fit into memory.
  using Block = std::array<std::size_t, 3>;  // part, train, block of seeds
  std::map<Block, std::vector<std::size_t>> blocks;
  std::map<std::uint64_t, std::size_t> seeds;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (!excluded.empty() && excluded[i] != 0) continue;
    const StudyRun& run = runs_[i];
    const std::size_t seed = run.own.seed ? seeds.try_emplace(*run.own.seed, seeds.size()).first->second : 0;
    blocks[{part(run), run.train, seed / width}].push_back(i);
  }
  std::vector<std::vector<std::size_t>> groups;
  for (const auto& block : blocks) {
    std::vector<ensemble::CaseRun> own;
    for (const std::size_t i : block.second) own.push_back(runs_[i].own);
    for (std::vector<std::size_t>& group : ensemble::group_runs(own, width)) {
      for (std::size_t& i : group) i = block.second[i];
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

double StudyScenes::duration(const std::vector<std::size_t>& group) {
  double sum = 0.0;
  for (const std::size_t run : group) sum += runner(0).runs->duration(runs_[run].train, runs_[run].own.speed);
  return sum;
}

}  // namespace traverse::study
