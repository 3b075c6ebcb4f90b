// PhaseBank: many phases turned side by side, each by its own step, to see where they agree.
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <experimental/simd>
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
    Floats re = 0;
    Floats im = 0;
    for (Block& b : blocks_) {
      re += b.re;
      im += b.im;
      const Floats next = b.re * b.step_re - b.im * b.step_im;
      b.im = b.re * b.step_im + b.im * b.step_re;
      b.re = next;
    }
    return {std::experimental::reduce(re), std::experimental::reduce(im)};
  }

 private:
  using Floats = std::experimental::native_simd<float>;
  static constexpr std::size_t kLanes = Floats::size();
  struct Block {
    Floats re = 0, im = 0, step_re = 0, step_im = 0;
  };
  std::vector<Block> blocks_;
  std::size_t size_ = 0;
};

}  // namespace pointreel
