// File attributes with versions and ranks, the exit of all MPI ranks after a failed write, the conversion of C++
// exceptions to error messages with an exit status, POSIX signal handlers that end the process or set a flag, and a
// timer that raises SIGXCPU shortly before the limit on processor time.
#include "run/process.hpp"

#include <fmt/format.h>
#include <petscversion.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <thread>

#include "base/notes.hpp"
#include "results/place.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "traverse/base/version.hpp"

namespace traverse::run {
namespace {

struct HandledSignal {
  int number;
  const char* name;
  bool ignored;  // at the start of the program
};

std::array<HandledSignal, 7> signals = {{{SIGINT, "2", false},
                                         {SIGTERM, "15", false},
                                         {SIGHUP, "1", false},
                                         {SIGQUIT, "3", false},
                                         {SIGPIPE, "13", false},
                                         {SIGXCPU, "24", false},
                                         {SIGUSR1, "10", false}}};

std::atomic<int> caught{0}, deferring{0};
/// What a StopRequest asks.
struct Asked {
  std::function<bool()> go_on;
  std::thread::id thread;
  std::chrono::steady_clock::time_point last;
};
Asked asked;
std::atomic<bool> printing{true}, checkpoint_flag{false};

/// Calls async-signal-safe functions only.
[[noreturn]] void end_at_once(int number) {
  const auto print = [](const char* text) { (void)!write(STDERR_FILENO, text, std::strlen(text)); };
  for (const HandledSignal& signal : signals) {
    if (signal.number != number || number == SIGPIPE || !printing) continue;  // SIGPIPE: the output has no reader
    print("traverse: ended by signal ");
    print(signal.name);
    print(" during ");
    print(results::Stage::now());
    print("\n");
  }
  results::remove_made_place();
  _exit(128 + number);
}

void handle(int number) {
  if (number == SIGUSR1) {
    checkpoint_flag = true;
    return;
  }
  const bool again = number == SIGXCPU && caught == number;  // the next SIGXCPU would kill
  if (deferring == 0 || again) end_at_once(number);
  caught = number;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> attributes(MPI_Comm comm, const scene::Scene& scene) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  return {{"program", "traverse"},
          {"version", version()},
          {"petsc_version", fmt::format("{}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR)},
          {"ranks", std::to_string(ranks)},
          {"scene", scene.name}};
}

void print_notes(MPI_Comm comm, const scene::Scene& scene, const std::vector<std::string>& notes) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank != 0) return;
  const auto said_before = [&](const std::string& note) {
    return std::find(scene.unusual.begin(), scene.unusual.end(), note) != scene.unusual.end();
  };
  std::vector<std::string> lines;
  for (const std::string& note : notes)
    if ((scene.verbose || !base::is_detail(note)) && !said_before(note)) lines.push_back(base::text_of_note(note));
  results::print_modelled(lines);
}

void print_error(const Error& error) { (void)std::fputs(fmt::format("traverse: {}\n", error.what()).c_str(), stderr); }

void leave_together(MPI_Comm comm, const Error& error) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  print_error(error);
  if (ranks > 1) MPI_Abort(comm, error.status());
  std::fflush(nullptr);
  std::_Exit(error.status());  // HDF5 may crash when it closes a file that it could not write
}

Error as_error(const std::exception& failure) {
  if (const auto* error = dynamic_cast<const Error*>(&failure)) return *error;
  const bool memory = dynamic_cast<const std::bad_alloc*>(&failure) != nullptr ||
                      dynamic_cast<const std::length_error*>(&failure) != nullptr;
  if (memory)
    return {
        "there is not enough memory for this scene; make it smaller: fewer elements (beam_elements_per_span, "
        "track_elements_per_bay, track_approach), probes (output_probes), vehicles, forces, modes (modes_count, "
        "model_modes) or runs of a sweep",
        5};
  return {std::string("internal error, please report it with the file that traverse fault makes: ") + failure.what(),
          70};
}

void store_ignored_signals() {
  for (HandledSignal& signal : signals) {
    struct sigaction action = {};
    if (sigaction(signal.number, nullptr, &action) == 0) signal.ignored = action.sa_handler == SIG_IGN;
  }
}

void install_handlers() {
  for (const HandledSignal& signal : signals) {
    struct sigaction action = {};
    action.sa_handler = signal.ignored ? SIG_IGN : handle;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal.number, &action, nullptr);
  }
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &ignore, nullptr);
}

void set_cpu_limit_timer() {
  struct rlimit limit = {};
  if (getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const auto seconds = static_cast<double>(limit.rlim_cur), before = seconds - std::min(1.0, 0.3 * seconds);
  struct sigevent event = {};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGXCPU;
  timer_t timer = {};
  if (timer_create(CLOCK_PROCESS_CPUTIME_ID, &event, &timer) != 0) return;
  struct itimerspec at = {};
  at.it_value.tv_sec = static_cast<time_t>(before);
  at.it_value.tv_nsec = 1 + static_cast<long>(1e9 * (before - std::floor(before)));
  timer_settime(timer, TIMER_ABSTIME, &at, nullptr);
}

void print_signals(bool prints) { printing = prints; }

DeferredSignals::DeferredSignals() { ++deferring; }

DeferredSignals::~DeferredSignals() { --deferring; }

StopRequest::StopRequest(std::function<bool()> go_on) { asked = {std::move(go_on), std::this_thread::get_id(), {}}; }

StopRequest::~StopRequest() {
  asked = {};
  caught = 0;
}

int caught_signal() {
  if (asked.go_on && caught == 0 && std::this_thread::get_id() == asked.thread) {
    const auto now = std::chrono::steady_clock::now();
    if (now - asked.last > std::chrono::milliseconds(50)) {
      asked.last = now;
      if (!asked.go_on()) caught = SIGINT;
    }
  }
  return caught;
}

bool checkpoint_requested() { return checkpoint_flag.exchange(false); }

int signal_on_any(MPI_Comm comm) { return requests_on_any(comm, false).signal; }

Requests requests_on_any(MPI_Comm comm, bool wanted) {
  int ranks = 1, both[2] = {caught_signal(), wanted ? 1 : 0};
  MPI_Comm_size(comm, &ranks);
  if (ranks > 1) MPI_Allreduce(MPI_IN_PLACE, both, 2, MPI_INT, MPI_MAX, comm);
  return {both[0], both[1] != 0};
}

}  // namespace traverse::run
