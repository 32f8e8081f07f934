// Loops over a size that only the run knows stay loops: as straight code they would be a third of the whole program.
#define TRAVERSE_KEEP_LOOPS
#include "blocks.hpp"

namespace traverse::solve {

TRAVERSE_COMPILE_BLOCK(any_block)

}  // namespace traverse::solve
