// Judges each pair of the sample once by the screen and once by all passages.
#include "screen/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/random_stream.hpp"
#include "results/stage.hpp"
#include "screen/pair.hpp"

namespace traverse::screen {
namespace {

constexpr double same_value = 1e-9;  // relative

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// All numbers of all ranks, on every rank.
std::vector<double> gathered(MPI_Comm comm, const std::vector<double>& own) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const int size = static_cast<int>(own.size());
  std::vector<int> sizes(static_cast<std::size_t>(ranks)), starts(sizes.size(), 0);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm);
  for (std::size_t r = 1; r < sizes.size(); ++r) starts[r] = starts[r - 1] + sizes[r - 1];
  std::vector<double> all(static_cast<std::size_t>(starts.back() + sizes.back()));
  MPI_Allgatherv(own.data(), size, MPI_DOUBLE, all.data(), sizes.data(), starts.data(), MPI_DOUBLE, comm);
  return all;
}

struct Ratios {
  std::vector<double> of_pairs, of_speeds;
};

void check_pair(const BridgeModel& model, const Formation& formation, Audit& audit, Ratios& ratios) {
  Pairs pairs(model);
  const Verdict verdict = pairs.judge(formation);
  if (verdict.decided_by == DecidedBy::nothing) return;
  const std::vector<double> bounds = pairs.bounds(formation), values = pairs.passages(formation);
  double permitted = 0.0, exceeding = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (bounds[i] < values[i]) ++audit.below;
    ratios.of_speeds.push_back(bounds[i] / values[i]);
    if (values[i] > 1.0) exceeding += 1.0;
    if (exceeding == 0.0) permitted = model.speed(i);
  }
  const double largest = *std::max_element(values.begin(), values.end());
  ratios.of_pairs.push_back(verdict.bound / largest);
  ++audit.pairs;
  audit.speeds += static_cast<long>(values.size());
  if (verdict.permitted > permitted) ++audit.missed;
  const bool other_ratio =
      verdict.decided_by == DecidedBy::passages && std::abs(verdict.ratio - largest) > same_value * largest;
  if (verdict.permitted != permitted || verdict.exceeding != exceeding || other_ratio) ++audit.different;
}

}  // namespace

Audit audit(MPI_Comm comm, const Problem& problem, int count) {
  const results::Stage stage("audit of the screen");
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  const options::Screen& screen = *problem.scene.screen;
  const base::RandomStream random(1, "screen_audit");
  Audit audit;
  Ratios ratios;
  for (int i = 0; i < count; ++i) {
    const auto draw = [&](std::uint64_t number, std::size_t size) {
      return std::min(size - 1, static_cast<std::size_t>(random.uniform(number) * static_cast<double>(size)));
    };
    const auto pair = 2 * static_cast<std::uint64_t>(i);
    const std::size_t bridge = draw(pair, problem.stock.size()), formation = draw(pair + 1, problem.fleet.size());
    if (i % ranks != rank) continue;
    const BridgeModel model(problem.stock[bridge], screen.modes, screen.parts, screen.speeds, screen.samples);
    check_pair(model, problem.fleet[formation], audit, ratios);
    results::Stage::advance(static_cast<double>(i) / static_cast<double>(count));
  }
  for (long* number : {&audit.pairs, &audit.speeds, &audit.missed, &audit.different, &audit.below})
    MPI_Allreduce(MPI_IN_PLACE, number, 1, MPI_LONG, MPI_SUM, comm);
  audit.median_pair = median(gathered(comm, ratios.of_pairs));
  audit.median_speed = median(gathered(comm, ratios.of_speeds));
  return audit;
}

std::vector<results::Attribute> Audit::attributes() const {
  return {{"audit_pairs", pairs},
          {"audit_speeds", speeds},
          {"audit_missed", missed},
          {"audit_different", different},
          {"audit_below", below},
          {"audit_median_bound_over_value", median_pair},
          {"audit_median_bound_over_value_at_a_speed", median_speed}};
}

std::string Audit::text() const {
  return fmt::format(
      "audit    {} pairs at {} speeds by all passages: {} exceedances missed, {} verdicts different, {} bounds below "
      "the value; median of bound over value {:.3f} (at each speed {:.3f})",
      pairs, speeds, missed, different, below, median_pair, median_speed);
}

}  // namespace traverse::screen
