// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "lanes/crossing_kernel.hpp"

namespace traverse::lanes::TRAVERSE_LANES_TARGET {
/// Doubles that Task::work needs.
long work_size(const Task& task) { return size_of_work<Group>(task); }
void cross(const Task& task) { run_as_wide<Group>(task); }

}  // namespace traverse::lanes::TRAVERSE_LANES_TARGET
