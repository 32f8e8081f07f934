// The build of a kernel for this processor's instruction set, and aligned memory for kernels.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace traverse::engine {

/// The instruction sets that kernels are compiled for, each in a namespace of that name.
enum class Target { plain, avx2, avx512 };
/// The best one on this processor, and its common name.
Target best_target();
std::string instructions();
/// The fastest number of runs in a batch: comparisons of vectors wider than the processor's registers are slow.
std::size_t best_width();

// Declares the functions of each build of a kernel; calls a function of the build for best_target().
#ifdef __x86_64__
#define TRAVERSE_LANES_DECLARE(...) \
  namespace plain {                 \
  __VA_ARGS__                       \
  }                                 \
  namespace avx2 {                  \
  __VA_ARGS__                       \
  }                                 \
  namespace avx512 {                \
  __VA_ARGS__                       \
  }
#define TRAVERSE_LANES_CALL(call)                                 \
  (engine::best_target() == engine::Target::avx512 ? avx512::call \
   : engine::best_target() == engine::Target::avx2 ? avx2::call   \
                                                   : plain::call)
#else
#define TRAVERSE_LANES_DECLARE(...) \
  namespace plain {                 \
  __VA_ARGS__                       \
  }
#define TRAVERSE_LANES_CALL(call) (plain::call)
#endif

/// The largest number of runs in a batch.
inline constexpr std::size_t widest = 8;

/// Numbers aligned for the widest vectors.
class Aligned {
 public:
  explicit Aligned(std::size_t size) : chunks_((size + widest - 1) / widest) {}
  double* data() { return chunks_.empty() ? nullptr : chunks_.front().numbers; }
  const double* data() const { return chunks_.empty() ? nullptr : chunks_.front().numbers; }

 private:
  struct alignas(64) Chunk {
    double numbers[widest] = {};
  };
  std::vector<Chunk> chunks_;
};

}  // namespace traverse::engine
