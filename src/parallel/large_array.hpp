// SPDX-License-Identifier: BSD-3-Clause
/// Room for arrays of millions of entries in large pages, where the system has them: fewer page faults on
/// first touch, fewer misses of the address cache on random access.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rhexis::parallel {

/// Reserves room for `count` entries in an empty vector.
template <class T>
void reserve_large(std::vector<T>& array, std::size_t count) {
  array.reserve(count);
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  const auto address = reinterpret_cast<std::uintptr_t>(array.data());
  const std::uintptr_t to_page = (page - address % page) % page;  // bytes before the first whole page
  const std::uintptr_t bytes = count * sizeof(T);
  // Only a hint: an answer of no changes nothing.
  if (bytes > to_page)
    (void)madvise(reinterpret_cast<char*>(array.data()) + to_page, bytes - to_page, MADV_HUGEPAGE);
#endif
}

template <class T>
std::vector<T> large_array(std::size_t count, T value = T{}) {
  std::vector<T> array;
  reserve_large(array, count);
  array.resize(count, value);
  return array;
}

}  // namespace rhexis::parallel
