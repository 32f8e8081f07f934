// Trains of moving forces that standards define.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formations.hpp"

namespace traverse::scene {

/// Forces and their positions relative to the first axle.
struct AxleList {
  std::vector<double> forces;   // N, downward
  std::vector<double> offsets;  // m, negative behind the first axle
};

/// Train A1 to A10, EN 1991-2, table 8.4 and figure 8.12.
AxleList hslm_a(int train);
/// HSLM-B of EN 1991-2: a number of forces of 170 kN at a distance, m. Both follow from the standard's charts over the
/// span.
AxleList hslm_b(int forces, double distance);

/// A number of reference wagons of a line category of EN 15528, annex A: four axles, 9.81 m/s2.
AxleList en15528(std::string_view line, int wagons);

/// The axles of a formation, whose first one is in front.
AxleList axles_of(const Formation& formation);

/// The forces of two columns: x in m, growing in the travel direction or `backward`, and force in N.
AxleList axles_of(const std::vector<std::vector<double>>& columns, bool backward);

}  // namespace traverse::scene
