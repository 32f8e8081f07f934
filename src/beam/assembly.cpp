// Assembles element matrices, crack springs, point foundations and beds into a rank's rows (sections 2 and 3 of the
// paper); equal neighbouring elements share one computed matrix.
#include "assembly.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "beam/shape.hpp"
#include "traverse/base/error.hpp"

namespace traverse::beam {
namespace {

/// Calls add(e, matrices) for the elements of the slice. If the beam's data are constant along x, `compute` runs once
/// for neighbouring elements of equal length.
template <class Compute, class Add>
void for_elements(const Line& line, const Slice& slice, bool uniform, Compute compute, Add add) {
  double length = 0.0;
  decltype(compute(line.mesh.element(0))) matrices{};
  const auto [first, past] = line.elements_at(slice.first, slice.local);
  for (int e = first; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    if (!uniform || element.length != length) matrices = compute(element);
    length = element.length;
    add(e, matrices);
  }
}

/// Adds the matrices of the twist, and those that couple it with the deflection.
void add_torsion(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness) {
  const Torsion& torsion = *line.model.torsion;
  const bool uniform = torsion.GJ.uniform() && (!torsion.warping || torsion.warping->uniform()) &&
                       torsion.inertia.uniform() && line.model.mass.uniform() && line.model.EI.uniform() &&
                       (!line.model.GA || line.model.GA->uniform());
  for_elements(
      line, slice, uniform, [&](const Element& e) { return torsion_matrices(line.model, e); },
      [&](int e, const TorsionMatrices& m) {
        const auto twists = line.twists(e);
        mass.add(twists, m.mass);
        stiffness.add(twists, m.stiffness);
        if (torsion.mass_centre == 0.0) return;
        std::array<int, 8> unknowns{};
        std::ranges::copy(line.transverse(e), unknowns.begin());
        std::ranges::copy(twists, unknowns.begin() + 4);
        std::array<double, 64> coupling{};
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t j = 0; j < 4; ++j)
            coupling[8 * i + j + 4] = coupling[8 * (j + 4) + i] = m.coupling[4 * i + j];
        mass.add(unknowns, coupling);
      });
}

/// A matrix of u1, u2 as a matrix of four unknowns.
Transverse among_four(const Axial& m) { return {m[0], m[1], 0.0, 0.0, m[2], m[3]}; }

}  // namespace

Station station_of(const Mesh& mesh, const PointFoundation& point) { return mesh.locate(point.x, point.from_left); }

void add_beam(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness) {
  const BeamModel& model = line.model;
  const bool uniform = model.EI.uniform() && model.EA.uniform() && (!model.GA || model.GA->uniform()) &&
                       model.mass.uniform() && model.rotary_inertia.uniform();
  for_elements(
      line, slice, uniform, [&](const Element& e) { return element_matrices(model, e); },
      [&](int e, const ElementMatrices& m) {
        mass.add(line.transverse(e), m.mass);
        stiffness.add(line.transverse(e), m.stiffness);
        if (!model.axial) return;
        mass.add(line.axial(e), m.axial_mass);
        stiffness.add(line.axial(e), m.axial_stiffness);
      });
  if (model.torsion) add_torsion(line, slice, mass, stiffness);
  for (const PointMass& point : model.point_masses)
    for (const Direction direction : {Direction::vertical, Direction::longitudinal}) {
      const PointShape s = shape_at(line, direction, line.mesh.locate(point.x));
      mass.add(s.unknown, outer(point.mass, s.shape));
    }
}

std::vector<DamperPlace> places_of_dampers(const Line& line, const Layout& layout) {
  const Mesh& mesh = line.mesh;
  std::vector<DamperPlace> places;
  for (const MassDamper& damper : line.model.dampers) {
    const Station at = mesh.locate(damper.x);
    const int left = mesh.element(at.element).left;
    std::vector<int> nodes = {left, left + 1};
    if (at.xi == 0.0 && at.element > 0 && mesh.element(at.element - 1).left + 1 == left) nodes.push_back(left - 1);
    const auto unknown_at = [&](int node) {
      return (line.first_column + node) * layout.block + layout.place[Kind::damper];
    };
    const auto is_free = [&](int node) {
      return std::none_of(places.begin(), places.end(),
                          [&](const DamperPlace& other) { return other.unknown == unknown_at(node); });
    };
    const auto node = std::find_if(nodes.begin(), nodes.end(), is_free);
    if (node == nodes.end())
      throw InputError(
          fmt::format("beam_{}_x: too many dampers near x = {:g} m; allowed: three at a node of the mesh, "
                      "two within an element; equal ones may be one",
                      damper.name, damper.x));
    places.push_back({&damper, shape_at(line, Direction::vertical, at), unknown_at(*node)});
  }
  return places;
}

