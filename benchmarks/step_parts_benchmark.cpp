// Prints what a step of 1 ms of esdirk4 and genalpha takes, its parts (medians of ROUNDS, 15, in turn), all per
// unknown, and what memory.
//   build/benchmarks/step_parts_benchmark [FILE.csv [LARGEST [SMALLEST [ROUNDS]]]], also under mpirun -n 2;
//   step_parts.py draws it.
//
// bare solve: of one right-hand side that stands ready. A stage makes its right-hand side (products of mass, damping
// and stiffness with combinations of the step's vectors) while it solves. Steps with a train: one coach below 1,000
// unknowns, eight above, from the bridge's beginning on; what they take beyond the step without is the vehicles'.

#include <malloc.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <utility>

#include "base/one_step_methods.hpp"
#include "step_scene.hpp"
#include "structure/beam_motion.hpp"

namespace {

using namespace traverse;
using namespace traverse::benchmarks;

constexpr double step = 1e-3;  // s

struct Part {
  std::string name;
  std::function<double()> time;  // s, of one
  std::vector<double> times = {};
};

struct Integrator {
  const char* name;
  base::Method method;
};

std::vector<Integrator> integrators() {
  return {{"esdirk4", base::esdirk4()}, {"genalpha", base::generalised_alpha(0.9)}};
}

/// The beam's stages and the step's end, apart from the system around them.
struct Stages {
  structure::BeamMotion motion;
  base::Method method;
  std::vector<double> v, w;

  Stages(const beam::Beam& beam, structure::BeamOperator& op, base::Method unit)
      : motion(beam, op, nullptr), method(std::move(unit)), v(static_cast<std::size_t>(op.unknowns()), 1e-3), w(v) {
    method.scale_to(step);
    motion.begin(method);
  }
  void solve() {
    for (std::size_t stage = 0; stage < method.stages.size(); ++stage) motion.solve(stage, v.data(), w.data(), {});
  }
  void finish() { motion.finish(v.data(), w.data()); }
};

/// Steps of a system, again from the start where the train is about to leave.
struct Steps {
  StepScene scene;
  std::vector<double> start, y;
  double t = 0.0;

