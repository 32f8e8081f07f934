#include "assembly.hpp"

#include "traverse/beam/shape.hpp"

namespace traverse::beam {
namespace {

/// Calls add(element, matrices) for the elements of the slice; `compute` runs once for equal neighbours of a beam
/// whose data do not change along x.
template <class Compute, class Add>
void for_elements(const Mesh& mesh, const Slice& slice, bool uniform, Compute compute, Add add) {
  double length = 0.0;
  decltype(compute(mesh.element(0))) matrices{};
  for (int e = slice.first_element; e < slice.past_element; ++e) {
    const Element& element = mesh.element(e);
    if (!uniform || element.length != length) matrices = compute(element);
    length = element.length;
    add(element, matrices);
  }
}

/// Sum over the points of value * s s^T; shape(xi, h) gives s.
template <class Shape>
Rows points(const std::vector<PointFoundation>& all, const Mesh& mesh, const Slice& slice, Term term, Shape shape) {
  Rows rows(slice);
  for (const PointFoundation& p : all) {
    const Station at = mesh.locate(p.x);
    if (at.element < slice.first_element || at.element >= slice.past_element) continue;
    const Element& e = mesh.element(at.element);
    rows.add(e.left, outer(term == Term::stiffness ? p.k : p.c, shape(at.xi, e.length)));
  }
  return rows;
}

template <class Matrix>
Rows bed(const Bed& bed, const Mesh& mesh, const Slice& slice, Term term, Matrix matrix) {
  Rows rows(slice);
  const Distribution& density = term == Term::stiffness ? bed.k : bed.c;
  for_elements(
      mesh, slice, density.uniform(), [&](const Element& e) { return matrix(density, e); },
      [&](const Element& e, const auto& m) { rows.add(e.left, m); });
  return rows;
}

}  // namespace

BeamRows beam_rows(const BeamModel& model, const Mesh& mesh, const Slice& slice) {
  BeamRows rows{Rows(slice), Rows(slice)};
  const bool uniform = model.EI.uniform() && model.EA.uniform() && model.mass.uniform();
  for_elements(
      mesh, slice, uniform, [&](const Element& e) { return element_matrices(model, e); },
      [&](const Element& e, const ElementMatrices& m) {
        rows.mass.add(e.left, m.mass);
        rows.stiffness.add(e.left, m.stiffness);
        if (!model.axial) return;
        rows.mass.add(e.left, m.axial_mass);
        rows.stiffness.add(e.left, m.axial_stiffness);
      });
  return rows;
}

Rows vertical_points(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term) {
  return points(model.foundation.vertical, mesh, slice, term, [](double xi, double h) { return hermite(xi, h).value; });
}

Rows longitudinal_points(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term) {
  return points(model.foundation.longitudinal, mesh, slice, term, [](double xi, double) { return linear(xi); });
}

Rows rotational_points(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term) {
  return points(model.foundation.rotational, mesh, slice, term,
                [](double xi, double h) { return hermite(xi, h).slope; });
}

Rows vertical_bed(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term) {
  return bed(*model.foundation.vertical_bed, mesh, slice, term, transverse_bed);
}

Rows longitudinal_bed(const BeamModel& model, const Mesh& mesh, const Slice& slice, Term term) {
  return bed(*model.foundation.longitudinal_bed, mesh, slice, term, axial_bed);
}

}  // namespace traverse::beam
