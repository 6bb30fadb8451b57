// SPDX-License-Identifier: MIT
// Large pages for an array that is about to be filled: the first touch of a small page costs more than what
// is written to it.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace tunica::meshing::detail {

/// Asks the system to back the whole pages among these bytes by large ones; it may decline.
inline void large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t small = 4096, large = std::uintptr_t{2} << 20U;  // [B]
  if (bytes < 2 * large) return;
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + small - 1) & ~(small - 1), last = (address + bytes) & ~(small - 1);
  (void)madvise(static_cast<char*>(begin) + (first - address), last - first, MADV_HUGEPAGE);
#endif
}

}  // namespace tunica::meshing::detail
