// End forces of the elements from left to right, in double or extended precision. The forces on the left end follow
// from the stiffness, the forces on the right end from equilibrium of the element.
#include "beam/internal_forces.hpp"

#include <iterator>

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
  const bool uniform = model.EI.uniform() && (!model.GA || model.GA->uniform()) && (!model.axial || model.EA.uniform());
  const auto [first, past] = line.elements_at(beam.first_column(), local_);
  double length = 0.0;
  Stiffness s{};
  for (int e = first; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    const int column = line.first_column + element.left - beam.first_column();
    if (run.elements.empty()) run.first = column;
    if (!uniform || element.length != length) {
      const ElementMatrices m = element_matrices(model, element);
      s = {element.length, m.stiffness[2], m.stiffness[3], m.stiffness[6], m.stiffness[7], m.axial_stiffness[1], 0, 0};
    }
    length = element.length;
    s.theta1 = line.mesh.hinged(element.left) ? line.place[3] : line.place[2];
    s.u1 = line.mesh.has_expansion_device(element.left) ? line.place[4] : line.place[0];
    run.elements.resize(index(column - run.first + 1));  // skips the columns between separate spans
    run.elements.back() = s;
  }
  return run;
}

// Processes the elements from left to right and keeps the forces of an element on its right node for the next element.
template <class Real, bool axial>
void InternalForces::add_run(const Run& run, double sign, const double* x, const double* left, const double* right,
                             double* r) const {
  const std::ptrdiff_t b = block_, v = run.v, theta = run.theta, u = run.u;
  double force = 0.0, moment = 0.0, along = 0.0;  // forces of the element on the left of a node, acting on the node
  const double* x1 = run.first < 0 ? left : x + run.first * b;
  for (std::ptrdiff_t i = 0, column = run.first; i < std::ssize(run.elements); ++i, ++column) {
    const Stiffness& s = run.elements[static_cast<std::size_t>(i)];
    const double* x2 = column + 1 < local_ ? x + (column + 1) * b : right;
    const Real turn = Real(x2[theta]) - Real(x1[s.theta1]);
    const Real rise = Real(x2[v]) - Real(x1[v]) - Real(s.h) * Real(x1[s.theta1]);
    const double f = sign * static_cast<double>(Real(s.A) * rise + Real(s.B) * turn);
    const double m = sign * static_cast<double>(Real(s.C) * rise + Real(s.D) * turn);
    double n = 0.0;
    if constexpr (axial) n = sign * static_cast<double>(Real(s.S) * (Real(x2[u]) - Real(x1[s.u1])));
    if (column >= 0) {
      double* node = r + column * b;
      node[v] += force + f;
      node[theta] += moment;
      node[s.theta1] += m;
      if constexpr (axial) node[u] += s.u1 == u ? along + n : along;
      if (axial && s.u1 != u) node[s.u1] += n;
    }
    force = -f;
    moment = f * s.h - m;
    if constexpr (axial) along = -n;
    x1 = x2;
  }
  const std::ptrdiff_t last = run.first + std::ssize(run.elements);
  if (last >= local_ || last < 0 || run.elements.empty()) return;
  r[last * b + v] += force;
  r[last * b + theta] += moment;
  if constexpr (axial) r[last * b + u] += along;
}

template <class Real>
void InternalForces::add(double sign, const double* x, const double* left, const double* right, double* r) const {
  for (const Run& run : runs_) {
    if (run.u >= 0) {
      add_run<Real, true>(run, sign, x, left, right, r);
    } else {
      add_run<Real, false>(run, sign, x, left, right, r);
    }
  }
}

template void InternalForces::add<double>(double, const double*, const double*, const double*, double*) const;
template void InternalForces::add<long double>(double, const double*, const double*, const double*, double*) const;

}  // namespace traverse::beam
