#include "lanes/crossing.hpp"

#include <algorithm>
#include <utility>

#include "engine/processor.hpp"
#include "lanes/crossing_numbers.hpp"

namespace traverse::lanes {

// Compiled from crossing_kernel.cpp, once for each.
TRAVERSE_LANES_DECLARE(long work_size(const Task& task); void cross(const Task& task);)

namespace {

/// The start is one of them.
std::size_t places_kept(const CrossingPlan& plan) {
  const auto count = std::count_if(plan.stretches.begin(), plan.stretches.end(),
                                   [](const TaskStretch& stretch) { return stretch.keeps; });
  return count > 0 ? static_cast<std::size_t>(count) + 1 : 0;
}

}  // namespace

// Vectors wider than the processor's are taken apart number by number, which takes several times as long.
std::vector<CrossingResult> cross(const CrossingPlan& plan, std::span<const CrossingRun> runs) {
  if (const std::size_t most = engine::best_width(); runs.size() > most) {
    std::vector<CrossingResult> all = cross(plan, runs.first(most));
    for (CrossingResult& result : cross(plan, runs.subspan(most))) all.push_back(std::move(result));
    return all;
  }
  const std::size_t width = runs.size() > 4 ? 8 : runs.size() > 2 ? 4 : 2;
  const CrossingNumbers numbers(plan, runs, width);
  Task task = numbers.task();
  const std::size_t probes = static_cast<std::size_t>(task.probes.count);
  engine::Aligned peak(3 * probes * width), time(3 * probes * width), least(width), greatest(width), edge(width),
      failed(width);
  const std::size_t kept = places_kept(plan) * probes;
  engine::Aligned accelerations(kept * width);
  if (kept > 0) task.kept = accelerations.data();
  engine::Aligned bent(static_cast<std::size_t>(task.coordinates) * width);
  task.peak = peak.data();
  task.peak_time = time.data();
  task.least_force = least.data();
  task.greatest_force = greatest.data();
  task.bent = bent.data();
  task.edge = edge.data();
  task.failed = failed.data();
  engine::Aligned work(static_cast<std::size_t>(TRAVERSE_LANES_CALL(work_size(task))));
  task.work = work.data();
  TRAVERSE_LANES_CALL(cross(task));
  std::vector<CrossingResult> results(runs.size());
  for (std::size_t lane = 0; lane < runs.size(); ++lane) {
    CrossingResult& r = results[lane];
    r.trouble = static_cast<Trouble>(static_cast<int>(failed.data()[lane]));
    const auto peaks = [&](std::size_t first) {
      std::vector<CrossingPeak> own(probes);
      for (std::size_t p = 0; p < probes; ++p) {
        const std::size_t at = (first + p) * width + lane;
        own[p] = {peak.data()[at], time.data()[at]};
      }
      return own;
    };
    r.deflection = peaks(0);
    r.acceleration = peaks(probes);
    r.moment = peaks(2 * probes);
    r.least_force = least.data()[lane];
    r.greatest_force = greatest.data()[lane];
    r.edge = edge.data()[lane];
    for (std::size_t i = 0; i < kept; ++i) r.kept.push_back(accelerations.data()[i * width + lane]);
    for (int i = 0; i < task.coordinates; ++i)
      r.bent.push_back(bent.data()[static_cast<std::size_t>(i) * width + lane]);
  }
  return results;
}

}  // namespace traverse::lanes
