// Each rank eliminates its inner nodes, with the factorisation compiled for the block size, from 2 to 7 unknowns per
// node or the general one. The Schur complements of the separators are gathered and solved on every rank, and back
// substitution computes the inner nodes.
#include "substructure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "traverse/base/error.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace traverse::solve {
namespace {

/// During its lifetime, subnormal numbers (below 2.2e-308) are set to zero on this thread, if the processor can do so.
/// A response that decays along the bridge ends in subnormal numbers, which rounding prevents from decaying to zero on
/// the remaining bridge, and with which many processors compute slowly.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | flush_results | flush_operands); }
  ~FlushDenormals() { _mm_setcsr(saved_); }

 private:
  static constexpr unsigned flush_results = 0x8000;
  static constexpr unsigned flush_operands = 0x0040;
  unsigned saved_;

 public:
#else
  FlushDenormals() {}
  ~FlushDenormals() {}
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

// The message of a rank to the others after factorisation: four numbers on its pivots, the diagonal entries of its
// separator in the original matrix, and the three blocks of SchurPart.
enum HeaderEntry { bad_unknown, bad_pivot, bad_diagonal, smallest_ratio, header_size };

std::ptrdiff_t factor_message_size(int block) { return header_size + block + std::ptrdiff_t{3} * block * block; }

/// Calls body(number of columns as a constant, first column) for groups of 8, 4, 2 and 1 columns.
template <class Body>
void for_column_groups(int columns, Body&& body) {
  int column = 0;
  for (; column + 8 <= columns; column += 8) body(std::integral_constant<int, 8>{}, column);
  if (column + 4 <= columns) {
    body(std::integral_constant<int, 4>{}, column);
    column += 4;
  }
  if (column + 2 <= columns) {
    body(std::integral_constant<int, 2>{}, column);
    column += 2;
  }
  if (column < columns) body(std::integral_constant<int, 1>{}, column);
}

Columns from(const Columns& x, int column) { return {x.x + column * x.stride, x.origin, x.stride}; }

void grow(std::vector<double>& buffer, std::ptrdiff_t size) {
  if (static_cast<std::ptrdiff_t>(buffer.size()) < size) buffer.resize(static_cast<std::size_t>(size));
}

std::unique_ptr<AnySubstructure> make_substructure(MPI_Comm comm, int block_size, int local_nodes) {
  if (block_size < 1 || block_size > largest_block || local_nodes < 0) {
    throw std::logic_error("blocks have 1 to " + std::to_string(largest_block) + " unknowns");
  }
  switch (block_size) {
    case 2:
      return std::make_unique<Substructure<2>>(comm, block_size, local_nodes);
    case 3:
      return std::make_unique<Substructure<3>>(comm, block_size, local_nodes);
    case 4:
      return std::make_unique<Substructure<4>>(comm, block_size, local_nodes);
    case 5:
      return std::make_unique<Substructure<5>>(comm, block_size, local_nodes);
    case 6:
      return std::make_unique<Substructure<6>>(comm, block_size, local_nodes);
    case 7:
      return std::make_unique<Substructure<7>>(comm, block_size, local_nodes);
    default:
      return std::make_unique<Substructure<any_block>>(comm, block_size, local_nodes);
  }
}

}  // namespace

Partition::Partition(MPI_Comm communicator, int local_nodes) : comm(communicator), nodes(local_nodes) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  MPI_Comm_rank(comm, &rank);
  std::vector<int> counts(static_cast<std::size_t>(size), local_nodes);
  if (size > 1) MPI_Allgather(&local_nodes, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::ptrdiff_t begin = 0;
  for (int r = 0; r < size; ++r) {
    const int count = counts[static_cast<std::size_t>(r)];
    if (count > 0) {
      if (r == rank) own_index = static_cast<int>(active.size());
      active.push_back(r);
    }
    begins.push_back(begin);
    begin += count;
  }
}

template <int B>
Substructure<B>::Substructure(MPI_Comm comm, int block_size, int local_nodes)
    : block_{block_size}, partition_(comm, local_nodes), reduced_matrix_(block_size, partition_.separators()) {
  if (partition_.own_index >= 0) local_.emplace(block_, local_nodes, partition_.follows(), partition_.followed());
  if (partition_.separators() > 0) separators_.emplace(block_, partition_.separators(), false, false);
  reduced_diagonal_.resize(static_cast<std::size_t>(partition_.separators()) * static_cast<std::size_t>(block_size));
}

