// A bridge, track or rail as a user describes it: the paper's sections 2 and 3.
// Units SI; x from the left end of the first span.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "traverse/beam/foundation.hpp"
#include "traverse/beam/given_modes.hpp"
#include "traverse/beam/layered_track.hpp"

namespace traverse::beam {

/// Kinematic conditions of the paper's 3.1 at a span end. `fixes` below says what each one holds.
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

/// What joins the beam to its continuation at an inner span end.
enum class Joint {
  continuous,  // it goes through
  hinge,       // it goes through, but its slope may jump: no moment there
  separate,    // two beams that end there, side by side on one support
  cracked,     // it goes through, but its slope may jump against a rotational spring
  expansion,   // it goes through, but its displacement along x may jump: no axial force there
};

/// A crack: a rotational spring between the beam's two sides.
struct Crack {
  double x = 0.0;  // m
  double k = 0.0;  // N m/rad, > 0
};

/// What the beam would do by itself since it was built in: it lengthens and, warmer above than below, curves upward.
struct Temperature {
  double uniform = 0.0;    // K
  double gradient = 0.0;   // K, of the top over the bottom
  double expansion = 0.0;  // 1/K
  double depth = 1.0;      // m, over which the gradient is

  double strain() const { return expansion * uniform; }               // 1, positive in elongation
  double curvature() const { return -expansion * gradient / depth; }  // 1/m, positive in sagging
};

struct BeamModel {
  std::vector<double> spans;       // m, each > 0
  std::vector<int> elements;       // one number a span, each >= 1; with a layered track its rail's mesh decides instead
  Distribution EI;                 // N m2, > 0
  Distribution EA;                 // N, > 0 where axial
  std::optional<Distribution> GA;  // N, > 0: shear stiffness kappa G A; none: the beam does not shear
  Distribution mass;               // kg/m, > 0
  Distribution rotary_inertia;     // kg m, >= 0: of a section about its neutral axis, rho I
  std::vector<Joint> joints;       // at the inner span ends, one for all or one each; empty: continuous
  std::vector<double> hinges;      // further hinges within spans, m, ascending
  std::vector<Crack> cracks;       // ascending, none at a hinge
  std::vector<double> expansion_devices;  // of a rail: stations where it may lengthen, m, ascending, none at a hinge
  std::vector<double> cuts;               // stations that always get a node, m, ascending
  std::vector<Support> supports;          // one at every span end: spans + 1; where spans are separate it serves both
  std::vector<double> settlement;         // m upward, of what holds v there: one at every span end, or none at all
  std::optional<Temperature> temperature;
  Foundation foundation;
  std::optional<LayeredTrack> track;
  std::optional<GivenModes> given;  // the bridge is these modes, between whose stations it has one element each
  bool axial = true;                // false: no axial unknowns
  double start = 0.0;               // x of the left end, m: 0, but for a rail that begins before the bridge
  double surface_height = 0.0;      // of the running surface above the neutral axis, m: forces along x act up there
  bool nodes_at_steps = true;       // of EI and mass
  std::array<bool, 2> ground = {true, true};  // whether the rigid running surface goes on before and behind it

  /// The length of all spans and the x of the right end, m.
  double length() const;
  double end() const { return start + length(); }
  /// At an inner span end, 1 <= span_end < spans.
  Joint joint(int span_end) const;
  /// Whether all its spans are beams of their own.
  bool all_separate() const;
  /// Whether settlements or temperature bend or stretch it without a load.
  bool strained() const;
  /// Whether some of its foundation, or sleepers over a gap or that slide, obey a law that is not linear.
  bool nonlinear() const { return foundation.nonlinear() || (track && (track->hangs() || track->slides())); }
};

/// A bridge of given modes: what its elements are between the stations of the shapes. They carry the shapes and
/// neither bend nor weigh.
BeamModel bridge_of(GivenModes modes);

/// Whether a kind of foundation has an effect on the beam: a longitudinal one needs axial unknowns.
inline bool acts(const FoundationKind& kind, const BeamModel& model) {
  return model.axial || kind.direction != Direction::longitudinal;
}

/// A run of elements of one length: a span, or what hinges and steps of EI and mass leave of it.
struct Piece {
  int span = 0;
  double left = 0.0, right = 0.0;  // m
  int elements = 0;
  Joint next = Joint::continuous;  // what joins it to the next piece; of the last one: separate
  bool ends_span = true;
};
std::vector<Piece> pieces_of(const BeamModel& model);

/// The sleepers and the rail's nodes of a model with a layered track: node i stands at rail_start + i*rail_element,
/// a sleeper at every elements_per_bay-th of them.
struct RailMesh {
  double start = 0.0, element = 0.0;  // m
  int elements = 0;
  double x(int node) const { return start + node * element; }
  /// The first node at or after x, within rounding.
  int first_from(double x) const;
};
RailMesh rail_mesh(const BeamModel& model);

/// The bridge without its layered track, whose ballast (without ballast its sleepers) is spread over its length: the
/// mean of what stands on the bridge. Damping ratios refer to the frequencies of this beam.
BeamModel bridge_alone(const BeamModel& model);

/// With every foundation linear, as it acts about rest under load: without a gap by its k and c, with one not at all.
/// Sleepers over a gap hang on the rail. Its frequencies are those of small motions.
BeamModel linearised(const BeamModel& model);

/// The rail as a beam, eqs. 1-12: free at both ends, without foundation; its layers join it to the sleepers.
BeamModel rail_model(const BeamModel& model);

/// Throws InputError when the model cannot be assembled: the message names the option (beam_EI, support_types,
/// foundation_vertical_x, ...), its value and what is allowed. A beam that floats is no error here.
void check(const BeamModel& model);

/// One entry a span, non-zero for one of several separate beams that neither supports nor a longitudinal spring or bed
/// hold along x: its left end is given a fixed bearing. Only where there are axial unknowns.
std::vector<char> axial_bearings(const BeamModel& model);

/// A motion without strain and without a spring's force of one part of the beam (what lies between its ends and
/// separate joints): along x, or a chain of straight pieces between hinges.
struct RigidMotion {
  double left = 0.0, right = 0.0;  // of the part, m
  bool axial = false;
  std::vector<double> x;           // stations of the part's ends and hinges
  std::vector<double> deflection;  // there; of an axial motion the displacement along x

  /// Deflection and slope at a station of the part; at a hinge the slope to its right, or to its left.
  double value(double station) const;
  double slope(double station, bool from_left) const;
};
/// All of them, found from what holds each part, from left to right. A model with a layered track has none.
/// What has a law that is not linear does not count: these are the motions that the matrices know.
std::vector<RigidMotion> rigid_motions(const BeamModel& model);

/// The first motion that nothing at all resists, in words, or empty. A foundation that is one-sided or has a gap
/// counts as resisting; the static solution finds out whether it does.
std::string floating_motion(const BeamModel& model);

}  // namespace traverse::beam
