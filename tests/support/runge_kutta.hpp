// Independent integrations for tests: the classical Runge-Kutta method.
#pragma once

#include <Eigen/Core>

namespace traverse::test {

/// One classical Runge-Kutta step.
template <int n>
using State = Eigen::Matrix<double, n, 1>;
template <int n, class Rate>
void runge_kutta(const Rate& rate, double h, State<n>& y) {
  const State<n> a = rate(y), b = rate(y + 0.5 * h * a), c = rate(y + 0.5 * h * b), d = rate(y + h * c);
  y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
}

}  // namespace traverse::test
