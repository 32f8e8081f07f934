// Stores the names of the current stages in atomic variables, from which a background thread prints progress at
// increasing intervals.
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

constexpr const char* idle = "set-up";                    // name outside of all stages, which are short
constexpr double longest_interval = 50.0;                 // s, longest interval between lines
constexpr double share = 0.2;                             // interval between lines, relative to the time so far
constexpr double silent_start = 2.0, redraw_every = 1.0;  // s, on a terminal

std::mutex awake;  // held by the thread of a heartbeat unless it sleeps
std::atomic<const char*> outermost{idle}, innermost{idle};
std::atomic<double> done{0.0};
std::atomic<long> line_count{0};
std::atomic<Clock::rep> start_time{0}, last_shown{0};

Clock::rep ticks() { return Clock::now().time_since_epoch().count(); }

double since(Clock::rep then) { return std::chrono::duration<double>(Clock::duration(ticks() - then)).count(); }

std::string text_of(double seconds) {
  const double part = done;
  const std::string outer = outermost.load(), inner = innermost.load();
  const std::string stage = inner == outer ? inner : outer + ", " + inner;
  const std::string duration =
      seconds < 120.0 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60.0);
  return part > 0.0 ? fmt::format("{}: {:.0f} %, {} so far", stage, 100.0 * std::min(part, 1.0), duration)
                    : fmt::format("{}, {} so far", stage, duration);
}

}  // namespace

Stage::Stage(const char* name) : outer_(innermost) {
  if (outer_ == idle) {
    start_time = last_shown = ticks();
    outermost = name;
  }
  done = 0.0;
  innermost = name;
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
  // Signals are handled by the main thread, except for SIGPIPE, which the writing thread receives.
  sigset_t all, before;
  sigfillset(&all);
  sigdelset(&all, SIGPIPE);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { print_progress(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  std::unique_lock lock(awake);
  wake_.wait(lock, [this] { return started_; });
}

Heartbeat::~Heartbeat() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(awake);
    ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void Heartbeat::shown() { last_shown = ticks(); }

long Heartbeat::lines() { return line_count; }

std::unique_lock<std::mutex> Heartbeat::asleep() { return std::unique_lock(awake); }

void Heartbeat::print_progress() {
  bool drawn = false;  // a line on the terminal must be rewritten
  std::unique_lock lock(awake);
  started_ = true;
  wake_.notify_one();
  const auto check_interval = std::chrono::duration<double>(0.1 * std::min(first_, 2.0));
  while (!wake_.wait_for(lock, check_interval, [this] { return ending_; })) {
    const double elapsed = since(start_time);
    const double interval =
        terminal_ ? (drawn ? redraw_every : silent_start) : std::clamp(share * elapsed, first_, longest_interval);
    const bool is_idle = outermost.load() == idle;
    if (drawn && is_idle) fmt::print("\r\033[K");
    if (is_idle) drawn = false;
    if (is_idle || since(last_shown) < interval) continue;
    fmt::print("{}{}{}", terminal_ ? "\r" : "", text_of(elapsed), terminal_ ? "\033[K" : "\n");
    std::fflush(stdout);
    drawn = terminal_;
    shown();
    ++line_count;
  }
  if (drawn) fmt::print("\r\033[K");
}

}  // namespace traverse::results
