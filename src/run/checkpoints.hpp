// Writes checkpoints of a single run in time, at intervals of the clock and on signals.
#pragma once

#include <mpi.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "results/checkpoint_file.hpp"
#include "run/simulation.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Digest of all inputs that determine the results: the options, without the options for duration, file names and
/// display, and the files that the options name.
std::string digest_of(const scene::Scene& scene);

/// Collective. The checkpoint of the option `restart`; empty if it is not given. InputError if it belongs to another
/// scene, or if the kind of run has no checkpoints. Sets the scene's results file from the checkpoint if the command
/// line does not give one.
std::optional<results::Checkpoint> earlier_of(MPI_Comm comm, scene::Scene& scene);

/// Collective. Claims the place of the results and checks the place of the checkpoint, before any computation.
/// InputError or FileError if a file would be overwritten that is not the output of an earlier run.
results::Place claim_outputs(MPI_Comm comm, const scene::Scene& scene);

class Checkpoints {
 public:
  /// Simulation and recorder must outlive this object. state: all data that are in none of them.
  Checkpoints(MPI_Comm comm, const scene::Scene& scene, Simulation& simulation, results::Recorder& recorder,
              results::Checkpoint state);

  /// Whether this rank requires a checkpoint now. The clock is read at intervals only.
  bool wanted();
  /// Collective. FileError if it cannot be written. wall_seconds: duration of the time loop.
  void write(double time, double wall_seconds);
  /// False if the run has no file for checkpoints or cannot write its state.
  bool possible() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  /// The reason why checkpoints are not possible; empty if they are possible or not wanted.
  const std::string& trouble() const { return trouble_; }
  /// After a complete run: removes the checkpoint that the run has written or was restarted from.
  void forget();

 private:
  using Clock = std::chrono::steady_clock;

  MPI_Comm comm_;
  Simulation& simulation_;
  results::Recorder& recorder_;
  results::Checkpoint state_;
  std::string path_, trouble_;
  results::FileId own_file_;  // the file that the run has written or was restarted from
  double interval_;           // s; 0: only on a signal
  double cost_ = 0.0;         // s, duration of the last write
  Clock::time_point last_ = Clock::now();
  unsigned calls_ = 0;
};

}  // namespace traverse::run
