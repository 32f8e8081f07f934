// The scenes of the runs of a study or a sweep, which runs share a bridge and a train, and the objects that compute
// them.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/case_runner.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::study {

/// A run of a study.
struct StudyRun {
  std::size_t base = 0;    // index of its scene
  std::size_t train = 0;   // index of the force train in a sweep
  std::size_t bridge = 0;  // scenes with the same index differ in parameters of vehicles and moving forces only
  ensemble::CaseRun own;   // speed and track seed
};

/// A base is a scene of a study. Runs of one base differ in speed and track seed only; bases differ in other options.
class StudyScenes {
 public:
  /// The scene of a run with these values of the varied options, as texts.
  using Read = std::function<scene::Scene(const std::vector<std::pair<std::string, std::string>>& values)>;
  /// The scene must have a study or a sweep and must outlive this object. read: empty: read_scene_of_study. Throws
  /// InputError if speeds contradict each other.
  explicit StudyScenes(const scene::Scene& scene, Read read = {});
  /// Replaces the study by one with more speeds between its slowest and its fastest, or with other values.
  void enumerate(const options::Study& study);

  const options::Study& study() const { return study_; }
  bool quiet() const { return scene_.quiet; }
  const std::vector<StudyRun>& runs() const { return runs_; }
  std::size_t bases() const { return first_run_.size(); }
  /// A base as the user describes it, with all speeds of the study in its sweep.
  scene::Scene base(std::size_t base) const;
  /// The base of the first run, and the bases with the least and the greatest value of each option.
  std::vector<std::size_t> extreme_bases() const;
  /// The bases that may need the finest model: the extreme ones, or the first one if all differ little from it.
  std::vector<std::size_t> bases_of_model() const;

  /// Sets the model chosen for the study, for mesh, step, modes and others that a base leaves open.
  void choose(const scene::NumericalModel& chosen) { chosen_ = chosen; }
  /// The object that computes the runs of a base.
  struct Runner {
    std::size_t base = 0;
    std::shared_ptr<ensemble::CaseRunner> runs;
    std::vector<double> values;  // of its base
    std::vector<double> batch;   // values of the base with which it was merged; its own values if with none
  };
  /// The last used runners are stored. With `notes`, which get the description of the model, its runs are checked.
  Runner runner(std::size_t base, std::vector<std::string>* notes = nullptr);
  /// Whether runs of two bases can be computed in one batch.
  static bool compatible(const Runner& a, const Runner& b) { return a.batch == b.batch; }

  /// Whether only the greatest results of all runs of a sensitivity analysis' point are needed, and are found without
  /// all of these runs.
  bool only_greatest() { return study_.sensitivity && runner(0).runs->has_bounds(); }

  /// What the runs of a batch may differ in, besides speed and track.
  enum class Mixing { nothing, vehicles, vehicles_and_bridges };
  /// Runs are mixed only if there are too few of one bridge, or of one base, to fill batches.
  Mixing mixing();
  /// Indices of the runs of each batch. Runs with a nonzero flag in `excluded` (one flag for each run; empty: none) are
  /// in no group.
  std::vector<std::vector<std::size_t>> groups(const std::vector<char>& excluded = {});
  /// Simulated time of all runs of a group, s, by the first base.
  double duration(const std::vector<std::size_t>& group);
  long separate_runs() const;  // on this rank, runs computed outside their batch

 private:
  const scene::Scene& scene_;
  Read read_;
  options::Study study_;
  std::optional<scene::NumericalModel> chosen_;
  std::vector<double> speeds_;        // speeds of all runs, ascending, m/s
  std::vector<std::uint64_t> seeds_;  // seeds of random tracks
  std::vector<StudyRun> runs_;
  std::vector<std::size_t> first_run_;  // the first run of each base
  /// The values that define each base. The numbers of bases change when values are added.
  std::vector<std::vector<double>> values_of_bases_;
  /// The first base, with which all others are compared, then those used last.
  std::deque<Runner> runners_;
  std::vector<std::size_t> first_of_bridge_;  // the first base of each bridge
  long separate_runs_ = 0;                    // separate runs of deleted runners
};

}  // namespace traverse::study
