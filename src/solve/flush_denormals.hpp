// A response that dies out along the bridge ends in subnormal numbers, which round to themselves instead of going on
// to zero, over the whole rest of the bridge, and which many processors compute slowly.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace traverse::solve {

/// While it lives, subnormal numbers (below 2.2e-308) count as zero on this thread, where the processor can do that.
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
