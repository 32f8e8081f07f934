// A bridge, track or rail as the user describes it (sections 2 and 3 of the paper), also a bridge by natural modes from
// another program's model or from a measurement. Units are SI; x is measured from the left end of the first span.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "traverse/beam/foundation.hpp"
#include "traverse/beam/layered_track.hpp"

namespace traverse::beam {

struct GivenModes {
  /// A further result that follows from the modal coordinates: a stress, a moment, a bearing's force.
  struct Output {
    std::string name, unit;
    std::vector<double> of_mode;  // value for each mode at a modal coordinate of 1 m kg^(1/2), in `unit`
  };

  std::string source;                      // the file of the modes, for messages
  std::vector<double> x;                   // m, ascending from 0, the left end of the bridge, to its right end
  std::vector<double> omega, ratio;        // rad/s, ascending, above 0; damping ratios
  std::vector<std::vector<double>> shape;  // [mode][station]: upward, m for 1 m kg^(1/2) of the mode's coordinate
  std::vector<std::vector<double>> slope;  // slope of the shapes, 1/m
  std::vector<Output> outputs;
};

/// Slopes of a cubic spline through values at x. The curvature is continuous. The slope at each end is the slope of the
/// cubic through the four stations there, or of the polynomial through all stations if there are fewer than four.
std::vector<double> spline_slopes(const std::vector<double>& x, const std::vector<double>& values);

/// Kinematic conditions at a span end (section 3.1 of the paper), with the displacements that each condition fixes.
enum class Support {
  free,     // nothing
  roller,   // v
  pinned,   // u and v
  clamped,  // u, v and the rotation
  guided,   // u and the rotation: slides vertically
  along,    // u
};
bool fixes_axial(Support s);
bool fixes_vertical(Support s);
bool fixes_rotation(Support s);

/// The connection of the beam to its continuation at an inner span end.
enum class Joint {
  continuous,  // no jump
  hinge,       // the slope may jump: no moment there
  separate,    // two beams that end side by side on one support
  cracked,     // the slope may jump against a rotational spring
  expansion,   // the displacement along x may jump: no axial force there
};

/// A crack: a rotational spring between the beam's two sides.
struct Crack {
  double x = 0.0;  // m
  double k = 0.0;  // N m/rad, > 0
};

/// A mass that moves with the beam at a station.
struct PointMass {
  double x = 0.0;     // m
  double mass = 0.0;  // kg
};

/// A tuned mass damper: a mass that a spring and a dashpot carry on the beam, and that moves vertically. At rest under
/// gravity its spring has the length at which its travel is zero.
struct MassDamper {
  std::string name;
  double x = 0.0;     // m
  double mass = 0.0;  // kg, > 0
  double k = 0.0;     // N/m, > 0
  double c = 0.0;     // N s/m
};

/// Temperature change since the beam was built. An unloaded free beam lengthens; if its top is warmer than its bottom,
/// it bends convex upward.
struct Temperature {
  double uniform = 0.0;    // K
  double gradient = 0.0;   // K, top minus bottom
  double expansion = 0.0;  // 1/K
  double depth = 1.0;      // m, between top and bottom

  double strain() const { return expansion * uniform; }               // 1, positive in elongation
  double curvature() const { return -expansion * gradient / depth; }  // 1/m, positive in sagging
};

/// Torsion of the beam: the twist of its sections about the line of their shear centres, to which the deflection v of
/// the beam belongs. It is positive if the left side, seen along x, goes up: a point at the distance e to the left of
/// the shear centre has the deflection v + e*twist. With the twist p, the inertia I about the shear centre and an
/// external moment t per length:  I p'' (in time) - (GJ p')' + (EC p'')'' = t.
/// A line along the beam on which wheels or forces act: a track at a distance to the left of the shear centre, or a
/// line above it at which forces to the left act, which only twist the beam. In a curve or on a canted track the
/// weights act at shift + shift_by_speed v^2 to the left of the track, at the speed v.
struct ActionLine {
  double lever = 0.0;  // m, from the shear centre: to the left, or upward if sideways
  bool sideways = false;
  double shift = 0.0;           // m
  double shift_by_speed = 0.0;  // s2/m
  bool operator==(const ActionLine&) const = default;
  bool shifts() const { return shift != 0.0 || shift_by_speed != 0.0; }
};

struct Torsion {
  Distribution GJ;                      // N m2, > 0: stiffness of St. Venant
  std::optional<Distribution> warping;  // N m4, > 0: stiffness EC against warping (Vlasov); empty: none
  Distribution inertia;                 // kg m, > 0: moment of inertia of the mass per length about its centre
  double shear_centre = 0.0;            // m, to the left of the axis from which the user measures; for results
  double mass_centre = 0.0;             // m, to the left of the shear centre
  std::vector<char> held;               // at each span end: non-zero if the support holds the twist
  std::vector<double>
      bearing_spacing;  // m, between the two bearings of each support that holds the twist; 0: not known
  std::vector<ActionLine> tracks = {{}};  // those that carry wheels or forces

