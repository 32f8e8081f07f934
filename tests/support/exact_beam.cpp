// Assembles dynamic stiffness matrices, counts natural frequencies by the Wittrick-Williams algorithm, computes them by
// bisection, and computes damped eigenvalues by the secant method on the determinant.
#include "support/exact_beam.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace traverse::test::exact {
namespace {

constexpr Real longest = 1.0L;  // largest length of a piece, as a multiple of its solution's length 1/beta

int unknowns_of_a_joint(const Chain& chain) { return chain.motion == Motion::bending ? 2 : 1; }

/// The chain with its pieces divided for |s|; `place` has the new index of each joint.
struct Cut {
  Chain chain;
  std::vector<int> place;
};

int cuts(const Piece& p, Motion motion, Real s) {
  const Real resistance = p.mass * s * s + p.bed_c * s + p.bed_k;
  const Real beta = std::pow(resistance / static_cast<Real>(p.stiffness), motion == Motion::bending ? 0.25L : 0.5L);
  return std::max(1, static_cast<int>(std::ceil(beta * p.length / longest)));
}

Cut cut(const Chain& chain, Real s) {
  Cut result;
  result.chain.motion = chain.motion;
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const int n = cuts(chain.pieces[i], chain.motion, s);
    result.place.push_back(static_cast<int>(result.chain.joints.size()));
    result.chain.joints.push_back(chain.joints[i]);
    result.chain.joints.resize(result.chain.joints.size() + static_cast<std::size_t>(n) - 1);
    Piece part = chain.pieces[i];
    part.length /= n;
    result.chain.pieces.insert(result.chain.pieces.end(), static_cast<std::size_t>(n), part);
  }
  result.place.push_back(static_cast<int>(result.chain.joints.size()));
  result.chain.joints.push_back(chain.joints.back());
  return result;
}

/// Sum of z^n/(step n + k)! over n.
template <class S>
S series(int step, int k, S z) {
  S term = 1.0L / std::tgamma(static_cast<Real>(k + 1)), sum = term;
  for (int i = k; std::abs(term) > 1e-24L * std::abs(sum);) {
    for (int j = 0; j < step; ++j) term /= static_cast<Real>(++i);
    term *= z;
    sum += term;
  }
  return sum;
}

/// End forces K d - f of one piece for the end displacements d. Bending: d = (v1, h theta1, v2, h theta2), all in m,
/// forces and moments over h.
template <class S>
struct EndForces {
  Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic> K;
  Eigen::Matrix<S, Eigen::Dynamic, 1> f;
};

template <class S>
S resistance_of(const Piece& p, S s) {
  return static_cast<Real>(p.mass) * s * s + static_cast<Real>(p.bed_c) * s + static_cast<Real>(p.bed_k);
}

// v(x) = v1 f0 + h theta1 f1 + a f2 + b f3 + Q f4 with the fundamental solutions f_k(x/h) = sum z^n
// (x/h)^(4n+k)/(4n+k)!, z = -(m s^2 + c s + k) h^4/EI, Q = q h^4/EI. a and b follow from the displacements of the right
// end.
template <class S>
EndForces<S> bending(const Piece& p, S s) {
  const Real h = p.length, EI = p.stiffness;
  const S z = -resistance_of(p, s) * (h * h * h * h / EI);
  S f[5];
  for (int k = 0; k < 5; ++k) f[k] = series(4, k, z);
  const Real Q = p.load * h * h * h * h / EI;
  const S det = f[2] * f[2] - f[1] * f[3];
  // Columns: v1, h theta1, v2, h theta2, load. Rows: a, b.
  Eigen::Matrix<S, 2, 5> right;
  right << -f[0], -f[1], S(1), S(0), -Q * f[4], -z * f[3], -f[0], S(0), S(1), -Q * f[3];
  Eigen::Matrix<S, 2, 2> inverse;
  inverse << f[2] / det, -f[3] / det, -f[1] / det, f[2] / det;
  const Eigen::Matrix<S, 2, 5> ab = inverse * right;
  // h^2 v'' and h^3 v''' at the right end.
  Eigen::Matrix<S, 1, 5> second = f[0] * ab.row(0) + f[1] * ab.row(1), third = z * f[3] * ab.row(0) + f[0] * ab.row(1);
  second(0) += z * f[2];
  second(1) += z * f[3];
  second(4) += Q * f[2];
  third(0) += z * f[1];
  third(1) += z * f[2];
  third(4) += Q * f[1];
  Eigen::Matrix<S, 4, 5> all;
  all << ab.row(1), -ab.row(0), -third, second;
  all *= S(EI / (h * h * h));
  return {all.template leftCols<4>(), -all.col(4)};
}

