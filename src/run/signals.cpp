#include "run/signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

#include "results/place.hpp"
#include "results/stage.hpp"

namespace traverse::app {
namespace {

struct Taken {
  int number;
  const char* name;
  bool ignored;  // when the program started
};

std::array<Taken, 5> signals = {{{SIGINT, "2", false},
                                 {SIGTERM, "15", false},
                                 {SIGHUP, "1", false},
                                 {SIGQUIT, "3", false},
                                 {SIGPIPE, "13", false}}};

std::atomic<int> caught{0}, noting{0};
std::atomic<bool> speaking{true};

/// Only what a signal handler may call.
[[noreturn]] void end_at_once(int number) {
  const auto say = [](const char* text) { (void)!write(STDERR_FILENO, text, std::strlen(text)); };
  for (const Taken& taken : signals) {
    if (taken.number != number || number == SIGPIPE || !speaking) continue;  // SIGPIPE: nobody reads any more
    say("traverse: ended by signal ");
    say(taken.name);
    say(" during ");
    say(results::Stage::now());
    say("\n");
  }
  results::remove_made_place();
  _exit(128 + number);
}

void take(int number) {
  if (noting == 0) end_at_once(number);
  caught = number;
}

}  // namespace

void look_at_ignored_signals() {
  for (Taken& taken : signals) {
    struct sigaction action = {};
    if (sigaction(taken.number, nullptr, &action) == 0) taken.ignored = action.sa_handler == SIG_IGN;
  }
}

void take_signals() {
  for (const Taken& taken : signals) {
    struct sigaction action = {};
    action.sa_handler = taken.ignored ? SIG_IGN : take;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(taken.number, &action, nullptr);
  }
}

void speak_of_signals(bool speaks) { speaking = speaks; }

SignalsNoted::SignalsNoted() { ++noting; }

SignalsNoted::~SignalsNoted() { --noting; }

int caught_signal() { return caught; }

int signal_on_any(MPI_Comm comm) {
  int ranks = 1, signal = caught_signal();
  MPI_Comm_size(comm, &ranks);
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, &signal, 1, MPI_INT, MPI_MAX, comm);
  return signal;
}

}  // namespace traverse::app
