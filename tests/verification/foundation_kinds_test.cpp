// Every kind of foundation in the table has its options, holds the beam, and is in the results.
#include <gtest/gtest.h>

#include <cmath>

#include "beam/beam.hpp"
#include "support/scene_run.hpp"
#include "traverse/options/table.hpp"

namespace traverse::test {
namespace {

const std::string scene = R"(
beam: {spans: [20.0, 20.0], elements_per_span: 6, EI: 2.0e9, EA: 1.0e10, mass: 2000.0}
support: {types: [clamped, roller, free]}
load: {forces: 1e5, positions: 8.0}
scene: {analysis: static}
model: {axial: true}
output: {probes: 8.0}
)";

class EveryKind : public testing::TestWithParam<std::size_t> {
 protected:
  const beam::FoundationKind& kind() const { return beam::foundation_kinds[GetParam()]; }
  std::string option(const std::string& what) const { return "foundation_" + std::string(kind().name) + "_" + what; }
  Values options(const std::string& k) const {
    Values values = {{option("k"), k}};
    if (kind().points != nullptr) values.emplace_back(option("x"), "5.0,11.0,28.0");
    return values;
  }
};

TEST_P(EveryKind, HasItsOptions) {
  for (const char* what : {"k", "c", "gap", "cubic"}) {
    const options::Row* row = options::find_row(options::fixed_rows(), option(what));
    ASSERT_NE(row, nullptr) << what;
    EXPECT_FALSE(row->unit.empty());
  }
  EXPECT_EQ(options::find_row(options::fixed_rows(), option("x")) != nullptr, kind().points != nullptr);
}

TEST_P(EveryKind, HoldsTheBeamAndIsInTheResults) {
  const std::string group = "/foundation/" + std::string(kind().name) + "/";
  Results bare = run_yaml(scene), held = run_yaml(scene, options("2e8"));
  const std::vector<double> forces = held(group + std::string(beam::force_name(kind()).quantity));
  EXPECT_EQ(forces.size(), kind().points != nullptr ? 3u : 2u);
  const double sunk = -held("/probes/deflection")[0], freely = -bare("/probes/deflection")[0];
  double most = 0.0;
  for (const double force : forces) most = std::max(most, std::abs(force));
  if (kind().direction == beam::Direction::longitudinal) {
    EXPECT_EQ(sunk, freely);
    EXPECT_EQ(most, 0.0);
    return;
  }
  EXPECT_LT(sunk, 0.95 * freely);
  EXPECT_GT(most, 1.0);
  // A law that is not linear, but nearly so, has the same forces.
  Values nearly = options("2e8");
  nearly.emplace_back(option("cubic"), "1");
  Results by_law = run_yaml(scene, nearly);
  EXPECT_LT(relative_difference(by_law(group + std::string(beam::force_name(kind()).quantity)), forces), 1e-8);
}

TEST_P(EveryKind, HasAMatrixOfItsOwn) {
  beam::BeamModel model;
  model.spans = {20.0};
  model.elements = {4};
  model.supports.assign(2, beam::Support::roller);
  model.EI = 2e9;
  model.EA = 1e10;
  model.mass = 2000.0;
  if (kind().points != nullptr) {
    (model.foundation.*kind().points).push_back({7.0, 1e8, 0.0});
  } else {
    model.foundation.*kind().bed = beam::Bed{1e8, 0.0};
  }
  const beam::Beam beam(PETSC_COMM_SELF, model);
  for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
    EXPECT_EQ(beam.foundation().of_kind[i][0] != nullptr, i == GetParam());
    EXPECT_EQ(beam.foundation().of_kind[i][1], nullptr);
  }
}

INSTANTIATE_TEST_SUITE_P(Foundations, EveryKind, testing::Range<std::size_t>(0, beam::foundation_kind_count),
                         [](const auto& which) { return std::string(beam::foundation_kinds[which.param].name); });

}  // namespace
}  // namespace traverse::test
