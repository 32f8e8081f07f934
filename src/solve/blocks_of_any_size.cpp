// Explicit instantiation for any block size. Loops over this size are not unrolled: straight code would be a third of
// the whole program.
#define TRAVERSE_KEEP_LOOPS
#include "blocks.hpp"

namespace traverse::solve {

TRAVERSE_COMPILE_BLOCK(any_block)

}  // namespace traverse::solve
