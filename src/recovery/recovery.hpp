// Response at any station: deflection from the shape functions, moment and shear from the element's equilibrium.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "beam/beam.hpp"

namespace traverse::beam {

/// A concentrated load on an element, at xi: fx, fy in N (fy upward), moment in N m counter-clockwise. It moves with
/// `speed` along x, m/s.
struct ElementLoad {
  int element = 0;
  double xi = 0.0;
  double fx = 0.0, fy = 0.0, moment = 0.0;
  double speed = 0.0;
};

/// Response at one station. Deflection positive upward, moment positive in sagging (EI v'' > 0),
/// shear = d moment/dx.
struct Response {
  double deflection = 0.0, velocity = 0.0, acceleration = 0.0;
  double moment = 0.0, shear = 0.0;
  double axial_displacement = 0.0, axial_force = 0.0;
  /// What the nodal values alone give of the forces and of d moment/dt (N m/s): all but what loads, inertia and
  /// foundation inside the element add.
  double nodal_moment = 0.0, nodal_shear = 0.0, nodal_axial_force = 0.0, nodal_moment_rate = 0.0;
  double moment_rate = 0.0;  // d moment/dt, N m/s; NaN where nobody knows it
  /// N: what of the forces is left of their jumps behind passing loads, which damping b K lets them follow within b.
  double unrelaxed_shear = 0.0, unrelaxed_axial_force = 0.0;
  /// Where a moving load stands on the station: what the forces differ by just before it is there, and just after, N.
  std::array<double, 2> shear_beside{}, axial_force_beside{};
};

/// Moment (N m), shear and axial force (N).
using Forces = std::array<double, 3>;

struct RecoverySection;

/// How a station responds without loads inside its element: linear forms of the unknowns of its element and of the
/// sleepers on it.
struct StationForms {
  using Form = std::vector<double>;
  int element = 0;
  std::vector<int> unknown;                                 // global
  std::array<Form, 3> deflection, moment;                   // of v, w and a; the moment without nodal_moment
  Form acceleration, nodal_moment;                          // of a; of v
  double constant_deflection = 0.0, constant_moment = 0.0;  // by its own weight and temperature
};

/// The nodal values of a station's element give these as linear forms, and the loads inside the element add to them.
class Recovery {
 public:
  /// Of the bridge or of the rail; stations on it: InputError otherwise. `self_weight`: gravity if it loads the beam,
  /// else 0. At a node the response is that of the element to its right (at the end of the beam: to its left).
  Recovery(const Beam& beam, const Line& line, std::vector<double> stations, double self_weight);
  /// Of the bridge.
  Recovery(const Beam& beam, std::vector<double> stations, double self_weight)
      : Recovery(beam, beam.bridge(), std::move(stations), self_weight) {}
  Recovery(Recovery&&) noexcept;
  ~Recovery();

  /// Collective. From this rank's slices of the nodal vectors and all concentrated loads on this line (the same list
  /// on every rank), the response at every station, complete on every rank.
  /// Moment and shear follow from the element's end forces K_e v + C_e w + M_e a - P_e and the loads and inertia
  /// inside the element, less the part b*K_e w that is damping, not bending. The deflection has the element's own
  /// deflection between held ends added, which the cubic shape functions leave out: under concentrated loads and the
  /// beam's weight and, where a foundation acts inside the element, on that foundation and with what it and inertia
  /// do to the beam. Nothing is added to velocity and acceleration.
  void evaluate(const double* v, const double* w, const double* a, const std::vector<ElementLoad>& loads,
                std::vector<Response>& out);

  const std::vector<double>& stations() const { return stations_; }
  StationForms forms(std::size_t station) const;
  /// Where the element of a station begins and ends, m.
  std::pair<double, double> element_of(std::size_t station) const;
  /// Where a load on this line stands, m.
  double x_of(const ElementLoad& load) const {
    const Element& e = line_.mesh.element(load.element);
    return e.x + load.xi * e.length;
  }
  bool is_beyond(double x) const { return x < line_.mesh.start() || x > line_.mesh.end(); }
  /// What a load adds to the forces by acting inside the station's element, if it stood at x: none elsewhere.
  Forces inside(std::size_t station, double x, ElementLoad load) const;
  /// The same, with the load counted to a side of the station on which it may not be.
  Forces inside(std::size_t station, double x, const ElementLoad& load, bool as_left) const;
  /// Whether evaluate() counts the load to what is left of the station.
  bool is_left_of(std::size_t station, const ElementLoad& load) const;
  /// By how much the forces differ where the load counts as left, from where it does not.
  Forces jump(std::size_t station, const ElementLoad& load) const;
  /// What a load adds to the response of a station by acting inside its element: nothing elsewhere.
  Response inside_response(std::size_t station, const ElementLoad& load) const;
  /// The same of the deflection, m.
  double deflection_inside(std::size_t station, const ElementLoad& load) const;
  /// Adds `factor` times the deflection of a station on the bridge, as a form of this rank's nodal displacements, to
  /// `forces`. Returns what the beam's weight adds to the deflection between nodes, m.
  double add_deflection_form(std::size_t station, double factor, double* forces) const;

 private:
  /// Nodal values of a station's element: u1, v1, theta1, u2, v2, theta2.
  using Values = std::array<double, 6>;

  void gather(const double* v, const double* w, const double* a);
  Response respond(const RecoverySection& s, const Values& v, const Values& w, const Values& a) const;
  void add_beside(const ElementLoad& load, std::vector<Response>& out) const;
  void add_riders(const RecoverySection& s, const Values* values, const double* riders, Response& r) const;

  const Beam& beam_;
  const Line& line_;
  std::vector<double> stations_;
  std::vector<RecoverySection> sections_;
  struct Place {
    int element;
    std::size_t section;
  };
  std::span<const Place> sections_of(int element) const;
  std::vector<Place> by_element_;  // ascending: many loads of a bed find their few sections
  double gravity_;
  std::vector<double> gathered_;  // of every station: v, w, a, and v, w of what stands above each riding sleeper
};

}  // namespace traverse::beam