template <int B>
void Substructure<B>::factor(const BlockTridiagonal& A, const std::vector<char>& fixed) {
  const std::size_t unknowns = static_cast<std::size_t>(partition_.nodes) * static_cast<std::size_t>(block_.size());
  if (A.block != block_.size() || A.nodes != partition_.nodes || (!fixed.empty() && fixed.size() != unknowns)) {
    throw std::logic_error("the matrix does not have the shape that the factorisation was made for");
  }
  factored_ = false;
  record_ = PivotRecord{};
  const Slice<B> slice{A, fixed.empty() ? nullptr : fixed.data(), next_fixed(fixed), nullptr};
  if (local_) local_->factor(slice, record_);
  if (partition_.ranks() > 1) {
    pack_factor(slice);
    gather_factors();
    factor_separators();
  } else if (record_.failed()) {
    fail(record_.bad_unknown, record_.bad_pivot, record_.bad_diagonal);
  }
  factored_ = true;
}

/// The fixed unknowns of the next rank's first node, one bit each.
template <int B>
std::uint64_t Substructure<B>::next_fixed(const std::vector<char>& fixed) const {
  if (partition_.separators() == 0) return 0;
  std::uint64_t own = 0;
  if (!fixed.empty()) {
    for (int i = 0; i < block_.size(); ++i) own |= std::uint64_t{fixed[static_cast<std::size_t>(i)] != 0} << i;
  }
  std::vector<std::uint64_t> all(static_cast<std::size_t>(partition_.ranks()));
  MPI_Allgather(&own, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, partition_.comm);
  if (!partition_.followed()) return 0;
  return all[static_cast<std::size_t>(partition_.active[static_cast<std::size_t>(partition_.own_index) + 1])];
}

template <int B>
void Substructure<B>::pack_factor(const Slice<B>& slice) {
  outgoing_.assign(static_cast<std::size_t>(factor_message_size(block_.size())), 0.0);
  const std::ptrdiff_t begin = partition_.begins[static_cast<std::size_t>(partition_.rank)] * block_.size();
  outgoing_[bad_unknown] = record_.failed() ? static_cast<double>(begin + record_.bad_unknown) : -1.0;
  outgoing_[bad_pivot] = record_.bad_pivot;
  outgoing_[bad_diagonal] = record_.bad_diagonal;
  outgoing_[smallest_ratio] = record_.smallest_ratio;
  if (!local_ || record_.failed()) return;
  double* to = outgoing_.data() + header_size;
  for (int i = 0; i < block_.size(); ++i) *to++ = slice.reference(0, i);
  const SchurPart<B>& schur = local_->schur();
  for (const Block<B>* part : {&schur.own, &schur.coupling, &schur.next}) {
    to = std::copy(part->data(), part->data() + block_.area(), to);
  }
}

template <int B>
void Substructure<B>::gather_factors() {
  const std::ptrdiff_t size = factor_message_size(block_.size());
  grow(incoming_, size * partition_.ranks());
  MPI_Allgather(outgoing_.data(), static_cast<int>(size), MPI_DOUBLE, incoming_.data(), static_cast<int>(size),
                MPI_DOUBLE, partition_.comm);
  agree_on_failure();
  for (int rank : partition_.active) {
    record_.smallest_ratio = std::min(record_.smallest_ratio, incoming_[rank * size + smallest_ratio]);
  }
}

template <int B>
void Substructure<B>::agree_on_failure() const {
  const std::ptrdiff_t size = factor_message_size(block_.size());
  const double* first = nullptr;
  for (int rank : partition_.active) {
    const double* message = incoming_.data() + rank * size;
    if (message[bad_unknown] < 0.0) continue;
    if (first == nullptr || message[bad_unknown] < first[bad_unknown]) first = message;
  }
  if (first != nullptr) fail(static_cast<std::ptrdiff_t>(first[bad_unknown]), first[bad_pivot], first[bad_diagonal]);
}

