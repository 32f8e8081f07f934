#include "blocks.hpp"

namespace traverse::solve {

TRAVERSE_COMPILE_BLOCK(2)
TRAVERSE_COMPILE_BLOCK(3)
TRAVERSE_COMPILE_BLOCK(4)

}  // namespace traverse::solve
