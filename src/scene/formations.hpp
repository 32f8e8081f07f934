// Formations: trains and road vehicles as lists of axle loads, from a table.
#pragma once

#include <string>
#include <vector>

namespace traverse::scene {

struct Formation {
  std::string name;
  double speed = 0.0;            // m/s, the highest that the train runs; infinite: not limited
  std::vector<double> loads;     // N, of each axle
  std::vector<double> distance;  // m, of each axle behind the first one, ascending
};

/// Whether the table has a column of axle loads, as all tables of formations have.
bool has_formations(const std::string& path);

/// The formations of a table. Its columns, if a row is an axle:
///   name                        of the formation, whose axles follow one another; without it the file is one formation
///   load_kN, load_t or load_N   of the axle (9.81 m/s2 times its mass in t)
///   position or spacing         m: along the train in either direction, or behind the axle before
///   speed                       m/s or km/h, the same for all axles of a formation; not required
/// If a row is a vehicle, as weigh-in-motion stations record it, it has the name of the file and the number of the row,
/// unless there is a column name. The columns are one of
///   loads_kN, loads_t or loads_N, spacings (m)    of all axles and between them, separated by blanks
///   load_1_kN, ... or load_1_t, ..., spacing_1 (m), ...
///   AWT01, ... (kg), W1_2, ... (cm), AX (number of axles), SPEED (0.01 km/h)   of the Swiss stations
/// with speed as above; others have no effect. note: receives a line on how the file is written, if it does not have
/// decimal points. InputError with file and line.
std::vector<Formation> read_formations(const std::string& path, std::string& note);

}  // namespace traverse::scene
