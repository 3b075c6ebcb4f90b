// parallel_for: independent tasks 0 .. count-1 on a given number of threads.
//
// OpenMP and TBB were passed over because ThreadSanitizer cannot see into their uninstrumented runtimes and
// reports false races.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <thread>

namespace pointreel {

// 0 means one per processor.
inline int resolve_threads(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Calls work() here and, while that runs, on as many as `others` threads of a pool that the process keeps (on
// fewer where they are busy). Returns when all calls have returned.
void run_with_others(std::size_t others, const std::function<void()>& work);

// Calls task(i) once for each i, in any order; returns when all are done. Tasks must not throw.
template <class Task>
void parallel_for(std::size_t count, int threads, const Task& task) {
  const std::size_t workers = std::min(count, static_cast<std::size_t>(std::max(1, threads)));
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) task(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  run_with_others(workers - 1, [&] {
    for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) task(i);
  });
}

// What else to do while a part of the work keeps fewer threads busy than there are.
using BesideTasks = std::span<const std::function<void()>>;

// Calls task(i) for each i as above, and then each of `beside` on whatever thread is free.
template <class Task>
void parallel_for(std::size_t count, int threads, BesideTasks beside, const Task& task) {
  parallel_for(count + beside.size(), threads, [&](std::size_t i) {
    if (i < count)
      task(i);
    else
      beside[i - count]();
  });
}
inline void run_all(int threads, BesideTasks tasks) {
  parallel_for(tasks.size(), threads, [&](std::size_t i) { tasks[i](); });
}

// Calls look_at(piece, first, last) for pieces of `points` points, on all threads.
inline constexpr std::size_t kPiecePoints = 8192;
template <class LookAt>
void for_each_piece(std::size_t points, int threads, const LookAt& look_at) {
  parallel_for((points + kPiecePoints - 1) / kPiecePoints, threads, [&](std::size_t piece) {
    look_at(piece, piece * kPiecePoints, std::min(points, (piece + 1) * kPiecePoints));
  });
}

// Calls both, at once where there are threads.
template <class One, class Other>
void run_both(int threads, const One& one, const Other& other) {
  parallel_for(2, threads, [&](std::size_t i) {
    if (i == 0)
      one();
    else
      other();
  });
}

}  // namespace pointreel
