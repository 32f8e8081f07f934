// Coefficients of the nodal values in the response of one section, from the element's stiffness, mass, foundation and
// temperature, and from the deflection of the element clamped at both ends.
#include "recovery/recovery_section.hpp"

#include <algorithm>

#include "beam/assembly.hpp"
#include "beam/element.hpp"
#include "beam/nonlinear_points.hpp"

namespace traverse::recovery {

using beam::Direction;

namespace {

/// The twist at xi of an element of length 1 and GJ = 1, held at both ends, under a unit torque at `load`, minus what
/// cubic twists contain of it. Its part in these is the sum over the two of them that vanish at the ends and whose
/// rates are orthogonal: 3^(1/2) xi (1 - xi) and 5^(1/2) xi (1 - xi) (1 - 2 xi).
double kink_beside_cubics(double xi, double load) {
  const double exact = std::min(xi, load) * (1.0 - std::max(xi, load));
  const double products = xi * (1.0 - xi) * load * (1.0 - load);
  return exact - products * (3.0 + 5.0 * (1.0 - 2.0 * xi) * (1.0 - 2.0 * load));
}

/// Its derivative by xi; left: whether the load is to the left of xi.
double rate_beside_cubics(double xi, double load, bool left) {
  const double other = 1.0 - 2.0 * load, along = 1.0 - 2.0 * xi;
  return (left ? 0.0 : 1.0) - load -
         load * (1.0 - load) * (along * (3.0 + 5.0 * along * other) - 10.0 * xi * (1.0 - xi) * other);
}

}  // namespace

RecoverySection::RecoverySection(const beam::Line& line, double x)
    : at(line.mesh.locate(x)),
      element(line.mesh.element(at.element)),
      psi(beam::hermite(at.xi, element.length, element.shear)),
      phi(beam::linear(at.xi)),
      bending(element, at.xi),
      stiffness(element, at.xi),
      damping(element, at.xi),
      mass(element, at.xi) {
  const beam::BeamModel& model = line.model;
  const auto [v1, theta1, v2, theta2] = line.transverse(at.element);
  const auto [u1, u2] = line.axial(at.element);
  unknowns = {u1, v1, theta1, u2, v2, theta2};
  const double middle = element.x + 0.5 * element.length;
  EI = model.EI.at(middle, element.x);
  const beam::ElementMatrices matrices = beam::element_matrices(model, element);
  bending.add_end_forces(matrices.stiffness);
  mass.add_end_forces(matrices.mass);
  mass.add_transverse_density(model.mass);
  if (model.rotary_inertia.maximum() > 0.0) mass.add_rotational_density(model.rotary_inertia);
  if (model.axial) {
    EA = model.EA.at(middle, element.x);
    bending.add_end_forces(matrices.axial_stiffness);
    mass.add_end_forces(matrices.axial_mass);
    mass.add_axial_density(model.mass);
  }
  add_foundation(line);
  if (model.torsion) add_torsion(line);
  if (model.temperature) add_strains(model);
}

/// The torsional moment at the section is that at the element's left end, which its equilibrium determines, plus the
/// inertia between the two.
void RecoverySection::add_torsion(const beam::Line& line) {
  const beam::Torsion& torsion = *line.model.torsion;
  const beam::TorsionMatrices matrices = beam::torsion_matrices(line.model, element);
  Twisting t;
  t.unknowns = line.twists(at.element);
  if (!torsion.warping) t.flexibility = element.length / torsion.GJ.at(element.x + 0.5 * element.length, element.x);
  const beam::Hermite shape = beam::hermite(at.xi, element.length);
  t.psi = shape.value;
  t.slope = shape.slope;
  for (std::size_t j = 0; j < 4; ++j) {
    t.moment[j] = -matrices.stiffness[j];
    t.moment_by_twist[j] = -matrices.mass[j];
    t.moment_by_bending[j] = -matrices.coupling[4 * j];
  }
  const auto add_until_here = [&](const beam::Distribution& density, double factor, auto add) {
    beam::integrate(density, element.x, element.x + at.xi * element.length,
                    [&](double x, double piece) { add((x - element.x) / element.length, factor * piece); });
  };
  const auto add_twist = [&](double xi, double piece) {
    const auto shape = beam::hermite(xi, element.length).value;
    for (std::size_t j = 0; j < 4; ++j) t.moment_by_twist[j] += piece * shape[j];
  };
  const double e = torsion.mass_centre;
  add_until_here(torsion.inertia, 1.0, add_twist);
  add_until_here(line.model.mass, e * e, add_twist);
  add_until_here(line.model.mass, e, [&](double xi, double piece) {
    const auto shape = beam::hermite(xi, element.length, element.shear).value;
    for (std::size_t i = 0; i < 4; ++i) t.moment_by_bending[i] += piece * shape[i];
  });
  twisting = t;
}

/// Subtracts the forces of the temperature: the elastic strain is the total strain minus the thermal strain.
void RecoverySection::add_strains(const beam::BeamModel& model) {
  const auto nodal_load = beam::strain_load(model, element);
  weight.shear -= nodal_load[0];
  weight.moment -= at.xi * element.length * nodal_load[0] - nodal_load[1];
  weight.axial_force += beam::axial_strain_load(model, element)[0];
}

void RecoverySection::record_sleepers(const beam::Beam& beam) {
  if (beam.rail() == nullptr) return;
  const int column = beam.bridge().first_column + element.left;
  for (const beam::Sleeper& s : beam::sleepers_of(beam.bridge(), column - 1, column + 3)) {
    if (s.on_bridge && s.at.element == at.element)
      sleepers.push_back({beam::connection_of(s, *beam.model().track, beam.layout()), s.at.xi});
  }
}

void RecoverySection::add_foundation(const beam::Line& line) {
  const beam::BeamModel& model = line.model;
  const beam::Foundation& f = model.foundation;
  std::vector<beam::InnerSpring> springs, dampers;
  beam::for_points(f, [&](const beam::FoundationKind& kind, const std::vector<beam::PointFoundation>& points) {
    if (!beam::acts(kind, model)) return;
    for (const beam::PointFoundation& p : points) {
      if (p.law.nonlinear() || p.depth != 0.0) continue;  // it is a load, or at a node
      // locate() determines the element, as in the assembly; a test of x avoids most of the calls.
      if (p.x < element.x - element.length || p.x > element.x + 2.0 * element.length) continue;
      const beam::Station s = beam::station_of(line.mesh, p);
      if (s.element != at.element) continue;
      if (p.eccentricity != 0.0) {
        eccentric_springs.push_back({s.xi, p.k, p.c, p.eccentricity});
        continue;
      }
      stiffness.add_spring(kind.direction, p.k, s.xi);
      damping.add_spring(kind.direction, p.c, s.xi);
      if (kind.direction == Direction::longitudinal || s.xi <= 0.0 || s.xi >= 1.0) continue;
      springs.push_back({s.xi, p.k, kind.direction == Direction::rotational});
      dampers.push_back({s.xi, p.c, kind.direction == Direction::rotational});
    }
  });
  bool acts_inside = !springs.empty();
  beam::for_beds(f, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    if (!beam::acts(kind, model) || bed.law.nonlinear()) return;
    stiffness.add_bed(kind.direction, bed.k);
    damping.add_bed(kind.direction, bed.c);
    acts_inside = acts_inside || kind.direction != Direction::longitudinal;
  });
  if (acts_inside) set_up_held_element(model, springs, dampers);
}

