// Assembles the outputs of a scene from the groups of bridge and train, with the stored energies: kinetic, strain,
// potential, dissipated, work and residual, and the forces of foundation and layered track: of single points and
// sleepers, and of beds on each span.
#include "run/outputs.hpp"

#include <algorithm>

#include "beam/nonlinear_points.hpp"
#include "output_groups.hpp"

namespace traverse::run {
namespace {

constexpr Row<EnergyTerms> energy_rows[] = {
    {"kinetic", "J", of<&EnergyTerms::kinetic>},     {"strain", "J", of<&EnergyTerms::strain>},
    {"potential", "J", of<&EnergyTerms::potential>}, {"dissipated", "J", of<&EnergyTerms::dissipated>},
    {"work", "J", of<&EnergyTerms::work>},           {"residual", "J", of<&EnergyTerms::residual>},
};

constexpr std::size_t max_points = 2000;  // largest number of points of a kind whose forces are stored

/// The number of stored forces of a kind of foundation: one for each point, or for each span on a bed; 0: the beam has
/// none of this kind.
std::size_t forces_stored(const beam::BeamModel& model, const beam::FoundationKind& kind) {
  if (!present(model.foundation, kind) || !acts(kind, model)) return 0;
  const std::size_t count = kind.bed != nullptr ? model.spans.size() : (model.foundation.*kind.points).size();
  return count <= max_points ? count : 0;
}

std::vector<double> stations_of(const std::vector<beam::PointFoundation>& points) {
  std::vector<double> x;
  for (const beam::PointFoundation& point : points) x.push_back(point.x);
  return x;
}

/// The positions of sleepers over a gap, in ascending order, m.
std::vector<double> hanging_positions(const beam::Beam& beam) {
  std::vector<double> x;
  for (const beam::NonlinearPoint& sleeper : beam::hanging_sleepers(beam.bridge(), beam.layout(), 0, beam.columns()))
    x.push_back(sleeper.x);
  return x;
}

}  // namespace

void add_energy(const Source&, Outputs& outputs) {
  outputs.add("/energy/", energy_rows, [](const Observed& now) -> const EnergyTerms& { return now.energy; });
}

Outputs outputs_of(const Source& source) {
  Outputs outputs;
  if (!source.scene.output.series) {
    add_energy(source, outputs);
    for (const results::Layout::Constant& x : stations(source.scene.output.probes, {}))
      outputs.add_constant(x.name, x.values, "m");
    return outputs;
  }
  if (source.beam != nullptr)
    for (const OutputGroup add : output_groups_of_a_bridge) add(source, outputs);
  for (const OutputGroup add : output_groups) add(source, outputs);
  return outputs;
}

std::vector<results::Layout::Constant> stations(const std::vector<double>& probes,
                                                const std::vector<double>& supports) {
  std::vector<results::Layout::Constant> constants;
  if (!probes.empty()) constants.push_back({"/probes/x", probes, "m"});
  if (!supports.empty()) constants.push_back({"/supports/x", supports, "m"});
  return constants;
}

results::Layout layout_without_series(const scene::Scene& scene) {
  std::vector<double> ends = {scene.beam->start};
  for (const double span : scene.beam->spans) ends.push_back(ends.back() + span);
  results::Layout layout;
  layout.constants = stations(scene.output.probes, ends);
  return layout;
}

void add_foundation(const Source& source, Outputs& outputs) {
  const beam::BeamModel& model = source.beam->model();
  for (std::size_t k = 0; k < beam::foundation_kind_count; ++k) {
    const beam::FoundationKind& kind = beam::foundation_kinds[k];
    const std::size_t count = forces_stored(model, kind);
    if (count == 0) continue;
    const std::string group = "/foundation/" + std::string(kind.name) + "/";
    if (kind.points != nullptr) outputs.add_constant(group + "x", stations_of(model.foundation.*kind.points), "m");
    const beam::FoundationForceName& force = beam::force_name(kind);
    outputs.add_numbers(group + std::string(force.quantity), std::string(force.unit), count,
                        [k](const Observed& now, std::size_t i) {  // sum of linear and nonlinear forces
                          const double linear = now.ground->of_kind(k)[i];
                          const std::vector<double>& other = now.motion.beam.foundation.of_kind[k];
                          return i < other.size() ? linear + other[i] : linear;
                        });
  }
}

// Sleepers over a gap.
void add_hanging(const Source& source, Outputs& outputs) {
  const std::vector<double> x = hanging_positions(*source.beam);
  if (x.empty() || x.size() > max_points) return;
  outputs.add_constant("/track/hanging/x", x, "m");
  outputs.add_numbers("/track/hanging/force", "N", x.size(),
                      [](const Observed& now, std::size_t i) { return now.motion.beam.foundation.below_sleepers[i]; });
  outputs.add_numbers("/track/hanging/gap", "m", x.size(),
                      [](const Observed& now, std::size_t i) { return now.motion.beam.foundation.open_gaps[i]; });
}

// The force of a gap's spring is not part of the linear forces.
void add_sleepers(const Source& source, Outputs& outputs) {
  if (source.scene.output.sleepers.empty()) return;
  const std::vector<double> hanging = hanging_positions(*source.beam);
  const std::vector<double> x = recovery::SleeperForces(*source.beam, source.scene.output.sleepers).x();
  std::vector<std::optional<std::size_t>> gap;  // index of the gap, for sleepers over one
  for (const double station : x) {
    const auto found = std::find(hanging.begin(), hanging.end(), station);
    gap.push_back(found == hanging.end() ? std::nullopt : std::optional<std::size_t>(found - hanging.begin()));
  }
  outputs.add_constant("/track/sleepers/x", x, "m");
  outputs.add_numbers("/track/sleepers/pad_force", "N", x.size(),
                      [](const Observed& now, std::size_t i) { return now.sleepers->pad(i); });
  if (!source.beam->model().track->ballast) return;
  outputs.add_numbers("/track/sleepers/ballast_force", "N", x.size(), [gap](const Observed& now, std::size_t i) {
    return now.sleepers->ballast(i) + (gap[i] ? now.motion.beam.foundation.below_sleepers[*gap[i]] : 0.0);
  });
}

}  // namespace traverse::run
