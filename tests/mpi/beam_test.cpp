// A beam cut over the ranks is the beam of one rank: the same rows, reactions, responses and modes.
#include "beam/beam.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modes/modes.hpp"
#include "recovery/recovery.hpp"
#include "support/rows.hpp"

namespace traverse {
namespace {

using beam::Beam;
using beam::BeamModel;
using beam::Support;

BeamModel model_of(std::vector<double> spans, int elements, bool isolated, bool axial) {
  BeamModel m;
  m.elements.assign(spans.size(), elements);
  m.supports.assign(spans.size() + 1, Support::roller);
  m.supports.front() = Support::clamped;
  m.spans = std::move(spans);
  m.EI = beam::Distribution({0, 11, 11, 40}, {2e9, 3e9, 1e9, 2e9}, "EI");
  m.EA = 1e10;
  m.mass = 2000.0;
  if (isolated) m.joints = {beam::Joint::separate};
  m.axial = axial;
  auto& f = m.foundation;
  f.vertical = {{3.3, 1e8, 1e5}, {10.0, 1e8, 1e5}, {m.length(), 2e8, 0.0}};
  f.rotational = {{5.0, 1e9, 1e6}};
  f.longitudinal = {{7.7, 1e8, 1e4}};
  f.vertical_bed = beam::Bed{1e7, 1e4};
  return m;
}

/// Spans of whole metres, elements, isolated, axial.
using Shape = std::tuple<std::vector<double>, int, bool, bool>;

class CutBeam : public testing::TestWithParam<Shape> {
 protected:
  CutBeam()
      : model_(std::apply(model_of, GetParam())),
        cut_(PETSC_COMM_WORLD, model_),
        whole_(PETSC_COMM_SELF, model_),
        first_(cut_.first_column() * cut_.block()) {
    cut_.set_rayleigh({0.3, 0.02});
    whole_.set_rayleigh({0.3, 0.02});
  }
  /// A nodal vector of the whole beam; held unknowns rest unless it is a load.
  std::vector<double> numbers(double frequency, double size, bool load) const {
    std::vector<double> y;
    for (int i = 0; i < whole_.local_unknowns(); ++i) {
      y.push_back(!load && whole_.fixed()[i] ? 0.0 : size * std::sin(frequency * (i + 1)));
    }
    return y;
  }

  BeamModel model_;
  Beam cut_, whole_;
  int first_;
};

// The last one has fewer nodes than three ranks.
INSTANTIATE_TEST_SUITE_P(Beams, CutBeam,
                         testing::Values(Shape{{12, 18, 9}, 5, false, true}, Shape{{12, 18, 9}, 5, false, false},
                                         Shape{{12, 18, 9}, 1, true, true}, Shape{{12, 18, 9}, 4, true, false},
                                         Shape{{12}, 1, false, true}));

TEST_P(CutBeam, OwnsEveryNodeOnce) {
  int ranks = 0, rank = 0, sum = 0;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  const int mine = cut_.local_columns();
  MPI_Allreduce(&mine, &sum, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
  EXPECT_EQ(sum, whole_.mesh().nodes());
  for (int node = 0; node < sum; ++node) {
    const bool here = node >= cut_.first_column() && node < cut_.first_column() + mine;
    EXPECT_EQ(cut_.owner(node) == rank, here);
  }
}

TEST_P(CutBeam, SameRows) {
  const auto same = [&](Mat cut, Mat whole) {
    ASSERT_EQ(cut == nullptr, whole == nullptr);
    const auto mine = test::local_rows(cut), all = test::local_rows(whole);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      for (std::size_t j = 0; j < all.size(); ++j) {
        const double exact = all[first_ + i][j];
        EXPECT_NEAR(mine[i][j], exact, 1e-15 * std::abs(exact)) << i << ", " << j;
      }
    }
  };
  same(cut_.mass(), whole_.mass());
  same(cut_.beam_stiffness(), whole_.beam_stiffness());
  same(cut_.stiffness(), whole_.stiffness());
  same(cut_.damping(), whole_.damping());
  for (int i = 0; i < 2; ++i) {
    same(cut_.foundation().of("vertical")[i], whole_.foundation().of("vertical")[i]);
    same(cut_.foundation().of("vertical_bed")[i], whole_.foundation().of("vertical_bed")[i]);
    same(cut_.foundation().of("longitudinal")[i], whole_.foundation().of("longitudinal")[i]);
    same(cut_.foundation().of("rotational")[i], whole_.foundation().of("rotational")[i]);
  }
  for (std::size_t i = 0; i < cut_.fixed().size(); ++i) EXPECT_EQ(cut_.fixed()[i], whole_.fixed()[first_ + i]);
  std::vector<double> mine(cut_.local_unknowns(), 0.0), all(whole_.local_unknowns(), 0.0);
  cut_.add_self_weight(9.81, mine.data());
  whole_.add_self_weight(9.81, all.data());
  for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_EQ(mine[i], all[first_ + i]);
}

TEST_P(CutBeam, SameReactionsAndResponses) {
  const auto v = numbers(0.7, 1e-3, false), w = numbers(1.3, 0.1, false), a = numbers(2.9, 5.0, false),
             P = numbers(0.3, 1e4, true);
  std::vector<beam::Reaction> mine, all;
  cut_.reactions(v.data() + first_, w.data() + first_, a.data() + first_, P.data() + first_, mine);
  whole_.reactions(v.data(), w.data(), a.data(), P.data(), all);
  double largest = 0.0;
  for (const auto& r : all) largest = std::max({largest, std::abs(r[0]), std::abs(r[1]), std::abs(r[2])});
  ASSERT_EQ(mine.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int kind = 0; kind < 3; ++kind) EXPECT_NEAR(mine[i][kind], all[i][kind], 1e-12 * largest);
  }

