// Bridges of a stock: continuous beams with uniform stiffness and mass on simple supports, which may twist between
// forks at all of them.
#pragma once

#include <string>
#include <vector>

#include "traverse/options/verdict_limit.hpp"

namespace traverse::screen {

struct Bridge {
  std::string name;
  std::vector<double> spans;             // m
  double EI = 0.0;                       // N m2
  double mass = 0.0;                     // kg/m
  double eccentricity = 0.0;             // m: distance of the track from the axis; 0: the bridge does not twist
  double GJ = 0.0, polar_inertia = 0.0;  // N m2, kg m, of a bridge that twists
  double damping = 0.0;                  // ratio of each mode
  double speed = 0.0;                    // m/s, of the line; infinite: not limited
  // Factors that make responses fractions of their limits, 1/(m/s2) and 1; 0: no limit. The second one is of the
  // deflection over the span.
  double of_acceleration = 0.0, of_deflection = 0.0;
};

/// Hz, of bending.
double first_frequency(const Bridge& bridge);

/// The bridges of a table. A row is a bridge. Columns:
///   name
///   spans              m, separated by blanks: 20 or 20 25 20
///   mass               kg/m, with the track
///   EI or f1           N m2, or the first frequency in Hz
///   eccentricity       m, from the axis to the track of the trains; not required. Unless it is 0, the bridge twists:
///   GJ or torsional_frequency  N m2, or the first frequency of torsion in Hz
///   polar_inertia      kg m, of the mass
///   damping or type    ratio, or steel, composite, prestressed, reinforced or filler_beam: EN 1991-2, table 6.6
///   speed              m/s or km/h of the line; not required
///   deck_acceleration  m/s2, deflection_over_span: instead of the values of `limits`; not required
/// notes: receives a line on how the file is written, if it does not have decimal points. InputError with file and
/// line.
std::vector<Bridge> read_stock(const std::string& path, const std::vector<options::VerdictLimit>& limits,
                               std::vector<std::string>& notes);

}  // namespace traverse::screen
