// A block tridiagonal matrix of uncoupled parts, such as simply supported spans. Each part has its own factor; equal
// parts share one factor and are solved together as its columns.
#pragma once

#include <cstddef>
#include <vector>

#include "solve/block_tridiagonal.hpp"

namespace traverse::solve {

/// The parts of a rank's nodes; parts of one kind have equal matrices.
struct Parts {
  struct Part {
    std::ptrdiff_t first = 0, past = 0;  // nodes
    int kind = 0;
  };
  std::vector<Part> parts;   // from left to right, covering all nodes
  std::vector<int> of_kind;  // index of a part of each kind
  std::ptrdiff_t nodes(int kind) const {
    const Part& p = parts[static_cast<std::size_t>(of_kind[static_cast<std::size_t>(kind)])];
    return p.past - p.first;
  }
  /// The part that contains a node.
  const Part& at(std::ptrdiff_t node) const;
  /// The end of the parts from `part` on that are of one kind, are solved together and begin before node `past`.
  const Part* group_end(const Part* part, std::ptrdiff_t past) const;

  /// begins: the first node of each part, and one past the last. Parts are of one kind if their rows of all matrices
  /// and their fixed unknowns are equal to the last bit.
  static Parts find(const std::vector<std::ptrdiff_t>& begins, const std::vector<const BlockTridiagonal*>& matrices,
                    const std::vector<char>& fixed);
};

/// The rows of one part.
BlockTridiagonal rows_of(const BlockTridiagonal& matrix, const Parts::Part& part);

class SeparateParts {
 public:
  /// Stores a reference to the layout.
  SeparateParts(int block_size, const Parts& layout);

  /// Factorises the matrix of a kind; `fixed` is for all this rank's unknowns. See SubstructuredCholesky::factor.
  void factor(int kind, const BlockTridiagonal& A, const std::vector<char>& fixed);

  /// Same meaning as in SubstructuredCholesky, without communication. A window must consist of whole parts.
  void solve(double* x, int columns = 1) const;
  void solve(double* x, RhsCallback& rhs_callback) const;
  void solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past, RhsCallback& rhs_callback) const;
  void solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const;
  /// Solves for `count` parts of this kind together; x contains their nodes only.
  void solve_group(const Parts::Part& part, double* x, int count) const { factor_of(part).solve(x, count); }
  double pivot_ratio() const;

 private:
  const SubstructuredCholesky& factor_of(const Parts::Part& part) const {
    return factors_[static_cast<std::size_t>(part.kind)];
  }

  int block_;
  const Parts& layout_;
  std::vector<SubstructuredCholesky> factors_;  // one per kind
};

}  // namespace traverse::solve
