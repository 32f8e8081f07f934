// The pieces of running surface under a wheel by where its centre is: what single runs and batches place wheels with.
#pragma once

#include "engine/train_task.hpp"

namespace traverse::engine {

/// The patches under a wheel whose centre is between two stations.
struct PatchesThere {
  struct Patch {
    int element = -1;                                                                      // -1: rigid ground
    double x = 0.0, length = 1.0, shear = 0.0, flexibility = 0.0, low = 1.0, high = -1.0;  // SurfacePatch
  };
  double from = 0.0, to = 0.0;  // m
  int candidates = 0;
  Patch patch[2];
};

/// Those of wheels of one radius, ascending and without gaps from minus to plus infinity.
struct SurfaceTable {
  int count = 0;
  const PatchesThere* there = nullptr;
};

namespace {

/// Where in the table x is, from where the wheel was: mostly there or beside that.
inline int follow(const SurfaceTable& table, double x, int k) {
  constexpr int near = 4;
  for (int step = 0; step < near && k + 1 < table.count && x > table.there[k].to; ++step) ++k;
  for (int step = 0; step < near && k > 0 && x < table.there[k].from; ++step) --k;
  int low = x < table.there[k].from ? 0 : k, high = x > table.there[k].to ? table.count - 1 : k;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (x > table.there[middle].to)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/// Puts the wheel with that number on its patches, but for their slots and compliances.
inline void put_on(TrainTask& train, int at, const PatchesThere& there) {
  train.from[at] = there.from;
  train.to[at] = there.to;
  if (train.active[at] >= there.candidates) train.active[at] = 0;
  for (int n = 0; n < 2; ++n) {
    const PatchesThere::Patch& from = there.patch[n];
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