/// Integrates over the clamped element: calls sum(s, weight*density(s)*G(s)), where G is its influence line for a
/// force, or for a moment.
template <class Sum>
void RecoverySection::integrate_held(const beam::Distribution& density, bool moments, Sum sum) const {
  const std::vector<double> ends = held->ends();
  const double h = element.length, x = element.x;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    beam::integrate(density, x + h * ends[i], x + h * ends[i + 1], [&](double s, double piece) {
      const double xi = (s - x) / h;
      sum(xi, piece * (moments ? held->by_moment(xi) : held->by_force(xi)));
    });
}

/// Computes the coefficients for the clamped element on its springs and on the mean of a vertical bed. The effect of a
/// bed that resists the slope on the deflection between clamped ends is neglected; it is the part k h^2/(40 EI) of it.
void RecoverySection::set_up_held_element(const beam::BeamModel& model, const std::vector<beam::InnerSpring>& springs,
                                          const std::vector<beam::InnerSpring>& dampers) {
  const double h = element.length;
  double mean = 0.0;
  beam::for_beds(model.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    if (kind.direction == Direction::vertical && !bed.law.nonlinear())
      beam::integrate(bed.k, element.x, element.x + h, [&](double, double piece) { mean += piece / h; });
  });
  held.emplace(at.xi, h, EI, mean, springs, element.shear);
  const auto add = [&](const beam::Distribution& density, Direction direction, std::array<double, 4>& form) {
    integrate_held(density, direction == Direction::rotational, [&](double s, double line) {
      const auto shape = beam::shape_of(direction, s, element);
      for (std::size_t i = 0; i < 4; ++i) form[i] -= line * shape[i];
    });
  };
  const auto add_points = [&](const std::vector<beam::InnerSpring>& points, std::array<double, 4>& form) {
    for (const beam::InnerSpring& p : points) {
      const auto shape = beam::shape_of(p.rotational ? Direction::rotational : Direction::vertical, p.xi, element);
      const double line = p.k * (p.rotational ? held->by_moment(p.xi) : held->by_force(p.xi));
      for (std::size_t i = 0; i < 4; ++i) form[i] -= line * shape[i];
    }
  };
  add(model.mass, Direction::vertical, held_by_mass);
  if (model.rotary_inertia.maximum() > 0.0) add(model.rotary_inertia, Direction::rotational, held_by_mass);
  beam::for_beds(model.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    if (kind.direction == Direction::longitudinal || bed.law.nonlinear()) return;
    add(bed.k, kind.direction, held_by_stiffness);
    add(bed.c, kind.direction, held_by_damping);
  });
  add_points(springs, held_by_stiffness);
  add_points(dampers, held_by_damping);
}

