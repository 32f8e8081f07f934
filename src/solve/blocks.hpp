// Explicit instantiations for one block size, distributed over a few files that compile in parallel:
// TRAVERSE_COMPILE_BLOCK(B) compiles the factors and sweeps for B unknowns per node.
#pragma once

#include "local_factor_body.hpp"
#include "subdomain_batch_factor.hpp"
#include "subdomain_batch_sweep.hpp"

#define TRAVERSE_COMPILE_COLUMNS(B, C)                                                                          \
  template void SubdomainBatch<B>::forward<C>(const Columns&, Range, RhsCallback*, ChainBorders<B, C>&) const;  \
  template void SubdomainBatch<B>::backward<C>(const Columns&, Range, const ChainBorders<B, C>&) const;         \
  template void SubdomainBatch<B>::solve_single<C>(const Columns&) const;                                       \
  template void LocalFactor<B>::eliminate<C>(const Columns&, int, Range, RhsCallback*, SeparatorPanels<B, C>&); \
  template void LocalFactor<B>::substitute<C>(const Columns&, int, Range, const SeparatorPanels<B, C>&);
#define TRAVERSE_COMPILE_BLOCK(B)   \
  template class SubdomainBatch<B>; \
  template class LocalFactor<B>;    \
  TRAVERSE_COMPILE_COLUMNS(B, 1)    \
  TRAVERSE_COMPILE_COLUMNS(B, 2)    \
  TRAVERSE_COMPILE_COLUMNS(B, 4)    \
  TRAVERSE_COMPILE_COLUMNS(B, 8)
