// Records for every kind of one-sided spring, support and sleeper whether it has been unloaded, compressed or in
// tension, and reports the first of these states that occurs only after the end of the trial runs. Prints a warning for
// deflections above a tenth of the longest span, and stops the run with an error above a hundred spans.
#include "run/extrapolation_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "traverse/base/error.hpp"
#include "traverse/train/vehicle.hpp"

namespace traverse::run {
namespace {

constexpr unsigned char unloaded = 1, compressed = 2, tensioned = 4;

bool may_separate(const beam::FoundationLaw& law) { return law.one_sided || law.gap > 0.0; }

constexpr double warning_ratio = 0.1;  // relative to the longest span
constexpr double error_ratio = 100.0;  // relative to the longest span

}  // namespace

ExtrapolationCheck::ExtrapolationCheck(double until, const train::Fleet& fleet, const beam::BeamModel* beam)
    : until_(until) {
  if (until == std::numeric_limits<double>::infinity()) return;
  add_springs(fleet);
  if (beam != nullptr) add_supports(*beam);
  sleepers_ = {states_.size(), "a sleeper over a gap"};
  states_.push_back(0);
}

void ExtrapolationCheck::add_springs(const train::Fleet& fleet) {
  std::map<std::tuple<const train::Vehicle*, bool, std::size_t>, std::size_t> kinds;
  for (std::size_t vehicle = 0; vehicle < fleet.members.size(); ++vehicle) {
    const train::Member& member = fleet.members[vehicle];
    const auto add = [&](const auto& springs, int first, bool torsion) {
      for (std::size_t i = 0; i < springs.size(); ++i) {
        if (!springs[i].law || !springs[i].law->can_disengage()) continue;
        const auto [kind, is_new] = kinds.try_emplace({member.type, torsion, i}, states_.size());
        if (is_new) states_.push_back(0);
        springs_.push_back({member.unit,
                            first + static_cast<int>(i),
                            torsion,
                            {kind->second, fmt::format("spring '{}' of vehicle {}", springs[i].name, vehicle)}});
      }
    };
    add(member.type->mechanism.springs, member.first_spring, false);
    add(member.type->mechanism.torsion_springs, member.first_torsion_spring, true);
  }
}

void ExtrapolationCheck::add_supports(const beam::BeamModel& beam) {
  for (std::size_t row = 0; row < beam::foundation_kind_count; ++row) {
    const beam::FoundationKind& kind = beam::foundation_kinds[row];
    std::map<std::tuple<double, double, double, bool>, std::size_t> kinds;
    const auto add = [&](std::size_t place, const auto& numbers, std::string name) {
      const auto [found, is_new] = kinds.try_emplace(numbers, states_.size());
      if (is_new) states_.push_back(0);
      supports_.push_back({row, place, {found->second, std::move(name)}});
    };
    if (kind.points != nullptr) {
      const std::vector<beam::PointFoundation>& points = beam.foundation.*kind.points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const beam::PointFoundation& p = points[i];
        if (may_separate(p.law))
          add(i, std::tuple{p.k, p.c, p.law.gap, p.law.one_sided},
              fmt::format("the {} foundation at {:g} m", kind.name, p.x));
      }
    } else if (beam.foundation.*kind.bed && may_separate((beam.foundation.*kind.bed)->law)) {
      for (std::size_t span = 0; span < beam.spans.size(); ++span)
        add(span, std::tuple{0.0, 0.0, 0.0, true}, fmt::format("the {} in span {}", kind.name, span));
    }
  }
}

void ExtrapolationCheck::record(double t, const Part& part, double force) {
  const unsigned char state = force == 0.0 ? unloaded : force < 0.0 ? compressed : tensioned;
  unsigned char& states = states_[part.kind];
  if (t > until_ && (states & state) == 0 && new_event_.empty())
    new_event_ = fmt::format("{} {} at {:.3g} s", part.name, state == unloaded ? "lets go" : "touches", t);
  states |= state;
}

void ExtrapolationCheck::add(double t, const train::Fleet& fleet, const structure::NonlinearForces& foundation,
                             ResponseExtremes& peaks) {
  if (t > until_ && !roughness_before_) {
    roughness_before_ = peaks.roughness();
    peaks.reset_roughness();
  }
  for (const Spring& s : springs_) {
    const train::MovingVehicle& vehicle = fleet.vehicles[static_cast<std::size_t>(s.vehicle)];
    record(t, s.part,
           s.torsion ? vehicle.mechanism.torsion_spring_moment(vehicle.state, s.spring)
                     : vehicle.mechanism.spring_tension(vehicle.state, s.spring));
  }
  for (const Support& s : supports_)
    if (const std::vector<double>& forces = foundation.of_kind[s.row]; s.place < forces.size())
      record(t, s.part, forces[s.place]);
  if (until_ < std::numeric_limits<double>::infinity())
    for (const double force : foundation.below_sleepers) record(t, sleepers_, force);
}

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
