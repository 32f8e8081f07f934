// Order of elimination by least degree of bodies and constraints, and sparse LU factorisation with a planned sequence
// of operations.
#include "multibody/augmented_system.hpp"

#include <algorithm>
#include <set>

namespace traverse::multibody {
namespace {

constexpr double least_pivot = 1e-13;  // of a body's coordinate, relative to its entry before the elimination

}  // namespace

/// For each node (a body or a kept row) the nodes that are not yet eliminated when it is, itself excluded. Fills
/// order_.
std::vector<std::vector<int>> AugmentedSystem::find_order(const AugmentedPattern& pattern) {
  const int bodies = pattern.bodies, nodes = bodies + static_cast<int>(pattern.rows.size());
  std::vector<std::set<int>> near(static_cast<std::size_t>(nodes));
  const auto connect = [&near](int a, int b) {
    if (a == b) return;
    near[a].insert(b);
    near[b].insert(a);
  };
  for (const auto& [first, second] : pattern.pairs)
    if (first != ground && second != ground) connect(first, second);
  std::vector<char> eliminated(static_cast<std::size_t>(nodes), 0);
  for (int k = bodies; k < nodes; ++k)
    for (const int coordinate : pattern.rows[k - bodies]) connect(k, coordinate / 3);
  const auto allowed = [&](int k) {  // a constraint after the bodies that it holds
    if (eliminated[k]) return false;
    return k < bodies || std::all_of(pattern.rows[k - bodies].begin(), pattern.rows[k - bodies].end(),
                                     [&](int coordinate) { return eliminated[coordinate / 3] != 0; });
  };
  std::vector<std::vector<int>> rest(static_cast<std::size_t>(nodes));
  order_.clear();
  for (int step = 0; step < nodes; ++step) {
    int next = -1;
    for (int k = 0; k < nodes; ++k)
      if ((next < 0 || near[k].size() < near[next].size()) && allowed(k)) next = k;
    eliminated[next] = 1;
    rest[next].assign(near[next].begin(), near[next].end());
    for (const int a : rest[next]) {
      near[a].erase(next);
      for (const int b : rest[next]) connect(a, b);
    }
    if (next < bodies)
      for (int c = 0; c < 3; ++c) order_.push_back(3 * next + c);
    else
      order_.push_back(3 * bodies + next - bodies);
  }
  return rest;
}

void AugmentedSystem::plan(const AugmentedPattern& pattern) {
  bodies_ = pattern.bodies;
  const std::vector<std::vector<int>> rest = find_order(pattern);
  const auto size = order_.size();
  place_.assign(size, 0);
  for (std::size_t k = 0; k < size; ++k) place_[order_[k]] = static_cast<int>(k);

  // The structure is symmetric: the upper part of each pivot's row, and its transpose.
  std::vector<std::vector<int>> upper(size), lower(size);
  const auto unknowns = [&](int node, auto use) {
    if (node >= bodies_) return use(place_[3 * bodies_ + node - bodies_]);
    for (int c = 0; c < 3; ++c) use(place_[3 * node + c]);
  };
  for (int node = 0; node < static_cast<int>(rest.size()); ++node)
    unknowns(node, [&](int k) {
      unknowns(node, [&](int j) {
        if (j > k) upper[k].push_back(j);
      });
      for (const int other : rest[node]) unknowns(other, [&](int j) { upper[k].push_back(j); });
    });
  for (int k = 0; k < static_cast<int>(size); ++k) {
    std::sort(upper[k].begin(), upper[k].end());
    for (const int j : upper[k]) lower[j].push_back(k);
  }
  lower_.clear();
  upper_.clear();
  diagonal_.clear();
  int begin = 0;
  for (std::size_t k = 0; k < size; ++k) {
    lower_.index.insert(lower_.index.end(), lower[k].begin(), lower[k].end());
    upper_.index.insert(upper_.index.end(), upper[k].begin(), upper[k].end());
    lower_.close();
    upper_.close();
    diagonal_.push_back(begin + static_cast<int>(lower[k].size()));
    begin += static_cast<int>(lower[k].size() + 1 + upper[k].size());
  }
  entries_.assign(static_cast<std::size_t>(begin), 0.0);
  inverse_.assign(size, 0.0);
  work_.assign(size, 0.0);
  find_updates(pattern);
}

/// The index in entries_ of row i and column j, which are pivots.
int AugmentedSystem::entry(int i, int j) const {
  if (i == j) return diagonal_[i];
  const IndexLists& lists = j < i ? lower_ : upper_;
  const int* found = std::lower_bound(lists.begin(i), lists.end(i), j);
  const auto offset = static_cast<int>(found - lists.begin(i));
  return j < i ? diagonal_[i] - static_cast<int>(lower_.end(i) - lower_.begin(i)) + offset : diagonal_[i] + 1 + offset;
}

void AugmentedSystem::find_updates(const AugmentedPattern& pattern) {
  pair_entry_.clear();
  for (const std::array<int, 2>& pair : pattern.pairs) {
    std::array<int, 36>& entries = pair_entry_.emplace_back();
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const int row = pair[i / 3], column = pair[j / 3];
        const bool moves = row != ground && column != ground;
        entries[6 * j + i] = moves ? entry(place_[3 * row + i % 3], place_[3 * column + j % 3]) : -1;
      }
  }
  constraint_entry_.clear();
  for (int row = 0; row < static_cast<int>(pattern.rows.size()); ++row)
    for (const int column : pattern.rows[row]) {
      const int k = place_[3 * bodies_ + row], j = place_[column];
      constraint_entry_.push_back({row, column, entry(k, j), entry(j, k)});
    }
  updated_.clear();
  for (int i = 0; i < static_cast<int>(order_.size()); ++i)
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k)
      for (const int* j = upper_.begin(*k); j != upper_.end(*k); ++j) updated_.push_back(entry(i, *j));
}

