// The exact peak of a response between two events, for one speed. There every modal coordinate is a sum of exponentials
// of the distance x travelled, q = Re(sum C exp(mu x)).
#pragma once

#include <complex>
#include <vector>

#include "screen/bridge_model.hpp"
#include "screen/train_events.hpp"

namespace traverse::screen {

class PeakSearch {
 public:
  PeakSearch(const BridgeModel& model, const TrainEvents& events) : model_(model), events_(events) {}

  /// The largest fraction of a limit in the interval of `length` (m) after an event, in a lane of a group of speeds.
  /// z: Z of each mode at its start, real and imaginary part. The interval is sampled in `parts`; a peak exceeds the
  /// samples beside it by at most `error`.
  double peak(std::size_t group, int lane, long event, const double* z, double length, int parts, double error);

 private:
  using Complex = std::complex<double>;
  void set_terms(std::size_t group, int lane, long event, const double* z);
  /// The coordinates of the modes at the samples, and their second derivatives in time.
  void set_samples(double step, std::size_t count);
  /// A response as a sum of exponentials with these weights, and its derivatives over x.
  double value(double x, double& slope, double& bend) const;
  double peak_of(const double* shape, const std::vector<double>& coordinates, double factor, double step, double error,
                 double largest);
  void improve(double x, double low, double high, double& largest) const;

  const BridgeModel& model_;
  const TrainEvents& events_;
  std::vector<Complex> amplitude_, exponent_, second_;  // C; mu, 1/m; (mu v)^2, 1/s2
  std::vector<std::size_t> mode_;                       // of each term
  std::vector<Complex> weights_;                        // of each term in the response that is improved
  std::vector<double> q_, acceleration_, samples_;      // [sample][mode], [sample][mode], [sample]
};

}  // namespace traverse::screen
