#include "traverse/beam/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gauss.hpp"
#include "section.hpp"
#include "traverse/beam/shape.hpp"

namespace traverse::beam {

struct Recovery::Section {
  Section(const Beam& beam, double x);

  void add_foundation(const Beam& beam);
  void add_weight(const BeamModel& model, double gravity);
  void add_load(const ElementLoad& load, Response& r) const;

  Station at;
  Element element;
  double EI = 0.0, EA = 0.0;  // in the element's middle, for the fixed-end deflections
  Hermite psi;
  std::array<double, 2> phi;
  SectionForms stiffness, damping, mass;  // K_e with the foundation, the foundation's C_e, M_e
  Response weight;                        // of the beam's own weight: deflection, moment and shear
};

Recovery::Section::Section(const Beam& beam, double x)
    : at(beam.mesh().locate(x)),
      element(beam.mesh().element(at.element)),
      psi(hermite(at.xi, element.length)),
      phi(linear(at.xi)),
      stiffness(element, at.xi),
      damping(element, at.xi),
      mass(element, at.xi) {
  const BeamModel& model = beam.model();
  const double middle = element.x + 0.5 * element.length;
  EI = model.EI.at(middle, element.x);
  const ElementMatrices matrices = element_matrices(model, element);
  stiffness.add_end_forces(matrices.stiffness);
  mass.add_end_forces(matrices.mass);
  mass.add_transverse_density(model.mass);
  if (model.axial) {
    EA = model.EA.at(middle, element.x);
    stiffness.add_end_forces(matrices.axial_stiffness);
    mass.add_end_forces(matrices.axial_mass);
    mass.add_axial_density(model.mass);
  }
  add_foundation(beam);
}

void Recovery::Section::add_foundation(const Beam& beam) {
  const BeamModel& model = beam.model();
  const Foundation& f = model.foundation;
  const auto add_points = [&](const std::vector<PointFoundation>& points, auto add) {
    for (const PointFoundation& p : points) {
      // locate() is the judge, as in the assembly; a glance at x spares most of the calls.
      if (p.x < element.x - element.length || p.x > element.x + 2.0 * element.length) continue;
      const Station s = beam.mesh().locate(p.x);
      if (s.element != at.element) continue;
      (stiffness.*add)(p.k, s.xi);
      (damping.*add)(p.c, s.xi);
    }
  };
  const auto add_beds = [&](const Bed& bed, auto matrix, auto add) {
    stiffness.add_end_forces(matrix(bed.k, element));
    damping.add_end_forces(matrix(bed.c, element));
    (stiffness.*add)(bed.k);
    (damping.*add)(bed.c);
  };
  add_points(f.vertical, &SectionForms::add_vertical_spring);
  add_points(f.rotational, &SectionForms::add_rotational_spring);
  if (f.vertical_bed) add_beds(*f.vertical_bed, transverse_bed, &SectionForms::add_transverse_density);
  if (!model.axial) return;
  add_points(f.longitudinal, &SectionForms::add_longitudinal_spring);
  if (f.longitudinal_bed) add_beds(*f.longitudinal_bed, axial_bed, &SectionForms::add_axial_density);
}

void Recovery::Section::add_weight(const BeamModel& model, double gravity) {
  const double h = element.length, x = at.xi * h;
  const auto end = transverse_load(model.mass, element);
  weight.shear = gravity * end[0];
  weight.moment = gravity * (x * end[0] - end[1]);
  integrate(model.mass, element.x, element.x + x, [&](double s, double weight_of_piece) {
    weight.shear -= gravity * weight_of_piece;
    weight.moment -= gravity * weight_of_piece * (element.x + x - s);
  });
  const double bubble = at.xi * (1.0 - at.xi) * h * h, middle = element.x + 0.5 * h;
  weight.deflection = -gravity * model.mass.at(middle, element.x) * bubble * bubble / (24.0 * EI);
}

void Recovery::Section::add_load(const ElementLoad& load, Response& r) const {
  const double h = element.length, x = at.xi * h;
  const Hermite s = hermite(load.xi, h);
  const double f1 = -load.fy * s.value[0] - load.moment * s.slope[0];
  const double m1 = -load.fy * s.value[1] - load.moment * s.slope[1];
  r.shear += f1;
  r.moment += f1 * x - m1;
  r.deflection +=
      load.fy * fixed_end_by_force(at.xi, load.xi, h, EI) + load.moment * fixed_end_by_moment(at.xi, load.xi, h, EI);
  const bool left = is_left(load.xi, at.xi);
  if (left) {
    r.shear += load.fy;
    r.moment += load.fy * (at.xi - load.xi) * h - load.moment;
  }
  if (EA <= 0.0) return;
  r.axial_force += load.fx * (left ? -load.xi : 1.0 - load.xi);
  r.axial_displacement += load.fx * h / EA * (left ? load.xi * (1.0 - at.xi) : at.xi * (1.0 - load.xi));
}

Recovery::Recovery(const Beam& beam, std::vector<double> stations, double self_weight)
    : beam_(beam), stations_(std::move(stations)), gathered_(3 * stations_.size()) {
  for (double x : stations_) {
    if (!std::isfinite(x) || x < 0.0 || x > beam.mesh().length()) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "output_probes has a station at x = %.10g; it must lie on the beam, from 0 to %.10g m", x,
                    beam.mesh().length());
      throw InputError(text);
    }
    sections_.emplace_back(beam, x);
    sections_.back().add_weight(beam.model(), self_weight);
  }
}

