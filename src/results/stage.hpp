// What the program is doing, shown to a user who waits: at least one line a minute.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace traverse::results {

/// Something that may take long. Stages lie within one another; the outermost and the innermost one are told.
class Stage {
 public:
  /// `what`: a literal such as "trial runs".
  explicit Stage(const char* what);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// How much of the innermost stage is done, from 0 to 1. It costs no more than a store.
  static void advance(double part);
  /// The outermost stage. A signal handler may ask for it.
  static const char* now();

 private:
  const char* outer_;
};

/// While it lives, a thread of its own tells the stage whenever nothing was shown for some time: on a terminal in one
/// line that is rewritten, otherwise line by line and ever more rarely, but at least once a minute.
class Heartbeat {
 public:
  /// `first`: s until the first line.
  explicit Heartbeat(bool quiet, double first = 5.0);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  /// Something else has just been shown.
  static void shown();
  static long lines();  // told so far, by all heartbeats

 private:
  void beat();

  double first_;
  bool terminal_;
  bool ending_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace traverse::results
