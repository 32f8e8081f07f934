// Signals that ask the program to end. Before anything is stored they end it at once, whatever it computes; while
// results are being written they are only noted, and the run that writes them ends in order.
#pragma once

#include <mpi.h>

namespace traverse::app {

/// Those that are ignored (nohup) stay so. Called before libraries are set up: UCX takes SIGHUP while it is loaded.
void look_at_ignored_signals();
/// Takes over SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE and SIGXCPU, and SIGUSR1, which ends nothing: at the start, and
/// again after a library has set handlers of its own. SIGXFSZ is ignored: the file that may not grow says so.
void install_handlers();
/// A limit of the processor's time may kill without a word (ulimit -t): SIGXCPU comes a little before it.
void heed_cpu_limit();
/// Only one rank of several tells the user of a signal.
void speak_of_signals(bool speaks);

/// While one lives signals are noted for `caught_signal`, whose owner has to ask for it after every step.
class SignalsNoted {
 public:
  SignalsNoted();
  ~SignalsNoted();
  SignalsNoted(const SignalsNoted&) = delete;
  SignalsNoted& operator=(const SignalsNoted&) = delete;
};

/// The signal that asks the run to end, or 0.
int caught_signal();
/// Whether SIGUSR1 has asked for a checkpoint since the last call.
bool checkpoint_asked();
/// Collective. The signal of any rank of comm.
int signal_on_any(MPI_Comm comm);
/// Collective. The same, and whether any rank wants something else.
struct Asked {
  int signal = 0;
  bool wanted = false;
};
Asked asked_on_any(MPI_Comm comm, bool wanted);

}  // namespace traverse::app
