// When a single run in time writes what it could go on from: by the clock, and where signals ask for it.
#pragma once

#include <mpi.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "results/checkpoint_file.hpp"
#include "run/passage.hpp"
#include "run/run_observer.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Of all that results follow from: the options, but for those that only say how long a run goes on, where its files
/// are and what is shown, and the files that they name.
std::string digest_of(const Scene& scene);

/// Collective. The checkpoint that the option `restart` names; none where it is not given. InputError where it is of
/// another scene, or of a kind of run that has no checkpoints. The scene takes its results file from it where the
/// command line names none.
std::optional<results::Checkpoint> earlier_of(MPI_Comm comm, Scene& scene);

/// Collective. The place of the results, and a look at that of the checkpoints: InputError or FileError where a file
/// would be written over that is no output of a run before, before anything is computed.
results::Place claim_outputs(MPI_Comm comm, const Scene& scene);

class Checkpoints {
 public:
  /// Those of a run whose parts must outlive it. `so_far`: all that follows from neither.
  Checkpoints(MPI_Comm comm, const Scene& scene, Passage& passage, RunObserver& watch, results::Recorder& recorder,
              results::Checkpoint so_far);

  /// Whether one is wanted now, as this rank sees it. It costs no more than a look at the clock now and then.
  bool wanted();
  /// Collective. FileError where it cannot be written. wall_seconds: of the time loop.
  void write(double time, double wall_seconds);
  /// Whether there are any: not where this run has no file for them or cannot write its state.
  bool possible() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  /// Why there are none, where it is not that nobody wants them; empty: there are.
  const std::string& trouble() const { return trouble_; }
  /// The run has ended by itself: it needs none any more, of those that it has written or gone on from.
  void forget();

 private:
  using Clock = std::chrono::steady_clock;

  MPI_Comm comm_;
  Passage& passage_;
  RunObserver& watch_;
  results::Recorder& recorder_;
  results::Checkpoint so_far_;
  std::string path_, trouble_;
  results::FileId own_;  // the file that the run has written or goes on from
  double interval_;      // s; 0: only where a signal asks
  double cost_ = 0.0;    // s, of the last one
  Clock::time_point last_ = Clock::now();
  unsigned looks_ = 0;
};

}  // namespace traverse::app
