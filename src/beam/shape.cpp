#include "traverse/beam/shape.hpp"

namespace traverse::beam {

Hermite hermite(double xi, double h) {
  const double xi2 = xi * xi, xi3 = xi2 * xi;
  Hermite s{};
  s.value = {1.0 - 3.0 * xi2 + 2.0 * xi3, h * (xi - 2.0 * xi2 + xi3), 3.0 * xi2 - 2.0 * xi3, h * (xi3 - xi2)};
  s.slope = {6.0 * (xi2 - xi) / h, 1.0 - 4.0 * xi + 3.0 * xi2, 6.0 * (xi - xi2) / h, 3.0 * xi2 - 2.0 * xi};
  s.curvature = {(12.0 * xi - 6.0) / (h * h), (6.0 * xi - 4.0) / h, (6.0 - 12.0 * xi) / (h * h), (6.0 * xi - 2.0) / h};
  s.third = {12.0 / (h * h * h), 6.0 / (h * h), -12.0 / (h * h * h), 6.0 / (h * h)};
  return s;
}

}  // namespace traverse::beam