void AugmentedSystem::set_zero() { std::fill(entries_.begin(), entries_.end(), 0.0); }

void AugmentedSystem::add_mass(const Eigen::VectorXd& mass, double factor) {
  for (int i = 0; i < 3 * bodies_; ++i) entries_[diagonal_[place_[i]]] += factor * mass[i];
}

void AugmentedSystem::add_to_body(int body, double factor, const std::array<double, 3>& first,
                                  const std::array<double, 3>& second) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      entries_[entry(place_[3 * body + static_cast<int>(i)], place_[3 * body + static_cast<int>(j)])] +=
          factor * first[i] * second[j];
}

void AugmentedSystem::add_pair(int pair, const PairMatrix& matrix) {
  const std::array<int, 36>& entries = pair_entry_[pair];
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (entries[i] >= 0) entries_[entries[i]] += matrix.data()[i];
}

void AugmentedSystem::set_constraints(const Eigen::MatrixXd& Phi_q, const std::vector<int>& rows) {
  for (const ConstraintEntry& e : constraint_entry_)
    entries_[e.below] = entries_[e.above] = Phi_q(rows[static_cast<std::size_t>(e.row)], e.column);
}

// With K positive definite the pivots of coordinates are positive and those of constraints are negative.
bool AugmentedSystem::factor() {
  const int* updated = updated_.data();
  for (int i = 0; i < static_cast<int>(order_.size()); ++i) {
    const double before = entries_[diagonal_[i]];
    double* left = &entries_[diagonal_[i]] - (lower_.end(i) - lower_.begin(i));
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k, ++left) {
      const double l = *left * inverse_[*k];
      *left = l;
      const double* right = &entries_[diagonal_[*k]] + 1;
      const int* const end = updated + (upper_.end(*k) - upper_.begin(*k));
      while (updated != end) entries_[*updated++] -= l * *right++;
    }
    const double pivot = entries_[diagonal_[i]];
    const bool regular = order_[i] < 3 * bodies_ ? pivot > least_pivot * before : pivot < 0.0;
    if (!regular) return false;
    inverse_[i] = 1.0 / pivot;
  }
  return true;
}

void AugmentedSystem::solve(Eigen::VectorXd& r) {
  const int size = static_cast<int>(order_.size());
  for (int i = 0; i < size; ++i) {
    double sum = order_[i] < 3 * bodies_ ? r[order_[i]] : 0.0;
    const double* left = &entries_[diagonal_[i]] - (lower_.end(i) - lower_.begin(i));
    for (const int* k = lower_.begin(i); k != lower_.end(i); ++k) sum -= *left++ * work_[*k];
    work_[i] = sum;
  }
  for (int i = size - 1; i >= 0; --i) {
    double sum = work_[i];
    const double* right = &entries_[diagonal_[i]] + 1;
    for (const int* j = upper_.begin(i); j != upper_.end(i); ++j) sum -= *right++ * work_[*j];
    work_[i] = sum * inverse_[i];
    if (order_[i] < 3 * bodies_) r[order_[i]] = work_[i];
  }
}

}  // namespace traverse::multibody
