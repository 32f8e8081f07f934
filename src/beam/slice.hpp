// One rank's nodes of a beam, its rows of the beam's matrices, and how they become PETSc matrices.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "traverse/base/petsc.hpp"
#include "traverse/beam/element.hpp"

namespace traverse::beam {

/// Indices of the standard library are unsigned.
constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Which nodes a rank owns, which elements touch them, and what the supports hold there and one node beyond.
struct Slice {
  Slice(const BeamModel& model, const Mesh& mesh, int first_node, int local_nodes);

  /// Unknowns of a node: [u,] v, theta; `kind` 0 u, 1 v, 2 theta whatever the block size.
  int kinds_from() const { return 3 - block; }
  bool owns(int node) const { return node >= first && node < first + local; }
  /// For first - 1 <= node <= first + local.
  bool held(int node, int kind) const { return held_[index(3 * (node - first + 1) + kind)] != 0; }
  /// Whether an element joins node and node + 1, for first - 1 <= node < first + local.
  bool linked(int node) const { return linked_[index(node - first + 1)] != 0; }

  int block = 0, first = 0, local = 0;
  int first_element = 0, past_element = 0;  // the elements with a node in the slice

 private:
  void hold(int node, int kind);
  std::vector<char> held_, linked_;
};

/// Rows of a symmetric matrix for the nodes of a slice, held unknowns included. Axial and transverse unknowns do not
/// couple, and a node couples to its neighbours only.
class Rows {
 public:
  explicit Rows(const Slice& slice) : first_(slice.first), rows_(index(slice.local)) {}

  /// The part of an element's matrix that belongs to this slice; `left` is the element's left node.
  void add(int left, const Transverse& matrix);
  void add(int left, const Axial& matrix);
  void add(const Rows& other);

  /// Entry between an owned node and its neighbour node + offset, -1 <= offset <= 1. Zero between u and the others.
  double at(int node, int kind, int offset, int other_kind) const;

  /// Collective: without the rows and columns that supports hold. All rows have the same pattern, also where a value
  /// is zero, unless `sparse`: then only what is not zero.
  base::Handle<Mat> matrix(MPI_Comm comm, const Slice& slice, bool sparse) const;

 private:
  struct Node {
    std::array<double, 12> transverse{};  // two rows: v, theta of the left, this and the right node
    std::array<double, 3> axial{};
  };
  Node* find(int node) {
    const int i = node - first_;
    return i >= 0 && i < static_cast<int>(rows_.size()) ? &rows_[index(i)] : nullptr;
  }

  int first_ = 0;
  std::vector<Node> rows_;
};

/// True when two unknowns of neighbouring nodes can couple: both axial or both transverse.
inline bool coupled(int kind, int other_kind) { return (kind == 0) == (other_kind == 0); }

}  // namespace traverse::beam
