// The file from which a run can be restarted. It is written under a temporary name and then replaces the former one
// atomically, so that a complete checkpoint exists at any time.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <string>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

/// The reason why a run is repeated.
struct Repeated {
  bool with_mechanisms = false;  // linear vehicles were not accurate enough
  int elements = 0;              // mesh and step, s, if the chosen ones were not accurate enough
  double step = 0.0;
};

struct Checkpoint {
  std::string version;                                     // version of the program
  std::string digest;                                      // digest of the scene
  double time = 0.0;                                       // s
  double end_time = 0.0, time_step = 0.0, interval = 0.0;  // values of the run's plan, s
  long stored = 1;                                         // value of the run's plan
  double wall_seconds = 0.0;                               // duration of the time loop so far
  int given_ranks = 1;  // number of ranks of the run; the ranks in of_ranks computed the steps
  Repeated repeated;
  Recorder::Earlier results;
  std::vector<std::string> of_ranks;  // state of each rank, from base::Archive

  template <class Bytes>
  void keep(Bytes& bytes) {
    bytes(version, digest, time, end_time, time_step, interval, stored, wall_seconds, given_ranks,
          repeated.with_mechanisms, repeated.elements, repeated.step, results.file, results.rows, results.objects,
          results.digests);
  }
};

/// Collective. state: state of this rank. Throws FileError on the first rank, which writes, if the checkpoint cannot be
/// written; then the former checkpoint remains.
void write_checkpoint(MPI_Comm comm, const std::string& path, Checkpoint checkpoint, const std::string& state);
/// Collective. Returns the checkpoint on all ranks. FileError if the file is no checkpoint, damaged, or of another
/// version of the program.
Checkpoint read_checkpoint(MPI_Comm comm, const std::string& path);
/// Removes the file if it exists and is a checkpoint. Only rank 0 acts.
void remove_checkpoint(MPI_Comm comm, const std::string& path);

/// Whether the path is an ordinary file with the signature of checkpoints.
bool is_checkpoint(const std::string& path);
/// The name of a checkpoint until it is complete.
std::string temporary_checkpoint(const std::string& path);
/// FileError if a checkpoint could not be written: no folder, no permission, or another file at this path.
void check_checkpoint_place(const std::string& path);

}  // namespace traverse::results
