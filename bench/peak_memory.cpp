#include "peak_memory.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace pointreel {
namespace {

// A line of /proc/self/status in MiB, such as "VmHWM:    1234 kB".
double status_mib(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == name && status >> kib) return kib / 1024;
  }
  return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
  malloc_trim(0);                               // what others have freed and not given back
  std::ofstream("/proc/self/clear_refs") << 5;  // VmHWM starts again from here
  before_mib_ = status_mib("VmRSS:");
}

double PeakMemory::growth_mib() const {
  return std::max(0.0, status_mib("VmHWM:") - before_mib_);
}

}  // namespace pointreel
