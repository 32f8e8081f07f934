// Exponential, sine and cosine in SIMD lanes, with errors of a few units of the last place. For the kernels only, like
// engine/lane.hpp.
#pragma once

#include "engine/lane.hpp"

namespace traverse::screen {
namespace {

template <int W>
struct LaneFunctions : engine::Lanes<W> {
  using typename engine::Lanes<W>::Lane;
  using typename engine::Lanes<W>::Mask;
  using engine::Lanes<W>::fill;

  /// The nearest integer n of x, as a number and in the lowest bits of a word.
  struct Nearest {
    Lane number;
    Mask word;
  };
  static Nearest nearest(Lane x) {
    const Lane shift = fill(6755399441055744.0);  // 1.5 2^52: the integer is in the last digits of the sum
    const Lane sum = x + shift;
    return {sum - shift, (Mask)sum};
  }

  /// exp(x) for x <= 0.
  static Lane exponential(Lane x) {
    const Lane least = fill(-700.0);
    x = x > least ? x : least;
    const Nearest n = nearest(x * 1.4426950408889634);
    const Lane r = (x - n.number * 6.93147180369123816490e-01) - n.number * 1.90821492927058770002e-10;
    Lane sum = fill(1.0 / 479001600.0);
    constexpr double terms[] = {
        1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0,
        1.0 / 120.0,      1.0 / 24.0,      1.0 / 6.0,      0.5,           1.0,          1.0};
    for (const double term : terms) sum = sum * r + term;
    return sum * (Lane)((n.word + 1023L) << 52);  // the exponent of the number 2^n
  }

  struct Turn {
    Lane cosine, sine;
  };
  /// cos(x) and sin(x) for |x| < 1e6, with the reduction and the polynomials of fdlibm (Sun Microsystems).
  static Turn turn(Lane x) {
    const Nearest n = nearest(x * 0.63661977236758134308);
    const Lane r = ((x - n.number * 1.57079632673412561417e+00) - n.number * 6.07710050630396597660e-11) -
                   n.number * 2.02226624871116645580e-21;
    const Lane z = r * r;
    Lane s = fill(1.58969099521155010221e-10), c = fill(-1.13596475577881948265e-11);
    constexpr double sines[] = {-2.50507602534068634195e-08, 2.75573137070700676789e-06, -1.98412698298579493134e-04,
                                8.33333333332248946124e-03, -1.66666666666666324348e-01};
    constexpr double cosines[] = {2.08757232129817482790e-09, -2.75573143513906633035e-07, 2.48015872894767294178e-05,
                                  -1.38888888888741095749e-03, 4.16666666666666019037e-02};
    for (const double term : sines) s = s * z + term;
    for (const double term : cosines) c = c * z + term;
    const Lane sine = r + r * z * s, cosine = 1.0 - 0.5 * z + z * z * c;
    const Mask odd = (n.word & 1L) != 0L;
    const Lane to_sine = odd ? cosine : sine, to_cosine = odd ? sine : cosine;
    const Lane sine_sign = (n.word & 2L) != 0L ? fill(-1.0) : fill(1.0),
               cosine_sign = ((n.word + 1L) & 2L) != 0L ? fill(-1.0) : fill(1.0);
    return {cosine_sign * to_cosine, sine_sign * to_sine};
  }
};

}  // namespace
}  // namespace traverse::screen
