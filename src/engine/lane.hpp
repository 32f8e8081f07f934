// SIMD vectors for the kernels: a number of each run in each lane. Like all parts of kernels, this file is compiled
// once for each instruction set, and its functions must have internal linkage (train_kernel.hpp).
#pragma once

namespace traverse::engine {
namespace {

/// Inlines functions that are called for every wheel, so that values remain in registers.
#define TRAVERSE_INLINE inline __attribute__((always_inline))

// NOLINTBEGIN: vector types have no other spelling
typedef double TwoNumbers __attribute__((vector_size(16), may_alias));
typedef double FourNumbers __attribute__((vector_size(32), may_alias));
typedef double EightNumbers __attribute__((vector_size(64), may_alias));
typedef long long EightWords __attribute__((vector_size(64), may_alias));
// NOLINTEND

template <int W>
struct Lanes {
  // NOLINTBEGIN: vector types have no other spelling
  typedef double Lane __attribute__((vector_size(8 * W), may_alias));
  typedef double Unaligned __attribute__((vector_size(8 * W), may_alias, aligned(8)));
  typedef long Mask __attribute__((vector_size(8 * W), may_alias));
  // NOLINTEND

  /// Lanes of a vector register.
#if defined(__AVX512F__)
  static constexpr int in_a_row = 8;
#elif defined(__AVX__)
  static constexpr int in_a_row = 4;
#else
  static constexpr int in_a_row = 2;
#endif

  static Lane fill(double value) { return Lane{} + value; }
  /// The numbers of a vector, one for each lane, and whether a mask is true in a lane.
  static double* numbers(Lane& x) { return reinterpret_cast<double*>(&x); }
  static const double* numbers(const Lane& x) { return reinterpret_cast<const double*>(&x); }
  static bool is_set(Mask mask, int lane) { return reinterpret_cast<const long*>(&mask)[lane] != 0; }
  static const Lane* lanes(const double* numbers) { return reinterpret_cast<const Lane*>(numbers); }
  static Lane* lanes(double* numbers) { return reinterpret_cast<Lane*>(numbers); }
  /// Clears the sign bit.
  static Lane magnitude(Lane x) { return (Lane)((Mask)x & 0x7fffffffffffffffL); }
  static Lane greater(Lane a, Lane b) { return a > b ? a : b; }
  static Lane root(Lane x) {
    for (int l = 0; l < W; ++l) numbers(x)[l] = __builtin_sqrt(numbers(x)[l]);
    return x;
  }
  /// Non-zero if a > b in some lane, otherwise zero.
  static int exceeds(Lane a, Lane b) {
#ifdef __AVX512DQ__
    constexpr int greater_than = 14, all = 0xff, no_rounding = 4;
    if constexpr (W == 8)
      return __builtin_ia32_cmppd512_mask(*reinterpret_cast<const EightNumbers*>(&a),
                                          *reinterpret_cast<const EightNumbers*>(&b), greater_than,
                                          static_cast<unsigned char>(all), no_rounding);
#endif
    return any(a > b) ? 1 : 0;
  }
  /// Whether a mask is true in some lane. All bits of a lane are equal, so that one bit is sufficient.
  static bool any(Mask mask) {
#ifdef __AVX512DQ__
    if constexpr (W == 8) return __builtin_ia32_cvtq2mask512(*reinterpret_cast<const EightWords*>(&mask)) != 0;
#endif
#ifdef __SSE2__
    if constexpr (W == 2) return __builtin_ia32_movmskpd(*reinterpret_cast<const TwoNumbers*>(&mask)) != 0;
#endif
#ifdef __AVX__
    if constexpr (W == 4) return __builtin_ia32_movmskpd256(*reinterpret_cast<const FourNumbers*>(&mask)) != 0;
#endif
    const long* words = reinterpret_cast<const long*>(&mask);
    long combined = 0;
    for (int l = 0; l < W; ++l) combined |= words[l];
    return combined != 0;
  }
};

/// The next `count` numbers of type T of the memory at `work`, aligned for the widest vectors; `used` is the number of
/// vectors in use. Null while work is null, to compute the size only.
template <class T>
T* allocate_from(double* work, long& used, int width, long count) {
  double* at = work == nullptr ? nullptr : work + used * width;
  constexpr long widest_vector = 8;  // doubles
  constexpr long bytes = 8 * widest_vector;
  used += (count * static_cast<long>(sizeof(T)) + bytes - 1) / bytes * (widest_vector / width);
  return reinterpret_cast<T*>(at);
}

/// The number of doubles that a task's kernel needs, and the call of the kernel, with the task's width.
template <template <int> class Group, class Task>
long size_of_work(const Task& task) {
  return task.width == 8   ? Group<8>(task, nullptr).size()
         : task.width == 4 ? Group<4>(task, nullptr).size()
                           : Group<2>(task, nullptr).size();
}
template <template <int> class Group, class Task>
void run_with_width(const Task& task) {
  if (task.width == 8)
    Group<8>(task, task.work).run();
  else if (task.width == 4)
    Group<4>(task, task.work).run();
  else
    Group<2>(task, task.work).run();
}

}  // namespace
}  // namespace traverse::engine
