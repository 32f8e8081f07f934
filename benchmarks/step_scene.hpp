// The scene of the step's benchmarks: a bridge of 32 m spans, 10 elements each, and S300 coaches on Hertz wheels; and
// how its parts are timed.
#pragma once

#include <mpi.h>
#include <slepceps.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "support/folders.hpp"
#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::benchmarks {

inline int rank() {
  int result = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &result);
  return result;
}

inline int ranks() {
  int result = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &result);
  return result;
}

/// Continuous spans, spans that do not touch, and continuous spans under a ballasted track.
enum class Spans { continuous, apart, under_track };

inline const char* name_of(Spans spans) {
  return spans == Spans::continuous ? "continuous" : spans == Spans::apart ? "simply supported" : "layered track";
}

/// A bridge of about so many unknowns under so many coaches, the foremost wheel at its beginning.
struct StepScene {
  std::unique_ptr<beam::Beam> beam;
  std::unique_ptr<coupling::System> system;

  StepScene(int unknowns, Spans kind, int coaches) {
    constexpr int elements = 10, a_span_under_track = 480;  // elements; unknowns on sleepers 0.667 m apart
    const bool track = kind == Spans::under_track, apart = kind == Spans::apart;
    const int a_span = track ? a_span_under_track : apart ? 2 * elements + 2 : 2 * elements;
    std::string text = "beam: {spans: 32.0*" + std::to_string(std::max(1, unknowns / a_span)) +
                       ", elements_per_span: " + std::to_string(std::clamp(unknowns / 2 - 1, 1, elements)) +
                       ", EI: 3.795e11, mass: 3.0e4, continuity: " + (apart ? "simply_supported" : "continuous") +
                       "}\nsupport: {types: " + (apart ? "pinned" : "roller") + "}\nts: {max_time: 1.0}\n";
    if (track)
      text +=
          "track: {rail: {EI: 1.32476e7, mass: 121.28}, spacing: 0.6666666666666666, pad: {k: 6.5e7, c: 7.5e4}, "
          "sleeper: {mass: 251.0}, ballast: {mass: 531.4, k: 1.3775e8, c: 5.88e4}}\n";
    if (coaches > 0)
      text += "vehicle: {coach: {file: " + source_folder() + "/options/vehicles/s300.yml}}\ntrain: {vehicles: coach*" +
              std::to_string(coaches) + ", speed: 83.333}\n";
    const scene::Scene scene = scene::read_scene(options::Options::from_yaml(text));
    beam = std::make_unique<beam::Beam>(PETSC_COMM_WORLD, *scene.beam);
    beam->set_rayleigh({0.5, 5e-4});
    system = std::make_unique<coupling::System>(
        PETSC_COMM_WORLD, beam.get(),
        coupling::SystemInput{scene.vehicles, scene.train, scene.load, scene.profile, scene.gravity, false});
  }
  int unknowns() const { return beam->columns() * beam->block(); }  // on all ranks
};

/// By the clock.
inline double seconds(int times, const std::function<void()>& work) {
  MPI_Barrier(PETSC_COMM_WORLD);
  const double start = MPI_Wtime();
  for (int i = 0; i < times; ++i) work();
  return (MPI_Wtime() - start) / times;
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace traverse::benchmarks
