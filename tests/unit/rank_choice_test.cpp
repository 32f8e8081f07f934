// How many ranks a run is worth by the model of its stages.
#include "run/rank_choice.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace traverse::test {
namespace {

run::StageWork long_bridge(double unknowns) {
  run::StageWork work;
  work.unknowns = unknowns;
  work.seconds_per_unknown = 7e-9;
  return work;
}

TEST(RankChoice, SmallBridgesAreForOneRank) { EXPECT_EQ(run::best_ranks(long_bridge(200.0), 64, 1e-6), 1); }

TEST(RankChoice, LongOnesForMany) {
  EXPECT_EQ(run::best_ranks(long_bridge(1e6), 2, 1e-6), 2);
  EXPECT_GT(run::best_ranks(long_bridge(1e6), 1024, 1e-6), 32);
  EXPECT_GT(run::best_ranks(long_bridge(1e7), 1024, 1e-6), run::best_ranks(long_bridge(1e6), 1024, 1e-6));
}

// Ranks that share a processor wait long for messages.
TEST(RankChoice, SlowMessagesAreForFewer) {
  EXPECT_LT(run::best_ranks(long_bridge(1e6), 1024, 1e-4), run::best_ranks(long_bridge(1e6), 1024, 1e-6));
  EXPECT_EQ(run::best_ranks(long_bridge(1e6), 1024, 1.0), 1);
}

// Never a number that the model itself finds slower than one rank.
TEST(RankChoice, IsNeverSlowerThanOneRankByTheModel) {
  for (double unknowns = 10.0; unknowns < 1e8; unknowns *= 3.0)
    for (double latency = 1e-7; latency < 1e-2; latency *= 3.0) {
      run::StageWork work = long_bridge(unknowns);
      work.vehicles = 16.0;
      for (const bool cut : {false, true}) {
        work.cut = cut;
        const int best = run::best_ranks(work, 16, latency);
        EXPECT_LE(run::stage_seconds(work, best, latency), run::stage_seconds(work, 1, latency));
      }
    }
}

TEST(RankChoice, WhatIsForOneRankAlone) {
  run::StageWork work = long_bridge(1e9);
  work.single_rank_reason = "its steps are short";
  EXPECT_EQ(run::best_ranks(work, 1024, 1e-9), 1);
}

}  // namespace
}  // namespace traverse::test
