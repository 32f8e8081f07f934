// Counts the heap allocations of a test program. Only one source file of a program may include this file.
#pragma once

#include <atomic>
#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRAVERSE_COUNTS_MEMORY

namespace {
std::atomic<long> allocations = 0;  // NOLINT(misc-definitions-in-headers): in one source file of a program
}

extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: the C library's own name
extern "C" void* malloc(std::size_t size) {        // NOLINT: counts the allocations of this test program
  ++allocations;
  return __libc_malloc(size);
}

#endif
