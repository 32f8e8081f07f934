// The current stage of the program, printed for a waiting user at least once a minute.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace traverse::results {

/// A stage that may take long. Stages may be nested; the outermost and the innermost one are printed.
class Stage {
 public:
  /// `name`: a literal such as "trial runs".
  explicit Stage(const char* name);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Sets the completed part of the innermost stage, from 0 to 1. It costs one store.
  static void advance(double part);
  /// The outermost stage. A signal handler may call it.
  static const char* now();

 private:
  const char* outer_;
};

/// During its life a thread prints the stage whenever nothing was printed for some time: on a terminal in one line that
/// is rewritten, otherwise in lines at increasing intervals, at least once a minute.
class Heartbeat {
 public:
  /// `first`: s until the first line.
  explicit Heartbeat(bool quiet, double first = 5.0);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  /// Reports that something else has been printed.
  static void shown();
  static long lines();  // lines printed by all heartbeats
  /// Keeps the threads of all heartbeats asleep. A process that is forked meanwhile inherits no lock that they hold,
  /// such as one of the allocator.
  static std::unique_lock<std::mutex> asleep();

 private:
  void print_progress();

  double first_;
  bool terminal_;
  bool started_ = false, ending_ = false;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace traverse::results
