// The formulas of EN 1991-2, 6.4, at values that tables give and where two branches meet.
#include "norm/en1991.hpp"

#include <gtest/gtest.h>

#include "support/beam_model.hpp"

namespace traverse::test {
namespace {

TEST(En1991, DynamicFactors) {
  EXPECT_NEAR(norm::phi2(10.0), 1.31, 5e-3);
  EXPECT_NEAR(norm::phi2(20.0), 1.16, 5e-3);
  EXPECT_NEAR(norm::phi3(10.0), 1.46, 5e-3);
  EXPECT_NEAR(norm::phi3(20.0), 1.24, 5e-3);
  EXPECT_NEAR(norm::phi2(3.61), 1.67, 5e-3);
  EXPECT_NEAR(norm::phi3(3.61), 2.00, 5e-3);
  for (const double L : {0.01, 0.04, 2.0}) {
    EXPECT_EQ(norm::phi2(L), 1.67);
    EXPECT_EQ(norm::phi3(L), 2.0);
  }
  EXPECT_EQ(norm::phi2(500.0), 1.0);
}

TEST(En1991, FactorsOfRealTrainsMeetWhereTheirBranchesDo) {
  const double L = 20.0, n0 = 5.0, v = 0.76 * 2.0 * L * n0;
  EXPECT_NEAR(norm::phi_of_speed(v * (1.0 - 1e-9), L, n0), norm::phi_of_speed(v, L, n0), 1e-3);
  EXPECT_NEAR(norm::phi_of_speed(1e-9, L, n0), 1e-9 / 200.0, 1e-20);
  EXPECT_DOUBLE_EQ(norm::phi_of_track(11.0, 4.0, 20.0), 0.5 * norm::phi_of_track(22.0, 4.0, 20.0));
  EXPECT_EQ(norm::phi_of_track(22.0, 4.0, 20.0), norm::phi_of_track(80.0, 4.0, 20.0));
  EXPECT_EQ(norm::phi_of_track(80.0, 60.0, 0.5), 0.0);  // not below 0
}

TEST(En1991, LimitsOfTheFrequency) {
  EXPECT_NEAR(norm::frequency_bounds(20.0)->first, norm::frequency_bounds(20.0001)->first, 5e-3);
  EXPECT_NEAR(norm::frequency_bounds(36.0)->first, 2.83, 5e-3);
  EXPECT_NEAR(norm::frequency_bounds(36.0)->second, 6.49, 5e-3);
  EXPECT_FALSE(norm::frequency_bounds(3.9));
  EXPECT_FALSE(norm::frequency_bounds(100.1));
}

TEST(En1991, LeastDamping) {
  using enum options::BridgeMaterial;
  const auto at = [](options::BridgeMaterial material, double span) {
    return 100.0 * norm::least_damping(material, span);
  };
  EXPECT_NEAR(at(composite, 10.0), 1.75, 1e-12);
  EXPECT_NEAR(at(steel, 36.0), 0.5, 1e-12);
  EXPECT_NEAR(at(prestressed, 10.0), 1.7, 1e-12);
  EXPECT_NEAR(at(prestressed, 20.0), 1.0, 1e-12);
  EXPECT_NEAR(at(reinforced, 10.0), 2.2, 1e-12);
  EXPECT_NEAR(at(filler_beam, 25.0), 1.5, 1e-12);
  EXPECT_NEAR(100.0 * norm::additional_damping(15.0), 0.64, 0.02);  // the figure's greatest
  EXPECT_LT(norm::additional_damping(29.0), 1e-4);
  EXPECT_EQ(norm::additional_damping(30.0), 0.0);
}

TEST(En1991, DeterminantLengths) {
  EXPECT_NEAR(norm::determinant_length(std::vector{20.0}), 20.0, 1e-12);
  EXPECT_NEAR(norm::determinant_length(std::vector{20.0, 20.0}), 24.0, 1e-12);
  EXPECT_NEAR(norm::determinant_length(std::vector{20.0, 30.0, 20.0}), 1.3 * 70.0 / 3.0, 1e-12);
  EXPECT_NEAR(norm::determinant_length(std::vector{20.0, 60.0}), 60.0, 1e-12);
  EXPECT_NEAR(norm::determinant_length(std::vector(7, 10.0)), 15.0, 1e-12);
  beam::BeamModel model = model_of({20.0, 20.0, 30.0}, 2);
  model.joints = {beam::Joint::continuous, beam::Joint::separate};
  EXPECT_EQ(norm::determinant_lengths(model), (std::vector{24.0, 24.0, 30.0}));
}

}  // namespace
}  // namespace traverse::test
