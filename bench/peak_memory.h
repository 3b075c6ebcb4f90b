// How much memory something took at most, on top of what was in use before.
#pragma once

namespace pointreel {

// From its making on, of this whole process. Linux only; 0 elsewhere.
class PeakMemory {
 public:
  PeakMemory();
  double growth_mib() const;

 private:
  double before_mib_ = 0;
};

}  // namespace pointreel
