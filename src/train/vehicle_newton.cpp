// Flexibility H = G J^-1 G^T of a vehicle at its contacts, where G are the contact directions projected onto the
// independent coordinates, and back-substitution of the contact forces. The inverse is explicit up to 24 degrees of
// freedom, a banded or dense LU factorisation above, and the pseudo-inverse for matrices that may be singular
// (statics).
#include "vehicle_newton.hpp"

#include <algorithm>

#include "train/fleet.hpp"

namespace traverse::train {
namespace {

constexpr int small_vehicle = 24;  // degrees of freedom up to which the Newton matrix is inverted explicitly

}  // namespace

void VehicleNewton::multiply_directions(ContactRows rows, const ColumnRanges& columns, const Eigen::MatrixXd& B,
                                        RowMatrix& G) {
  G.setZero(static_cast<Eigen::Index>(rows.size()), B.cols());
  for (int i = 0; i < G.rows(); ++i) {
    const ContactRow& row = rows[static_cast<std::size_t>(i)];
    const Contact& c = *row.contact;
    const auto add = [&](int body, const Eigen::Vector3d& direction) {
      const auto [first, last] = columns[body];
      G.row(i).segment(first, last - first).noalias() +=
          direction.transpose() * B.block(3 * static_cast<Eigen::Index>(body), first, 3, last - first);
    };
    add(c.body, row.normal ? c.touch.normal_on_body : c.touch.tangent_on_body);
    if (c.other_body != multibody::ground)
      add(c.other_body, row.normal ? c.touch.normal_on_other : c.touch.tangent_on_other);
  }
}

void VehicleNewton::renew(ContactRows rows, const ColumnRanges& columns, const Eigen::MatrixXd& B,
                          const RowMatrix* projected, bool statics, Eigen::MatrixXd& J, ContactCompliance& compliance) {
  const auto f = J.rows();
  const auto r = static_cast<int>(rows.size());
  multiply_directions(rows, columns, B, G_);
  range_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Contact& c = *rows[i].contact;
    range_[i] = columns[c.body];
    if (c.other_body == multibody::ground) continue;
    const multibody::ColumnRange other = columns[c.other_body];
    range_[i] = {std::min(range_[i].first, other.first), std::max(range_[i].last, other.last)};
  }
  const RowMatrix& left = projected != nullptr ? *projected : G_;
  if (statics) add_contacts(left, compliance.D, J);
  inverse_.compute(J, statics);
  Y_.resize(f, r);
  for (int i = 0; i < r; ++i) {
    s_ = left.row(i).transpose();
    inverse_.apply(s_, dx_);
    Y_.col(i) = dx_;
  }
  compliance.H.resize(r, r);
  compliance.c.resize(r);
  for (int i = 0; i < r; ++i) {
    const auto [first, last] = range_[i];
    compliance.H.row(i).noalias() = G_.row(i).segment(first, last - first) * Y_.middleRows(first, last - first);
  }
}

// J += G^T D G. The first column of D belongs to tangential rows.
void VehicleNewton::add_contacts(const RowMatrix& left, const RowTangent& D, Eigen::MatrixXd& J) {
  DG_.resize(G_.rows(), G_.cols());
  for (int i = 0; i < G_.rows(); ++i) {
    DG_.row(i) = D(i, 1) * G_.row(i);
    if (D(i, 0) != 0.0) DG_.row(i) += D(i, 0) * G_.row(i - 1);
  }
  J.noalias() += left.transpose() * DG_;
}

void VehicleNewton::compute_free_displacement(const Eigen::VectorXd& R, ContactCompliance& compliance) {
  inverse_.apply(R, dx_);
  dx_ = -dx_;
  for (int i = 0; i < compliance.c.size(); ++i) {
    const auto [first, last] = range_[i];
    compliance.c[i] = G_.row(i).segment(first, last - first).dot(dx_.segment(first, last - first));
  }
}

const Eigen::VectorXd& VehicleNewton::coordinate_change(const Eigen::VectorXd& forces) {
  for (int i = 0; i < forces.size(); ++i) dx_ -= forces[i] * Y_.col(i);
  return dx_;
}

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
