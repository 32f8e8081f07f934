// A low-pass filter without delay: Butterworth's of order 4, run over a series forward and then backward.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace traverse::app {

/// What a filter is called where its numbers are stored.
inline constexpr const char* low_pass_name = "Butterworth, order 4, forward and backward";

/// A sine of f Hz keeps 1/(1 + r^8) of its amplitude, r = tan(pi f h)/tan(pi frequency h) at a spacing of h: half of it
/// at the filter's frequency.
class LowPass {
 public:
  /// frequency in Hz, of which a series at `interval` (s) has to hold more than two instants a period.
  LowPass(double frequency, double interval);

  /// Filters series in place, `count` of them side by side in the rows of [instants][count]. Beyond both ends they go
  /// on as their mirror images through the last value, and the filter starts as if that had held forever: neither end
  /// brings a transient with it.
  void apply(std::vector<double>& series, std::size_t count = 1) const;

 private:
  /// y_k = b (x_k + 2 x_(k-1) + x_(k-2)) - a1 y_(k-1) - a2 y_(k-2), which leaves a constant as it is.
  struct Section {
    double b = 0.0, a1 = 0.0, a2 = 0.0;
  };
  void pass(double* row, std::ptrdiff_t to_next, std::size_t rows, std::size_t count) const;
  template <std::size_t Width>
  void pass(double* row, std::ptrdiff_t to_next, std::size_t rows) const;

  std::array<Section, 2> sections_;
  std::size_t margin_ = 0;  // instants beyond either end
};

}  // namespace traverse::app
