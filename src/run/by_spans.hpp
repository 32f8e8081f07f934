// A run whose steps are those of a train of linear vehicles over spans that do not touch (lanes/span_crossing.hpp).
#pragma once

#include <memory>
#include <string>

#include "coupling/system.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Why a scene, with its vehicles linear, cannot be stepped so, in words; empty: as far as the scene itself tells, it
/// can.
std::string spans_obstacle(const Scene& scene);

/// The steps of a system at its start y, of linear vehicles. Null where they cannot be taken so, or where the scene
/// asks that they are not. The beam must outlive it.
std::unique_ptr<coupling::SteppedApart> by_spans(const Scene& scene, const SharedBeam& shared,
                                                 const coupling::System& system, const double* y, double end_time);

}  // namespace traverse::app
