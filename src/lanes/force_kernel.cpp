// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "lanes/force_kernel.hpp"

namespace traverse::lanes::TRAVERSE_LANES_TARGET {

/// Doubles that ForceTask::work needs.
long work_size(const ForceTask& task) { return size_of_work<ForceGroup>(task); }
void cross(const ForceTask& task) { run_as_wide<ForceGroup>(task); }

}  // namespace traverse::lanes::TRAVERSE_LANES_TARGET
