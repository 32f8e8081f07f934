#include "assembly.hpp"

#include "traverse/beam/shape.hpp"

namespace traverse::beam {
namespace {

/// Calls add(e, matrices) for the elements of the slice; `compute` runs once for equal neighbours of a beam whose
/// data do not change along x.
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

/// Sum over the points of value * s s^T; shape(xi, h) gives s.
template <class Shape, class Unknowns>
Rows points(const std::vector<PointFoundation>& all, const Line& line, const Slice& slice, Term term, Shape shape,
            Unknowns unknowns) {
  Rows rows(slice);
  const auto [first, past] = line.elements_at(slice.first, slice.local);
  for (const PointFoundation& p : all) {
    if (p.law.nonlinear()) continue;
    const Station at = station_of(line.mesh, p);
    if (at.element < first || at.element >= past) continue;
    rows.add(unknowns(at.element),
             outer(term == Term::stiffness ? p.k : p.c, shape(at.xi, line.mesh.element(at.element).length)));
  }
  return rows;
}

template <class Matrix, class Unknowns>
Rows bed(const Bed& bed, const Line& line, const Slice& slice, Term term, Matrix matrix, Unknowns unknowns) {
  Rows rows(slice);
  const Distribution& density = term == Term::stiffness ? bed.k : bed.c;
  for_elements(
      line, slice, density.uniform(), [&](const Element& e) { return matrix(density, e); },
      [&](int e, const auto& m) { rows.add(unknowns(e), m); });
  return rows;
}

auto transverse_of(const Line& line) {
  return [&line](int e) { return line.transverse(e); };
}
auto axial_of(const Line& line) {
  return [&line](int e) { return line.axial(e); };
}

}  // namespace

Station station_of(const Mesh& mesh, const PointFoundation& point) { return mesh.locate(point.x, point.from_left); }

void add_beam(const Line& line, const Slice& slice, Rows& mass, Rows& stiffness) {
  const BeamModel& model = line.model;
  const bool uniform = model.EI.uniform() && model.EA.uniform() && model.mass.uniform();
  for_elements(
      line, slice, uniform, [&](const Element& e) { return element_matrices(model, e); },
      [&](int e, const ElementMatrices& m) {
        mass.add(line.transverse(e), m.mass);
        stiffness.add(line.transverse(e), m.stiffness);
        if (!model.axial) return;
        mass.add(line.axial(e), m.axial_mass);
        stiffness.add(line.axial(e), m.axial_stiffness);
      });
}

Rows vertical_points(const Line& line, const Slice& slice, Term term) {
  return points(
      line.model.foundation.vertical, line, slice, term, [](double xi, double h) { return hermite(xi, h).value; },
      transverse_of(line));
}

Rows longitudinal_points(const Line& line, const Slice& slice, Term term) {
  return points(
      line.model.foundation.longitudinal, line, slice, term, [](double xi, double) { return linear(xi); },
      axial_of(line));
}

Rows rotational_points(const Line& line, const Slice& slice, Term term) {
  return points(
      line.model.foundation.rotational, line, slice, term, [](double xi, double h) { return hermite(xi, h).slope; },
      transverse_of(line));
}

Rows vertical_bed(const Line& line, const Slice& slice, Term term) {
  return bed(*line.model.foundation.vertical_bed, line, slice, term, transverse_bed, transverse_of(line));
}

Rows longitudinal_bed(const Line& line, const Slice& slice, Term term) {
  return bed(*line.model.foundation.longitudinal_bed, line, slice, term, axial_bed, axial_of(line));
}

}  // namespace traverse::beam
