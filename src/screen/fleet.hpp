// Formations: trains as lists of axle loads, from a table or a folder of tables.
#pragma once

#include <string>
#include <vector>

namespace traverse::screen {

struct Formation {
  std::string name;
  double speed = 0.0;            // m/s, the highest that the train runs; infinite: not limited
  std::vector<double> loads;     // N, of each axle
  std::vector<double> distance;  // m, of each axle behind the first one, ascending
};

/// The formations of a table, or of all tables of a folder in the order of their names. A row is an axle. Columns:
///   name                        of the formation, whose axles follow one another; without it the file is one formation
///   load_kN, load_t or load_N   of the axle (9.81 m/s2 times its mass in t)
///   position or spacing         m: along the train in either direction, or behind the axle before
///   speed                       m/s or km/h, the same for all axles of a formation; not required
/// InputError with file and line.
std::vector<Formation> read_fleet(const std::string& path);

}  // namespace traverse::screen
