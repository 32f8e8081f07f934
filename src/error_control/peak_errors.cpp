// Relative differences of the peaks of two runs, for each quantity.
#include "error_control/peak_errors.hpp"

#include <algorithm>
#include <cmath>

#include "error_control/accuracy.hpp"

namespace traverse::error_control {

PeakErrors difference(const scene::Scene& scene, const base::PassagePeaks& rough, const base::PassagePeaks& fine) {
  PeakErrors errors{};
  const auto compare = [&](run::Quantity q, base::Extreme base::ProbePeaks::*peak) {
    double change = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < fine.peaks.size(); ++p) {
      const double value = (fine.peaks[p].*peak).value;
      change = std::max(change, std::abs((rough.peaks[p].*peak).value - value));
      largest = std::max(largest, value);
    }
    if (is_controlled(scene, q) && largest > 0.0) errors[q] = change / largest;
  };
  compare(run::deflection, &base::ProbePeaks::deflection);
  compare(run::acceleration, &base::ProbePeaks::acceleration);
  compare(run::moment, &base::ProbePeaks::moment);
  compare(run::low_passed, &base::ProbePeaks::low_passed);
  if (is_controlled(scene, run::wheel_force) && fine.greatest_wheel_force > 0.0)
    errors[run::wheel_force] = std::max(std::abs(rough.greatest_wheel_force - fine.greatest_wheel_force),
                                        std::abs(rough.least_wheel_force - fine.least_wheel_force)) /
                               fine.greatest_wheel_force;
  return errors;
}

}  // namespace traverse::error_control
