// Keeps the names of the current stages in atomic variables, from which a background thread prints progress at growing
// intervals.
#include "results/stage.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>

namespace traverse::results {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* idle = "set-up";                    // outside of all stages, where nothing takes long
constexpr double rarest = 50.0;                           // s between lines
constexpr double share = 0.2;                             // of the time so far, from line to line
constexpr double silent_start = 2.0, redraw_every = 1.0;  // s, on a terminal

std::atomic<const char*> outermost{idle}, innermost{idle};
std::atomic<double> done{0.0};
std::atomic<long> told{0};
std::atomic<Clock::rep> begun{0}, last_shown{0};

Clock::rep ticks() { return Clock::now().time_since_epoch().count(); }

double since(Clock::rep then) { return std::chrono::duration<double>(Clock::duration(ticks() - then)).count(); }

std::string text_of(double seconds) {
  const double part = done;
  const std::string outer = outermost.load(), inner = innermost.load();
  const std::string what = inner == outer ? inner : outer + ", " + inner;
  const std::string how_long =
      seconds < 120.0 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60.0);
  return part > 0.0 ? fmt::format("{}: {:.0f} %, {} so far", what, 100.0 * std::min(part, 1.0), how_long)
                    : fmt::format("{}, {} so far", what, how_long);
}

}  // namespace

Stage::Stage(const char* what) : outer_(innermost) {
  if (outer_ == idle) {
    begun = last_shown = ticks();
    outermost = what;
  }
  done = 0.0;
  innermost = what;
}

Stage::~Stage() {
  innermost = outer_;
  if (outer_ == idle) outermost = idle;
  done = 0.0;
}

void Stage::advance(double part) { done.store(part, std::memory_order_relaxed); }

const char* Stage::now() { return outermost; }

Heartbeat::Heartbeat(bool quiet, double first) : first_(first), terminal_(isatty(STDOUT_FILENO) == 1) {
  if (quiet) return;
  // Signals are for the main thread, but SIGPIPE, which comes to whoever writes.
  sigset_t all, before;
  sigfillset(&all);
  sigdelset(&all, SIGPIPE);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { beat(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Heartbeat::~Heartbeat() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void Heartbeat::shown() { last_shown = ticks(); }

long Heartbeat::lines() { return told; }

void Heartbeat::beat() {
  bool drawn = false;  // a line on the terminal that is to be rewritten
  std::unique_lock lock(mutex_);
  const auto look_every = std::chrono::duration<double>(0.1 * std::min(first_, 2.0));
  while (!wake_.wait_for(lock, look_every, [this] { return ending_; })) {
    const double so_far = since(begun);
    const double every = terminal_ ? (drawn ? redraw_every : silent_start) : std::clamp(share * so_far, first_, rarest);
    const bool resting = outermost.load() == idle;
    if (drawn && resting) fmt::print("\r\033[K");
    if (resting) drawn = false;
    if (resting || since(last_shown) < every) continue;
    fmt::print("{}{}{}", terminal_ ? "\r" : "", text_of(so_far), terminal_ ? "\033[K" : "\n");
    std::fflush(stdout);
    drawn = terminal_;
    shown();
    ++told;
  }
  if (drawn) fmt::print("\r\033[K");
}

}  // namespace traverse::results
