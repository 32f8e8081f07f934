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

  /// Collective. Prepares the compliance between `elements` for the factorisation of `shift`, with springs added where
  /// there are some.
  void prepare(double shift, const AddedSprings* added, const std::vector<int>& elements);

  /// The elements of the last prepare that respond to a load on one of them: [first, last) of their list.
  struct Response {
    int first = 0, last = 0;
    std::size_t begin = 0;  // of their blocks
  };
  const Response& response(int b) const { return responses_[b]; }
  /// Displacement of unknown i of elements[a] from a unit load on unknown j of elements[b], at (i, j) of a matrix of
  /// 2*per_node rows stored by columns; a in the response to b.
  const double* block(int a, int b) const {
    const Response& r = responses_[b];
    return &blocks_[r.begin + static_cast<std::size_t>(a - r.first) * m_ * m_];
  }

  /// v += A^-1 loads, where loads holds 2*per_node nodal values an element of the last prepare. This rank's slice.
  void add_response(const std::vector<double>& loads, double* v) const;

 private:
  struct Column {
    int element = 0;
    long stamp = 0;
    int low = 0, high = 0;       // local unknowns that respond above rounding
    int first = 0, last = 0;     // the columns of the beam on all ranks that do: [first, last)
    std::vector<double> values;  // (high - low) x 2*per_node, column by column
  };
  Column& column(const solve::SubstructuredCholesky& factor, double shift, const AddedSprings* added, long stamp,
                 int element);
  void keep(Column& c) const;
  void find_places(long stamp);
  void find_responses();
  void fill_blocks();

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const beam::Line& line_;
  int m_;                                           // 2*per_node
  std::list<Column> columns_;                       // most recent first
  std::size_t kept_ = 0;                            // doubles in them
  std::vector<std::list<Column>::iterator> place_;  // of every element's column of the last prepare's stamp, or the end
  std::vector<const Column*> active_;               // of the elements of the last prepare
  std::vector<int> elements_;
  long stamp_ = -1;
  std::vector<Response> responses_;
  std::vector<double> blocks_, work_;  // by the element loaded, then by the one that responds
};

}  // namespace traverse::coupling
