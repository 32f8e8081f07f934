// Precomputed data of the beam at a station: its response as a function of the nodal values of its element and of the
// loads on this element.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "beam/layered_track.hpp"
#include "beam/section.hpp"
#include "beam/shape.hpp"
#include "recovery/recovery.hpp"

namespace traverse::recovery {

/// All coefficients refer to the element's nodal values; in transverse direction these are v1, theta1, v2, theta2.
struct RecoverySection {
  /// The section of the bridge or the rail at a station x (m) on it. At a node it is in the element on the right.
  RecoverySection(const beam::Line& line, double x);

  /// Adds the dead weight of the beam to `weight`; `gravity` in m/s2.
  void add_weight(const beam::BeamModel& model, double gravity);
  /// Stores the sleepers on this element of the bridge.
  void record_sleepers(const beam::Beam& beam);
  /// Adds the effect of a load on this element to the response, without the effect of the element's end forces, which
  /// follows from the nodal values.
  void add_load(const ElementLoad& load, Response& r) const;

  /// The twist of the element, by (twist1, rate1, twist2, rate2): coefficients of these values, of their accelerations,
  /// and of the accelerations of the transverse values in the torsional moment.
  struct Twisting {
    std::array<int, 4> unknowns{};  // global
    double eccentricity = 0.0;      // m, of the station to the left of the shear centre
    double flexibility = 0.0;       // rad/(N m): length/GJ at the middle; 0 with stiffness against warping
    std::array<double, 4> psi{}, slope{}, moment{}, moment_by_twist{}, moment_by_bending{};
  };

  /// A vertical spring with a dashpot beside the shear centre, such as a bearing.
  struct EccentricSpring {
    double xi = 0.0, k = 0.0, c = 0.0, eccentricity = 0.0;
  };

  /// A sleeper of a layered track on this element.
  struct ConnectedSleeper {
    beam::SleeperConnection connection;
    double xi = 0.0;
  };

  beam::Station at;
  beam::Element element;
  std::array<int, 6> unknowns;  // global: u1, v1, theta1, u2, v2, theta2; -1: does not exist
  double EI = 0.0, EA = 0.0;    // at the element's middle, for the fixed-end deflections
  beam::Hermite psi;
  std::array<double, 2> phi;
  beam::SectionForms bending;                   // K_e of the beam, for nodal values minus the element's rigid motion
  beam::SectionForms stiffness, damping, mass;  // K_e and C_e of the foundation, M_e
  Response weight;                              // deflection and forces by the beam's weight and temperature
  /// If a foundation acts inside the element: the deflection that the shape functions do not contain, under loads, and
  /// under the forces of foundation and inertia for a motion by the shape functions.
  std::optional<beam::HeldElement> held;
  std::array<double, 4> held_by_stiffness{}, held_by_damping{}, held_by_mass{};
  std::optional<Twisting> twisting;
  std::vector<EccentricSpring> eccentric_springs;
  double support_line = 0.0;  // m: the height of the line through the settled supports
  std::vector<ConnectedSleeper> sleepers;

 private:
  void add_point_load(const ElementLoad& load, Response& r) const;
  /// A force along x (N) at xi.
  void add_axial_point_load(double xi, double force, Response& r) const;
  void add_foundation(const beam::Line& line);
  void add_torsion(const beam::Line& line);
  void set_up_held_element(const beam::BeamModel& model, const std::vector<beam::InnerSpring>& springs,
                           const std::vector<beam::InnerSpring>& dampers);
  template <class Sum>
  void integrate_held(const beam::Distribution& density, bool moments, Sum sum) const;
  void add_strains(const beam::BeamModel& model);
  void add_weight_at_points(const beam::Bed& bed, const beam::Distribution& mass_per_length, double gravity);
};

}  // namespace traverse::recovery
