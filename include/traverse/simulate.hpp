// Runs in a program: problems in, results out, without a file, a terminal or another process.
//
//   traverse::Session session;
//   traverse::Problem problem({{"beam_spans", {32, 40, 32}}, {"beam_EI", 5.9e10}, {"beam_mass", 1.2e4},
//                              {"load_forces", 2e5}, {"load_speed", 83.3}});
//   const traverse::Result result = traverse::simulate(problem);
//   std::printf("%.3f mm\n", 1e3 * result.largest(&traverse::ProbeResult::deflection).value);
//
// examples/ has programs that observe and control a run, define laws of their own, and sweep a thousand problems.
#pragma once

#include <mpi.h>

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "traverse/base/error.hpp"
#include "traverse/problem.hpp"

namespace traverse {

/// Starts MPI, PETSc and SLEPc if they are not started yet, and ends those that it has started, once in a process.
/// Signals remain those of the program. Runs need one during their time, and all calls are made in one thread.
class Session {
 public:
  /// petsc_words: options of PETSc's own, such as {"-log_view"}.
  explicit Session(const std::vector<std::string>& petsc_words = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  bool starts_;
};

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The greatest magnitude of a quantity in a run, with its time (s).
struct Extreme {
  double value = unknown, time = unknown;
};

/// The results at a station of output_probes; by default these are the midspans.
struct ProbeResult {
  double x = unknown;                        // m
  Extreme deflection, acceleration, moment;  // m, m/s2, N m
  double static_deflection = unknown;        // m, the largest one while the same loads pass slowly
};

/// The quantity of a limit of the problem (its option limits).
struct LimitResult {
  std::string name, quantity, unit;                      // name: the quantity, with a number from its second limit on
  double bound = unknown, value = unknown, x = unknown;  // in the unit; m
  std::string why;                                       // the reason why the value is unknown
};

/// The result of a run. What a run does not have is `unknown`.
struct Result {
  std::vector<ProbeResult> probes;
  double least_wheel_force = unknown, greatest_wheel_force = unknown;  // N
  double contact_losses = unknown, longest_loss = unknown;             // number; s
  std::vector<LimitResult> limits;
  // Diagnostics of a run that is computed alone; runs in batches do not evaluate them.
  double energy_residual = unknown;         // relative to the energy that is exchanged
  double linearisation_residual = unknown;  // of linear vehicles, relative to their weight
  double steps = unknown;
  std::string model;  // how it was computed, in words
  /// Input that is probably not intended, in the first of the problems that are computed together.
  std::vector<std::string> unusual;

  /// The largest extreme of all probes: result.largest(&ProbeResult::deflection).
  Extreme largest(Extreme ProbeResult::*quantity) const;
};

/// A run under way at one of its samples, which are output_interval (s) apart. Values are those of this instant.
class Instant {
 public:
  virtual ~Instant() = default;
  virtual double time() const = 0;  // s
  virtual double end() const = 0;   // s, of the run
  /// The row of a dataset that the results file would have, such as "/probes/deflection" (doc/results_file.md).
  /// InputError if there is none of this name.
  virtual std::span<const double> read(const std::string& dataset) const = 0;
  /// Sets forces that remain constant until they are set again: on a body of a vehicle, numbered from 0, at its centre
  /// of mass (fx, fy in N, moment in N m), or on the beam at x (m), upward (N). InputError.
  virtual void set_body_force(int vehicle, const std::string& body, const std::array<double, 3>& force) = 0;
  virtual void set_beam_force(double x, double force) = 0;
};

/// What follows a run, and may act on it. A run that is repeated with another model begins again.
class Observer {
 public:
  virtual ~Observer() = default;
  /// At t = 0.
  virtual void begin(Instant& /*now*/) {}
  /// At each further sample. False: the run ends here.
  virtual bool sample(Instant& /*now*/) { return true; }
  virtual void end(const Result& /*result*/) {}
};

/// A problem and what follows its run. With observers, vehicles are mechanisms unless model_vehicles is given.
struct Case {
  Problem problem;
  std::vector<Observer*> observers = {};
};

/// Called about twenty times a second with the share of the work that is done, 0 to 1. False: the runs end here.
using Progress = std::function<bool(double done)>;

/// A run failed, or they were stopped (status 130); the results of all runs that were computed before are kept, and the
/// others have no probes.
class RunsFailed : public Error {
 public:
  RunsFailed(const std::string& message, int status, std::vector<Result> before)
      : Error(message, status), results(std::move(before)) {}
  std::vector<Result> results;
};

/// Collective. The result of each case, in their order, on every rank of comm, and the same for any number of ranks.
/// Problems that differ in the values of options only are computed together as the runs of a study, with one numerical
/// model and in batches. Cases with observers are computed alone; observers are called on the rank that computes their
/// case. Throws InputError, before anything is computed, RunsFailed, and what an observer throws.
std::vector<Result> simulate(std::span<const Case> cases, const Progress& progress = {}, MPI_Comm comm = MPI_COMM_SELF);
std::vector<Result> simulate(std::span<const Problem> problems, const Progress& progress = {},
                             MPI_Comm comm = MPI_COMM_SELF);
Result simulate(const Problem& problem, const std::vector<Observer*>& observers = {});

}  // namespace traverse
