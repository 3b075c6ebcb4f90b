// PhaseBank: many phases turned side by side, each by its own step, to see where they agree.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

namespace pointreel {

class PhaseBank {
 public:
  void add(double phase_rad, double step_rad, float weight = 1) {
    const std::size_t lane = size_ % kLanes;
    if (lane == 0) blocks_.emplace_back();
    Block& block = blocks_.back();
    block.re[lane] = static_cast<float>(std::cos(phase_rad)) * weight;
    block.im[lane] = static_cast<float>(std::sin(phase_rad)) * weight;
    block.step_re[lane] = static_cast<float>(std::cos(step_rad));
    block.step_im[lane] = static_cast<float>(std::sin(step_rad));
    ++size_;
  }
  std::size_t size() const { return size_; }
  void clear() {
    blocks_.clear();
    size_ = 0;
  }

  // The sum of all; then each takes its step. Floats drift: by 1e-4 in a thousand steps.
  std::complex<float> sum_and_turn() {
    float re[kLanes] = {};
    float im[kLanes] = {};
    for (Block& b : blocks_) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        re[k] += b.re[k];
        im[k] += b.im[k];
        const float next = b.re[k] * b.step_re[k] - b.im[k] * b.step_im[k];
        b.im[k] = b.re[k] * b.step_im[k] + b.im[k] * b.step_re[k];
        b.re[k] = next;
      }
    }
    std::complex<float> sum;
    for (std::size_t k = 0; k < kLanes; ++k) sum += std::complex<float>(re[k], im[k]);
    return sum;
  }

 private:
  static constexpr std::size_t kLanes = 8;
  struct Block {
    float re[kLanes] = {}, im[kLanes] = {}, step_re[kLanes] = {}, step_im[kLanes] = {};
  };
  std::vector<Block> blocks_;
  std::size_t size_ = 0;
};

}  // namespace pointreel
