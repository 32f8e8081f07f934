// Prints estimates with standard errors and correlations, the residuals of each measurement, and the minima.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/fit_file.hpp"

namespace traverse::fit {
namespace {

constexpr Eigen::Index most_printed = 8;  // unknowns of a printed matrix of correlations

std::string error_text(const Estimate& estimate) {
  if (estimate.at_bound) return "at a bound";
  if (!std::isfinite(estimate.standard_error)) return "not determined by the data";
  const double relative = std::abs(estimate.standard_error / estimate.value);
  return fmt::format("standard error {:.2g}{}", estimate.standard_error,
                     estimate.value != 0.0 && relative < 1.0 ? fmt::format(" ({:.2g} %)", 100.0 * relative) : "");
}

void print_estimate(const Unknown& estimated, const Estimate& estimate) {
  const std::string unit = estimated.unit == "1" ? "" : " " + estimated.unit;
  fmt::print("  {:<30}{:.7g}{}, {}\n", estimated.name, estimate.value, unit, error_text(estimate));
}

void print_correlations(const Residuals& residuals, const Eigen::MatrixXd& correlation) {
  if (correlation.rows() < 2 || correlation.rows() > most_printed) return;
  fmt::print("  correlations\n");
  for (Eigen::Index i = 1; i < correlation.rows(); ++i) {
    fmt::print("    {:<28}", residuals.unknowns()[static_cast<std::size_t>(i)].name);
    for (Eigen::Index j = 0; j < i; ++j)
      std::isnan(correlation(i, j)) ? fmt::print("{:>8}", "-") : fmt::print("{:8.3f}", correlation(i, j));
    fmt::print("\n");
  }
}

void print_measurements(const options::Fit& fit, const Residuals& residuals, const FitCourse& course) {
  const Minimum& best = course.minima[course.best];
  for (std::size_t f = 0; f < fit.frequencies.size(); ++f) {
    const options::MeasuredFrequency& mode = fit.frequencies[f];
    fmt::print("  {:<30}measured {:.6g} Hz, computed {:.6g} Hz{}\n", mode.name, mode.value, course.response[f],
               mode.x.empty() ? "" : fmt::format(", MAC {:.4f}", residuals.shape(f, course.response).mac));
  }
  for (std::size_t s = 0; s < fit.series.size(); ++s) {
    const ComparedSeries both = residuals.compared(s, course.response, best.u);
    double sum = 0.0, largest = 0.0;
    for (std::size_t k = 0; k < both.time.size(); ++k) {
      const double difference = both.computed[k] - both.measured[k];
      sum += difference * difference;
      largest = std::max(largest, std::abs(both.measured[k]));
    }
    fmt::print("  {:<30}{} values, root mean square of the residuals {:.3g}, largest measured {:.3g}; {} {:.3g}\n",
               fit.series[s].name, both.time.size(), std::sqrt(sum / static_cast<double>(both.time.size())), largest,
               fit.series[s].sd ? "standard deviation" : "estimated standard deviation", residuals.sd(s));
  }
}

void print_minima(const options::Fit& fit, const Residuals& residuals, const std::vector<Minimum>& minima) {
  if (fit.starts == 1) return;
  const std::vector<DistinctMinimum> distinct = distinct_minima(minima);
  const auto stopped = std::count_if(minima.begin(), minima.end(), [](const Minimum& m) { return !has_converged(m); });
  fmt::print("  {} of {} starts reached the least misfit, {:.6g}{}{}\n", distinct.front().count, minima.size(),
             distinct.front().best->misfit(), distinct.size() == 1 ? "; there were no other minima" : "",
             stopped > 0 ? fmt::format("; {} did not converge", stopped) : "");
  if (distinct.size() == 1) return;
  fmt::print("  {} other minim{} met; the lowest has the misfit {:.6g} at", distinct.size() - 1,
             distinct.size() == 2 ? "um was" : "a were", distinct[1].best->misfit());
  for (std::size_t j = 0; j < residuals.options(); ++j)
    fmt::print("{} {} = {:.5g}", j == 0 ? "" : ",", residuals.unknowns()[j].name,
               residuals.unknowns()[j].value(distinct[1].best->u[static_cast<Eigen::Index>(j)]));
  fmt::print("\n");
}

}  // namespace

void print_fit(const options::Fit& fit, const Residuals& residuals, const FitCourse& course, const std::string& file) {
  if (!course.minima.empty()) {
    fmt::print("estimates\n");
    for (std::size_t j = 0; j < residuals.unknowns().size(); ++j)
      print_estimate(residuals.unknowns()[j], course.estimates.of[j]);
    print_correlations(residuals, course.estimates.correlation);
    print_measurements(fit, residuals, course);
    print_minima(fit, residuals, course.minima);
    for (const std::string& sentence : course.estimates.sentences) fmt::print("  note: {}\n", sentence);
  }
  fmt::print("  {} runs in {:.3g} s; the fit {}\nresults  {}\n", course.evaluations, course.seconds, course.ended,
             file.empty() ? "none" : file);
}

}  // namespace traverse::fit