void RecoverySection::add_weight(const beam::BeamModel& model, double gravity) {
  const double h = element.length, x = at.xi * h;
  if (twisting)  // the weight acts like a uniform acceleration
    weight.torsional_moment += gravity * (twisting->moment_by_bending[0] + twisting->moment_by_bending[2]);
  const auto end = beam::transverse_load(model.mass, element);
  weight.shear += gravity * end[0];
  weight.moment += gravity * (x * end[0] - end[1]);
  const auto add_along = [&](double s, double piece) {
    add_axial_point_load((s - element.x) / h, -model.gradient * gravity * piece, weight);
  };
  if (model.gradient != 0.0 && EA > 0.0) {
    beam::integrate(model.mass, element.x, element.x + x, add_along);
    beam::integrate(model.mass, element.x + x, element.x + h, add_along);
  }
  const beam::Bed* nonlinear_bed = nullptr;
  beam::for_beds(model.foundation, [&](const beam::FoundationKind& kind, const beam::Bed& bed) {
    if (kind.direction == Direction::vertical && bed.law.nonlinear()) nonlinear_bed = &bed;
  });
  if (nonlinear_bed != nullptr) return add_weight_at_points(*nonlinear_bed, model.mass, gravity);
  beam::integrate(model.mass, element.x, element.x + x, [&](double s, double piece) {
    weight.shear -= gravity * piece;
    weight.moment -= gravity * piece * (element.x + x - s);
  });
  if (held) {
    integrate_held(model.mass, false, [&](double, double line) { weight.deflection -= gravity * line; });
    return;
  }
  const double bubble = at.xi * (1.0 - at.xi) * h * h, middle = element.x + 0.5 * h;
  const double shape = bubble * (bubble + element.shear * h * h);
  weight.deflection = -gravity * model.mass.at(middle, element.x) * shape / (24.0 * EI);
}

/// Adds the weight at the integration points of a bed that acts there, so that both cancel where the beam rests on it.
void RecoverySection::add_weight_at_points(const beam::Bed& bed, const beam::Distribution& mass_per_length,
                                           double gravity) {
  for (const auto& [left, right] : beam::bed_pieces(bed, element)) {
    beam::integrate(mass_per_length, left, right, [&](double s, double piece) {
      const double xi = (s - element.x) / element.length, force = gravity * piece;
      weight.deflection -=
          force * (held ? held->by_force(xi) : beam::fixed_end_by_force(at.xi, xi, element.length, EI, element.shear));
      if (!beam::is_left(xi, at.xi)) return;
      weight.shear -= force;
      weight.moment -= force * (at.xi - xi) * element.length;
    });
  }
}

void RecoverySection::add_load(const ElementLoad& load, Response& r) const {
  for_points(load, at.xi, [&](const ElementLoad& point) { add_point_load(point, r); });
}

void RecoverySection::add_point_load(const ElementLoad& load, Response& r) const {
  const double h = element.length, x = at.xi * h;
  const beam::Hermite s = beam::hermite(load.xi, h, element.shear);
  const auto theta = element.shear == 0.0 ? s.slope : beam::rotation(load.xi, h, element.shear);
  const double f1 = -load.fy * s.value[0] - load.moment * theta[0];
  const double m1 = -load.fy * s.value[1] - load.moment * theta[1];
  r.shear += f1;
  r.moment += f1 * x - m1;
  if (held)
    r.deflection +=
        load.fy * held->by_force(load.xi) + (load.moment == 0.0 ? 0.0 : load.moment * held->by_moment(load.xi));
  else
    r.deflection += load.fy * beam::fixed_end_by_force(at.xi, load.xi, h, EI, element.shear) +
                    load.moment * beam::fixed_end_by_moment(at.xi, load.xi, h, EI, element.shear);
  const bool left = beam::is_left(load.xi, at.xi);
  if (load.torque != 0.0) {
    r.torsional_moment += load.torque * (beam::hermite(load.xi, h).value[0] - (left ? 1.0 : 0.0));
    const double by_torque = load.torque * twisting->flexibility;
    const double twist = by_torque * kink_beside_cubics(at.xi, load.xi);
    r.twist += twist;
    r.twist_along += by_torque * rate_beside_cubics(at.xi, load.xi, left) / h;
    r.deflection += twisting->eccentricity * twist;
  }
  if (left) {
    r.shear += load.fy;
    r.moment += load.fy * std::max(at.xi - load.xi, 0.0) * h - load.moment;
  }
  if (EA > 0.0) add_axial_point_load(load.xi, load.fx, r);
}

void RecoverySection::add_axial_point_load(double xi, double force, Response& r) const {
  const bool left = beam::is_left(xi, at.xi);
  r.axial_force += force * (left ? -xi : 1.0 - xi);
  r.axial_displacement += force * element.length / EA * (left ? xi * (1.0 - at.xi) : at.xi * (1.0 - xi));
}

}  // namespace traverse::recovery
