// Given modes as vectors of the unknowns at their stations.
#include <algorithm>

#include "modes.hpp"

namespace traverse::modes {

Basis given_basis(const beam::Beam& beam, int count) {
  const beam::GivenModes& given = *beam.model().given;
  const std::size_t modes = std::min(given.omega.size(), static_cast<std::size_t>(count));
  Basis basis;
  basis.omega.assign(given.omega.begin(), given.omega.begin() + static_cast<std::ptrdiff_t>(modes));
  for (std::size_t i = 0; i < modes; ++i) {
    auto& shape = basis.shape.emplace_back(static_cast<std::size_t>(beam.columns()) * beam.block(), 0.0);
    for (int node = 0; node < beam.mesh().nodes(); ++node) {
      shape[static_cast<std::size_t>(beam.bridge().unknown(node, 1))] = given.shape[i][static_cast<std::size_t>(node)];
      shape[static_cast<std::size_t>(beam.bridge().unknown(node, 2))] = given.slope[i][static_cast<std::size_t>(node)];
    }
  }
  return basis;
}

}  // namespace traverse::modes
