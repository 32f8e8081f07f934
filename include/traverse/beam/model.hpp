// A bridge, track or rail as a user describes it: the paper's sections 2 and 3.
// Units SI; x from the left end of the first span.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace traverse::beam {

/// A quantity along x: one value, or a piecewise linear table in which a repeated x is a step.
/// Outside the table the end value holds.
class Distribution {
 public:
  Distribution(double value = 0.0) : values_{value} {}  // NOLINT: a number is a distribution
  /// x not decreasing, at most two equal in a row; throws InputError naming `name` otherwise.
  Distribution(std::vector<double> x, std::vector<double> values, const std::string& name);

  /// Value at x seen from inside the interval that lies towards `inside` (matters at a step only).
  double at(double x, double inside) const;
  bool uniform() const { return x_.empty(); }
  double minimum() const;
  double maximum() const;
  /// Stations of the table strictly inside (a, b), without repetition: where an integration has to be split.
  std::vector<double> breaks(double a, double b) const;

 private:
  std::vector<double> x_;
  std::vector<double> values_;
};

/// Kinematic conditions of the paper's 3.1 at a span end. `fixes` below says what each one holds.
enum class Support {
  free,     // nothing
  roller,   // v
  pinned,   // u and v
  clamped,  // u, v and the rotation
  guided,   // u and the rotation: slides vertically
};
bool fixes_axial(Support s);
bool fixes_vertical(Support s);
bool fixes_rotation(Support s);

/// A spring and a damper at one station (vertical or longitudinal: N/m, N s/m; rotational: N m/rad, N m s/rad).
struct PointFoundation {
  double x = 0.0;
  double k = 0.0;
  double c = 0.0;
};

/// A bed along the whole beam: N/m2 and N s/m2, neither negative.
struct Bed {
  Distribution k;
  Distribution c;
};

/// The paper's section 3: all of it linear, each kind assembled into a matrix of its own. It pushes back: the force
/// on the beam is -k v - c dv/dt. A station on an inner span end of isolated spans belongs to the right span.
/// The longitudinal kinds have no effect on a beam without axial unknowns.
struct Foundation {
  std::vector<PointFoundation> vertical;      // 3.2
  std::optional<Bed> vertical_bed;            // 3.3
  std::vector<PointFoundation> longitudinal;  // 3.4
  std::optional<Bed> longitudinal_bed;        // 3.5
  std::vector<PointFoundation> rotational;    // 3.6
};

struct BeamModel {
  std::vector<double> spans;      // m, each > 0
  std::vector<int> elements;      // one number a span, each >= 1
  Distribution EI;                // N m2, > 0
  Distribution EA;                // N, > 0 where axial
  Distribution mass;              // kg/m, > 0
  bool isolated = false;          // true: each span a beam of its own (simply supported spans)
  std::vector<Support> supports;  // one at every span end: spans + 1; isolated: an inner one serves both spans
  Foundation foundation;
  bool axial = true;  // false: no axial unknowns
  double length() const;
};

/// Throws InputError when the model cannot be assembled: the message names the option (beam_EI, support_types,
/// foundation_vertical_x, ...), its value and what is allowed. A beam that floats is no error here.
void check(const BeamModel& model);

/// One entry a span, non-zero for an isolated span that neither its supports nor a longitudinal spring or bed hold
/// along x: it is given a fixed bearing, its left end is held axially. Only where there are axial unknowns.
std::vector<char> axial_bearings(const BeamModel& model);

/// How a part of the beam (each isolated span, or the whole beam) can move without strain and without a spring's
/// force, found by counting what holds it. `rotation` alone: about the one station `pivot` that is held.
struct RigidMotion {
  int first_span = 0, last_span = 0;
  bool vertical = false, rotation = false, axial = false;
  double pivot = 0.0;  // m
};
std::vector<RigidMotion> rigid_motions(const BeamModel& model);  // one a part, from left to right

/// The first of these motions in words ("span 3 can move vertically"; spans count from 1), or empty: statics has
/// a unique answer.
std::string floating_motion(const BeamModel& model);

}  // namespace traverse::beam
