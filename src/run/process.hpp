// Functions that single runs and studies share: the attributes of the file, messages, the exit after a failure, and
// signals that end the program. Before results are written they end it at once; while results are being written they
// are deferred, and the run ends in order.
#pragma once

#include <mpi.h>

#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/base/error.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const scene::Scene& scene);
/// Rank 0 of comm prints the description of the model, without unusual input, which is printed before.
void print_notes(MPI_Comm comm, const scene::Scene& scene, const std::vector<std::string>& notes);
/// Prints one line on standard error, if possible.
void print_error(const Error& error);
/// Ends all ranks if a file cannot be written. Only the writing rank detects this, and the others would wait for it.
[[noreturn]] void leave_together(MPI_Comm comm, const Error& error);

/// Converts any failure to an error with a message and an exit status; for lack of memory the message lists how to
/// reduce the scene.
Error as_error(const std::exception& failure);

/// Stores which signals are ignored (nohup); they remain ignored. Called before libraries are initialised, because UCX
/// handles SIGHUP while it is loaded.
void store_ignored_signals();
/// Installs handlers for SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU and SIGUSR1, which does not end the run: at
/// the start, and again after a library has set its own handlers. SIGXFSZ is ignored, because the failed write is
/// reported.
void install_handlers();
/// Raises SIGXCPU shortly before the limit of processor time (ulimit -t), at which the process may be killed.
void set_cpu_limit_timer();
/// Sets whether this rank prints a message on a signal; only one of several ranks does.
void print_signals(bool prints);

/// Signals are deferred while an object of this class exists; its owner must call `caught_signal` after every step.
class DeferredSignals {
 public:
  DeferredSignals();
  ~DeferredSignals();
  DeferredSignals(const DeferredSignals&) = delete;
  DeferredSignals& operator=(const DeferredSignals&) = delete;
};

/// The deferred signal, or 0.
int caught_signal();

/// For programs that have their own signals: as long as the object exists, `caught_signal` asks `go_on` in this thread,
/// at most twenty times a second, and is SIGINT once that has returned false.
class StopRequest {
 public:
  explicit StopRequest(std::function<bool()> go_on);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
};
/// Whether SIGUSR1 has requested a checkpoint since the last call.
bool checkpoint_requested();
/// Collective. The signal of any rank of comm.
int signal_on_any(MPI_Comm comm);
/// Collective. The signal of any rank, and whether `wanted` is true on any rank.
struct Requests {
  int signal = 0;
  bool wanted = false;
};
Requests requests_on_any(MPI_Comm comm, bool wanted);

}  // namespace traverse::run
