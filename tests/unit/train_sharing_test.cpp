// How the trains of a line are divided among ranks.
#include "coupling/train_sharing.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace traverse::test {
namespace {

using coupling::divide;
using coupling::Portion;
using coupling::TrainReach;
using structure::Range;

double vehicles_of(const Portion& portion, const std::vector<TrainReach>& trains) {
  double sum = 0.0;
  for (const std::size_t k : portion.trains) sum += trains[k].vehicles;
  return sum;
}

/// Trains of eight vehicles on 100 columns each, 1,000 columns apart.
std::vector<TrainReach> line_of(int count) {
  std::vector<TrainReach> trains;
  for (int k = 0; k < count; ++k) trains.push_back({static_cast<std::size_t>(k), {1000 * k, 1000 * k + 100}, 8.0});
  return trains;
}

TEST(TrainSharing, EveryTrainAndEveryMovingColumnHasOneRank) {
  const std::vector<TrainReach> trains = line_of(10);
  const std::vector<Range> moving = {{0, 150}, {900, 3200}, {5050, 9100}};
  const std::vector<Portion> portions = divide(trains, moving, 3);
  std::vector<int> of_train(trains.size(), 0), of_column(11000, 0);
  for (const Portion& portion : portions) {
    for (const std::size_t k : portion.trains) {
      ++of_train[k];
      const auto has = [&](const Range& r) {
        return r.first <= trains[k].columns.first && trains[k].columns.past <= r.past;
      };
      EXPECT_TRUE(std::any_of(portion.columns.begin(), portion.columns.end(), has)) << k;
    }
    for (const Range& r : portion.columns)
      for (int c = r.first; c < r.past; ++c) ++of_column[static_cast<std::size_t>(c)];
  }
  EXPECT_EQ(std::count(of_train.begin(), of_train.end(), 1), 10);
  EXPECT_LE(*std::max_element(of_column.begin(), of_column.end()), 1);
  for (const Range& r : moving)
    for (int c = r.first; c < r.past; ++c) EXPECT_EQ(of_column[static_cast<std::size_t>(c)], 1) << c;
}

TEST(TrainSharing, TrainsWithCommonColumnsStayTogether) {
  std::vector<TrainReach> trains = line_of(6);
  trains[3].columns = {50, 200};   // meets train 0,
  trains[5].columns = {190, 260};  // which comes behind it
  trains[4].columns = {0, 0};      // beside the bridge
  const std::vector<Portion> portions = divide(trains, {}, 4);
  const auto rank_of = [&](std::size_t k) {
    return std::find_if(portions.begin(), portions.end(),
                        [k](const Portion& portion) {
                          return std::find(portion.trains.begin(), portion.trains.end(), k) != portion.trains.end();
                        }) -
           portions.begin();
  };
  EXPECT_EQ(rank_of(0), rank_of(3));
  EXPECT_EQ(rank_of(3), rank_of(5));
  EXPECT_NE(rank_of(0), rank_of(1));
  EXPECT_LT(rank_of(4), 4);
}

TEST(TrainSharing, RanksHaveEqualWork) {
  const std::vector<TrainReach> trains = line_of(40);
  const std::vector<Portion> portions = divide(trains, {}, 3);
  EXPECT_LT(vehicles_of(portions[0], trains), 70.0);  // it evaluates the trains of all
  for (const std::size_t rank : {1U, 2U}) EXPECT_NEAR(vehicles_of(portions[rank], trains), 140.0, 8.0);
}

TEST(TrainSharing, MoreRanksThanTrains) {
  const std::vector<Portion> portions = divide(line_of(2), {{0, 100}}, 5);
  EXPECT_EQ(portions.size(), 5U);
  EXPECT_EQ(std::count_if(portions.begin(), portions.end(), [](const Portion& p) { return !p.trains.empty(); }), 2);
}

}  // namespace
}  // namespace traverse::test
