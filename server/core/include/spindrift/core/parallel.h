// Work that has independent parts, on all processors.
#pragma once

#include <cstddef>
#include <functional>

namespace spindrift::core {

/// Calls work(0) to work(count - 1), each once, on up to as many threads as the machine has processors, the calling
/// thread among them. They inherit its priority. Returns when all have returned. `work` must not throw.
void forEachInParallel(std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls work(begin, end) with ranges that together cover 0 to count - 1 once, in the same way. For loops over rows or
/// cells whose turns cost about the same.
void forRangesInParallel(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace spindrift::core
