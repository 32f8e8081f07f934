// Explicit inverse up to 24 degrees of freedom, banded or dense LU factorisation above, and the pseudo-inverse for
// matrices that may be singular (statics).
#include "newton_inverse.hpp"

namespace traverse::train {
namespace {

constexpr int small_vehicle = 24;  // degrees of freedom up to which the Newton matrix is inverted explicitly

}  // namespace

void NewtonInverse::compute(const Eigen::MatrixXd& J, bool singular) {
  const int f = static_cast<int>(J.rows());
  form_ = Form::whole;
  if (f == 0) {
    inverse_.resize(0, 0);
  } else if (singular) {
    inverse_ = J.completeOrthogonalDecomposition().pseudoInverse();
  } else if (f <= small_vehicle) {
    factors_.compute(J);
    inverse_ = factors_.permutationP();
    factors_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(inverse_);
    factors_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(inverse_);
  } else if (const int band = solve::half_bandwidth(J); 3 * band < f) {
    form_ = Form::band;
    band_.compute(J, band);
  } else {
    form_ = Form::factors;
    factors_.compute(J);
    lu_ = factors_.matrixLU();
    order_ = factors_.permutationP().indices();
  }
}

void NewtonInverse::apply(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  switch (form_) {
    case Form::whole:
      x.noalias() = inverse_ * b;
      break;
    case Form::band:
      x = b;
      band_.solve_in_place(x.data());
      break;
    case Form::factors:
      x.resize(b.size());
      for (Eigen::Index i = 0; i < b.size(); ++i) x[order_[i]] = b[i];
      lu_.triangularView<Eigen::UnitLower>().solveInPlace(x);
      lu_.triangularView<Eigen::Upper>().solveInPlace(x);
      break;
  }
}

}  // namespace traverse::train
