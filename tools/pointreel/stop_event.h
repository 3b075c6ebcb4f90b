// The wish to end a live encode: SIGINT (Ctrl-C), SIGTERM, or the program itself.
#pragma once

namespace pointreel {

class StopEvent {
 public:
  // From now on the first SIGINT or SIGTERM is such a wish; a second one ends the process as usual. One
  // object at a time.
  StopEvent();
  ~StopEvent();
  StopEvent(const StopEvent&) = delete;
  StopEvent& operator=(const StopEvent&) = delete;

  void request() const;
  int descriptor() const { return descriptor_; }  // for poll(): readable from the first request on

 private:
  int descriptor_;
};

}  // namespace pointreel
