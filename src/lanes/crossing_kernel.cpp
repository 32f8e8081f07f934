// Compiled once for each kind of processor, each time with another name for TRAVERSE_LANES_TARGET.
#include "lanes/crossing_kernel.hpp"

namespace traverse::lanes::TRAVERSE_LANES_TARGET {

// A crossing by itself, step by step: it stands in front of its numbers in Task::work.
namespace {
using One = Group<1>;
constexpr long size_of_one = (sizeof(One) + 63) / 64 * 8;
}  // namespace

/// Doubles that Task::work needs.
long work_size(const Task& task) { return task.width == 1 ? One(task, nullptr).size() : size_of_work<Group>(task); }
void cross(const Task& task) {
  if (task.width == 1)
    One(task, task.work).run();
  else
    run_as_wide<Group>(task);
}

/// Doubles that Task::work needs for a crossing step by step.
long stepped_size(const Task& task) { return size_of_one + One(task, nullptr).size(); }
void begin(const Task& task) { (new (task.work) One(task, task.work + size_of_one))->begin(); }
/// Group::step.
TaskInstant step(const Task& task, double to, bool from_kink, bool to_kink) {
  One& one = *reinterpret_cast<One*>(task.work);
  one.step(to, from_kink, to_kink);
  return one.instant();
}
/// Goes on from where another crossing of the same task was, whose memory this is.
void go_on_from(const Task& task, const double* memory) {
  const long size = stepped_size(task);
  for (long i = size_of_one; i < size; ++i) task.work[i] = memory[i];
  One& one = *(new (task.work) One(task, task.work + size_of_one));  // with its own pointers
  one.go_on_from(*reinterpret_cast<const One*>(memory));
}
TaskInstant instant(const Task& task) { return reinterpret_cast<const One*>(task.work)->instant(); }

}  // namespace traverse::lanes::TRAVERSE_LANES_TARGET
