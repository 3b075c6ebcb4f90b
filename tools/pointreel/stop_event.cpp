#include "pointreel/stop_event.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>

namespace pointreel {
namespace {

volatile std::sig_atomic_t signalled_descriptor = -1;

void signal_event(int descriptor) {
  const std::uint64_t one = 1;
  // Fails only when the event is signalled more often than a uint64_t counts.
  [[maybe_unused]] const ssize_t written = ::write(descriptor, &one, sizeof(one));
}

void on_signal(int) {
  const int error_before = errno;
  signal_event(signalled_descriptor);
  errno = error_before;
}

}  // namespace

StopEvent::StopEvent() : descriptor_(::eventfd(0, EFD_CLOEXEC)) {
  signalled_descriptor = descriptor_;
  struct sigaction action {};
  action.sa_handler = on_signal;
  // The sweep at hand is still encoded and written: no call of it may fail because of the signal.
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

StopEvent::~StopEvent() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  ::close(descriptor_);
}

void StopEvent::request() const {
  signal_event(descriptor_);
}

}  // namespace pointreel
