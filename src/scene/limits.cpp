// Estimates the memory of a scene from measured bytes per node, unknown, vehicle, force and probe, and compares it with
// the memory of the machine or of the cgroup of the process.
#include "limits.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

namespace traverse::scene {
namespace {

// Bytes for each item, measured in runs with many of them.
constexpr double a_node = 500.0, a_nodal_unknown = 750.0, a_probe = 2200.0, a_vehicle = 6e4, a_pair_of_vehicles = 1e3,
                 a_force = 400.0, a_spring = 800.0, a_sweep_peak = 200.0;
constexpr double most_peaks = 1e8;  // limit for a sweep; 32 bits can number them
constexpr int lapack_copies = 3, few_modes = 2;

/// The memory of one kind of item.
struct Need {
  double bytes = 0.0;
  std::string option, what;  // the option that sets their number (empty: the option of the mesh), and a description
};

double memory_of_machine() {
  double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    double limit = 0.0;
    if (std::ifstream(file) >> limit && limit > 0.0) bytes = std::min(bytes, limit);
  }
  return bytes;
}

int ranks() {
  int started = 0, count = 1;
  MPI_Initialized(&started);
  if (started != 0) MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

double sum(const std::vector<int>& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0); }

/// The number of elements of the bridge, or of the rail, which has more.
double elements_of(const beam::BeamModel& beam) {
  if (!beam.track) return sum(beam.elements);
  return (beam.length() + 2.0 * beam.track->approach) / beam.track->spacing * beam.track->elements_per_bay;
}

std::string option_of_mesh(const options::Options& o, const Scene& scene) {
  if (!scene.beam->track) return o.has("beam_elements_per_span") ? "beam_elements_per_span" : "beam_spans";
  if (o.has("track_elements_per_bay")) return "track_elements_per_bay";
  return scene.beam->track->approach > scene.beam->length() ? "track_approach" : "track_spacing";
}

void check_elements(const options::Options& o, const Scene& scene) {
  o.check_at_most(option_of_mesh(o, scene), elements_of(*scene.beam), most_elements, "elements in total");
}

Need mesh(const Scene& scene) {
  const beam::BeamModel& beam = *scene.beam;
  const double elements = elements_of(beam), unknowns = (beam.axial ? 3.0 : 2.0) + (beam.track ? 3.0 : 0.0);
  return {elements * (a_node + a_nodal_unknown * unknowns / ranks()), "", fmt::format("{:.3g} elements", elements)};
}

Need modes(const Scene& scene) {
  const bool modal_analysis = scene.analysis == Analysis::modes;
  const double nodes = elements_of(*scene.beam), unknowns = nodes * (scene.beam->axial ? 3.0 : 2.0);
  const double count = std::min<double>(modal_analysis ? scene.mode_count : scene.model.modes, unknowns);
  const bool all = count > unknowns / few_modes;
  const double numbers = all ? lapack_copies * unknowns * unknowns : 6.0 * count * unknowns;
  return {8.0 * numbers, modal_analysis ? "modes_count" : "model_modes",
          fmt::format("{:g} modes of {:g} unknowns", count, unknowns)};
}

double runs_of(const Sweep& sweep) {
  return static_cast<double>(std::max<std::size_t>(1, sweep.speeds.size())) *
         static_cast<double>(std::max<std::size_t>(1, sweep.loads.size()));
}

std::string option_of(const Sweep& sweep) { return sweep.speeds.empty() ? "sweep_hslm_a" : "sweep_speed"; }

void check_peaks(const options::Options& o, const Scene& scene) {
  const double probes = static_cast<double>(scene.output.probes.size());
  o.check_at_most(option_of(*scene.sweep), runs_of(*scene.sweep) * probes, most_peaks, "runs times probes");
}

Need sweep(const Scene& scene) {
  const double runs = runs_of(*scene.sweep), probes = static_cast<double>(scene.output.probes.size());
  return {a_sweep_peak * runs * probes, option_of(*scene.sweep),
          fmt::format("{:.3g} runs with {} probes each", runs, probes)};
}

std::vector<Need> needs_of(const Scene& scene) {
  const double vehicles = static_cast<double>(scene.train.vehicles.size());
  const double forces = static_cast<double>(scene.load.forces.size());
  const double probes = static_cast<double>(scene.output.probes.size());
  double wheels = 0.0;
  for (const int index : scene.train.vehicles)
    wheels += static_cast<double>(scene.vehicles[static_cast<std::size_t>(index)].wheels.size());
  std::vector<Need> needs = {{vehicles * (a_vehicle + a_pair_of_vehicles * vehicles), "train_vehicles",
                              fmt::format("{:g} vehicles", vehicles)},
                             {forces * a_force, "load_forces", fmt::format("{:g} forces", forces)},
                             {probes * (a_probe + 8.0 * (wheels + forces)), "output_probes",
                              fmt::format("{:g} probes and the wheels and forces that pass them", probes)}};
  if (!scene.beam) return needs;
  const beam::Foundation& f = scene.beam->foundation;
  double springs = 0.0;
  for_points(f,
             [&](const beam::FoundationKind&, const auto& points) { springs += static_cast<double>(points.size()); });
  const double kinks = static_cast<double>(scene.profile.kinks().size() + scene.beam->spans.size());
  needs.push_back(mesh(scene));
  needs.push_back(
      {springs * a_spring, "foundation_vertical_x", fmt::format("{:g} springs of the foundation", springs)});
  needs.push_back({16.0 * (wheels + forces) * kinks, forces > wheels ? "load_forces" : "train_vehicles",
                   fmt::format("{:g} wheels and forces that pass {:g} kinks of the surface", wheels + forces, kinks)});
  if (scene.analysis == Analysis::modes || scene.model.modes > 0) needs.push_back(modes(scene));
  if (scene.sweep) needs.push_back(sweep(scene));
  return needs;
}

}  // namespace

double memory_of(const Scene& scene) {
  const std::vector<Need> needs = needs_of(scene);
  return std::accumulate(needs.begin(), needs.end(), 0.0,
                         [](double bytes, const Need& need) { return bytes + need.bytes; });
}

void check_size(const options::Options& o, const Scene& scene) {
  if (scene.beam) check_elements(o, scene);
  if (scene.sweep) check_peaks(o, scene);
  const double available = memory_of_machine(), needed = memory_of(scene);
  if (needed <= available) return;
  const std::vector<Need> needs = needs_of(scene);
  const Need& most =
      *std::max_element(needs.begin(), needs.end(), [](const Need& a, const Need& b) { return a.bytes < b.bytes; });
  o.refuse(most.option.empty() ? option_of_mesh(o, scene) : most.option,
           fmt::format("the scene needs about {:.2g} GB of memory, {:.2g} GB of it for {}; this machine has "
                       "{:.2g} GB; reduce their number",
                       1e-9 * needed, 1e-9 * most.bytes, most.what, 1e-9 * available));
}

}  // namespace traverse::scene
