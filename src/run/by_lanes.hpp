// A run whose steps are taken by the kernel of the runs side by side (src/lanes): linear vehicles over modes.
#pragma once

#include <memory>
#include <string>

#include "coupling/system.hpp"
#include "lanes/crossing.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Why that kernel cannot step a scene, in words; empty: as far as the scene itself tells, it can.
std::string lanes_obstacle(const Scene& scene, const SharedBeam& shared);

/// What such runs have in common, but for method and stretches.
lanes::CrossingPlan lanes_plan(const Scene& scene, const SharedBeam& shared, const coupling::System& system);

/// The steps of a system at its start y, of linear vehicles. Null where the kernel
/// cannot take them, or where the scene asks that it does not. The beam must outlive it.
std::unique_ptr<coupling::SteppedApart> by_lanes(const Scene& scene, const SharedBeam& shared,
                                                 const coupling::System& system, const double* y, double end_time);

}  // namespace traverse::app
