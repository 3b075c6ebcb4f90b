// What codecs that are programs have in common: a sweep by itself, a process each way.
#pragma once

#include "codecs/program.h"

namespace pointreel {

// Runs one program, any number of times, in a folder of its own.
class ProgramRunner {
 public:
  explicit ProgramRunner(std::filesystem::path program) : program_(std::move(program)) {}
  Result<void> run(const std::vector<std::string>& arguments);
  std::string file(const std::string& name) const { return folder_ / name; }
  std::size_t peak_kib() const { return peak_kib_; }

 private:
  std::filesystem::path program_;
  ScratchFolder folder_;
  std::size_t peak_kib_ = 0;
};

class ProgramEncoder : public SweepEncoder {
 public:
  explicit ProgramEncoder(std::filesystem::path program) : runner_(std::move(program)) {}
  Result<std::vector<Chunk>> encode(const PointCloud& sweep) final;
  std::size_t program_peak_kib() const final { return runner_.peak_kib(); }

 private:
  virtual Result<Bytes> encode_sweep(const PointCloud& sweep, ProgramRunner& runner) = 0;
  ProgramRunner runner_;
};

class ProgramDecoder : public SweepDecoder {
 public:
  explicit ProgramDecoder(std::filesystem::path program) : runner_(std::move(program)) {}
  Result<std::vector<PointCloud>> decode(const Chunk& chunk) final;
  std::size_t program_peak_kib() const final { return runner_.peak_kib(); }

 private:
  virtual Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes, ProgramRunner& runner) = 0;
  ProgramRunner runner_;
};

}  // namespace pointreel
