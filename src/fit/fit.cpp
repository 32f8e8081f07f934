// Computes a fit: choice of the model, alignment of the clocks, minimisations from all starts, results.
#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "base/notes.hpp"
#include "base/random_stream.hpp"
#include "engine/processor.hpp"
#include "ensemble/parallel_cases.hpp"
#include "fit/evaluator.hpp"
#include "fit/fit_file.hpp"
#include "fit/minimise.hpp"
#include "fit/record_check.hpp"
#include "results/stage.hpp"
#include "results/terminal.hpp"
#include "run/process.hpp"
#include "traverse/options/input.hpp"

namespace traverse::fit {
namespace {

constexpr double shift_range = 0.1;  // of a shift about its start, relative to the duration of the run
constexpr double settled = 0.01;     // relative change of estimated standard deviations
constexpr double long_record = 5.0;  // duration of the records over that of the passage, from which a note warns
constexpr int most_rounds = 3;       // of minimisations with newly estimated standard deviations

using Clock = std::chrono::steady_clock;

/// Start number i: the scene's values, then a Latin hypercube, in which every option takes a value of each part of its
/// range.
Eigen::VectorXd start_of(const Residuals& residuals, const options::Fit& fit, int i) {
  Eigen::VectorXd u = residuals.start();
  if (i == 0) return u;
  const auto others = static_cast<std::size_t>(fit.starts - 1);
  for (std::size_t j = 0; j < residuals.options(); ++j) {
    const base::RandomStream stream(fit.seed, fit.parameters[j].name());
    std::vector<std::size_t> parts(others);
    std::iota(parts.begin(), parts.end(), std::size_t{0});
    for (std::size_t k = others; k-- > 1;)
      std::swap(parts[k], parts[static_cast<std::size_t>(stream.uniform(k) * static_cast<double>(k + 1))]);
    const auto own = static_cast<std::size_t>(i - 1);
    u[static_cast<Eigen::Index>(j)] =
        (static_cast<double>(parts[own]) + stream.uniform(others + own)) / static_cast<double>(others);
  }
  return u;
}

/// The minimisations on rank 0.
class MultiStart {
 public:
  MultiStart(Evaluator& evaluator, Residuals& residuals, const options::Fit& fit, FitFile& file)
      : residuals_(residuals), fit_(fit), file_(file), problem_(evaluator, residuals) {}

  void run(FitCourse& course) {
    for (int i = 0; i < fit_.starts; ++i) {
      Eigen::VectorXd u = start_of(residuals_, fit_, i);
      residuals_.set_starts(problem_.response(u), u);
      course.minima.push_back(minimise(problem_, u));
      estimate_sd(course.minima);
      record(course);
      results::Stage::advance(static_cast<double>(i + 1) / static_cast<double>(fit_.starts));
    }
  }

 private:
  static Minimum& best_of(std::vector<Minimum>& minima) {
    return *std::min_element(minima.begin(), minima.end(),
                             [](const Minimum& a, const Minimum& b) { return a.misfit() < b.misfit(); });
  }

  /// The weights of several measurements decide the estimates, so that the minimisation is repeated with new ones.
  void estimate_sd(std::vector<Minimum>& minima) {
    for (int round = 0; round < most_rounds; ++round) {
      const Eigen::VectorXd factors = residuals_.estimate_sd(best_of(minima).residuals);
      for (Minimum& one : minima) {
        one.residuals = one.residuals.cwiseProduct(factors);
        one.jacobian = factors.asDiagonal() * one.jacobian;
      }
      const double change = (factors.array() - 1.0).abs().maxCoeff();
      const bool single = fit_.series.size() + fit_.frequencies.size() == 1;
      Minimum& best = best_of(minima);
      if ((single || change < settled) && has_converged(best)) return;
      best = minimise(problem_, best.u);
    }
  }

  void record(FitCourse& course) {
    const Minimum& best = best_of(course.minima);
    course.best = static_cast<std::size_t>(&best - course.minima.data());
    course.estimates = estimates_of(best, residuals_);
    course.response = problem_.response(best.u);
    file_.update(residuals_, course);
  }

