// What the kernels share: a number of every run, one in each lane of a vector. As all that kernels are made of, it is
// compiled once for each kind of processor and seen by no linker (train_kernel.hpp).
#pragma once

namespace traverse::engine {
namespace {

/// For what is called for every wheel: values in registers are not worth a call's memory.
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

  /// Numbers in a vector of the processor.
#if defined(__AVX512F__)
  static constexpr int in_a_row = 8;
#elif defined(__AVX__)
  static constexpr int in_a_row = 4;
#else
  static constexpr int in_a_row = 2;
#endif

  static Lane fill(double value) { return Lane{} + value; }
  /// The numbers of a vector, one a lane, and whether a mask holds a lane.
  static double* numbers(Lane& x) { return reinterpret_cast<double*>(&x); }
  static const double* numbers(const Lane& x) { return reinterpret_cast<const double*>(&x); }
  static bool holds(Mask mask, int lane) { return reinterpret_cast<const long*>(&mask)[lane] != 0; }
  static const Lane* lanes(const double* numbers) { return reinterpret_cast<const Lane*>(numbers); }
  static Lane* lanes(double* numbers) { return reinterpret_cast<Lane*>(numbers); }
  /// Without the bit of the sign.
  static Lane magnitude(Lane x) { return (Lane)((Mask)x & 0x7fffffffffffffffL); }
  static Lane greater(Lane a, Lane b) { return a > b ? a : b; }
  static Lane root(Lane x) {
    for (int l = 0; l < W; ++l) numbers(x)[l] = __builtin_sqrt(numbers(x)[l]);
    return x;
  }
  /// Bits, one at least where a > b in some lane, and none where it is in no lane.
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
  /// All bits of a lane of the mask are set, or none: one of them tells.
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
    long seen = 0;
    for (int l = 0; l < W; ++l) seen |= words[l];
    return seen != 0;
  }
};

/// The next `count` numbers of type T of the memory at `work`, of which `used` lanes are taken, from where the widest
/// vectors may start; null while work is null and the size alone is asked for.
template <class T>
T* take_from(double* work, long& used, int width, long count) {
  double* at = work == nullptr ? nullptr : work + used * width;
  constexpr long widest_vector = 8;  // doubles
  constexpr long bytes = 8 * widest_vector;
  used += (count * static_cast<long>(sizeof(T)) + bytes - 1) / bytes * (widest_vector / width);
  return reinterpret_cast<T*>(at);
}

/// Doubles that a task's work takes, and its runs, by a kernel as wide as the task asks.
template <template <int> class Group, class Task>
long size_of_work(const Task& task) {
  return task.width == 8   ? Group<8>(task, nullptr).size()
         : task.width == 4 ? Group<4>(task, nullptr).size()
                           : Group<2>(task, nullptr).size();
}
template <template <int> class Group, class Task>
void run_as_wide(const Task& task) {
  if (task.width == 8)
    Group<8>(task, task.work).run();
  else if (task.width == 4)
    Group<4>(task, task.work).run();
  else
    Group<2>(task, task.work).run();
}

}  // namespace
}  // namespace traverse::engine
