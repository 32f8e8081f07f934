// End forces of the elements from left to right, in double or extended precision, and in loops over neighbouring nodes.
// The forces on the left end follow from the stiffness, those on the right end from equilibrium of the element.
#include "beam/internal_forces.hpp"

#include <iterator>

#include "assembly.hpp"

namespace traverse::beam {
namespace {

/// Whether elements of equal length have the same stiffness.
bool is_uniform(const BeamModel& model) {
  return model.EI.uniform() && (!model.GA || model.GA->uniform()) && (!model.axial || model.EA.uniform()) &&
         (!model.torsion ||
          (model.torsion->GJ.uniform() && (!model.torsion->warping || model.torsion->warping->uniform())));
}

TwistForces twist_forces(const BeamModel& model, const Element& element) {
  return model.torsion ? TwistForces(torsion_matrices(model, element).stiffness) : TwistForces();
}

}  // namespace

InternalForces::InternalForces(const Beam& beam) : block_(beam.block()), local_(beam.local_columns()) {
  if (local_ == 0) return;
  runs_.push_back(run_of(beam, beam.bridge()));
  if (beam.rail() != nullptr) runs_.push_back(run_of(beam, *beam.rail()));
}

InternalForces::Run InternalForces::run_of(const Beam& beam, const Line& line) const {
  Run run{.twist = TwistPlaces(line)};
  run.u = line.place[0];
  run.v = line.place[1];
  run.theta = line.place[2];
  const BeamModel& model = line.model;
  const bool uniform = is_uniform(model);
  const auto [first, past] = line.elements_at(beam.first_column(), local_);
  double length = 0.0;
  Stiffness s{};
  TwistForces twisting;
  for (int e = first; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    const int column = line.first_column + element.left - beam.first_column();
    if (run.elements.empty()) run.first = column;
    if (!uniform || element.length != length) {
      const ElementMatrices m = element_matrices(model, element);
      s = {element.length, m.stiffness[2], m.stiffness[3], m.stiffness[6], m.stiffness[7], m.axial_stiffness[1], 0, 0};
      twisting = twist_forces(model, element);
    }
    length = element.length;
    s.theta1 = line.mesh.hinged(element.left) ? line.place[3] : line.place[2];
    s.u1 = line.mesh.has_expansion_device(element.left) ? line.place[4] : line.place[0];
    run.elements.resize(index(column - run.first + 1));  // skips the columns between separate spans
    run.elements.back() = s;
    if (run.twist.twist < 0) continue;
    run.twisting.resize(run.elements.size());
    run.twisting.back() = twisting;
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
void InternalForces::add_twist(const Run& run, double sign, const double* x, const double* left, const double* right,
                               double* r) const {
  const std::ptrdiff_t b = block_, past = run.first + std::ssize(run.elements);
  const auto [twist, left_rate, right_rate] = run.twist;
  const double* x1 = run.first < 0 ? left : x + run.first * b;
  for (std::ptrdiff_t column = run.first; column < past; ++column) {
    const double* x2 = column + 1 < local_ ? x + (column + 1) * b : right;
    const TwistForces& t = run.twisting[static_cast<std::size_t>(column - run.first)];
    if (t.T != 0.0) {  // not between separate spans
      const auto [torque, moment1, moment2] =
          t.of(Real(x2[twist]) - Real(x1[twist]), Real(x1[left_rate]), Real(x2[right_rate]));
      if (column >= 0) {
        r[column * b + twist] += sign * torque;
        r[column * b + left_rate] += sign * moment1;
      }
      if (column + 1 < local_) {
        r[(column + 1) * b + twist] -= sign * torque;
        r[(column + 1) * b + right_rate] += sign * moment2;
      }
    }
    x1 = x2;
  }
}

template <class Real>
void InternalForces::add(double sign, const double* x, const double* left, const double* right, double* r) const {
  for (const Run& run : runs_) {
    if (run.u >= 0) {
      add_run<Real, true>(run, sign, x, left, right, r);
    } else {
      add_run<Real, false>(run, sign, x, left, right, r);
    }
    if (run.twist.twist >= 0) add_twist<Real>(run, sign, x, left, right, r);
  }
}

template void InternalForces::add<double>(double, const double*, const double*, const double*, double*) const;
template void InternalForces::add<long double>(double, const double*, const double*, const double*, double*) const;

ElementRows::ElementRows(const Beam& beam) {
  if (beam.local_columns() == 0) return;
  runs_.push_back(run_of(beam, beam.bridge()));
  if (beam.rail() != nullptr) runs_.push_back(run_of(beam, *beam.rail()));
}

ElementRows::Run ElementRows::run_of(const Beam& beam, const Line& line) {
  using Numbers = std::array<double, numbers>;
  std::vector<std::pair<Numbers, TwistForces>> all(static_cast<std::size_t>(beam.local_columns()) + 1);
  const BeamModel& model = line.model;
  const auto [from, past] = line.elements_at(beam.first_column(), beam.local_columns());
  const bool uniform = is_uniform(model);
  double length = 0.0;
  std::pair<Numbers, TwistForces> c;
  for (int e = from; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    if (!uniform || element.length != length) {
      const ElementMatrices m = element_matrices(model, element);
      c.first = {element.length, m.stiffness[2], m.stiffness[3], m.stiffness[6], m.stiffness[7], m.axial_stiffness[1]};
      c.second = twist_forces(model, element);
    }
    length = element.length;
    all[static_cast<std::size_t>(line.first_column + element.left - beam.first_column() + 1)] = c;
  }
  Run run{line.place[0], line.place[1], line.place[2], TwistPlaces(line), {}, {}, {}};
  const auto hash = [&](std::ptrdiff_t j) { return solve::hash_of(0, all[static_cast<std::size_t>(j)].first); };
  const auto same = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return all[static_cast<std::size_t>(i)] == all[static_cast<std::size_t>(j)];
  };
  for (std::ptrdiff_t j : run.stored.assign(std::ssize(all), hash, same)) {
    const auto& [numbers_of, twisting] = all[static_cast<std::size_t>(j)];
    for (std::size_t i = 0; i < numbers; ++i) run.coefficients[i].push_back(numbers_of[i]);
    if (run.twist.twist >= 0) run.twisting.push_back(twisting);
  }
  return run;
}

template <bool axial>
void ElementRows::add_run(const Run& run, int first, int past, const Planes& x, const Planes& r) {
  const int nodes = past - first;
  const double *const v = x[run.v], *const theta = x[run.theta], *const u = axial ? x[run.u] : nullptr;
  // For each element: force, moment and axial force on its left end, and the moment on its right end.
  std::array<double, tile + 1> force, left_moment, right_moment, along;
  for (int begin = 0; begin <= nodes;) {
    const solve::Stored& stored = run.stored.at(first + begin);
    const int end = static_cast<int>(std::min<std::ptrdiff_t>(nodes + 1, stored.row_end(first + begin) - first));
    const std::ptrdiff_t place = stored.storage_index(first + begin) - begin;
    const auto coefficients_from = [&](std::size_t i) { return run.coefficients[i].data() + place; };
    const double *h = coefficients_from(0), *A = coefficients_from(1), *B = coefficients_from(2),
                 *C = coefficients_from(3), *D = coefficients_from(4), *S = coefficients_from(5);
    for (int j = begin; j < end; ++j) {
      const double turn = theta[j + 1] - theta[j];
      const double rise = v[j + 1] - v[j] - h[j] * theta[j];
      force[j] = A[j] * rise + B[j] * turn;
      left_moment[j] = C[j] * rise + D[j] * turn;
      right_moment[j] = force[j] * h[j] - left_moment[j];
      if constexpr (axial) along[j] = S[j] * (u[j + 1] - u[j]);
    }
    begin = end;
  }
  double *const rv = r[run.v], *const rtheta = r[run.theta];
  for (int i = 0; i < nodes; ++i) {
    rv[i] += force[i + 1] - force[i];
    rtheta[i] += right_moment[i] + left_moment[i + 1];
  }
  if constexpr (axial) {
    double* const ru = r[run.u];
    for (int i = 0; i < nodes; ++i) ru[i] += along[i + 1] - along[i];
  }
}

void ElementRows::add_twist(const Run& run, int first, int past, const Planes& x, const Planes& r) {
  const int nodes = past - first;
  const double *const twist = x[run.twist.twist], *const left = x[run.twist.left_rate],
                      *const right = x[run.twist.right_rate];
  double *const to_twist = r[run.twist.twist], *const to_left = r[run.twist.left_rate],
                *const to_right = r[run.twist.right_rate];
  for (int j = 0; j <= nodes; ++j) {
    const auto place = static_cast<std::size_t>(run.stored.at(first + j).storage_index(first + j));
    const auto [torque, moment1, moment2] = run.twisting[place].of(twist[j + 1] - twist[j], left[j], right[j + 1]);
    if (j > 0) {
      to_twist[j - 1] += torque;
      to_left[j - 1] += moment1;
    }
    if (j == nodes) break;
    to_twist[j] -= torque;
    to_right[j] += moment2;
  }
}

void ElementRows::add(int first, int past, const Planes& x, const Planes& r) const {
  for (const Run& run : runs_) {
    run.u >= 0 ? add_run<true>(run, first, past, x, r) : add_run<false>(run, first, past, x, r);
    if (run.twist.twist >= 0) add_twist(run, first, past, x, r);
  }
}

}  // namespace traverse::beam