template <class S>
EndForces<S> stretching(const Piece& p, S s) {
  const Real h = p.length, EA = p.stiffness;
  const S z = resistance_of(p, s) * (h * h / EA);
  const S cosine = series(2, 0, z), sine = series(2, 1, z);
  EndForces<S> e{Eigen::Matrix<S, 2, 2>::Zero(), Eigen::Matrix<S, 2, 1>::Zero()};
  const S scale = S(EA / h) / sine;
  e.K << scale * cosine, -scale, -scale, scale * cosine;
  const S f = static_cast<Real>(p.load) * h * series(2, 2, z) /
              sine;  // end force due to a uniform force; half of it in statics
  e.f << f, f;
  return e;
}

template <class S>
EndForces<S> end_forces(const Chain& chain, std::size_t i, S s) {
  EndForces<S> e = chain.motion == Motion::bending ? bending(chain.pieces[i], s) : stretching(chain.pieces[i], s);
  if (chain.motion == Motion::axial) return e;
  const Real h = chain.pieces[i].length;
  for (int moment : {1, 3}) {
    e.K.row(moment) *= S(h);
    e.K.col(moment) *= S(h);
    e.f(moment) *= S(h);
  }
  return e;
}

/// The whole chain; held unknowns have rows and columns of the identity (a positive pivot each).
template <class S>
EndForces<S> assembled(const Chain& chain, S s) {
  const int per = unknowns_of_a_joint(chain), n = per * static_cast<int>(chain.joints.size());
  EndForces<S> whole;
  whole.K.setZero(n, n);
  whole.f.setZero(n);
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const EndForces<S> e = end_forces(chain, i, s);
    const int at = per * static_cast<int>(i);
    whole.K.block(at, at, 2 * per, 2 * per) += e.K;
    whole.f.segment(at, 2 * per) += e.f;
  }
  for (int i = 0; i < n; ++i) {
    const Joint& j = chain.joints[static_cast<std::size_t>(i / per)];
    const int kind = i % per;
    whole.K(i, i) += static_cast<Real>(j.k[kind]) + static_cast<Real>(j.c[kind]) * s;
    whole.f(i) += static_cast<Real>(j.load[kind]);
    if (!j.held[kind]) continue;
    whole.K.row(i).setZero();
    whole.K.col(i).setZero();
    whole.K(i, i) = S(1);
    whole.f(i) = S(0);
  }
  return whole;
}

/// Pivots of L U of a band of three codiagonals at most.
std::vector<std::complex<Real>> pivots(Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, Eigen::Dynamic> K) {
  std::vector<std::complex<Real>> d;
  for (Eigen::Index i = 0; i < K.rows(); ++i) {
    const Eigen::Index last = std::min(K.rows() - 1, i + 3);
    d.push_back(K(i, i));
    for (Eigen::Index row = i + 1; row <= last; ++row) {
      const std::complex<Real> factor = K(row, i) / K(i, i);
      for (Eigen::Index column = i + 1; column <= last; ++column) K(row, column) -= factor * K(i, column);
    }
  }
  return d;
}

/// The number of negative eigenvalues of a symmetric matrix, by Bunch and Parlett's pivots. Pivots in their given order
/// would fail: the last but one pivot vanishes at the frequencies of a beam that is clamped at its last joint, and a
/// beam that is free there may have the same frequencies.
int negative(Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> K) {
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  int count = 0;
  for (Eigen::Index n = K.rows(); n > 0;) {
    Eigen::Index diagonal = 0, row = 0, column = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (std::abs(K(i, i)) > std::abs(K(diagonal, diagonal))) diagonal = i;
      for (Eigen::Index j = 0; j < i; ++j) {
        if (std::abs(K(i, j)) > std::abs(K(row, column)) || row == column) row = i, column = j;
      }
    }
    const auto exchange = [&](Eigen::Index a, Eigen::Index b) {
      K.row(a).swap(K.row(b));
      K.col(a).swap(K.col(b));
    };
    const bool single = n == 1 || std::abs(K(diagonal, diagonal)) >= 0.64L * std::abs(K(row, column));
    const Eigen::Index size = single ? 1 : 2, left = n - size;
    if (single) {
      exchange(diagonal, n - 1);
      if (K(n - 1, n - 1) < 0.0L) ++count;
      if (K(n - 1, n - 1) == 0.0L) return count;  // the remaining matrix is zero
    } else {
      exchange(row, n - 1);
      exchange(column, n - 2);
      ++count;  // an indefinite pair
    }
    const Matrix inverse = K.block(left, left, size, size).inverse();
    for (Eigen::Index i = 0; i < left; ++i) {  // most rows of a band remain unchanged
      if (K.row(i).segment(left, size).isZero(0.0L)) continue;
      const Eigen::Matrix<Real, 1, Eigen::Dynamic> factor = K.row(i).segment(left, size) * inverse;
      for (Eigen::Index j = 0; j <= i; ++j) {
        for (Eigen::Index p = 0; p < size; ++p) K(i, j) -= factor(p) * K(j, left + p);
      }
    }
    for (Eigen::Index i = 0; i < left; ++i) {
      for (Eigen::Index j = 0; j < i; ++j) K(j, i) = K(i, j);
    }
    n = left;
  }
  return count;
}

