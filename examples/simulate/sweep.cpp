// A thousand problems on the ranks of a communicator: mpirun -n 2 build/simulate/sweep. The resonance curve of a bridge
// under ten axles. As bridge_and_train.cpp, which says how it is built.
#include <cstdio>
#include <vector>

#include "traverse/simulate.hpp"

int main() {
  const traverse::Session session;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    std::vector<traverse::Problem> problems;
    for (int i = 0; i < 1000; ++i)
      problems.push_back(traverse::Problem({{"beam_spans", 25.0},
                                            {"beam_EI", 2.0e10},
                                            {"beam_mass", 1.0e4},
                                            {"beam_damping_ratios", 0.01},
                                            {"model_modes", 10},  // exact in time
                                            {"load_forces", std::vector<double>(10, 1.7e5)},
                                            {"load_positions", {0, -18, -36, -54, -72, -90, -108, -126, -144, -162}},
                                            {"load_speed", 30.0 + 0.06 * i}}));
    const std::vector<traverse::Result> results = traverse::simulate(problems, {}, MPI_COMM_WORLD);
    std::size_t worst = 0;
    const auto acceleration = [&](std::size_t i) {
      return results[i].largest(&traverse::ProbeResult::acceleration).value;
    };
    for (std::size_t i = 0; i < results.size(); ++i)
      if (acceleration(i) > acceleration(worst)) worst = i;
    if (rank == 0)
      std::printf("%zu runs: %.2f m/s2 at %.2f m/s, %.2f m/s2 at 30 m/s; computed %s\n", results.size(),
                  acceleration(worst), 30.0 + 0.06 * static_cast<double>(worst), acceleration(0),
                  results[0].model.c_str());
  } catch (const traverse::Error& error) {
    if (rank == 0) std::fprintf(stderr, "sweep: %s\n", error.what());
    return error.status();
  }
}
