// Sweeps that come through standard input: binary PCD or PLY files, one after another.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "pointreel/io.h"
#include "pointreel/stop_event.h"
#include "pointreel/sweep_source.h"

namespace pointreel {

// A thread of its own reads, so that a sweep's time of arrival is right and its bytes come in while the one
// before is encoded.
class SweepStream final : public SweepSource {
 public:
  explicit SweepStream(const StopEvent& stop);
  ~SweepStream() override;
  SweepStream(const SweepStream&) = delete;
  SweepStream& operator=(const SweepStream&) = delete;
  std::optional<ArrivedSweep> next() override;

 private:
  struct Received {
    std::string bytes;
    CloudFormat format;
    std::optional<Error> error;  // instead of a sweep
    ArrivalClock::time_point arrived;
  };
  void receive();
  bool cut_sweeps(std::string& buffer);
  void push(Received received);

  const StopEvent& stop_;
  std::size_t received_count_ = 0;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<Received> waiting_;
  std::size_t taken_count_ = 0;
  bool ended_ = false, abandoned_ = false;
  std::jthread thread_;
};

}  // namespace pointreel
