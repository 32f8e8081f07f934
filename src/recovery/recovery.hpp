// Response at any station: deflection from the shape functions, moment and shear from the element's equilibrium. A load
// that is spread over a part of an element acts as point loads of a Gauss rule.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/gauss.hpp"
#include "beam/beam.hpp"
#include "beam/section.hpp"

namespace traverse::recovery {

/// A load on an element (of the beam, or of a track: beam::Mesh::element), at xi: fx, fy in N (fy upward), moment in N
/// m counter-clockwise, torque about the line of shear centres in N m, positive as the twist. It moves with `speed`
/// along x, m/s, and keeps its number `source`, which no other load of a list has; -1: a load that does not move.
struct ElementLoad {
  int element = 0;
  double xi = 0.0;
  double fx = 0.0, fy = 0.0, moment = 0.0;
  double speed = 0.0;
  double extent = 0.0;  // the load is spread uniformly over xi -+ extent/2 within the element; 0: concentrated
  int source = -1;
  double torque = 0.0;

  /// Turns a force on a line of action into what it is on the line of shear centres.
  void move_from(const beam::ActionLine& line) {
    torque = line.lever * fy;
    if (line.sideways) fy = 0.0;
  }
};

/// Response at one station. Deflection positive upward, moment positive in sagging (EI v'' > 0),
/// shear = d moment/dx.
struct Response {
  double deflection = 0.0, velocity = 0.0, acceleration = 0.0;  // in space
  double relative_deflection = 0.0;                             // to the line through the supports (beam/mesh.hpp)
  double twist = 0.0, torsional_moment = 0.0;                   // rad; N m, positive as the twist on a right section
  double twist_along = 0.0;                                     // rad/m: the rate of the twist along x
  double moment = 0.0, shear = 0.0;
  double axial_displacement = 0.0, axial_force = 0.0;
  /// The parts of the forces, and of d moment/dt (N m/s), that follow from the nodal values alone, without loads,
  /// inertia and foundation inside the element.
  double nodal_moment = 0.0, nodal_shear = 0.0, nodal_axial_force = 0.0, nodal_moment_rate = 0.0;
  double moment_rate = 0.0;  // d moment/dt, N m/s; NaN if it is unknown
  /// The parts of jumps behind passing loads that the forces do not contain yet, N; damping b K delays them by b.
  double unrelaxed_shear = 0.0, unrelaxed_axial_force = 0.0;
  /// If a moving load is at the station: the differences of the forces (N) and of the rate of the twist (rad/m) just
  /// before and just after its passage.
  std::array<double, 2> shear_beside{}, axial_force_beside{}, twist_along_beside{};
};

/// The twist of a track of standard gauge over 3 m (EN 1990, A2.4.4.2.2), by its rate along the bridge, m.
inline constexpr double track_base = 1.435 * 3.0;  // m2
inline double track_twist(const Response& r) { return track_base * r.twist_along; }

/// Moment (N m), shear and axial force (N).
using Forces = std::array<double, 3>;

struct RecoverySection;

/// The response of a station without loads inside its element, as linear combinations of the unknowns of its element
/// and of the sleepers on it. A Form has the coefficient of each unknown.
struct StationForms {
  using Form = std::vector<double>;
  int element = 0;
  std::vector<int> unknown;                // global
  std::array<Form, 3> deflection, moment;  // coefficients of v, w and a; the moment without nodal_moment
  Form acceleration, nodal_moment;         // coefficients of a; coefficients of v
  double constant_deflection = 0.0, constant_moment = 0.0;  // by weight and temperature
  double support_line = 0.0;                                // m: the height of the line through the settled supports
};

/// Evaluates responses: linear combinations of the nodal values of a station's element, plus the effect of loads inside
/// it.
class Recovery {
 public:
  /// Responses of the bridge or the rail; throws InputError for stations that are not on it. `self_weight` is gravity
  /// if it loads the beam, otherwise 0. At a node the response is computed in the element on its right (at the end of
  /// the beam in the element on its left). eccentricities: of each station to the left of the shear centre, m, for a
  /// beam that twists; empty: those of its first track.
  Recovery(const beam::Beam& beam, const beam::Line& line, std::vector<double> stations, double self_weight,
           const std::vector<double>& eccentricities = {});
  /// Responses of the bridge.
  Recovery(const beam::Beam& beam, std::vector<double> stations, double self_weight,
           const std::vector<double>& eccentricities = {})
      : Recovery(beam, beam.bridge(), std::move(stations), self_weight, eccentricities) {}
  Recovery(Recovery&&) noexcept;
  ~Recovery();

