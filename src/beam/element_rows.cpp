#include "beam/element_rows.hpp"

#include <algorithm>

namespace traverse::beam {
namespace {
constexpr std::size_t longest_period = 4 * ElementRows::tile;  // elements
}

/// h, A, B, C, D of internal_forces.hpp, then M's upper triangle.
struct ElementRows::Coefficients {
  std::array<double, stiffnesses> K{};
  std::array<double, masses> M{};
  bool operator==(const Coefficients&) const = default;
};

bool ElementRows::fit(const Beam& beam) {
  return beam.block() == 2 && beam.rail() == nullptr && beam.springs() == nullptr && beam.dampers() == nullptr;
}

ElementRows::ElementRows(const Beam& beam) : nodes_(beam.local_columns()) {
  const Line& line = beam.bridge();
  const int n = nodes_;
  if (n == 0) return;
  std::vector<Coefficients> all(static_cast<std::size_t>(n) + 1);  // zero between separate spans and beyond the ends
  const auto [from, past] = line.elements_at(beam.first_column(), n);
  const bool uniform = line.model.EI.uniform() && line.model.mass.uniform();
  double length = 0.0;
  Coefficients c;
  for (int e = from; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    if (!uniform || element.length != length) {
      const ElementMatrices m = element_matrices(line.model, element);
      const Transverse &k = m.stiffness, &M = m.mass;
      c = {{element.length, k[2], k[3], k[6], k[7]}, {M[0], M[1], M[2], M[3], M[5], M[6], M[7], M[10], M[11], M[15]}};
    }
    length = element.length;
    all[static_cast<std::size_t>(line.first_column + element.left - beam.first_column() + 1)] = c;
  }
  begins_ = all.front() == Coefficients{};
  ends_ = all.back() == Coefficients{};
  // The shortest period; elements beyond the beam's ends fit any.
  const std::size_t count = all.size(), low = begins_ ? 1 : 0, high = ends_ ? count - 1 : count;
  const auto repeats = [&](std::size_t p) {
    return low + p < high &&
           std::equal(all.begin() + static_cast<std::ptrdiff_t>(low + p),
                      all.begin() + static_cast<std::ptrdiff_t>(high), all.begin() + static_cast<std::ptrdiff_t>(low));
  };
  std::size_t period = 1;
  while (period < longest_period && !repeats(period)) ++period;
  if (period == longest_period) period = count;
  period_ = static_cast<int>(period);
  const std::size_t stored = period == count ? count : period + tile;
  for (std::size_t j = 0; j < stored; ++j) {
    std::size_t place = period == count ? j : j % period;
    if (period < count && place < low) place += period;
    append(all[place]);
  }
}

void ElementRows::append(const Coefficients& c) {
  for (std::size_t i = 0; i < c.K.size(); ++i) K_[i].push_back(c.K[i]);
  for (std::size_t i = 0; i < c.M.size(); ++i) M_[i].push_back(c.M[i]);
}

void ElementRows::multiply(int first, int past, NodalPair x, NodalPair y, NodalPair r) const {
  if (y.v != nullptr)
    products<true>(first, past, x, y, r);
  else
    products<false>(first, past, x, y, r);
}

template <bool with_mass>
void ElementRows::products(int first, int past, NodalPair x, NodalPair y, NodalPair r) const {
  const int nodes = past - first;
  const std::size_t offset = static_cast<std::size_t>(first % period_);
  const auto K = [&](std::size_t i) { return K_[i].data() + offset; };
  const auto M = [&](std::size_t i) { return M_[i].data() + offset; };
  const double *h = K(0), *A = K(1), *B = K(2), *C = K(3), *D = K(4);
  const double *m11 = M(0), *m12 = M(1), *m13 = M(2), *m14 = M(3), *m22 = M(4), *m23 = M(5), *m24 = M(6), *m33 = M(7),
               *m34 = M(8), *m44 = M(9);
  // Of each element on its left end, and on its right one.
  std::array<double, tile + 1> left_force, left_moment, right_force, right_moment;
  for (int j = 0; j <= nodes; ++j) {
    const double turn = x.theta[j + 1] - x.theta[j];
    const double rise = x.v[j + 1] - x.v[j] - h[j] * x.theta[j];
    const double f = A[j] * rise + B[j] * turn;
    const double m = C[j] * rise + D[j] * turn;
    if constexpr (with_mass) {
      const double v1 = y.v[j], t1 = y.theta[j], v2 = y.v[j + 1], t2 = y.theta[j + 1];
      left_force[j] = f + m11[j] * v1 + m12[j] * t1 + m13[j] * v2 + m14[j] * t2;
      left_moment[j] = m + m12[j] * v1 + m22[j] * t1 + m23[j] * v2 + m24[j] * t2;
      right_force[j] = m13[j] * v1 + m23[j] * t1 + m33[j] * v2 + m34[j] * t2 - f;
      right_moment[j] = f * h[j] - m + m14[j] * v1 + m24[j] * t1 + m34[j] * v2 + m44[j] * t2;
    } else {
      left_force[j] = f;
      left_moment[j] = m;
      right_force[j] = -f;
      right_moment[j] = f * h[j] - m;
    }
  }
  if (first == 0 && begins_) right_force[0] = right_moment[0] = 0.0;
  if (past == nodes_ && ends_) left_force[nodes] = left_moment[nodes] = 0.0;
  for (int i = 0; i < nodes; ++i) {
    r.v[i] = right_force[i] + left_force[i + 1];
    r.theta[i] = right_moment[i] + left_moment[i + 1];
  }
}

}  // namespace traverse::beam
