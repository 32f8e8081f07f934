// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "modal_engine/moving_force_kernel.hpp"

namespace traverse::modal_engine::TRAVERSE_LANES_TARGET {

/// Doubles that ForceTask::work needs.
long work_size(const ForceTask& task) { return size_of_work<MovingForceBatch>(task); }
void cross(const ForceTask& task) { run_as_wide<MovingForceBatch>(task); }

}  // namespace traverse::modal_engine::TRAVERSE_LANES_TARGET
