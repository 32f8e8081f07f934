// All that is compiled for a size of block, spread over a few files so that they compile side by side:
// TRAVERSE_COMPILE_BLOCK(B) compiles the factors and sweeps of B unknowns a node.
#pragma once

#include "bundle_factor.hpp"
#include "bundle_sweep.hpp"
#include "local_factor_body.hpp"

#define TRAVERSE_COMPILE_COLUMNS(B, C)                                                                         \
  template void Bundle<B>::forward<C>(const Columns&, Range, NodeFiller*, ChainBorders<B, C>&) const;          \
  template void Bundle<B>::backward<C>(const Columns&, Range, const ChainBorders<B, C>&) const;                \
  template void Bundle<B>::solve_alone<C>(const Columns&) const;                                               \
  template void LocalFactor<B>::eliminate<C>(const Columns&, int, Range, NodeFiller*, SeparatorPanels<B, C>&); \
  template void LocalFactor<B>::substitute<C>(const Columns&, int, Range, const SeparatorPanels<B, C>&);
#define TRAVERSE_COMPILE_BLOCK(B) \
  template class Bundle<B>;       \
  template class LocalFactor<B>;  \
  TRAVERSE_COMPILE_COLUMNS(B, 1)  \
  TRAVERSE_COMPILE_COLUMNS(B, 2)  \
  TRAVERSE_COMPILE_COLUMNS(B, 4)  \
  TRAVERSE_COMPILE_COLUMNS(B, 8)
