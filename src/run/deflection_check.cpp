// Prints a warning for deflections above a tenth of the longest span, and stops the run with an error above a hundred
// spans.
#include "run/deflection_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "traverse/base/error.hpp"

namespace traverse::run {
namespace {

constexpr double warning_ratio = 0.1;  // relative to the longest span
constexpr double error_ratio = 100.0;  // relative to the longest span

}  // namespace

void check_deflection(MPI_Comm comm, const scene::Scene& scene, double deflection) {
  if (!scene.beam) return;
  const double span = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end());
  const double size = std::abs(deflection);
  if (size > error_ratio * span)
    throw SolverError(
        fmt::format("the bridge deflects by {:.3g} m, its longest span is {:g} m: no beam does; check the units of "
                    "beam_EI, beam_mass, loads and speed (N, m, kg, s)",
                    size, span));
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (size > warning_ratio * span && rank == 0)
    fmt::print(
        "  note: the bridge deflects by {:.3g} m, more than a tenth of its longest span of {:g} m: the theory of small "
        "displacements does not hold there\n",
        size, span);
}

}  // namespace traverse::run
