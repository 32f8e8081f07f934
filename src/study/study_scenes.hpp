// The scenes behind the runs of a study or a sweep: which runs share a bridge and a train, and what computes them.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "ensemble/case_runner.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// A run of a study.
struct StudyRun {
  std::size_t base = 0;    // the scene that it is a run of
  std::size_t train = 0;   // of forces, of a sweep
  std::size_t bridge = 0;  // scenes with the same one differ in their vehicles' numbers alone
  CaseRun own;             // its speed and the seed of its track
};

/// Runs that differ in speed and in the track's seed alone are runs of one scene, a base; bases differ in all else.
class StudyScenes {
 public:
  /// Of a scene with a study or a sweep, which must outlive it. InputError where speeds contradict one another.
  explicit StudyScenes(const Scene& scene);
  /// The same with more speeds between its slowest and its fastest.
  void enumerate(const Study& study);

  const Study& study() const { return study_; }
  bool quiet() const { return scene_.quiet; }
  const std::vector<StudyRun>& runs() const { return runs_; }
  std::size_t bases() const { return first_run_.size(); }
  /// A base as the user describes it, with all speeds of the study in its sweep.
  Scene base(std::size_t base) const;
  /// The bases whose model may have to be the finest: of the first run, and of the least and the greatest values.
  std::vector<std::size_t> extreme_bases() const;

  /// What was chosen for the study: mesh, step, modes and so on, as far as a base leaves them open.
  void choose(const NumericalModel& chosen) { chosen_ = chosen; }
  /// Ready to compute the runs of a base.
  struct Runner {
    std::size_t base = 0;
    bool joined = false;  // its runs go beside those of all other joined ones on its bridge
    std::shared_ptr<CaseRunner> runs;
  };
  /// The bases used last are kept.
  Runner runner(std::size_t base, std::vector<std::string>* notes = nullptr);
  /// Whether runs of two bases go side by side.
  bool beside(const Runner& a, const Runner& b) const;

  /// Whether runs of vehicles with different numbers go beside each other.
  bool mixes(std::size_t width) const;
  /// Indices of runs that go together, those of a bridge one after another.
  /// Those in `left_out` (one flag a run; empty: none) are in no group.
  std::vector<std::vector<std::size_t>> groups(std::size_t width, const std::vector<char>& left_out = {}) const;
  /// s of motion, of all runs of a group, by the first base.
  double duration(const std::vector<std::size_t>& group);
  long alone() const;  // runs that had to leave their group, on this rank

 private:
  const Scene& scene_;
  Study study_;
  std::optional<NumericalModel> chosen_;
  std::vector<double> speeds_;        // of all runs, ascending
  std::vector<std::uint64_t> seeds_;  // of some tracks
  std::vector<StudyRun> runs_;
  std::vector<std::size_t> first_run_;  // of each base
  /// The first base, which all are compared with, then those used last.
  std::deque<Runner> runners_;
  std::vector<std::size_t> first_of_bridge_;  // the first base of each bridge
  long alone_ = 0;                            // of runners that are gone
};

}  // namespace traverse::app
