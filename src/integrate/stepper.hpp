// Time integration of the combined system by PETSc TS: own types in second-order form (second_order.hpp), or PETSc's.
// PETSc's implicit types solve their stages through a SNESSHELL that hands (t, shift, c) to System::solve_stage; its
// explicit ones evaluate System::rate. Steps end exactly at stored
// samples and where wheels pass kinks of the running surface, since unaligned kinks pull every method down to
// order two.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "coupling/contact_event_locator.hpp"
#include "coupling/system.hpp"
#include "integrate/step_size_control.hpp"

namespace traverse::integrate {

struct Settings {
  double end_time = 0.0;           // s
  double time_step = 0.0;          // s, the longest
  double interval = 0.0;           // s between samples
  std::vector<double> events{};    // ascending times at which a step has to end
  double contact_tolerance = 0.0;  // s: how close behind the loss or gain of a contact steps end; 0: not located
  std::vector<double> passages{};  // ascending times at which a step has to end and a sample is due, not to be stored
  bool corners = false;            // steps end where wheels turn about corners of the bridge's surface
  long stored = 1;                 // one in so many of the samples at the interval is stored
  std::string type{};              // that accuracy chose; empty: as the options say
};

/// What an instant is for: one of the evenly spaced samples, a look at peaks between them, or the end of the run where
/// that is no multiple of the interval between samples.
enum class Purpose { sample, look, end };

/// An accepted instant of this rank: y, and w' of the structure.
struct Instant {
  double time;
  const double* y;
  const double* acceleration;
  const double* drag = nullptr;  // modal damping forces over the mass, m/s2, of this rank's beam; null: none
  Purpose purpose = Purpose::sample;
};

class Stepper {
 public:
  /// Collective. Reads PETSc's own options (-ts_type, ...). InputError for a type that does not work here; the
  /// start is written by System::start into state().
  Stepper(coupling::System& system, Settings settings);

  double* state();  // this rank's entries, before run()
  void restore_state(double** array);

  /// Collective. Gives the sample at t = 0, unless that was done: run() does so too.
  void begin(const std::function<void(const Instant&)>& sample);
  /// Collective. Runs to the end, from where an earlier call was stopped. `sample` is called at t = 0, at every
  /// multiple of the interval, at passages and at the end, `step` after every step; when it returns false the run stops
  /// early. Throws SolverError with what to change when a step cannot be taken. Returns the time reached. `between` is
  /// called before every step, when all that belongs to the steps so far has been called.
  double run(const std::function<void(const Instant&)>& sample, const std::function<bool(double, long)>& step,
             const std::function<void(double)>& between = {});

  /// Collective. The state between two steps, written or read back: then, after the start, run() goes on from there.
  void keep(base::Archive& archive);
  /// Why it cannot be written; empty: it can.
  std::string no_archive() const;

  long steps() const { return steps_; }
  long rejected() const;                                           // steps tried in vain
  bool stopped_at_limit() const { return steps_ >= most_steps_; }  // of -ts_max_steps
  std::string method() const;                                      // e.g. "ARKIMEX 4, implicit"
  /// Whether steps that are too long would go unnoticed: those of an implicit method with one length.
  bool hides_long_steps() const { return implicit_ && !adaptive_; }
  bool adaptive() const { return adaptive_; }      // steps by an error control
  bool high_order() const { return high_order_; }  // above 2

 private:
  struct Request {  // what TS asks of a stage
    double t = 0.0;
    double shift = 0.0;
    Vec unknown = nullptr;  // of the stage
    bool recording = false, start = false;
  };

  /// Where the loop over steps is.
  struct Way {
    double t = 0.0, target = 0.0, next_sample = 0.0;  // s
    long samples = 0;
    std::size_t event = 0, passage = 0;     // the next ones
    bool begun = false, under_way = false;  // to the target
    bool beyond = false;                    // the end is no multiple of the interval, and the next sample
  };

  void set_up_type();
  void set_target(double slack);
  double next_step(double from, double left) const;
  void show_to_monitors(double t);
  double take_step(double from, double left);
  double step_to(double from, double end);
  std::optional<coupling::KinkEvents::KinkPassage> next_kink(double from, double left);
  void arrive(double t);
  double step_again(double from, double end);
  double locate_contact_change(double from, double full);
  double end_at_kink(double from, double at, const coupling::KinkEvents::KinkPassage& turn);
  void sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose);
  void check_bounds(double t, const double* y) const;
  void rate(double t, Vec y, Vec ydot, coupling::Terms terms);
  bool remembered(double t, const double* y) const;
  void implicit_residual(double t, Vec y, Vec ydot, Vec residual);
  void solve_stage(SNES snes, Vec x);

  static PetscErrorCode ifunction(TS, PetscReal, Vec, Vec, Vec, void*);
  static PetscErrorCode ijacobian(TS, PetscReal, Vec, Vec, PetscReal, Mat, Mat, void*);
  static PetscErrorCode rhs_function(TS, PetscReal, Vec, Vec, void*);
  static PetscErrorCode shell_solve(SNES, Vec);

  coupling::System& system_;
  Settings settings_;
  base::Handle<TS> ts_;
  base::Handle<Vec> y_, rate_;
  base::Handle<Vec> before_, residual_;  // y at the start of the step, F; of PETSc's types alone
  base::Handle<Mat> jacobian_;
  Request request_;
  coupling::Terms implicit_terms_ = coupling::Terms::all;
  bool second_order_ = false, implicit_ = true, adaptive_ = false, multistep_ = false, high_order_ = false;
  bool monitored_ = false;                 // by -ts_monitor and its like
  std::optional<StepSizeControl> ladder_;  // of adaptive steps of an own type
  Way way_;
  double next_step_ = 0.0;  // what the step control wants
  double last_step_ = 0.0;
  long steps_ = 0;
  PetscInt most_steps_ = 0;
  std::vector<double> stage_c_;               // Xdot, then c
  std::vector<double> known_y_, known_rate_;  // the last solved stage and its rate
  double known_t_ = 0.0;
  bool known_ = false;
};

}  // namespace traverse::integrate
