// Compliance of the beam at the elements under the wheels: columns of A^-1 for unit loads on an element's unknowns,
// computed when a wheel enters an element (or the shift changes) and kept, since they do not change inside it.
#pragma once

#include <list>
#include <vector>

#include "traverse/coupling/beam_operator.hpp"

namespace traverse::coupling {

class Compliance {
 public:
  Compliance(const beam::Beam& beam, BeamOperator& op);

  /// Collective. Prepares the compliance between `elements` for the factorisation of these shifts, with springs added
  /// where there are some.
  void prepare(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements);

  /// Displacement of unknown i of elements[a] from a unit load on unknown j of elements[b]; i, j < 2*per_node of the
  /// line that wheels run on.
  const double* block(int a, int b) const { return &matrix_[(static_cast<std::size_t>(a) * count_ + b) * m_ * m_]; }

  /// v += A^-1 loads, where loads holds 2*per_node nodal values an element of the last prepare. This rank's slice.
  void add_response(const std::vector<double>& loads, double* v) const;

 private:
  struct Column {
    int element = 0;
    long stamp = 0;
    int low = 0, high = 0;       // local unknowns that respond above rounding
    std::vector<double> values;  // (high - low) x 2*per_node, column by column
  };
  Column& column(const BeamFactor& factor, double shift, const AddedSprings* added, long stamp,
                 int element);
  void fill_matrix();

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const beam::Line& line_;
  int m_;                              // 2*per_node
  std::list<Column> columns_;          // most recent first
  std::vector<const Column*> active_;  // of the elements of the last prepare
  std::vector<int> elements_;
  long stamp_ = -1;
  std::size_t count_ = 0;
  std::vector<double> matrix_, work_;  // [a][b] blocks, each m x m, column-major in (i, j)
};

}  // namespace traverse::coupling
