// A low-pass filter without delay: Butterworth of order 4, applied to a series forward and then backward.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace traverse::run {

/// The name of the filter in the results file.
inline constexpr const char* low_pass_name = "Butterworth, order 4, forward and backward";

/// The amplitude of a sine of f Hz is multiplied by 1/(1 + r^8), r = tan(pi f h)/tan(pi frequency h) at an interval of
/// h: by one half at the filter's frequency.
class LowPass {
 public:
  /// frequency in Hz; a period must have more than two instants of a series at `interval` (s).
  LowPass(double frequency, double interval);

  /// Filters `count` series in place, in the rows of [instants][count]. Both ends are extended by point reflection at
  /// the last value, and the filter starts from a constant state, so that neither end causes a transient.
  void apply(std::vector<double>& series, std::size_t count = 1) const;

 private:
  /// y_k = b (x_k + 2 x_(k-1) + x_(k-2)) - a1 y_(k-1) - a2 y_(k-2); a constant remains unchanged.
  struct Section {
    double b = 0.0, a1 = 0.0, a2 = 0.0;
  };
  void pass(double* row, std::ptrdiff_t to_next, std::size_t rows, std::size_t count) const;
  template <std::size_t Width>
  void pass(double* row, std::ptrdiff_t to_next, std::size_t rows) const;

  std::array<Section, 2> sections_;
  std::size_t margin_ = 0;  // added instants at either end
};

}  // namespace traverse::run
