// The exact peak of a response between two events, in time and along the bridge, for one speed. There every modal
// coordinate is a sum of exponentials of the distance x travelled, q = Re(sum C exp(mu x)), and the response is the sum
// of phi_n(xi) q_n(x).
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "screen/bridge_model.hpp"
#include "screen/train_events.hpp"

namespace traverse::screen {

class PeakSearch {
 public:
  PeakSearch(const BridgeModel& model, const TrainEvents& events) : model_(model), events_(events) {}

  /// The largest fraction of a limit at any place of the bridge in the interval of `length` (m) after an event, in a
  /// lane of a group of speeds; `least` if that is greater. z: Z of each mode at its start, real and imaginary part.
  /// The interval is sampled in `parts`; a peak exceeds the nearest of the stations' samples by at most `error`.
  double peak(std::size_t group, int lane, long event, const double* z, double length, int parts, double error,
              double least);

 private:
  using Complex = std::complex<double>;
  enum Response { deflection, acceleration };
  struct Point {  // of a span: the place on it and the distance travelled, m
    double xi = 0.0, x = 0.0;
  };
  void set_terms(std::size_t group, int lane, long event, const double* z);
  /// The coordinates of the modes at the samples, and their second derivatives in time.
  void set_samples(double step, std::size_t count);
  /// The coordinate of each mode, or its second derivative in time, and its two derivatives over x.
  void set_coordinates(Response response, double x);
  void search_span(std::size_t span, Response response, double factor, double step, double error);
  /// Climbs to the peak near a point of the span and of the interval of `length` by Newton's method.
  void improve(std::size_t span, Response response, double factor, Point at, double length);

  const BridgeModel& model_;
  const TrainEvents& events_;
  std::vector<Complex> amplitude_, exponent_, second_;  // C; mu, 1/m; (mu v)^2, 1/s2
  std::vector<std::size_t> mode_;                       // of each term
  std::array<std::vector<double>, 2> samples_;          // of each response: [sample][mode]
  std::vector<double> fractions_;                       // of the limit: [sample][station of the span]
  std::vector<std::array<double, 3>> coordinates_;      // of each mode, with its derivatives over x
  Point longest_;                                       // of one step of Newton's method
  double largest_ = 0.0;                                // fraction of a limit so far
};

}  // namespace traverse::screen
