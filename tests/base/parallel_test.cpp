#include "base/parallel.h"

#include <gtest/gtest.h>

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

TEST(ResolveThreads, ZeroIsOnePerProcessor) {
  EXPECT_GE(resolve_threads(0), 1);
  EXPECT_EQ(resolve_threads(3), 3);
}

}  // namespace
}  // namespace pointreel
