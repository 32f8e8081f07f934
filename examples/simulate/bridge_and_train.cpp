// A bridge and a train in a program, and the largest deflection. Over the installed library:
//
//   cmake --install build --prefix "$PWD/build/installed"
//   cmake -S examples/simulate -B build/simulate -DCMAKE_PREFIX_PATH="$PWD/build/installed"
//   cmake --build build/simulate
//   build/simulate/bridge_and_train
#include <cstdio>

#include "traverse/simulate.hpp"

int main() {
  try {
    const traverse::Session session;  // MPI and PETSc
    const traverse::Problem problem({
        {"beam_spans", {32.0, 40.0, 32.0}},  // m
        {"beam_EI", 5.9e10},                 // N m2
        {"beam_mass", 1.2e4},                // kg/m
        {"beam_damping_ratios", 0.01},
        {"vehicle_coach_file", "options/vehicles/velaro.yml"},
        {"train_vehicles", "coach*8"},
        {"train_speed", "300 km/h"},
        {"accuracy", 1e-2},
    });
    const traverse::Result result = traverse::simulate(problem);
    for (const traverse::ProbeResult& probe : result.probes)
      std::printf("x = %4.1f m: %.2f mm at %.3f s, %.2f m/s2\n", probe.x, 1e3 * probe.deflection.value,
                  probe.deflection.time, probe.acceleration.value);
    const traverse::Extreme largest = result.largest(&traverse::ProbeResult::deflection);
    std::printf("largest deflection: %.2f mm; wheels: %.1f to %.1f kN; computed %s\n", 1e3 * largest.value,
                1e-3 * result.least_wheel_force, 1e-3 * result.greatest_wheel_force, result.model.c_str());
  } catch (const traverse::Error& error) {
    std::fprintf(stderr, "bridge_and_train: %s\n", error.what());
    return error.status();
  }
}
