// Sweeps that appear in a folder, each taken once it is complete.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "pointreel/stop_event.h"
#include "pointreel/sweep_source.h"

namespace pointreel {

// Complete is a file that its writer has closed, renamed to its name or linked, or, if it was there before,
// that has been left alone for a second. Sweeps come in natural order of names (2.bin before 10.bin): one
// that is still being written holds up those behind it. A thread of its own watches, so that times of arrival
// are right while a sweep is encoded.
class FolderWatch final : public SweepSource {
 public:
  // Ends when `stop` is requested or, if given, `idle` seconds after a file last appeared or was completed;
  // what is complete then is still given. Errors: io_error for what is no folder or cannot be watched.
  static Result<std::unique_ptr<FolderWatch>> create(const std::filesystem::path& folder,
                                                     std::optional<double> idle_s, const StopEvent& stop);
  ~FolderWatch() override;
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;
  std::optional<ArrivedSweep> next() override;

 private:
  struct File {
    bool complete = false;
    std::optional<ArrivalClock::time_point> arrived;
    // Of a file that was there before: how it was, and since when.
    bool settles = false;
    std::filesystem::file_time_type written{};
    ArrivalClock::time_point unchanged_since{};
  };
  struct NaturalOrder {
    bool operator()(const std::string& a, const std::string& b) const;
  };

  FolderWatch(std::filesystem::path folder, std::optional<double> idle_s, const StopEvent& stop, int inotify);
  void watch();
  bool take_events();
  void take_event(std::uint32_t mask, const std::string& name);
  void take_what_is_there();
  void look_at_settling();
  bool any_settles();

  const std::filesystem::path folder_;
  const std::optional<double> idle_s_;
  const StopEvent& stop_;
  const int inotify_;
  std::set<std::string> seen_;  // by the watching thread
  std::mutex mutex_;            // guards what follows
  std::condition_variable changed_;
  std::map<std::string, File, NaturalOrder> files_;  // not given yet
  ArrivalClock::time_point last_change_;
  bool ended_ = false;
  std::jthread thread_;
};

}  // namespace pointreel
