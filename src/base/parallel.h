// parallel_for: independent tasks 0 .. count-1 on a given number of threads.
//
// Threads are started per call (tens of microseconds, against milliseconds of work per task). OpenMP and TBB
// were passed over because ThreadSanitizer cannot see into their uninstrumented runtimes and reports false
// races.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace pointreel {

// 0 means one per processor.
inline int resolve_threads(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Calls task(i) once for each i, in any order; returns when all are done. Tasks must not throw.
template <class Task>
void parallel_for(std::size_t count, int threads, const Task& task) {
  const std::size_t workers = std::min(count, static_cast<std::size_t>(std::max(1, threads)));
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) task(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) task(i);
  };
  std::vector<std::jthread> others;
  others.reserve(workers - 1);
  for (std::size_t w = 1; w < workers; ++w) others.emplace_back(work);
  work();
}  // jthread joins

}  // namespace pointreel
