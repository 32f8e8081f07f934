// N four-bar linkages side by side, a benchmark of singular positions: 2N + 1 rods of 1 m and 1 kg. N + 1 rods are
// cranks on the ground, 1 m apart; N rods are couplers between the ends of neighbouring cranks.
#pragma once

#include <string>

namespace traverse::test {

/// The options of the vehicle: the cranks are upright at the start, and the couplers' points move at 1 m/s along +x.
std::string four_bars(int n);

}  // namespace traverse::test
