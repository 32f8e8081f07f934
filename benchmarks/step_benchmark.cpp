// Time of a step and of its parts: `build/benchmarks/step_benchmark`, or under `mpirun -n 2`.
// Scene: a continuous bridge of 32 m spans, 10 elements each, under coaches of 10 degrees of freedom on Hertz wheels.
// right_hand_side and implicit_stage are what PETSc's implicit types such as ARKIMEX are made of, not the default;
// whole_step is a step of esdirk4, or of what -ts_type names. Counters: time per beam unknown, and per step.
#include <benchmark/benchmark.h>
#include <slepceps.h>

#include <memory>
#include <string>

#include "integrate/stepper.hpp"
#include "support/folders.hpp"
#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace {

using namespace traverse;

struct Setup {
  std::unique_ptr<beam::Beam> beam;
  std::unique_ptr<coupling::System> system;
  std::vector<double> y, ydot, c;
  double shift = 4000.0;  // 1/s, of a stage of ARKIMEX 4, or of esdirk4, at steps of 1 ms

  Setup(int spans, int coaches) {
    const scene::Scene scene = scene::read_scene(options::Options({
        {"beam_spans", "32.0*" + std::to_string(spans)},
        {"beam_elements_per_span", "10"},
        {"beam_EI", "3.795e11"},
        {"beam_mass", "3.0e4"},
        {"support_types", "roller"},
        {"vehicle_coach_file", traverse::source_folder() + "/options/vehicles/s300.yml"},
        {"train_vehicles", "coach*" + std::to_string(coaches)},
        {"train_positions", std::to_string(16.0 + 25.0 * (coaches - 1))},
        {"train_spacing", "25.0"},
        {"train_speed", "83.333"},
        {"ts_max_time", "1.0"},
    }));
    beam = std::make_unique<beam::Beam>(PETSC_COMM_WORLD, *scene.beam);
    beam->set_rayleigh({0.5, 5e-4});
    system = std::make_unique<coupling::System>(
        PETSC_COMM_WORLD, beam.get(),
        coupling::SystemInput{scene.vehicles, scene.train, scene.load, scene.profile, scene.gravity, false});
    y.resize(static_cast<std::size_t>(system->local_size()));
    ydot.resize(y.size());
    c.resize(y.size());
    system->start(true, y.data());
    system->rate(0.0, y.data(), ydot.data());
    for (std::size_t i = 0; i < y.size(); ++i) c[i] = ydot[i] - shift * y[i];
  }
};

int all_unknowns(const Setup& s) { return s.beam->mesh().nodes() * s.beam->block(); }

void per_unknown(benchmark::State& state, const Setup& s) {
  state.counters["per_unknown"] =
      benchmark::Counter(all_unknowns(s), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["unknowns"] = all_unknowns(s);
}

void beam_solve(benchmark::State& state) {
  Setup s(static_cast<int>(state.range(0)), 1);
  structure::BeamOperator op(*s.beam);
  std::vector<double> x(static_cast<std::size_t>(op.unknowns()), 1.0);
  const auto& factor = op.factored(s.shift, s.shift * s.shift);
  for (auto _ : state) factor.solve(x.data());
  per_unknown(state, s);
}

void beam_product(benchmark::State& state) {
  Setup s(static_cast<int>(state.range(0)), 1);
  structure::BeamOperator op(*s.beam);
  std::vector<double> x(static_cast<std::size_t>(op.unknowns()), 1.0), r(x.size());
  for (auto _ : state) op.multiply(-1.0, x.data(), x.data(), nullptr, r.data());
  per_unknown(state, s);
}

void right_hand_side(benchmark::State& state) {
  Setup s(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  for (auto _ : state) s.system->rate(0.0, s.y.data(), s.ydot.data());
  per_unknown(state, s);
}

void implicit_stage(benchmark::State& state) {
  Setup s(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  for (auto _ : state) s.system->solve_stage(1e-3, s.shift, s.c.data(), s.y.data());
  per_unknown(state, s);
}

// A run of 200 steps of 1 ms; the time is that of one step.
void whole_step(benchmark::State& state) {
  constexpr int steps = 200;
  Setup s(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  for (auto _ : state) {
    state.PauseTiming();
    integrate::Stepper stepper(*s.system, {steps * 1e-3, 1e-3, 1.0, {}});
    double* y = stepper.state();
    s.system->start(true, y);
    stepper.restore_state(&y);
    state.ResumeTiming();
    stepper.run([](const integrate::Instant&) {}, [](double, long) { return true; });
  }
  state.counters["per_step"] =
      benchmark::Counter(steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  per_unknown(state, s);
  state.counters["per_unknown"] = benchmark::Counter(
      all_unknowns(s) * steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Equal counts on every rank: the parts are collective.
void shapes(benchmark::internal::Benchmark* b) {
  for (int spans : {1, 30, 1000}) b->Args({spans, spans == 1 ? 1 : 8})->Iterations(spans == 1000 ? 100 : 2000);
}
BENCHMARK(beam_solve)->Apply(shapes);
BENCHMARK(beam_product)->Apply(shapes);
BENCHMARK(right_hand_side)->Apply(shapes);
BENCHMARK(implicit_stage)->Apply(shapes);
BENCHMARK(whole_step)->Args({1, 1})->Args({30, 8})->Args({1000, 8})->Iterations(1);

class Silent : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  int count = 1;
  (void)SlepcInitialize(&count, &argv, nullptr, nullptr);
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  Silent silent;
  if (rank == 0)
    benchmark::RunSpecifiedBenchmarks();
  else
    benchmark::RunSpecifiedBenchmarks(&silent);
  (void)SlepcFinalize();
  return 0;
}
