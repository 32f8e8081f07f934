#include "slice.hpp"

#include <algorithm>

namespace traverse::beam {

Slice::Slice(const BeamModel& model, const Mesh& mesh, int first_node, int local_nodes)
    : block(model.axial ? 3 : 2), first(first_node), local(local_nodes) {
  if (local == 0) return;
  held_.assign(3 * index(local + 2), 0);
  linked_.assign(index(local + 1), 0);

  const auto bearings = axial_bearings(model);
  for (int end = 0; end <= mesh.spans(); ++end) {
    const auto [left, right] = mesh.nodes_at(end);
    const Support s = model.supports[end];
    for (int node : {left, right}) {
      if (fixes_axial(s)) hold(node, 0);
      if (fixes_vertical(s)) hold(node, 1);
      if (fixes_rotation(s)) hold(node, 2);
    }
    if (end < mesh.spans() && bearings[end] != 0) hold(right, 0);
  }

  // Elements are sorted by their left node.
  const auto first_from = [&](int node) {
    int low = 0, high = mesh.elements();
    while (low < high) {
      const int middle = low + (high - low) / 2;
      if (mesh.element(middle).left < node) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  };
  first_element = first_from(first - 1);
  past_element = first_from(first + local);
  for (int e = first_element; e < past_element; ++e) {
    linked_[index(mesh.element(e).left - first + 1)] = 1;
  }
}

void Slice::hold(int node, int kind) {
  if (node >= first - 1 && node <= first + local) held_[index(3 * (node - first + 1) + kind)] = 1;
}

void Rows::add(int left, const Transverse& matrix) {
  if (Node* node = find(left)) {
    for (std::size_t r = 0; r < 2; ++r) {
      for (std::size_t c = 0; c < 4; ++c) node->transverse[6 * r + 2 + c] += matrix[4 * r + c];
    }
  }
  if (Node* node = find(left + 1)) {
    for (std::size_t r = 0; r < 2; ++r) {
      for (std::size_t c = 0; c < 4; ++c) node->transverse[6 * r + c] += matrix[4 * (r + 2) + c];
    }
  }
}

void Rows::add(int left, const Axial& matrix) {
  if (Node* node = find(left)) {
    node->axial[1] += matrix[0];
    node->axial[2] += matrix[1];
  }
  if (Node* node = find(left + 1)) {
    node->axial[0] += matrix[2];
    node->axial[1] += matrix[3];
  }
}

void Rows::add(const Rows& other) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (std::size_t j = 0; j < 12; ++j) rows_[i].transverse[j] += other.rows_[i].transverse[j];
    for (std::size_t j = 0; j < 3; ++j) rows_[i].axial[j] += other.rows_[i].axial[j];
  }
}

double Rows::at(int node, int kind, int offset, int other_kind) const {
  const Node& n = rows_[index(node - first_)];
  if (!coupled(kind, other_kind)) return 0.0;
  if (kind == 0) return n.axial[index(offset + 1)];
  return n.transverse[index(6 * (kind - 1) + 2 * (offset + 1) + other_kind - 1)];
}

base::Handle<Mat> Rows::matrix(MPI_Comm comm, const Slice& slice, bool sparse) const {
  std::vector<PetscInt> starts{0}, columns;
  std::vector<double> values;
  const std::size_t size = index(slice.local) * (slice.block == 3 ? 15 : 12);
  starts.reserve(index(slice.local * slice.block + 1));
  columns.reserve(sparse ? 1 : size + 1);  // at least one: PETSc takes no null pointer
  values.reserve(sparse ? 1 : size + 1);
  for (int node = slice.first; node < slice.first + slice.local; ++node) {
    const int from = slice.linked(node - 1) ? -1 : 0, to = slice.linked(node) ? 1 : 0;
    for (int kind = slice.kinds_from(); kind < 3; ++kind) {
      for (int offset = from; offset <= to && !slice.held(node, kind); ++offset) {
        for (int other = slice.kinds_from(); other < 3; ++other) {
          if (!coupled(kind, other) || slice.held(node + offset, other)) continue;
          const double value = at(node, kind, offset, other);
          if (sparse && value == 0.0) continue;
          columns.push_back((node + offset) * slice.block + other - slice.kinds_from());
          values.push_back(value);
        }
      }
      starts.push_back(static_cast<PetscInt>(columns.size()));
    }
  }

  base::Handle<Mat> matrix;
  const PetscInt rows = slice.local * slice.block;
  base::check(MatCreate(comm, matrix.out()));
  base::check(MatSetSizes(matrix, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  base::check(MatSetType(matrix, MATAIJ));
  // Each of the two has an effect on its own kind of matrix only.
  base::check(MatSeqAIJSetPreallocationCSR(matrix, starts.data(), columns.data(), values.data()));
  base::check(MatMPIAIJSetPreallocationCSR(matrix, starts.data(), columns.data(), values.data()));
  base::check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  base::check(MatSetOption(matrix, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return matrix;
}

}  // namespace traverse::beam