  Steps(int unknowns, Spans kind, int coaches, const base::Method& method)
      : scene(unknowns, kind, coaches), start(static_cast<std::size_t>(scene.system->local_size())) {
    scene.system->start(true, start.data());
    scene.system->begin_motion(method);
    scene.beam->release_matrices();
    restart();
  }
  void restart() {
    y = start;
    t = 0.0;
    scene.system->restart_motion(t, step, y.data());
  }
  double time(int steps) {
    if (t + steps * step > scene.system->leaving_time()) restart();
    return seconds(steps, [&] {
      scene.system->begin_step(t, t + step);
      if (!scene.system->step_motion(t, step, y.data())) throw std::runtime_error("a step without a solution");
      t += step;
      scene.system->accept(t, y.data());
    });
  }
};

/// One kind of bridge at one size: lines of the table.
void measure(int size, Spans kind, int rounds, std::ofstream& table) {
  const StepScene bridge(size, kind, 0);
  structure::BeamOperator op(*bridge.beam);
  const int unknowns = bridge.unknowns(), coaches = size < 1000 ? 1 : 8;
  const int solves = std::clamp(500'000 / unknowns, 3, 5'000), steps = std::clamp(100'000 / unknowns, 3, 100);
  std::vector<double> x(static_cast<std::size_t>(op.unknowns()), 1.0);
  const double shift = 1.0 / (0.25 * step);
  std::vector<Part> parts = {
      {"bare solve", [&] { return seconds(solves, [&] { op.factored(shift, shift * shift).solve(x.data()); }); }}};
  for (const Integrator& i : integrators()) {
    const auto stages = std::make_shared<Stages>(*bridge.beam, op, i.method);
    const auto count = static_cast<double>(i.method.stages.size());
    const std::string name = i.name;
    parts.push_back({name + " stage", [=] { return seconds(solves, [&] { stages->solve(); }) / count; }});
    parts.push_back({name + " end of the step", [=] { return seconds(solves, [&] { stages->finish(); }); }});
    const auto bare = std::make_shared<Steps>(size, kind, 0, i.method);
    const auto laden = std::make_shared<Steps>(size, kind, coaches, i.method);
    parts.push_back({name + " step without vehicles", [=] { return bare->time(steps); }});
    parts.push_back({name + " step", [=] { return laden->time(steps); }});
  }
  for (Part& part : parts) (void)part.time();  // factorisations
  for (int round = 0; round < rounds; ++round)
    for (Part& part : parts) part.times.push_back(part.time());
  if (rank() != 0) return;
  const double reference = median(parts.front().times);
  for (const Part& part : parts) {
    const double time = median(part.times);
    std::printf("%9d  %-17s %-32s %10.3f %10.3f %8.2f\n", unknowns, name_of(kind), part.name.c_str(), 1e6 * time,
                1e9 * time / unknowns, time / reference);
    table << unknowns << ',' << name_of(kind) << ',' << ranks() << ',' << coaches << ',' << part.name << ',' << time
          << ',' << 1e9 * time / unknowns << ',' << time / reference << '\n';
  }
}

/// Bytes that this process keeps in memory.
double resident() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return 1024.0 * std::strtod(line.c_str() + 6, nullptr);
  return 0.0;
}

/// Eight coaches and esdirk4, everything that a run holds but the recorder.
void measure_memory(int size, Spans kind, std::ofstream& table) {
  malloc_trim(0);  // what was freed before would serve again, unseen
  const double before = resident();
  Steps steps(size, kind, 8, base::esdirk4());
  const int unknowns = steps.scene.unknowns(), few = size <= 100'000 ? 100 : 10;
  const auto bytes = [&] { return (resident() - before) * ranks() / unknowns; };
  const double built = bytes();
  (void)steps.time(few);
  const double after_few = bytes();
  for (int i = 0; i < 9; ++i) (void)steps.time(few);
  const double after_many = bytes();
  if (rank() != 0) return;
  std::printf("%9d  %-17s resident bytes per unknown: %.0f built, %.0f after %d steps, %.0f after %d\n", unknowns,
              name_of(kind), built, after_few, few, after_many, 10 * few);
  for (const auto& [steps_taken, value] : {std::pair{0, built}, {few, after_few}, {10 * few, after_many}})
    table << unknowns << ',' << name_of(kind) << ',' << ranks() << ",8,bytes after " << steps_taken << " steps,,"
          << value << ",\n";
}

void run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::ofstream table;
  if (argc > 1 && rank() == 0) table.open(argv[1]);
  const int largest = argc > 2 ? std::atoi(argv[2]) : 1'000'000, smallest = argc > 3 ? std::atoi(argv[3]) : 10;
  const int rounds = argc > 4 ? std::max(1, std::atoi(argv[4])) : 15;
  table << "unknowns,bridge,ranks,coaches,part,seconds,per_unknown,of_bare_solve\n";
  constexpr std::array kinds = {Spans::continuous, Spans::apart, Spans::under_track};
  for (Spans kind : kinds)
    for (int size : {100'000, 1'000'000})
      if (size <= largest && size >= smallest) measure_memory(size, kind, table);
  if (rank() == 0) std::printf("%9s  %-17s %-32s %10s %10s %8s\n", "unknowns", "", "", "us", "ns/unknown", "of solve");
  for (int size : {10, 100, 1000, 10'000, 100'000, 200'000, 1'000'000})
    for (Spans kind : kinds)
      if (size <= largest && size >= smallest) measure(size, kind, rounds, table);
}

}  // namespace

int main(int argc, char** argv) {
  int count = 1;
  if (SlepcInitialize(&count, &argv, nullptr, nullptr) != 0) return EXIT_FAILURE;
  try {
    run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    (void)SlepcFinalize();
    return EXIT_FAILURE;
  }
  (void)SlepcFinalize();
  return EXIT_SUCCESS;
}