Recovery::Recovery(Recovery&&) noexcept = default;
Recovery::~Recovery() = default;

void Recovery::gather(const double* v, const double* w, const double* a) {
  std::fill(gathered_.begin(), gathered_.end(), Values{});
  const int block = beam_.block(), from = 3 - block;
  const std::array<const double*, 3> vectors{v, w, a};
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    for (int end = 0; end < 2; ++end) {
      const int node = sections_[i].element.left + end - beam_.first_node();
      if (node < 0 || node >= beam_.local_nodes()) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        std::copy_n(vectors[k] + static_cast<std::ptrdiff_t>(node) * block, block,
                    gathered_[3 * i + k].begin() + 3 * end + from);
      }
    }
  }
  if (gathered_.empty()) return;
  MPI_Allreduce(MPI_IN_PLACE, gathered_.front().data(), static_cast<int>(6 * gathered_.size()), MPI_DOUBLE, MPI_SUM,
                beam_.comm());
}

Response Recovery::respond(const Section& s, const Values& v, const Values& w, const Values& a) const {
  const auto transverse = [](const std::array<double, 4>& form, const Values& y) {
    return form[0] * y[1] + form[1] * y[2] + form[2] * y[4] + form[3] * y[5];
  };
  const auto axial = [](const std::array<double, 2>& form, const Values& y) { return form[0] * y[0] + form[1] * y[3]; };
  Values inertial = a;  // mass-proportional damping acts like inertia
  for (std::size_t i = 0; i < 6; ++i) inertial[i] += beam_.rayleigh().a * w[i];

  Response r = s.weight;
  r.deflection += transverse(s.psi.value, v);
  r.velocity = transverse(s.psi.value, w);
  r.acceleration = transverse(s.psi.value, a);
  r.moment +=
      transverse(s.stiffness.moment(), v) + transverse(s.damping.moment(), w) + transverse(s.mass.moment(), inertial);
  r.shear +=
      transverse(s.stiffness.shear(), v) + transverse(s.damping.shear(), w) + transverse(s.mass.shear(), inertial);
  r.axial_displacement = axial(s.phi, v);
  r.axial_force =
      axial(s.stiffness.axial_force(), v) + axial(s.damping.axial_force(), w) + axial(s.mass.axial_force(), inertial);
  return r;
}

void Recovery::evaluate(const double* v, const double* w, const double* a, const std::vector<ElementLoad>& loads,
                        std::vector<Response>& out) {
  gather(v, w, a);
  out.resize(sections_.size());
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& s = sections_[i];
    out[i] = respond(s, gathered_[3 * i], gathered_[3 * i + 1], gathered_[3 * i + 2]);
    for (const ElementLoad& load : loads) {
      if (load.element == s.at.element) s.add_load(load, out[i]);
    }
  }
}

}  // namespace traverse::beam
