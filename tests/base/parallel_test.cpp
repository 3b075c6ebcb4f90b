#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace pointreel {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  for (int threads = 1; threads <= 8; ++threads) {
    for (const std::size_t count : {0u, 1u, 2u, 7u, 8u, 9u, 1000u}) {
      std::vector<std::atomic<int>> calls(count);
      parallel_for(count, threads, [&](std::size_t i) { ++calls.at(i); });
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(calls[i], 1) << "index " << i << " of " << count << ", " << threads << " threads";
      }
    }
  }
}

TEST(ParallelFor, ResultsAreVisibleToTheCaller) {
  // Plain ints: the thread sanitizer checks that joining orders the writes before the reads.
  std::vector<int> squares(500);
  parallel_for(squares.size(), 4, [&](std::size_t i) { squares[i] = static_cast<int>(i * i); });
  for (std::size_t i = 0; i < squares.size(); ++i) EXPECT_EQ(squares[i], static_cast<int>(i * i));
}

TEST(ParallelFor, TakesNonsenseThreadCountsAsOne) {
  for (const int threads : {0, -3}) {
    std::size_t sum = 0;  // not atomic: one thread only
    parallel_for(10, threads, [&](std::size_t i) { sum += i; });
    EXPECT_EQ(sum, 45u);
  }
}

TEST(ParallelFor, RunsInsideItself) {
  std::vector<std::atomic<int>> calls(20 * 30);
  parallel_for(20, 3,
               [&](std::size_t i) { parallel_for(30, 3, [&](std::size_t k) { ++calls.at(i * 30 + k); }); });
  for (const auto& count : calls) EXPECT_EQ(count, 1);
}

TEST(ParallelFor, ServesSeveralCallersAtOnce) {
  std::vector<std::size_t> sums(4);
  std::vector<std::thread> callers;
  for (std::size_t& sum : sums) {
    callers.emplace_back([&sum] {
      for (int round = 0; round < 200; ++round) {
        std::atomic<std::size_t> part{0};
        parallel_for(round % 10, 3, [&](std::size_t i) { part += i + 1; });
        sum += part;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  for (const std::size_t sum : sums) EXPECT_EQ(sum, 20u * (1 + 3 + 6 + 10 + 15 + 21 + 28 + 36 + 45));
}

TEST(ParallelFor, WakesThreadsThatFellAsleep) {
  for (int round = 0; round < 5; ++round) {
    std::atomic<int> together{0};
    // Each waits for the other: one thread alone would wait in vain.
    parallel_for(2, 2, [&](std::size_t) {
      ++together;
      while (together.load() < 2) std::this_thread::yield();
    });
    EXPECT_EQ(together, 2);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(RunBoth, CallsBoth) {
  for (const int threads : {1, 2}) {
    int one = 0, other = 0;
    run_both(
        threads, [&] { one = 1; }, [&] { other = 2; });
    EXPECT_EQ(one, 1);
    EXPECT_EQ(other, 2);
  }
}

TEST(ResolveThreads, ZeroIsOnePerProcessor) {
  EXPECT_GE(resolve_threads(0), 1);
  EXPECT_EQ(resolve_threads(3), 3);
}

}  // namespace
}  // namespace pointreel