template <int B>
void Substructure<B>::fail(std::ptrdiff_t unknown, double pivot, double diagonal) const {
  throw SolverError(fmt::format(
      "the matrix is not positive definite at unknown {} (node {}, component {}): pivot {:.3g}, diagonal entry {:.3g}; "
      "is a support missing?",
      unknown, unknown / block_.size(), unknown % block_.size(), pivot, diagonal));
}

/// The blocks of the rank with the index `place` among the ranks with nodes.
template <int B>
const double* Substructure<B>::factor_message(int place) const {
  const int rank = partition_.active[static_cast<std::size_t>(place)];
  return incoming_.data() + rank * factor_message_size(block_.size()) + header_size;
}

template <int B>
void Substructure<B>::factor_separators() {
  if (!separators_) return;
  const std::ptrdiff_t n = block_.size();
  const std::ptrdiff_t area = block_.area();
  for (int i = 0; i < partition_.separators(); ++i) {
    const double* before = factor_message(i) + n;
    const double* message = factor_message(i + 1);
    std::copy_n(message, n, reduced_diagonal_.data() + i * n);
    const double* own = message + n;
    for (std::ptrdiff_t e = 0; e < area; ++e) {
      reduced_matrix_.diagonal[static_cast<std::size_t>(i * area + e)] = own[e] + before[2 * area + e];
      reduced_matrix_.upper[static_cast<std::size_t>(i * area + e)] = own[area + e];
    }
  }
  const Slice<B> slice{reduced_matrix_, nullptr, 0, reduced_diagonal_.data()};
  PivotRecord record;
  if (!separators_->factor(slice, record)) {
    const int rank = partition_.active[static_cast<std::size_t>(record.bad_unknown / n + 1)];
    fail(partition_.begins[static_cast<std::size_t>(rank)] * n + record.bad_unknown % n, record.bad_pivot,
         record.bad_diagonal);
  }
  record_.smallest_ratio = std::min(record_.smallest_ratio, record.smallest_ratio);
}

template <int B>
void Substructure<B>::solve(const Request& request) {
  if (!factored_) throw std::logic_error("solve before a successful factor");
  const Range window = request.window;
  if (window.first < 0 || window.first > window.past || window.past > partition_.nodes) {
    throw std::logic_error("a window beyond this rank's nodes");
  }
  const FlushDenormals flush;
  const bool whole = request.window.past - request.window.first == partition_.nodes;
  if (const SubdomainBatch<B>* single_batch = local_ && whole ? local_->single_batch() : nullptr;
      single_batch != nullptr) {
    if (request.rhs_callback != nullptr)
      request.rhs_callback->fill(0, partition_.nodes);  // few enough to remain in the cache
    for_column_groups(request.columns,
                      [&](auto C, int column) { single_batch->template solve_single<C>(from(request.x, column)); });
    return;
  }
  if (local_) local_->reserve(request.columns);
  if (!separators_) {
    if (local_) for_column_groups(request.columns, [&](auto C, int column) { solve_single<C>(request, column); });
    return;
  }
  grow(outgoing_, std::ptrdiff_t{2} * block_.size() * request.columns);
  if (local_) for_column_groups(request.columns, [&](auto C, int column) { reduce<C>(request, column); });
  solve_separators(request.columns);
  if (local_) for_column_groups(request.columns, [&](auto C, int column) { expand<C>(request, column); });
}

template <int B>
template <int C>
void Substructure<B>::solve_single(const Request& request, int column) {
  const Columns x = from(request.x, column);
  SeparatorPanels<B, C> none;
  local_->template eliminate<C>(x, column, request.window, request.rhs_callback, none);
  local_->template substitute<C>(x, column, request.window, none);
}

/// Eliminates the inner nodes and writes this rank's message: for each column the reduced right-hand side of its
/// separator, and its contribution to the right-hand side of the next separator.
template <int B>
template <int C>
void Substructure<B>::reduce(const Request& request, int column) {
  const std::ptrdiff_t length = std::ptrdiff_t{2} * block_.size();
  SeparatorPanels<B, C> separators;
  local_->template eliminate<C>(from(request.x, column), column, request.window, request.rhs_callback, separators);
  separators.own.store(block_, outgoing_.data() + column * length, length);
  separators.next.store(block_, outgoing_.data() + column * length + block_.size(), length);
}