  std::vector<double> stations;
  for (int i = 0; i <= 40; ++i) stations.push_back(model_.length() * i / 40);
  const std::vector<recovery::ElementLoad> loads{{0, 0.3, 1e3, -1e5, 2e4},
                                                 {whole_.mesh().elements() - 1, 0.8, 0.0, -2e5, 0.0}};
  std::vector<recovery::Response> here, there;
  recovery::Recovery(cut_, stations, 9.81)
      .evaluate(v.data() + first_, w.data() + first_, a.data() + first_, loads, here);
  recovery::Recovery(whole_, stations, 9.81).evaluate(v.data(), w.data(), a.data(), loads, there);
  for (std::size_t i = 0; i < stations.size(); ++i) {  // the same bits: nothing but zeros is added to a value
    EXPECT_EQ(here[i].deflection, there[i].deflection);
    EXPECT_EQ(here[i].velocity, there[i].velocity);
    EXPECT_EQ(here[i].acceleration, there[i].acceleration);
    EXPECT_EQ(here[i].moment, there[i].moment);
    EXPECT_EQ(here[i].shear, there[i].shear);
    EXPECT_EQ(here[i].axial_displacement, there[i].axial_displacement);
    EXPECT_EQ(here[i].axial_force, there[i].axial_force);
  }
}

TEST_P(CutBeam, SameModesToTheLastBit) {
  const auto here = modes::natural_modes(cut_, 6, true), there = modes::natural_modes(whole_, 6, true);
  EXPECT_EQ(here.omega, there.omega);
  EXPECT_EQ(here.shape, there.shape);
  if (whole_.mesh().elements() > 1) {  // else there is one frequency of bending only
    EXPECT_EQ(modes::distinct_frequencies(cut_, 2), modes::distinct_frequencies(whole_, 2));
  }
}

// C* itself is the same to rounding only, a M + b K being summed in pieces; what the ranks know of it is the same.
TEST_P(CutBeam, DampedModesAreTheSameOnEveryRank) {
  cut_.set_rayleigh({0.3, 1e-4});  // a smaller b: modes are listed up to 1/b
  whole_.set_rayleigh({0.3, 1e-4});
  const auto here = modes::damped_modes(cut_, 6, true), there = modes::damped_modes(whole_, 6, true);
  ASSERT_EQ(here.size(), there.size());
  ASSERT_GT(here.size(), 0u);
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_LE(std::abs(here.lambda[i] - there.lambda[i]), 1e-9 * std::abs(there.lambda[i]));
  }
  auto of_first = here.lambda;
  MPI_Bcast(of_first.data(), static_cast<int>(of_first.size()), MPI_CXX_DOUBLE_COMPLEX, 0, PETSC_COMM_WORLD);
  EXPECT_EQ(here.lambda, of_first);
}

}  // namespace
}  // namespace traverse
