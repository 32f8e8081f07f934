// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "lanes/force_kernel.hpp"

namespace traverse::lanes::TRAVERSE_LANES_TARGET {

/// Doubles that ForceTask::work needs.
long work_size(const ForceTask& task) {
  switch (task.width) {
    case 8:
      return ForceGroup<8>(task, nullptr).size();
    case 4:
      return ForceGroup<4>(task, nullptr).size();
    default:
      return ForceGroup<2>(task, nullptr).size();
  }
}

void cross(const ForceTask& task) {
  switch (task.width) {
    case 8:
      return ForceGroup<8>(task, task.work).run();
    case 4:
      return ForceGroup<4>(task, task.work).run();
    default:
      return ForceGroup<2>(task, task.work).run();
  }
}

}  // namespace traverse::lanes::TRAVERSE_LANES_TARGET
