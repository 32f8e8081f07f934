#include "lanes/stepped_crossing.hpp"

#include <algorithm>

#include "engine/processor.hpp"

namespace traverse::lanes {

// Compiled from crossing_kernel.cpp, once for each.
TRAVERSE_LANES_DECLARE(long stepped_size(const Task& task); void begin(const Task& task);
                       TaskInstant step(const Task& task, double to, bool from_kink, bool to_kink);
                       TaskInstant instant(const Task& task); void go_on_from(const Task& task, const double* memory);)

SteppedCrossing::SteppedCrossing(CrossingPlan plan, TrainNumbers train, TrackNumbers track, std::vector<double> q,
                                 double speed)
    : plan_(std::move(plan)),
      train_(std::move(train)),
      track_(std::move(track)),
      q_(std::move(q)),
      run_{CrossingRun{&train_, &track_, nullptr, &q_, speed, 0.0}},
      numbers_(plan_, run_, 1),
      task_(numbers_.task()),
      work_(static_cast<std::size_t>(TRAVERSE_LANES_CALL(stepped_size(task_)))) {
  task_.work = work_.data();
  TRAVERSE_LANES_CALL(begin(task_));
  now_ = TRAVERSE_LANES_CALL(instant(task_));
}

Trouble SteppedCrossing::step(double t, bool from_kink, bool to_kink) {
  now_ = TRAVERSE_LANES_CALL(step(task_, run_[0].speed * t, from_kink, to_kink));
  return static_cast<Trouble>(static_cast<int>(now_.failed));
}

void SteppedCrossing::keep(base::Bytes& bytes) {
  const engine::Target own = engine::best_target();
  engine::Target target = own;
  const auto size = static_cast<std::size_t>(TRAVERSE_LANES_CALL(stepped_size(task_)));
  std::vector<double> memory;
  if (!bytes.reads()) memory.assign(work_.data(), work_.data() + size);
  bytes(target, memory);
  if (!bytes.reads()) return;
  if (target != own || memory.size() != size)
    throw FileError(
        "the checkpoint was written on a processor with other vector instructions; restart it on one alike");
  engine::Aligned aligned(size);
  std::copy(memory.begin(), memory.end(), aligned.data());
  TRAVERSE_LANES_CALL(go_on_from(task_, aligned.data()));
  now_ = TRAVERSE_LANES_CALL(instant(task_));
}

std::vector<double> SteppedCrossing::bent() const {
  std::vector<double> bent;
  for (int i = 0; i < train_.coordinates; ++i) bent.push_back(at(&TaskInstant::bent, static_cast<std::size_t>(i)));
  return bent;
}

}  // namespace traverse::lanes
