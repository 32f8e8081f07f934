#include "run/span_modes.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace traverse::app {
namespace {

/// The columns of M or K of one part of each kind, one unit displacement at a time in all of them.
std::vector<Eigen::MatrixXd> matrices(const structure::BeamOperator& op, bool mass) {
  const solve::Parts& parts = *op.parts();
  const auto kinds = static_cast<int>(parts.of_kind.size());
  std::vector<Eigen::MatrixXd> of_kind;
  Eigen::Index largest = 0;
  for (int k = 0; k < kinds; ++k) {
    const Eigen::Index size = 2 * parts.nodes(k);
    of_kind.emplace_back(size, size);
    largest = std::max(largest, size);
  }
  std::vector<double> unit(static_cast<std::size_t>(op.unknowns())), product(unit.size());
  const auto first = [&](int k) {
    return 2 * parts.parts[static_cast<std::size_t>(parts.of_kind[static_cast<std::size_t>(k)])].first;
  };
  for (Eigen::Index i = 0; i < largest; ++i) {
    std::fill(unit.begin(), unit.end(), 0.0);
    for (int k = 0; k < kinds; ++k)
      if (i < of_kind[static_cast<std::size_t>(k)].rows()) unit[static_cast<std::size_t>(first(k) + i)] = 1.0;
    op.multiply(1.0, mass ? unit.data() : nullptr, nullptr, mass ? nullptr : unit.data(), product.data());
    for (int k = 0; k < kinds; ++k) {
      Eigen::MatrixXd& to = of_kind[static_cast<std::size_t>(k)];
      if (i < to.rows()) to.col(i) = Eigen::Map<const Eigen::VectorXd>(product.data() + first(k), to.rows());
    }
  }
  return of_kind;
}

lanes::SpanKind kind_of(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const char* fixed, double length,
                        beam::Rayleigh rayleigh) {
  std::vector<Eigen::Index> unknowns;
  for (Eigen::Index i = 0; i < M.rows(); ++i)
    if (fixed[i] == 0) unknowns.push_back(i);
  const Eigen::MatrixXd stiffness = K(unknowns, unknowns), inertia = M(unknowns, unknowns);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(stiffness, inertia);
  lanes::SpanKind kind;
  kind.elements = static_cast<int>(M.rows()) / 2 - 1;
  kind.length = length;
  const auto modes = static_cast<std::size_t>(solved.eigenvalues().size());
  kind.shape.assign(static_cast<std::size_t>(M.rows()) * modes, 0.0);
  for (std::size_t m = 0; m < modes; ++m) {
    const auto column = static_cast<Eigen::Index>(m);
    kind.omega2.push_back(solved.eigenvalues()[column]);
    kind.damping.push_back(rayleigh.a + rayleigh.b * kind.omega2.back());
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      kind.shape[static_cast<std::size_t>(unknowns[i]) * modes + m] =
          solved.eigenvectors()(static_cast<Eigen::Index>(i), column);
  }
  return kind;
}

}  // namespace

lanes::SpanPlan spans_of(const beam::Beam& beam, const structure::BeamOperator& op) {
  const solve::Parts& parts = *op.parts();
  const beam::Mesh& mesh = beam.mesh();
  lanes::SpanPlan plan;
  const std::vector<Eigen::MatrixXd> M = matrices(op, true), K = matrices(op, false);
  for (std::size_t k = 0; k < M.size(); ++k) {
    const auto part = static_cast<std::size_t>(parts.of_kind[k]);
    const int first = mesh.nodes_at(static_cast<int>(part)).second;
    plan.kinds.push_back(kind_of(M[k], K[k], beam.fixed().data() + 2 * parts.parts[part].first,
                                 mesh.x(first + 1) - mesh.x(first), beam.rayleigh()));
  }
  for (std::size_t s = 0; s < parts.parts.size(); ++s)
    plan.spans.push_back({static_cast<std::size_t>(parts.parts[s].kind), mesh.span_ends()[s], mesh.span_ends()[s + 1]});
  return plan;
}

std::vector<double> modal_coordinates(const beam::Beam& beam, const structure::BeamOperator& op,
                                      const lanes::SpanPlan& plan, const double* v) {
  std::vector<double> momentum(static_cast<std::size_t>(op.unknowns()));
  op.multiply(1.0, v, nullptr, nullptr, momentum.data());
  for (std::size_t i = 0; i < momentum.size(); ++i)
    if (beam.fixed()[i] != 0) momentum[i] = 0.0;
  const auto stride = static_cast<std::size_t>(lanes::SpanCrossing::stride_of(plan.kinds));
  std::vector<double> q(plan.spans.size() * stride, 0.0);
  for (std::size_t s = 0; s < plan.spans.size(); ++s) {
    const lanes::SpanKind& kind = plan.kinds[plan.spans[s].kind];
    const Eigen::Index unknowns = 2 * static_cast<Eigen::Index>(kind.elements + 1);
    using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Eigen::VectorXd>(&q[s * stride], kind.modes()) =
        Eigen::Map<const ByRows>(kind.shape.data(), unknowns, kind.modes()).transpose() *
        Eigen::Map<const Eigen::VectorXd>(momentum.data() + 2 * op.parts()->parts[s].first, unknowns);
  }
  return q;
}

}  // namespace traverse::app
