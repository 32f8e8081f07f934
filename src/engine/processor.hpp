// Which of a kernel's builds this processor can run, and memory as kernels take it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace traverse::engine {

/// What a kernel is compiled for, each in a namespace of that name.
enum class Target { plain, avx2, avx512 };
/// The best that this processor can run, and its name as people know it.
Target best_target();
std::string instructions();
/// The runs side by side that are quickest: comparisons of vectors wider than the processor's cost more than they save.
std::size_t best_width();

// Declares what each build of a kernel has; calls it in the build for best_target().
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

/// The most runs that go side by side.
inline constexpr std::size_t widest = 8;

/// Numbers that start where the widest vectors may.
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
