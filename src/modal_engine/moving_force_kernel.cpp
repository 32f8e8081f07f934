// Compiled once for each instruction set, each time with another name for TRAVERSE_LANES_TARGET.
#include "modal_engine/moving_force_kernel.hpp"

namespace traverse::modal_engine::TRAVERSE_LANES_TARGET {

/// The number of doubles in ForceTask::work.
long work_size(const ForceTask& task) { return engine::size_of_work<MovingForceBatch>(task); }
void run_passages(const ForceTask& task) { engine::run_with_width<MovingForceBatch>(task); }

}  // namespace traverse::modal_engine::TRAVERSE_LANES_TARGET
