// The exchange between contacts and structure in a stage that is solved by passes (engine/linear_train.hpp).
#pragma once

#include <array>
#include <vector>

namespace traverse::structure {

/// Values at the unknowns of the elements under contacts. The index of unknown k of an element, in the order of
/// beam::Line::unknowns, is its slot plus offset[k].
struct ContactField {
  std::array<int, 6> offset{};
  std::vector<int> slot;                    // slot of each element
  int ground = 0;                           // a slot with zeros, for rigid ground
  const double *v = nullptr, *w = nullptr;  // m and rad; their rates
  double* load = nullptr;                   // N, N m
};

}  // namespace traverse::structure
