// Lists the entries other than zero, those apart that are equal in all lanes.
#include "engine/matrix_lanes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace traverse::engine {
namespace {
constexpr std::array matrices = {&ColumnBlocks::mass, &ColumnBlocks::damping, &ColumnBlocks::stiffness};

double value(const double* blocks, std::size_t place) { return blocks == nullptr ? 0.0 : blocks[place]; }
}  // namespace

MatrixLanes::MatrixLanes(int block, const std::vector<char>& held, std::vector<ColumnBlocks> of_lanes)
    : block_(block),
      of_lanes_(std::move(of_lanes)),
      order_(block, static_cast<int>(held.size()) / block, [this](int i, int j) { return !is_zero(place(i, j)); }) {
  const int unknowns = static_cast<int>(held.size());
  std::vector<int> value_at(static_cast<std::size_t>(2 * unknowns * block), -1);
  std::vector<std::size_t> places[2];
  for (int i = 0; i < unknowns; ++i) {
    const int column = i / block;
    const int end = held[static_cast<std::size_t>(i)] != 0 ? 0 : std::min(unknowns, (column + 2) * block);
    for (int j = std::max(0, (column - 1) * block); j < end; ++j) {
      const std::size_t at = place(i, j);
      if (is_zero(at)) continue;
      const bool equal = is_equal(at);
      if (value_at[at] < 0) {
        value_at[at] = static_cast<int>(places[equal ? 0 : 1].size());
        places[equal ? 0 : 1].push_back(at);
      }
      Entries& entries = equal ? equal_ : different_;
      entries.unknown.push_back(j);
      entries.value.push_back(value_at[at]);
    }
    for (Entries* entries : {&equal_, &different_}) entries->begin.push_back(static_cast<int>(entries->unknown.size()));
  }
  copy_values(equal_, places[0], true);
  copy_values(different_, places[1], false);
}

/// The place of a coefficient in the blocks, which is the same on both sides of the diagonal.
std::size_t MatrixLanes::place(int i, int j) const {
  if (i > j) std::swap(i, j);
  const int column = i / block_, next = j / block_ - column;
  return static_cast<std::size_t>(((2 * column + next) * block_ + j % block_) * block_ + i % block_);
}

bool MatrixLanes::is_zero(std::size_t place) const {
  return std::all_of(of_lanes_.begin(), of_lanes_.end(), [&](const ColumnBlocks& one) {
    return std::all_of(matrices.begin(), matrices.end(), [&](auto of) { return value(one.*of, place) == 0.0; });
  });
}

bool MatrixLanes::is_equal(std::size_t place) const {
  return std::all_of(of_lanes_.begin(), of_lanes_.end(), [&](const ColumnBlocks& one) {
    return std::all_of(matrices.begin(), matrices.end(),
                       [&](auto of) { return value(one.*of, place) == value(of_lanes_.front().*of, place); });
  });
}

void MatrixLanes::copy_values(Entries& to, const std::vector<std::size_t>& places, bool equal) {
  const std::size_t width = equal ? 1 : of_lanes_.size();
  std::array stored = {&to.mass, &to.damping, &to.stiffness};
  for (std::size_t m = 0; m < matrices.size(); ++m) {
    *stored[m] = std::make_unique<Aligned>(places.size() * width);
    double* next = (*stored[m])->data();
    for (const std::size_t place : places)
      for (std::size_t lane = 0; lane < width; ++lane) *next++ = value(of_lanes_[lane].*matrices[m], place);
  }
}

MatrixEntries MatrixLanes::Entries::task() const {
  return {begin.data(), unknown.data(), value.data(), mass->data(), damping->data(), stiffness->data()};
}

void MatrixLanes::set(BeamTask& task) const {
  task.equal = equal_.task();
  task.different = different_.task();
  order_.set(task);
}

}  // namespace traverse::engine
