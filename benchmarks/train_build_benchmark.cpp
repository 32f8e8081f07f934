// Time from options to a train ready to run: files of sixteen coaches read and checked, their mechanisms put together
// and partitioned, the bridge assembled, static equilibrium found: `build/benchmarks/train_build_benchmark`.
#include <benchmark/benchmark.h>
#include <slepceps.h>

#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "support/folders.hpp"
#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace {

using namespace traverse;

/// Up to a System; with `start` also the static equilibrium it starts from.
void train_build(benchmark::State& state, const std::string& vehicle, bool start) {
  const int coaches = 16;
  double freedom = 0.0;
  for (auto _ : state) {
    const scene::Scene scene = scene::read_scene(options::Options({
        {"beam_spans", "32.0*3"},
        {"beam_elements_per_span", "10"},
        {"beam_EI", "3.795e11"},
        {"beam_mass", "3.0e4"},
        {"support_types", "roller"},
        {"vehicle_coach_file", traverse::source_folder() + "/options/vehicles/" + vehicle + ".yml"},
        {"train_vehicles", "coach*" + std::to_string(coaches)},
        {"train_speed", "83.333"},
        {"ts_max_time", "1.0"},
    }));
    beam::Beam beam(PETSC_COMM_WORLD, *scene.beam);
    beam.set_rayleigh({0.5, 5e-4});
    coupling::System system(
        PETSC_COMM_WORLD, &beam,
        coupling::SystemInput{scene.vehicles, scene.train, scene.load, scene.profile, scene.gravity, false});
    freedom = system.fleet().freedom();
    if (!start) continue;
    std::vector<double> y(static_cast<std::size_t>(system.local_size()));
    system.start(true, y.data());
    benchmark::DoNotOptimize(y.data());
  }
  state.counters["freedom"] = freedom;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  int count = 1;
  (void)SlepcInitialize(&count, &argv, nullptr, nullptr);
  for (const std::string vehicle : {"s300", "velaro"})
    for (const bool start : {false, true}) {
      const std::string name = "train_build/" + vehicle + (start ? "/with_equilibrium" : "");
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        train_build(state, vehicle, start);
      })->Unit(benchmark::kMillisecond);
    }
  benchmark::RunSpecifiedBenchmarks();
  (void)SlepcFinalize();
  return 0;
}