int modes_below(const Chain& chain, Real omega) {
  // s^2 = -omega^2 is real: the equations remain real with a negative mass.
  Cut c = cut(chain, omega);
  for (Piece& p : c.chain.pieces) {
    p.mass = -p.mass;
    p.bed_c = 0.0;
  }
  for (Joint& j : c.chain.joints) j.c[0] = j.c[1] = 0.0;
  return negative(assembled<Real>(c.chain, omega).K);
}

}  // namespace

std::vector<double> frequencies(const Chain& chain, int count) {
  std::vector<double> found;
  Real high = 1e-3L;
  while (modes_below(chain, high) < count) high *= 2.0L;
  for (int i = 0; i < count; ++i) {
    Real low = 0.0L, top = high;
    while (top - low > 1e-15L * top && top > 1e-9L * high) {
      const Real middle = 0.5L * (low + top);
      if (middle <= low || middle >= top) break;
      (modes_below(chain, middle) > i ? top : low) = middle;
    }
    found.push_back(static_cast<double>(0.5L * (low + top)));
  }
  return found;
}

std::vector<Section> statics(const Chain& chain) {
  const Cut c = cut(chain, 0.0L);
  const int per = unknowns_of_a_joint(chain);
  const EndForces<Real> whole = assembled<Real>(c.chain, 0.0L);
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> d = whole.K.partialPivLu().solve(whole.f);
  std::vector<Section> sections(chain.joints.size());
  for (std::size_t i = 0; i < sections.size(); ++i) {
    Section& section = sections[i];
    const int joint = c.place[i];
    (per == 2 ? section.v : section.u) = static_cast<double>(d(per * joint));
    if (per == 2) section.rotation = static_cast<double>(d(2 * joint + 1));
    for (int side : {-1, 0}) {  // the piece on the left and the piece on the right
      const int piece = joint + side;
      if (piece < 0 || piece >= static_cast<int>(c.chain.pieces.size())) continue;
      const EndForces<Real> e = end_forces<Real>(c.chain, static_cast<std::size_t>(piece), 0.0L);
      const Eigen::Matrix<Real, Eigen::Dynamic, 1> f = e.K * d.segment(per * piece, 2 * per) - e.f;
      if (per == 1) {
        (side < 0 ? section.axial_left : section.axial_right) = static_cast<double>(side < 0 ? f(1) : -f(0));
      } else {
        (side < 0 ? section.moment_left : section.moment_right) = static_cast<double>(side < 0 ? f(3) : -f(1));
        (side < 0 ? section.shear_left : section.shear_right) = static_cast<double>(side < 0 ? -f(2) : f(0));
      }
    }
  }
  return sections;
}

std::complex<double> damped_root(const Chain& chain, std::complex<double> start) {
  using Complex = std::complex<Real>;
  const Cut c = cut(chain, std::abs(start) * 1.1L);
  Complex scale(1.0L);
  const auto determinant = [&](Complex s) {
    Complex product(1.0L);
    for (const Complex& d : pivots(assembled<Complex>(c.chain, s).K)) product *= d / std::abs(scale);
    return product;
  };
  const auto sizes = pivots(assembled<Complex>(c.chain, Complex(start.real(), start.imag())).K);
  Real logarithm = 0.0L;  // logarithm of the geometric mean, so that the product neither overflows nor vanishes
  for (const Complex& d : sizes) logarithm += std::log(std::abs(d)) / static_cast<Real>(sizes.size());
  scale = std::exp(logarithm);
  Complex a(start.real(), start.imag()), b = a * (1.0L + 1e-6L), at_a = determinant(a), at_b = determinant(b);
  for (int i = 0; i < 100; ++i) {
    const Complex next = b - at_b * (b - a) / (at_b - at_a);
    a = b;
    at_a = at_b;
    b = next;
    if (!(std::abs(b - a) > 1e-16L * std::abs(b))) break;
    at_b = determinant(b);
    if (at_b == at_a) break;
  }
  if (!(std::abs(b - a) <= 1e-12L * std::abs(b))) throw std::runtime_error("exact::damped_root does not converge");
  return {static_cast<double>(b.real()), static_cast<double>(b.imag())};
}

}  // namespace traverse::test::exact
