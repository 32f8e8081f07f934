// Functions for tests with extreme input: a run must have the correct result, or be refused with advice.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {

/// The message with which `run` is refused; "" if it runs to its end.
inline std::string refusal(const std::function<void()>& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline void expect_refused(const std::function<void()>& run, const std::vector<std::string>& parts) {
  const std::string message = refusal(run);
  EXPECT_FALSE(message.empty()) << "not refused";
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

/// Largest difference of a dataset of two runs over `scale`, at the instants that both runs have stored.
inline double difference(Results& run, Results& reference, const std::string& name, double scale) {
  const std::vector<double> t = run.time(), t_reference = reference.time();
  const std::vector<double> a = run(name), b = reference(name);
  const std::size_t columns = a.size() / t.size();
  EXPECT_EQ(columns, b.size() / t_reference.size());
  double largest = 0.0;
  std::size_t common = 0;
  for (std::size_t i = 0, j = 0; i < t.size(); ++i) {
    while (j < t_reference.size() && t_reference[j] < t[i] - 1e-9) ++j;
    if (j == t_reference.size() || t_reference[j] > t[i] + 1e-9) continue;
    ++common;
    for (std::size_t c = 0; c < columns; ++c)
      largest = std::max(largest, std::abs(a[i * columns + c] - b[j * columns + c]));
  }
  EXPECT_GT(2 * common, t.size());
  return largest / scale;
}

/// The largest difference over the largest value of the reference.
inline double difference(Results& run, Results& reference, const std::string& name) {
  return difference(run, reference, name, std::abs(peak(reference(name)).first));
}

inline double lowest(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
inline double highest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// A simply supported beam on a bed under a force that moves from its left end: the exact series of its modes
/// (Fryba, Vibration of Solids and Structures under Moving Loads, ch. 1 and 3), with C = a M + b K:
///   q'' + 2 s q' + w^2 q = 2 F/(m L) sin(W t),  w^2 = (n pi/L)^4 EI/m + k/m,  2 s = a + b w^2,  W = n pi v/L.
struct MovingForce {
  double L, EI, m, F, speed, k = 0.0, a = 0.0, b = 0.0;

  /// Deflection at x, downward, while the force is on the beam.
  double deflection(double x, double t) const {
    using Complex = std::complex<double>;
    constexpr int modes = 2001;
    double sum = 0.0;
    for (int n = 1; n <= modes; ++n) {
      const double wave = n * std::numbers::pi / L, W = wave * speed;
      // The frequency is changed by 5e-8 to avoid resonance, so that one formula suffices; q changes by as little.
      const double w2 = (std::pow(wave, 4) * EI + k) / m * (1.0 + 1e-7), s = 0.5 * (a + b * w2);
      const Complex root = std::sqrt(Complex(s * s - w2)), r1 = -s + root, r2 = -s - root;
      const Complex A = 2.0 * F / (m * L) / Complex(w2 - W * W, 2.0 * s * W);
      // Im A e^{iWt} plus the free vibration for which q = q' = 0 at the start.
      const double q0 = A.imag(), rate0 = W * A.real();
      const Complex c1 = (r2 * q0 - rate0) / (r1 - r2), c2 = -q0 - c1;
      const double q =
          (A * std::exp(Complex(0.0, W * t))).imag() + (c1 * std::exp(r1 * t) + c2 * std::exp(r2 * t)).real();
      sum += q * std::sin(wave * x);
    }
    return sum;
  }
};

}  // namespace traverse::test
