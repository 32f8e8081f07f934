// Gauss' rules of quadrature. Boost.Math has them too, but it computes these ones when the program runs, and each file
// that includes it takes three seconds longer to compile.
#pragma once

#include <array>
#include <cstddef>

namespace traverse::base {

/// The rule of N points for the interval from -1 to 1, exact for polynomials of degree 2N - 1.
template <std::size_t N>
struct GaussRule {
  std::array<double, N> points, weights;
};
template <std::size_t N>
inline constexpr GaussRule<N> gauss_rule;
template <>
inline constexpr GaussRule<3> gauss_rule<3> = {{-0.77459666924148338, 0.0, 0.77459666924148338},
                                               {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0}};
template <>
inline constexpr GaussRule<4> gauss_rule<4> = {
    {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522},
    {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737}};
template <>
inline constexpr GaussRule<5> gauss_rule<5> = {
    {-0.90617984593866399280, -0.53846931010568309104, 0.0, 0.53846931010568309104, 0.90617984593866399280},
    {0.23692688505618908751, 0.47862867049936646804, 128.0 / 225.0, 0.47862867049936646804, 0.23692688505618908751}};

/// Calls sum(x, weight) for the points of the rule on [from, to].
template <std::size_t N, class Sum>
void at_gauss_points(double from, double to, Sum sum) {
  const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
  for (std::size_t i = 0; i < N; ++i) sum(middle + half * gauss_rule<N>.points[i], half * gauss_rule<N>.weights[i]);
}

}  // namespace traverse::base
