// Assembles the outputs of a scene from the groups of bridge and train, with the stored energies: kinetic, strain,
// potential, dissipated, work and residual.
#include "run/outputs.hpp"

#include "output_groups.hpp"

namespace traverse::run {
namespace {

constexpr Row<EnergyTerms> energy_rows[] = {
    {"kinetic", "J", of<&EnergyTerms::kinetic>},     {"strain", "J", of<&EnergyTerms::strain>},
    {"potential", "J", of<&EnergyTerms::potential>}, {"dissipated", "J", of<&EnergyTerms::dissipated>},
    {"work", "J", of<&EnergyTerms::work>},           {"residual", "J", of<&EnergyTerms::residual>},
};

}  // namespace

void add_energy(const Source&, Outputs& outputs) {
  outputs.add("/energy/", energy_rows, [](const Observed& now) -> const EnergyTerms& { return now.energy; });
}

Outputs outputs_of(const Source& source) {
  Outputs outputs;
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

}  // namespace traverse::run