  /// Collective. Evaluates the response at every station from this rank's slices of the nodal vectors and all
  /// concentrated loads on this line (the same list on every rank); the result is complete on every rank. Moment and
  /// shear follow from the element's end forces K_e v + C_e w + M_e a - P_e and the loads and inertia inside the
  /// element, without the part b*K_e w, which is damping and not bending. The deflection includes the element's
  /// deflection between clamped ends, which the cubic shape functions do not contain: under concentrated loads and the
  /// beam's weight and, if a foundation acts inside the element, on this foundation and with the forces of foundation
  /// and inertia. Velocity and acceleration do not include it. The relative deflection is relative to the line through
  /// the settled supports of the beam's model.
  void evaluate(const double* v, const double* w, const double* a, const std::vector<ElementLoad>& loads,
                std::vector<Response>& out) {
    evaluate(v, w, a, loads, all_, out);
  }
  /// The same for the stations `which` (ascending, the same on every rank) only; the other entries of `out` remain.
  void evaluate(const double* v, const double* w, const double* a, const std::vector<ElementLoad>& loads,
                const std::vector<std::size_t>& which, std::vector<Response>& out);
  /// All stations, 0, 1, ...
  const std::vector<std::size_t>& all() const { return all_; }
  /// The left node of a station's element.
  int node_of(std::size_t station) const;

  const std::vector<double>& stations() const { return stations_; }
  StationForms forms(std::size_t station) const;
  /// Start and end of the element of a station, m.
  std::pair<double, double> element_of(std::size_t station) const;
  /// Position of a load on this line, m.
  double x_of(const ElementLoad& load) const {
    const beam::Element& e = line_.mesh.element(load.element);
    return e.x + load.xi * e.length;
  }
  /// An upper bound of the distance from a station at which a load is at it, m.
  double greatest_tolerance() const { return beam::section_tolerance * (line_.mesh.end() - line_.mesh.start()); }
  /// Whether a load at x is at an end of the line or outside.
  bool is_outside(double x) const;
  /// The contribution of a load to the forces if it acts at x inside the station's element; zero elsewhere.
  Forces inside(std::size_t station, double x, ElementLoad load) const;
  /// The contribution of a load that is assigned to the given side of the station, independent of its position.
  Forces inside(std::size_t station, double x, const ElementLoad& load, bool as_left) const;
  /// Whether evaluate() assigns a load at x to the left side of the station.
  bool is_left_of(std::size_t station, double x) const;
  /// The forces with the load on the left side of the station minus those with the load on its right side.
  Forces jump(std::size_t station, const ElementLoad& load) const;
  /// The contribution of a load inside the station's element to the response; zero for a load elsewhere.
  Response inside_response(std::size_t station, const ElementLoad& load) const;
  /// The deflection of inside_response, m.
  double deflection_inside(std::size_t station, const ElementLoad& load) const;
  /// Adds the coefficients of this rank's nodal displacements in `factor` times the deflection of a station on the
  /// bridge to `forces`. Returns the contribution of the beam's weight to the deflection between nodes, m.
  double add_deflection_form(std::size_t station, double factor, double* forces) const;

 private:
  /// Nodal values of a station's element: u1, v1, theta1, u2, v2, theta2.
  using Values = std::array<double, 6>;
  /// Twists and their rates along x at both ends of a station's element, and the first and second derivatives in time.
  using Twists = std::array<std::array<double, 4>, 3>;

  void gather(const double* v, const double* w, const double* a, const std::vector<std::size_t>& which);
  Response evaluate_section(const RecoverySection& s, const Values& v, const Values& w, const Values& a,
                            const Twists& twists) const;
  /// The load as one of the element at its place: a wheel may already be beyond the element that it was assigned to.
  ElementLoad in_own_element(ElementLoad load) const;
  void add_beside(const ElementLoad& load, const std::vector<std::size_t>& which, std::vector<Response>& out) const;
  void add_sleepers(const RecoverySection& s, const Values* values, const Twists& twists, const double* sleepers,
                    Response& r) const;
  static double deflection_at(const RecoverySection& s, double xi, double eccentricity, const Values& y,
                              const std::array<double, 4>& twists);

  const beam::Beam& beam_;
  const beam::Line& line_;
  std::vector<double> stations_;
  std::vector<std::size_t> all_;
  std::vector<RecoverySection> sections_;
  struct Place {
    int element;
    std::size_t section;
  };
  std::span<const Place> sections_of(int element) const;
  std::vector<Place> by_element_;  // ascending, so that many loads of a bed find their few sections fast
  double gravity_;
  std::vector<double>
      gathered_;  // for every evaluated station: v, w, a, and v, w of the unknowns above each sleeper on its element
};

/// Calls f(ElementLoad) with point loads that have the effect of `load`, exact for responses that are polynomials of xi
/// up to degree 5 on both sides of `kink`. A concentrated load is its own point.
template <class F>
void for_points(const ElementLoad& load, double kink, F f) {
  if (load.extent == 0.0) return f(load);
  const double left = load.xi - 0.5 * load.extent, right = load.xi + 0.5 * load.extent;
  const double middle = std::clamp(kink, left, right);
  for (const auto& [from, to] : {std::array{left, middle}, std::array{middle, right}}) {
    if (!(to > from)) continue;
    base::at_gauss_points<3>(from, to, [&](double xi, double weight) {
      const double part = weight / load.extent;
      f(ElementLoad{load.element, xi, part * load.fx, part * load.fy, part * load.moment, load.speed, 0.0, load.source,
                    part * load.torque});
    });
  }
}

}  // namespace traverse::recovery
