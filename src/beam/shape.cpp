#include "beam/shape.hpp"

namespace traverse::beam {

Hermite hermite(double xi, double h) {
  const double xi2 = xi * xi, xi3 = xi2 * xi;
  const double per_h = 1.0 / h, per_h2 = per_h * per_h, per_h3 = per_h2 * per_h;
  Hermite s{};
  s.value = {1.0 - 3.0 * xi2 + 2.0 * xi3, h * (xi - 2.0 * xi2 + xi3), 3.0 * xi2 - 2.0 * xi3, h * (xi3 - xi2)};
  s.slope = {6.0 * (xi2 - xi) * per_h, 1.0 - 4.0 * xi + 3.0 * xi2, 6.0 * (xi - xi2) * per_h, 3.0 * xi2 - 2.0 * xi};
  s.curvature = {(12.0 * xi - 6.0) * per_h2, (6.0 * xi - 4.0) * per_h, (6.0 - 12.0 * xi) * per_h2,
                 (6.0 * xi - 2.0) * per_h};
  s.third = {12.0 * per_h3, 6.0 * per_h2, -12.0 * per_h3, 6.0 * per_h2};
  return s;
}

}  // namespace traverse::beam
