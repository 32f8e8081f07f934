// Trains of moving forces that norms define.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace traverse::app {

/// Forces, and where they are from the first axle on: backward negative.
struct AxleList {
  std::vector<double> forces;   // N, downward
  std::vector<double> offsets;  // m
};

/// Train A1 to A10, EN 1991-2, table 8.4 and figure 8.12.
AxleList hslm_a(int train);
/// HSLM-B of EN 1991-2: so many forces of 170 kN at this distance, m, both from the norm's charts over the span.
AxleList hslm_b(int forces, double distance);

/// So many of the reference wagons of one of load_en15528's lines, annex A: four axles, 9.81 m/s2.
AxleList en15528(std::string_view line, int wagons);

/// A file of two columns, x in m, which grows towards where the load runs or `backward`, and force in N. InputError.
AxleList read_axles(const std::string& path, bool backward);

}  // namespace traverse::app
