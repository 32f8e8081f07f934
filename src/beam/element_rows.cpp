// End forces of each element from the relative displacement and rotation of its ends, in loops over neighbouring nodes.
#include "beam/element_rows.hpp"

namespace traverse::beam {

ElementRows::ElementRows(const Beam& beam) {
  if (beam.local_columns() == 0) return;
  runs_.push_back(run_of(beam, beam.bridge()));
  if (beam.rail() != nullptr) runs_.push_back(run_of(beam, *beam.rail()));
}

ElementRows::Run ElementRows::run_of(const Beam& beam, const Line& line) {
  using Numbers = std::array<double, numbers>;
  std::vector<Numbers> all(static_cast<std::size_t>(beam.local_columns()) + 1, Numbers{});
  const BeamModel& model = line.model;
  const auto [from, past] = line.elements_at(beam.first_column(), beam.local_columns());
  const bool uniform = model.EI.uniform() && (!model.GA || model.GA->uniform()) && (!model.axial || model.EA.uniform());
  double length = 0.0;
  Numbers c{};
  for (int e = from; e < past; ++e) {
    const Element& element = line.mesh.element(e);
    if (!uniform || element.length != length) {
      const ElementMatrices m = element_matrices(model, element);
      c = {element.length, m.stiffness[2], m.stiffness[3], m.stiffness[6], m.stiffness[7], m.axial_stiffness[1]};
    }
    length = element.length;
    all[static_cast<std::size_t>(line.first_column + element.left - beam.first_column() + 1)] = c;
  }
  Run run{line.place[0], line.place[1], line.place[2], {}, {}};
  const auto hash = [&](std::ptrdiff_t j) { return solve::hash_of(0, all[static_cast<std::size_t>(j)]); };
  const auto same = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return all[static_cast<std::size_t>(i)] == all[static_cast<std::size_t>(j)];
  };
  for (std::ptrdiff_t j : run.stored.assign(std::ssize(all), hash, same)) {
    for (std::size_t i = 0; i < numbers; ++i) run.coefficients[i].push_back(all[static_cast<std::size_t>(j)][i]);
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

void ElementRows::add(int first, int past, const Planes& x, const Planes& r) const {
  for (const Run& run : runs_)
    run.u >= 0 ? add_run<true>(run, first, past, x, r) : add_run<false>(run, first, past, x, r);
}

}  // namespace traverse::beam
