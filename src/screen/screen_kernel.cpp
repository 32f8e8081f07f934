// Compiled once for each instruction set, each time with another name for TRAVERSE_LANES_TARGET.
#include "screen/screen_kernel.hpp"

namespace traverse::screen::TRAVERSE_LANES_TARGET {

/// The number of doubles in ScreenTask::work.
long screen_work_size(const ScreenTask& task) { return ScreenBatch<8>(task, nullptr).size(); }
void bound_responses(const ScreenTask& task) { ScreenBatch<8>(task, task.work).bound(); }
void pass_bridge(const ScreenTask& task) { ScreenBatch<8>(task, task.work).pass(); }

}  // namespace traverse::screen::TRAVERSE_LANES_TARGET
