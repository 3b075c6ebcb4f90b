#include "base/parallel.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <vector>

namespace pointreel {
namespace {

// A sweep has a dozen parallel parts, some of them shorter than what starting or waking a thread takes (0.1
// ms): threads that wait stay awake for as long as the parts between usually take.
constexpr std::chrono::microseconds kStaysAwake{1000};

// False when that time passes first.
template <class Condition>
bool awaited_awake(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kStaysAwake;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::yield();
  }
  return true;
}

class WorkerPool {
 public:
  WorkerPool() = default;
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  ~WorkerPool() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void run(std::size_t others, const std::function<void()>& work) {
    Job job{work, others};
    bool wake = false;
    {
      const std::lock_guard lock(mutex_);
      while (threads_.size() < others) threads_.emplace_back([this] { serve(); });
      jobs_.push_back(&job);
      ++posted_;
      wake = sleeping_ > 0;
    }
    if (wake) wake_.notify_all();
    work();
    {
      const std::lock_guard lock(mutex_);
      std::erase(jobs_, &job);
    }
    // Nobody joins any more.
    if (awaited_awake([&] { return job.helpers.load() == 0; })) return;
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return job.helpers.load() == 0; });
  }

 private:
  struct Job {
    const std::function<void()>& work;
    std::size_t places;                   // free ones; under the mutex
    std::atomic<std::size_t> helpers{0};  // changed under the mutex; once 0 after the last, the job is gone
  };

  void serve() {
    for (;;) {
      const std::uint64_t posted = posted_.load();
      if (Job* job = join_one()) {
        job->work();
        {
          const std::lock_guard lock(mutex_);
          --job->helpers;
        }
        done_.notify_all();
        continue;
      }
      const auto news = [&] { return posted_.load() != posted; };
      if (awaited_awake(news)) continue;
      std::unique_lock lock(mutex_);
      ++sleeping_;
      wake_.wait(lock, [&] { return stopping_ || news(); });
      --sleeping_;
      if (stopping_) return;
    }
  }

  Job* join_one() {
    const std::lock_guard lock(mutex_);
    if (jobs_.empty()) return nullptr;
    Job* job = jobs_.front();
    ++job->helpers;
    if (--job->places == 0) jobs_.pop_front();
    return job;
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::deque<Job*> jobs_;                 // with free places
  std::atomic<std::uint64_t> posted_{0};  // jobs so far: says that there may be something new
  std::size_t sleeping_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

void run_with_others(std::size_t others, const std::function<void()>& work) {
  static WorkerPool pool;
  pool.run(others, work);
}

}  // namespace pointreel
