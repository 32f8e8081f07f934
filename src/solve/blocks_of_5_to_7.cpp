// Explicit template instantiations of the block factorisations for 5, 6 and 7 unknowns per node.
#include "blocks.hpp"

namespace traverse::solve {

TRAVERSE_COMPILE_BLOCK(5)
TRAVERSE_COMPILE_BLOCK(6)
TRAVERSE_COMPILE_BLOCK(7)

}  // namespace traverse::solve
