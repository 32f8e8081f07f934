// The pieces of running surface under a wheel by the position of its centre, for single runs and batches.
#pragma once

#include "engine/train_task.hpp"

namespace traverse::engine {

/// The patches under a wheel whose centre is between two stations.
struct WheelPatches {
  struct Patch {
    int element = -1;                                                                      // -1: rigid ground
    double x = 0.0, length = 1.0, shear = 0.0, flexibility = 0.0, low = 1.0, high = -1.0;  // SurfacePatch
  };
  double from = 0.0, to = 0.0;  // m
  int candidates = 0;
  Patch patch[2];
};

/// The intervals of wheels of one radius, ascending and without gaps from minus to plus infinity.
struct SurfaceTable {
  int count = 0;
  const WheelPatches* patches = nullptr;
};

namespace {

/// The index of the interval with x. The search starts at the previous index k, usually the same or a neighbour.
inline int find_interval(const SurfaceTable& table, double x, int k) {
  constexpr int nearby = 4;
  for (int step = 0; step < nearby && k + 1 < table.count && x > table.patches[k].to; ++step) ++k;
  for (int step = 0; step < nearby && k > 0 && x < table.patches[k].from; ++step) --k;
  int low = x < table.patches[k].from ? 0 : k, high = x > table.patches[k].to ? table.count - 1 : k;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (x > table.patches[middle].to)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/// Sets the patches of a wheel, without their slots and compliances.
inline void set_patches(TrainTask& train, int at, const WheelPatches& patches) {
  train.from[at] = patches.from;
  train.to[at] = patches.to;
  if (train.active[at] >= patches.candidates) train.active[at] = 0;
  for (int n = 0; n < 2; ++n) {
    const WheelPatches::Patch& from = patches.patch[n];
    SurfacePatch& p = train.patch[n];
    p.x[at] = from.x;
    p.length[at] = from.length;
    p.per_length[at] = 1.0 / from.length;
    p.shear[at] = from.shear;
    p.flexibility[at] = from.flexibility;
    p.low[at] = from.low;
    p.high[at] = from.high;
  }
}

}  // namespace
}  // namespace traverse::engine
