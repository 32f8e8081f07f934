// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "lanes/crossing_kernel.hpp"

namespace traverse::lanes::TRAVERSE_LANES_TARGET {

/// Doubles that Task::work needs.
long work_size(const Task& task) {
  switch (task.width) {
    case 8:
      return Group<8>(task, nullptr).size();
    case 4:
      return Group<4>(task, nullptr).size();
    default:
      return Group<2>(task, nullptr).size();
  }
}

void cross(const Task& task) {
  switch (task.width) {
    case 8:
      return Group<8>(task, task.work).run();
    case 4:
      return Group<4>(task, task.work).run();
    default:
      return Group<2>(task, task.work).run();
  }
}

}  // namespace traverse::lanes::TRAVERSE_LANES_TARGET
