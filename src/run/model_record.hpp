// Stores the model for pictures and reports, /model of the results file, the deflected shape of the bridge at the
// instant of its largest deflection, /shape, and a digest of all inputs of a scene.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "options/input_texts.hpp"
#include "recovery/recovery.hpp"
#include "results/recorder.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Stores the notes of the run.
void record_notes(const std::vector<std::string>& notes, results::Recorder& recorder);

/// Stores spans, supports, hinges, foundations, stiffness and mass, vehicles and forces at t = 0, and the notes of the
/// run.
void record_model(const scene::Scene& scene, const std::vector<std::string>& notes, results::Recorder& recorder);

/// Stores the modes that represent the bridge, or its first distinct frequencies, with their damping ratios: /modes.
void record_modes(const SharedBeam& shared, results::Recorder& recorder);

/// A 64-bit hash (16 hex digits) of the scene's options, the files' texts and `more`. Options in `excluded`, and
/// options that only change the display, are not included.
std::string digest_of(const scene::Scene& scene, std::span<const std::string_view> excluded,
                      const std::vector<options::InputText>& files, std::string_view more = {});

/// The data of the deflected shape: this rank's nodal values and the loads on the bridge.
struct LargestDeflection {
  double time = 0.0;  // s
  std::vector<double> v, w, a;
  std::vector<recovery::ElementLoad> loads;
  std::vector<double> ground;  // m: displacements of moving supports, at every span end; empty: none
};

/// Collective. The deflection relative to the line through the supports, at the nodes, at the probes and at points in
/// between, with the contribution of loads inside elements, as at probes.
results::Shape shape_of(const beam::Beam& beam, const scene::Scene& scene, const LargestDeflection& worst);

}  // namespace traverse::run
