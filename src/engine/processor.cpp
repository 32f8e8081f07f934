// Detects AVX-512 and AVX2 at run time, and derives from that which build of a kernel is called and how many lanes its
// vectors have.
#include "engine/processor.hpp"

namespace traverse::engine {

Target best_target() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw"))
    return Target::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Target::avx2;
#endif
  return Target::plain;
}

std::size_t best_width() {
  switch (best_target()) {
    case Target::avx512:
      return 8;
    case Target::avx2:
      return 4;
    default:
      return 2;
  }
}

std::string instructions() {
  switch (best_target()) {
    case Target::avx512:
      return "AVX-512";
    case Target::avx2:
      return "AVX2";
    default:
      return "plain";
  }
}

}  // namespace traverse::engine
