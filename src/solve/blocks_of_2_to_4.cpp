// Explicit template instantiations of the block factorisations for 2, 3 and 4 unknowns per node.
#include "blocks.hpp"

namespace traverse::solve {

TRAVERSE_COMPILE_BLOCK(2)
TRAVERSE_COMPILE_BLOCK(3)
TRAVERSE_COMPILE_BLOCK(4)

}  // namespace traverse::solve