  Residuals& residuals_;
  const options::Fit& fit_;
  FitFile& file_;
  Problem problem_;
};

void align_clocks(ForwardModel& model, const options::Fit& fit, Residuals& residuals) {
  const auto aligned = [](const options::MeasuredSeries& series) { return series.align; };
  std::vector<double> response;
  if (std::any_of(fit.series.begin(), fit.series.end(), aligned)) {
    model.set_end(model.duration());
    response = model.run({model.start()}).front();
  }
  residuals.align(response, model.interval(), shift_range * model.duration());
  model.set_end(residuals.end());
}

void describe(const options::Fit& fit, const ForwardModel& model, std::vector<std::string>& notes) {
  for (const options::MeasuredFrequency& f : fit.frequencies)
    notes.push_back(fmt::format("{}: frequency {}, {:g} Hz, standard deviation {:g} Hz{}", f.name, f.number, f.value,
                                f.sd, f.x.empty() ? "" : fmt::format(", with its shape at {} places", f.x.size())));
  for (const options::MeasuredSeries& s : fit.series)
    notes.push_back(fmt::format("{}: {} values of {}{}{}{}{}{}", s.name, s.value.size(), s.dataset.substr(1),
                                s.x ? fmt::format(" at x = {:g} m", *s.x) : fmt::format(", number {}", s.component),
                                s.low_pass ? fmt::format(", low-passed at {:g} Hz", *s.low_pass) : "",
                                s.align ? ", with a clock of its own" : "", s.offset ? ", with an offset" : "",
                                s.gain ? ", with a factor" : ""));
  if (!fit.series.empty())
    notes.push_back(
        base::detail(fmt::format("every run has {} samples every {:g} s", model.instants(), model.interval())));
  if (model.width() > 1)
    notes.push_back(base::detail(fmt::format("up to {} runs are advanced together, one in each lane of {} vectors",
                                             model.width(), engine::instructions())));
  const double end = model.interval() * static_cast<double>(model.instants());
  if (end > long_record * model.duration() && model.duration() > 0.0)
    notes.push_back(
        fmt::format("every run lasts {:.3g} s, as the records do, and the passage {:.3g} s; fit_to_..._from "
                    "and fit_to_..._to shorten the records",
                    end, model.duration()));
  for (const std::string& note : options::notes_on_unused(model.given()))
    if (!note.starts_with("tao_")) notes.push_back(note);
}

/// The failure of a fit whose estimates are none: its records are not what was computed, or its best minimum is none
/// within the bounds.
ensemble::RunFailure failure_of(const options::Fit& fit, const ForwardModel& model, const Residuals& residuals,
                                const FitCourse& course) {
  const int status = SolverError("").status();
  const Minimum& best = course.minima[course.best];
  if (const std::vector<std::string> doubts = doubts_that_remain(fit, model, residuals, course.response, best.u);
      !doubts.empty())
    return {0, status, fmt::format("the estimates do not explain the records: {}", fmt::join(doubts, "; "))};
  std::string held;
  for (std::size_t j = 0; j < course.estimates.of.size(); ++j)
    if (course.estimates.of[j].at_bound) held += (held.empty() ? "" : ", ") + residuals.unknowns()[j].name;
  if (!held.empty())
    return {
        0, status,
        fmt::format("the fit has no minimum within its bounds: {} at a bound, beyond which the misfit decreases; "
                    "allowed: wider bounds (fit_vary), if unit, sign, clock and offset of the measurements are right",
                    held)};
  if (has_converged(best)) return {};
  return {0, status,
          fmt::format("the minimisation of the fit has not converged ({}); allowed: more iterations (tao_max_it), more "
                      "starts (fit_starts) or narrower bounds (fit_vary)",
                      best.reason)};
}

}  // namespace

int run_fit(MPI_Comm comm, const scene::Scene& scene, results::Place place) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const options::Fit& fit = *scene.fit;
  std::vector<std::string> notes;
  ForwardModel model(scene, notes);
  Residuals residuals(fit, model.units());
  align_clocks(model, fit, residuals);
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  describe(fit, model, notes);
  const std::vector<std::string> doubts = doubts_about_records(fit, model, residuals);
  results::print_unusual(doubts);
  run::print_notes(comm, scene, notes);
  notes.insert(notes.end(), doubts.begin(), doubts.end());
  const run::DeferredSignals deferred;
  FitFile file(comm, std::move(place), scene, residuals, notes);
  Evaluator evaluator(comm, fit.parameters.size(), model.size(), model.width(),
                      [&](const std::vector<Evaluator::Values>& points) { return model.run(points); });
  const auto begin = Clock::now();
  const results::Stage stage("fit");
  FitCourse course;
  int signal = 0;
  ensemble::RunFailure failure;
  if (rank == 0) {
    try {
      MultiStart(evaluator, residuals, fit, file).run(course);
      course.ended = "reached its end";
    } catch (const Evaluator::Interrupted& interrupted) {
      signal = interrupted.signal;
      course.ended = fmt::format("ended by signal {}", signal);
    } catch (const FileError& error) {
      run::leave_together(comm, error);
    } catch (const std::exception& error) {
      const Error known = run::as_error(error);
      failure = {0, known.status(), known.what()};
      course.ended = fmt::format("failed: {}", known.what());
    }
    evaluator.stop();
  } else {
    evaluator.serve();
  }
  course.evaluations = evaluator.evaluations();
  course.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  try {
    file.finish(course);
  } catch (const FileError& error) {
    run::leave_together(comm, error);
  }
  if (rank == 0) print_fit(fit, residuals, course, scene.output.file);
  if (rank == 0 && !failure.failed() && signal == 0) failure = failure_of(fit, model, residuals, course);
  failure = ensemble::first_of(comm, std::move(failure));
  if (failure.failed()) throw Error(failure.message, failure.status);
  MPI_Bcast(&signal, 1, MPI_INT, 0, comm);
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace traverse::fit