void add_dampers(const std::vector<DamperPlace>& dampers, Rows& mass, Rows& stiffness, Rows& damping) {
  for (const auto& [damper, beam, unknown] : dampers) {
    std::array<int, 9> unknowns{};
    std::array<double, 9> travel{};
    std::copy(beam.unknown.begin(), beam.unknown.end(), unknowns.begin());
    std::copy(beam.shape.begin(), beam.shape.end(), travel.begin());
    unknowns.back() = unknown;
    travel.back() = -1.0;
    mass.add(std::array{unknown}, std::array{damper->mass});
    stiffness.add(unknowns, outer(damper->k, travel));
    damping.add(unknowns, outer(damper->c, travel));
  }
}

void add_cracks(const Line& line, const Slice& slice, Rows& stiffness) {
  const auto [first, past] = line.elements_at(slice.first, slice.local);
  for (const Crack& crack : line.model.cracks) {
    const int e = line.mesh.locate(crack.x).element, node = line.mesh.element(e).left;
    if (e + 1 < first || e > past) continue;
    stiffness.add(std::array{line.unknown(node, 2), line.unknown(node, 3)},
                  std::array{crack.k, -crack.k, -crack.k, crack.k});
  }
}

Rows points_of(const FoundationKind& kind, const Line& line, const Slice& slice, Term term) {
  Rows rows(slice);
  const auto [first, past] = line.elements_at(slice.first, slice.local);
  for (const PointFoundation& p : line.model.foundation.*kind.points) {
    if (p.law.nonlinear()) continue;
    const Station at = station_of(line.mesh, p);
    if (at.element < first || at.element >= past) continue;
    const PointShape s = shape_at(line, kind.direction, at, p.depth, p.eccentricity);
    rows.add(s.unknown, outer(term == Term::stiffness ? p.k : p.c, s.shape));
  }
  return rows;
}

Rows bed_of(const FoundationKind& kind, const Line& line, const Slice& slice, Term term) {
  Rows rows(slice);
  const Bed& bed = *(line.model.foundation.*kind.bed);
  const Distribution& density = term == Term::stiffness ? bed.k : bed.c;
  for_elements(
      line, slice, density.uniform(), [&](const Element& e) { return bed_matrix(kind.direction, density, e); },
      [&](int e, const Transverse& m) { rows.add(unknowns_of(line, kind.direction, e), m); });
  return rows;
}

std::array<int, 4> unknowns_of(const Line& line, Direction direction, int element) {
  if (direction != Direction::longitudinal) return line.transverse(element);
  const auto [u1, u2] = line.axial(element);
  return {u1, u2, -1, -1};
}

std::array<double, 4> shape_of(Direction direction, double xi, const Element& element) {
  if (direction == Direction::vertical) return hermite(xi, element.length, element.shear).value;
  if (direction == Direction::rotational) return rotation(xi, element.length, element.shear);
  const auto [left, right] = linear(xi);
  return {left, right, 0.0, 0.0};
}

PointShape shape_at(const Line& line, Direction direction, const Station& at) {
  PointShape s;
  std::ranges::copy(unknowns_of(line, direction, at.element), s.unknown.begin());
  std::ranges::copy(shape_of(direction, at.xi, line.mesh.element(at.element)), s.shape.begin());
  return s;
}

PointShape shape_at(const Line& line, Direction direction, const Station& at, double depth, double eccentricity) {
  PointShape s = shape_at(line, direction, at);
  if (depth != 0.0) {
    const std::size_t end = at.xi < 0.5 ? 0 : 1;
    s = {};
    s.unknown[0] = line.axial(at.element)[end];
    s.unknown[1] = line.transverse(at.element)[2 * end + 1];
    s.shape[0] = 1.0;
    s.shape[1] = depth;
  }
  if (eccentricity == 0.0) return s;
  const auto psi = hermite(at.xi, line.mesh.element(at.element).length).value;
  std::ranges::copy(line.twists(at.element), s.unknown.begin() + 4);
  for (std::size_t k = 0; k < 4; ++k) s.shape[4 + k] = eccentricity * psi[k];
  return s;
}

Transverse bed_matrix(Direction direction, const Distribution& density, const Element& element) {
  if (direction == Direction::vertical) return transverse_bed(density, element);
  if (direction == Direction::rotational) return slope_bed(density, element);
  return among_four(axial_bed(density, element));
}

std::array<double, 4> bed_form(Direction direction, const Distribution& density, const Element& element) {
  if (direction == Direction::vertical) return transverse_load(density, element);
  if (direction == Direction::rotational) return slope_load(density, element);
  const auto [left, right] = axial_load(density, element);
  return {left, right, 0.0, 0.0};
}

}  // namespace traverse::beam