template <int B>
void Substructure<B>::solve_separators(int columns) {
  const std::ptrdiff_t n = block_.size();
  const std::ptrdiff_t size = 2 * n * columns;
  const std::ptrdiff_t stride = n * partition_.separators();
  grow(incoming_, size * partition_.ranks());
  grow(reduced_, stride * columns);
  MPI_Allgather(outgoing_.data(), static_cast<int>(size), MPI_DOUBLE, incoming_.data(), static_cast<int>(size),
                MPI_DOUBLE, partition_.comm);
  if (!local_) return;
  for (int i = 0; i < partition_.separators(); ++i) {
    const double* before = incoming_.data() + partition_.active[static_cast<std::size_t>(i)] * size + n;
    const double* own = incoming_.data() + partition_.active[static_cast<std::size_t>(i) + 1] * size;
    for (int column = 0; column < columns; ++column) {
      double* to = reduced_.data() + column * stride + i * n;
      for (std::ptrdiff_t e = 0; e < n; ++e) to[e] = own[column * 2 * n + e] + before[column * 2 * n + e];
    }
  }
  const Range all = {0, partition_.separators()};
  separators_->reserve(columns);
  for_column_groups(columns, [&](auto C, int column) {
    const Columns x = {reduced_.data() + column * stride, 0, stride};
    SeparatorPanels<B, C> none;
    separators_->template eliminate<C>(x, column, all, nullptr, none);
    separators_->template substitute<C>(x, column, all, none);
  });
}

template <int B>
template <int C>
void Substructure<B>::expand(const Request& request, int column) {
  const std::ptrdiff_t reduced_stride = std::ptrdiff_t{block_.size()} * partition_.separators();
  const double* own = reduced_.data() + column * reduced_stride + (partition_.own_index - 1) * block_.size();
  SeparatorPanels<B, C> separators = {};
  if (partition_.follows()) separators.own.load(block_, own, reduced_stride);
  if (partition_.followed()) separators.next.load(block_, own + block_.size(), reduced_stride);
  local_->template substitute<C>(from(request.x, column), column, request.window, separators);
}

template class Substructure<2>;
template class Substructure<3>;
template class Substructure<4>;
template class Substructure<5>;
template class Substructure<6>;
template class Substructure<7>;
template class Substructure<any_block>;

struct SubstructuredCholesky::Impl {
  std::unique_ptr<AnySubstructure> substructure;
  int block = 0;
  std::ptrdiff_t nodes = 0;
};

SubstructuredCholesky::SubstructuredCholesky(MPI_Comm comm, int block_size, int local_nodes)
    : impl_(std::make_unique<Impl>(Impl{make_substructure(comm, block_size, local_nodes), block_size, local_nodes})) {}
SubstructuredCholesky::~SubstructuredCholesky() = default;
SubstructuredCholesky::SubstructuredCholesky(SubstructuredCholesky&&) noexcept = default;
SubstructuredCholesky& SubstructuredCholesky::operator=(SubstructuredCholesky&&) noexcept = default;

void SubstructuredCholesky::factor(const BlockTridiagonal& A, const std::vector<char>& fixed) {
  impl_->substructure->factor(A, fixed);
}

void SubstructuredCholesky::solve(double* x, int columns) const {
  const Range all = {0, impl_->nodes};
  impl_->substructure->solve({{x, 0, impl_->nodes * impl_->block}, columns, all, nullptr});
}

void SubstructuredCholesky::solve(double* x, RhsCallback& rhs_callback) const {
  const Range all = {0, impl_->nodes};
  impl_->substructure->solve({{x, 0, impl_->nodes * impl_->block}, 1, all, &rhs_callback});
}

void SubstructuredCholesky::solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past,
                                         RhsCallback& rhs_callback) const {
  impl_->substructure->solve({{x, 0, impl_->nodes * impl_->block}, 1, {first, past}, &rhs_callback});
}

void SubstructuredCholesky::solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const {
  impl_->substructure->solve({{x, first, (past - first) * impl_->block}, columns, {first, past}, nullptr});
}

double SubstructuredCholesky::pivot_ratio() const { return impl_->substructure->pivot_ratio(); }
std::size_t SubstructuredCholesky::stored_numbers() const { return impl_->substructure->stored_numbers(); }

}  // namespace traverse::solve
