// A block tridiagonal matrix of parts that do not touch, such as simply supported spans: each part has a factor of its
// own, equal parts share one and are solved side by side as columns of it.
#pragma once

#include <cstddef>
#include <vector>

#include "solve/block_tridiagonal.hpp"

namespace traverse::solve {

/// A rank's nodes as parts; parts of one kind have the same matrices.
struct Parts {
  struct Part {
    std::ptrdiff_t first = 0, past = 0;  // nodes
    int kind = 0;
  };
  std::vector<Part> parts;   // from left to right, covering all nodes
  std::vector<int> of_kind;  // a part of each kind
  std::ptrdiff_t nodes(int kind) const {
    const Part& p = parts[static_cast<std::size_t>(of_kind[static_cast<std::size_t>(kind)])];
    return p.past - p.first;
  }
  /// The part that a node belongs to.
  const Part& at(std::ptrdiff_t node) const;
  /// The end of the run of parts of one kind from `part` on that are solved side by side and begin before node `past`.
  const Part* together(const Part* part, std::ptrdiff_t past) const;

  /// begins: the first node of each part, and one past the last. Parts are of one kind when their rows of all matrices
  /// and their fixed unknowns are the same to the last bit.
  static Parts find(const std::vector<std::ptrdiff_t>& begins, const std::vector<const BlockTridiagonal*>& matrices,
                    const std::vector<char>& fixed);
};

/// The rows of a part alone.
BlockTridiagonal rows_of(const BlockTridiagonal& matrix, const Parts::Part& part);

class SeparateParts {
 public:
  /// The layout is kept by reference.
  SeparateParts(int block_size, const Parts& layout);

  /// The matrix of a kind; `fixed` of all this rank's unknowns. See SubstructuredCholesky::factor.
  void factor(int kind, const BlockTridiagonal& A, const std::vector<char>& fixed);

  /// As SubstructuredCholesky's, without communication. A window consists of whole parts.
  void solve(double* x, int columns = 1) const;
  void solve(double* x, NodeFiller& filler) const;
  void solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past, NodeFiller& filler) const;
  void solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const;
  /// Parts like this one, side by side: x holds their nodes alone.
  void solve_together(const Parts::Part& part, double* x, int count) const { factor_of(part).solve(x, count); }
  double pivot_ratio() const;

 private:
  const SubstructuredCholesky& factor_of(const Parts::Part& part) const {
    return factors_[static_cast<std::size_t>(part.kind)];
  }

  int block_;
  const Parts& layout_;
  std::vector<SubstructuredCholesky> factors_;  // one a kind
};

}  // namespace traverse::solve
