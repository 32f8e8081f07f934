// N four-bar linkages side by side, a benchmark of singular positions: 2N + 1 rods of 1 m and 1 kg, N + 1 of them
// cranks on the ground 1 m apart, N couplers from one crank's end to the next one's.
#pragma once

#include <string>

namespace traverse::test {

/// A vehicle's options: rods upright at the start, coupler points moving at 1 m/s along +x.
std::string four_bars(int n);

}  // namespace traverse::test
