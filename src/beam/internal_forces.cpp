#include "traverse/beam/internal_forces.hpp"

#include "assembly.hpp"

namespace traverse::beam {

InternalForces::InternalForces(const Beam& beam) : block_(beam.block()), local_(beam.local_columns()) {
  if (local_ == 0) return;
  runs_.push_back(run_of(beam, beam.bridge()));
  if (beam.rail() != nullptr) runs_.push_back(run_of(beam, *beam.rail()));
}

InternalForces::Run InternalForces::run_of(const Beam& beam, const Line& line) const {
  Run run;
  run.u = line.place[0];
  run.v = line.place[1];
  run.theta = line.place[2];
  const BeamModel& model = line.model;
  const bool uniform = model.EI.uniform() && (!model.axial || model.EA.uniform());
  const auto [first, past] = elements_of(line, Slice(block_, beam.first_column(), local_));
  double length = 0.0;
  Stiffness s{};
  for (int e = first; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    const int column = line.first_column + element.left - beam.first_column();
    if (run.elements.empty()) run.first = column;
    if (!uniform || element.length != length) {
      const ElementMatrices m = element_matrices(model, element);
      s = {element.length, m.stiffness[2], m.stiffness[3], m.stiffness[6], m.stiffness[7], m.axial_stiffness[1], 0};
    }
    length = element.length;
    s.theta1 = line.mesh.hinged(element.left) ? line.place[3] : line.place[2];
    run.elements.resize(index(column - run.first + 1));  // leaves a gap between separate spans
    run.there.resize(run.elements.size(), 0);
    run.elements.back() = s;
    run.there.back() = 1;
  }
  return run;
}

template <class Real>
void InternalForces::add(double sign, const double* x, const double* left, const double* right, double* r) const {
  for (const Run& run : runs_) {
    const int count = static_cast<int>(run.elements.size());
    for (int i = 0; i < count; ++i) {
      if (run.there[index(i)] == 0) continue;
      const Stiffness& s = run.elements[index(i)];
      const int column = run.first + i;
      const bool owns_left = column >= 0, owns_right = column + 1 < local_;
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(column) * block_;
      const double* x1 = owns_left ? x + at : left;
      const double* x2 = owns_right ? x + at + block_ : right;
      const Real turn = Real(x2[run.theta]) - Real(x1[s.theta1]);
      const Real rise = Real(x2[run.v]) - Real(x1[run.v]) - Real(s.h) * Real(x1[s.theta1]);
      const auto force = static_cast<double>(Real(sign) * (Real(s.A) * rise + Real(s.B) * turn));
      const auto moment = static_cast<double>(Real(sign) * (Real(s.C) * rise + Real(s.D) * turn));
      const double along = run.u >= 0 ? sign * s.S * (x2[run.u] - x1[run.u]) : 0.0;
      if (owns_left) {
        r[at + run.v] += force;
        r[at + s.theta1] += moment;
        if (run.u >= 0) r[at + run.u] += along;
      }
      if (owns_right) {
        r[at + block_ + run.v] -= force;
        r[at + block_ + run.theta] += force * s.h - moment;
        if (run.u >= 0) r[at + block_ + run.u] -= along;
      }
    }
  }
}

template void InternalForces::add<double>(double, const double*, const double*, const double*, double*) const;
template void InternalForces::add<long double>(double, const double*, const double*, const double*, double*) const;

}  // namespace traverse::beam
