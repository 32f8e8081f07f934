// The results file of a fit, and its printed results.
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

#include "fit/estimates.hpp"
#include "results/recorder.hpp"

namespace traverse::fit {

/// The minimisations of a fit so far.
struct FitCourse {
  std::vector<Minimum> minima;  // one for each start
  std::size_t best = 0;         // index of the one with the least misfit
  Estimates estimates;
  std::vector<double> response;  // of the best one, see ForwardModel::run
  long evaluations = 0;          // computed points
  double seconds = 0.0;
  std::string ended;
};

/// The file exists from the start of the fit on, with the measurements. Estimates are NaN until the first minimisation
/// has ended.
class FitFile {
 public:
  /// Collective. Only rank 0 writes.
  FitFile(MPI_Comm comm, results::Place place, const scene::Scene& scene, const Residuals& residuals,
          const std::vector<std::string>& notes);
  void update(const Residuals& residuals, const FitCourse& course);
  void finish(const FitCourse& course);

 private:
  const options::Fit& fit_;
  results::Recorder recorder_;
};

void print_fit(const options::Fit& fit, const Residuals& residuals, const FitCourse& course, const std::string& file);

}  // namespace traverse::fit
