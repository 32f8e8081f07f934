// Setting of subnormal numbers to zero. A response that decays along the bridge ends in subnormal numbers, which
// rounding prevents from decaying to zero on the remaining bridge, and with which many processors compute slowly.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace traverse::solve {

/// During its lifetime, subnormal numbers (below 2.2e-308) are set to zero on this thread, if the processor can do so.
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

}  // namespace traverse::solve
