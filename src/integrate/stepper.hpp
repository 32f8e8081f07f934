// Time integration of the combined system by PETSc TS, with the program's own types in second-order form
// (second_order.hpp) or the types of PETSc. PETSc's implicit types solve their stages through a SNESSHELL that passes
// (t, shift, c) to System::solve_stage; its explicit ones evaluate System::rate. Steps end exactly at stored samples
// and where wheels pass kinks of the running surface: a kink inside a step reduces every method to order two.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "coupling/system.hpp"
#include "integrate/step_size_control.hpp"

namespace traverse::integrate {

struct Settings {
  double end_time = 0.0;           // s
  double time_step = 0.0;          // longest time step, s
  double interval = 0.0;           // s between samples
  std::vector<double> events{};    // ascending times at which a step has to end
  double contact_tolerance = 0.0;  // s, for the ends of steps at contact events; 0: events are not located
  /// Ascending times at which loads cross probes. Steps end there.
  std::vector<double> crossing_times{};
  bool kinks = false;  // steps end where wheels turn about kinks of the bridge's surface
  long stored = 1;     // one sample out of this number is stored
  std::string type{};  // chosen by accuracy; empty: from the options
};

/// The purpose of an instant: one of the equidistant samples, the end of a step between them, for peaks only, the end
/// of the run if that is not a multiple of the interval between samples, or the motion of the tip just before a guided
/// wheel leaves.
enum class Purpose { sample, peaks, end, exit };
inline bool is_stored(Purpose purpose) { return purpose == Purpose::sample || purpose == Purpose::end; }

/// An accepted instant of this rank: y, and w' of the structure; null: as the last step left it.
struct Instant {
  double time;
  const double* y;
  const double* acceleration;
  const double* drag = nullptr;  // modal damping forces over the mass, m/s2, of this rank's beam; null: none
  Purpose purpose = Purpose::sample;
};

class Stepper {
 public:
  /// Collective. Reads PETSc's own options (-ts_type, ...). InputError for a type that is not supported; System::start
  /// writes the initial state into state().
  Stepper(coupling::System& system, Settings settings);

  double* state();  // this rank's entries, before run()
  void restore_state(double** array);

  /// Collective. Samples t = 0 unless that is done; run() calls it too.
  void begin(const std::function<void(const Instant&)>& sample);
  /// Collective. Runs to the end, from the time at which an earlier call stopped. `sample` is called at t = 0 and
  /// after every step, also at every multiple of the interval and at the end; `step` before that after every step: if
  /// it returns false the run stops. Throws SolverError with advice if a step cannot be solved. Returns the final time.
  /// `between` is called before every step, after all calls for earlier steps.
  double run(const std::function<void(const Instant&)>& sample, const std::function<bool(double, long)>& step,
             const std::function<void(double)>& between = {});

  /// After the start, in place of run(): System::serve.
  void serve();

  /// Collective. Writes or reads the state between two steps; after start and reading, run() continues from that state.
  void keep(base::Archive& archive);
  /// The reason why the state cannot be written; empty: it can.
  std::string no_archive() const;

  /// Before the run: the steps until `end`, with lengths of at most `step` and samples every `interval`, s, as far as
  /// it is known where they end: impacts and rejected steps are not.
  StepCount count_steps(double end, double step, double interval);

  long steps() const { return steps_; }
  long rejected() const;                                           // rejected steps
  bool stopped_at_limit() const { return steps_ >= most_steps_; }  // limit -ts_max_steps
  std::string method() const;                                      // e.g. "ARKIMEX 4, implicit"
  /// Whether too long steps would have no visible sign. This is true for an implicit method with constant steps.
  bool hides_long_steps() const { return implicit_ && !adaptive_; }
  bool high_order() const { return high_order_; }  // order above 2

 private:
  struct Request {  // the data of a stage from TS
    double t = 0.0;
    double shift = 0.0;
    Vec unknown = nullptr;  // unknown of the stage
    bool recording = false, start = false;
  };

  /// The progress of the loop over steps.
  struct Progress {
    double t = 0.0, target = 0.0, next_sample = 0.0;  // s
    long samples = 0;
    std::size_t event = 0, crossing = 0;    // indices of the next event and crossing time
    bool begun = false, under_way = false;  // a step towards the target has been computed
    bool ends_between_samples = false;      // the next sample is at the end of the run, which is no multiple of
                                            // the interval
  };

  void set_up_type();
  void set_target(double slack);
  double next_step(double from, double remaining) const;
  void call_monitors(double t);
  double take_step(double from, double remaining);
  double step_to(double from, double end);
  std::optional<coupling::KinkEvents::KinkEvent> next_kink(double from, double remaining);
  void set_vehicles(double t);
  double step_again(double from, double end);
  double locate_contact_change(double from, double full);
  double end_at_kink(double from, double at, const coupling::KinkEvents::KinkEvent& kink_event);
  void sample_now(const std::function<void(const Instant&)>& sample, Purpose purpose);
  void check_bounds(double t, const double* y) const;
  void rate(double t, Vec y, Vec ydot);
  bool is_last_stage(double t, const double* y) const;
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
  base::Handle<Vec> before_, residual_;  // y at the start of the step, and the residual F; for PETSc's types only
  base::Handle<Mat> jacobian_;
  Request request_;
  bool second_order_ = false, implicit_ = true, adaptive_ = false, multistep_ = false, high_order_ = false;
  bool monitored_ = false;                       // monitors of -ts_monitor and similar options are active
  std::optional<StepSizeControl> step_control_;  // for adaptive steps of the program's own types
  Progress progress_;
  double next_step_ = 0.0;  // length selected by the step control
  double last_step_ = 0.0;
  long steps_ = 0;
  PetscInt most_steps_ = 0;
  std::vector<double> stage_c_;               // Xdot, then c
  std::vector<double> known_y_, known_rate_;  // last solved stage and its rate
  double known_t_ = 0.0;
  bool known_ = false;
};

}  // namespace traverse::integrate
