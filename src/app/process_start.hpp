// The start of the program: settings of MPI before its initialisation, with which a single process starts fast, one
// thread of BLAS, and standard output whose failure (a full disk, a reader that has ended) does not affect the run and
// its results.
#pragma once

namespace traverse::app {

/// The number of this process among those of its launcher, which the launcher tells in the environment: Open MPI's
/// mpirun, or another one that speaks PMIx, as Slurm's srun. Null: started without a launcher, as a single process.
const char* rank_of_launcher();

/// Call before MPI_Init. Sets the variables that are not set in the environment.
void start_lightly();

/// During its life OpenBLAS, where it is the library for BLAS, uses one thread: its results depend on the number of
/// threads, which differs between a process alone and the ranks of mpirun, and its matrices are small here.
class OneThreadOfBlas {
 public:
  OneThreadOfBlas();
  ~OneThreadOfBlas();
  OneThreadOfBlas(const OneThreadOfBlas&) = delete;
  OneThreadOfBlas& operator=(const OneThreadOfBlas&) = delete;

 private:
  int before_ = 0;  // threads; 0: another library
};

/// Call after MPI_Init. Removes the variable that would prevent this process from starting mpirun.
void started();

/// Call before anything is written or opened. From then on writing to stdout always succeeds, and the first error is
/// stored. Closed standard streams are opened as /dev/null, so that no file of the program gets their numbers.
void guard_standard_output();

/// Writes the buffered output. Returns the errno of the first failed write; 0 if no output was lost.
int lost_output();

}  // namespace traverse::app
