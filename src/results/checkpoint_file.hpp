// The file that a run goes on from. It is written aside and takes the place of the one before at once, so that there is
// a complete one at any time.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <string>
#include <vector>

#include "results/recorder.hpp"

namespace traverse::results {

/// What a run is repeated with.
struct Repeated {
  bool with_mechanisms = false;  // after linear vehicles would not do
};

struct Checkpoint {
  std::string version;                                     // of the program
  std::string digest;                                      // of the scene
  double time = 0.0;                                       // s
  double end_time = 0.0, time_step = 0.0, interval = 0.0;  // of the run's plan, s
  long stored = 1;                                         // the same
  double wall_seconds = 0.0;                               // of the time loop so far
  int given_ranks = 1;                                     // of which those that wrote took the steps
  Repeated repeated;
  Recorder::Earlier results;
  std::vector<std::string> of_ranks;  // state, base::Archive's

  template <class Bytes>
  void keep(Bytes& bytes) {
    bytes(version, digest, time, end_time, time_step, interval, stored, wall_seconds, given_ranks,
          repeated.with_mechanisms, results.file, results.rows, results.objects, results.digests);
  }
};

/// Collective. own: this rank's state. FileError on the first rank, which writes, where it cannot be written; what was
/// there before then stays.
void write_checkpoint(MPI_Comm comm, const std::string& path, Checkpoint checkpoint, const std::string& own);
/// Collective. The same on all ranks. FileError where the file is none, damaged, or of another version of the program.
Checkpoint read_checkpoint(MPI_Comm comm, const std::string& path);
/// Removes it, if it is there and a checkpoint. Rank 0 alone does something.
void remove_checkpoint(MPI_Comm comm, const std::string& path);

/// Whether it is an ordinary file that begins as checkpoints do.
bool is_checkpoint(const std::string& path);
/// The name that a checkpoint has until it is complete.
std::string aside_of_checkpoint(const std::string& path);
/// FileError where a checkpoint could not be written: no folder, none that may be written to, something else there.
void check_checkpoint_place(const std::string& path);

}  // namespace traverse::results
