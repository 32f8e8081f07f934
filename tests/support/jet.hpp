// Numbers with their first two derivatives with respect to one variable, for reference solutions such as a mechanism's
// positions over its crank's angle.
#pragma once

#include <cmath>

namespace traverse::test {

struct Jet {
  double value = 0.0, first = 0.0, second = 0.0;
  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: a constant can be used like a jet
  Jet(double v, double d, double dd) : value(v), first(d), second(dd) {}
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.first + b.first, a.second + b.second}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.first - b.first, a.second - b.second}; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}
/// f(a) from f, f' and f'' at a's value.
inline Jet chain(const Jet& a, double f, double df, double ddf) {
  return {f, df * a.first, ddf * a.first * a.first + df * a.second};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  const double i = 1.0 / b.value;
  return a * chain(b, i, -i * i, 2.0 * i * i * i);
}
inline Jet sin(const Jet& a) { return chain(a, std::sin(a.value), std::cos(a.value), -std::sin(a.value)); }
inline Jet cos(const Jet& a) { return chain(a, std::cos(a.value), -std::sin(a.value), -std::cos(a.value)); }
inline Jet sqrt(const Jet& a) {
  const double r = std::sqrt(a.value);
  return chain(a, r, 0.5 / r, -0.25 / (r * a.value));
}
/// The angle of (x, y).
inline Jet angle(const Jet& y, const Jet& x) {
  const Jet square = x * x + y * y;
  const Jet rate = (x * Jet(y.first, y.second, 0.0) - y * Jet(x.first, x.second, 0.0)) / square;
  return {std::atan2(y.value, x.value), rate.value, rate.first};
}

}  // namespace traverse::test
