// What is stored of a line with several trains: the peaks of each train over the run, and of each span with the train
// that caused them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/recorder.hpp"
#include "run/response_extremes.hpp"
#include "run/wheel_unloading.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// /trains/least_wheel_force, greatest_wheel_force (N), wheel_unloading, each [trains] with its _time (s), and
/// on_bridge [trains,2] (s): from the first wheel at one end of the bridge to the last at the other, also beyond the
/// run; NaN without a prescribed speed.
std::vector<results::Recorder::Dataset> peaks_of_trains(const scene::Scene& scene, const train::Fleet& fleet,
                                                        const WheelExtremes& wheels);
/// Name of each train, and number of its first vehicle.
std::vector<std::pair<std::string, std::string>> names_of_trains(const scene::Scene& scene);

/// /spans/x [spans,2] (m), and of the probes in each span the largest deflection (m), acceleration (m/s2) and moment
/// (N m), each [spans] with its _time (s) and _train: the index in /trains of the nearest train at that time. NaN: no
/// probe.
std::vector<results::Recorder::Dataset> peaks_of_spans(const scene::Scene& scene, const ResponseExtremes& peaks);

}  // namespace traverse::run