  bool shifts() const { return std::ranges::any_of(tracks, &ActionLine::shifts); }
};

struct BeamModel {
  std::vector<double> spans;  // m, each > 0
  std::vector<int> elements;  // number per span, each >= 1; with a layered track the mesh of its rail is used instead
  Distribution EI;            // N m2, > 0
  Distribution EA;            // N, > 0 where axial
  std::optional<Distribution> GA;         // N, > 0: shear stiffness kappa G A; empty: no shear deformation
  Distribution mass;                      // kg/m, > 0
  Distribution rotary_inertia;            // kg m, >= 0: rho I of a section about its neutral axis
  std::vector<Joint> joints;              // at the inner span ends, one for all or one each; empty: continuous
  std::vector<double> hinges;             // further hinges within spans, m, ascending
  std::vector<Crack> cracks;              // ascending, none at a hinge
  std::vector<double> expansion_devices;  // stations of a rail at which u may jump, m, ascending, none at a hinge
  std::vector<double> cuts;               // stations of additional nodes, m, ascending
  std::vector<PointMass> point_masses;    // with a node at each, unless the beam has a layered track
  std::vector<MassDamper> dampers;        // likewise
  std::vector<Support> supports;   // one at every span end: spans + 1; separate spans share the support between them
  std::vector<double> settlement;  // m upward, settlements of supports that fix v: one at every span end, or empty
  std::vector<double> shift;       // m along the beam, displacements of supports that fix u: likewise
  std::optional<Temperature> temperature;
  std::optional<Torsion> torsion;  // empty: the beam does not twist
  Foundation foundation;
  std::optional<LayeredTrack> track;
  std::optional<GivenModes>
      given;                    // the bridge consists of these modes, with one element between neighbouring stations
  bool axial = true;            // false: no axial unknowns
  double start = 0.0;           // x of the left end, m; 0 except for a rail that begins before the bridge
  double surface_height = 0.0;  // height of the running surface above the neutral axis, m; forces along x act there
  double gradient = 0.0;        // tan of the angle of the x axis: weight has the component -gradient along x
  bool nodes_at_steps = true;   // whether the mesh has nodes at jumps of EI and mass
  std::array<bool, 2> ground = {true, true};  // whether the rigid running surface continues before and behind the beam

  /// The length of all spans and the x of the right end, m.
  double length() const;
  double end() const { return start + length(); }
  /// The joint at an inner span end, 1 <= span_end < spans.
  Joint joint(int span_end) const;
  /// Whether all spans are separate beams.
  bool all_separate() const;
  /// Whether settlements or temperature deform the beam without a load.
  bool strained() const;
  /// Whether a part of the foundation or the sleepers (over a gap, or sliding) have a nonlinear law.
  bool nonlinear() const { return foundation.nonlinear() || (track && (track->hangs() || track->slides())); }
};

/// The beam model of a bridge by given modes, with elements between the stations of the shapes. The elements
/// interpolate the shapes; they contribute no flexibility and no weight.
BeamModel bridge_of(GivenModes modes);

/// Whether a kind of foundation acts on the beam: the longitudinal kinds need axial unknowns.
inline bool acts(const FoundationKind& kind, const BeamModel& model) {
  return model.axial || kind.direction != Direction::longitudinal;
}

/// A range of elements of equal length: a span, or a part of it between hinges and jumps of EI and mass.
struct Piece {
  int span = 0;
  double left = 0.0, right = 0.0;  // m
  int elements = 0;
  Joint next = Joint::continuous;  // joint to the next piece; separate for the last piece
  bool ends_span = true;
};
std::vector<Piece> pieces_of(const BeamModel& model);

/// The nodes of the rail in a model with a layered track: node i is at start + i*element, and every elements_per_bay-th
/// node is at a sleeper.
struct RailMesh {
  double start = 0.0, element = 0.0;  // m
  int elements = 0;
  double x(int node) const { return start + node * element; }
  /// The first node at or after x, within rounding.
  int first_from(double x) const;
};
RailMesh rail_mesh(const BeamModel& model);

/// The bridge without its layered track and its mass dampers. The ballast on the bridge (without ballast its sleepers)
/// becomes a uniform mass per length. Damping ratios refer to the frequencies of this beam.
BeamModel bridge_alone(const BeamModel& model);

/// The model with linear foundations, for small motions about the static equilibrium: a foundation without a gap acts
/// by its k and c, a foundation with a gap does not act, and sleepers over a gap hang on the rail.
BeamModel linearised(const BeamModel& model);

/// The rail as a beam, eqs. 1-12, free at both ends and without foundation; the layers connect it to the sleepers.
BeamModel rail_model(const BeamModel& model);

/// Throws InputError if the model cannot be assembled. The message names the option (beam_EI, support_types,
/// foundation_vertical_x, ...), its value and the allowed values. A floating beam is not an error here.
void check(const BeamModel& model);

/// One entry per span, non-zero if the span is one of several separate beams and no support, longitudinal spring or bed
/// holds it along x. The left end of such a span has a fixed bearing. Only with axial unknowns.
std::vector<char> axial_bearings(const BeamModel& model);

/// A motion of one part of the beam without strain and without spring forces: along x, or a chain of straight segments
/// between hinges. A part is the beam between its ends and separate joints.
struct RigidMotion {
  double left = 0.0, right = 0.0;  // ends of the part, m
  bool axial = false;
  std::vector<double> x;           // stations of the part's ends and hinges
  std::vector<double> deflection;  // deflection at the stations; for an axial motion the displacement along x
  double twist = 0.0;              // rad, if the deflections are in m

  /// Deflection and slope at a station of the part; at a hinge the slope on its right, or on its left.
  double value(double station) const;
  double slope(double station, bool from_left) const;
};
/// All rigid motions that the linear supports and foundations allow, from left to right. A model with a layered track
/// has none. Nonlinear foundations are ignored, because the matrices do not contain them.
std::vector<RigidMotion> rigid_motions(const BeamModel& model);

/// The description of the first motion that nothing resists, or empty. A foundation that is one-sided or has a gap is
/// treated as a resistance; the static solution determines whether it acts.
std::string floating_motion(const BeamModel& model);

/// Throws InputError that names the option if only springs resist a rigid motion and are so soft that rounding of the
/// stiffness of the elements hides them.
void check_springs(const BeamModel& model);

}  // namespace traverse::beam
