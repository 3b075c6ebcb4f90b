#include "codecs/program_codec.h"

#include <algorithm>

namespace pointreel {

Result<void> ProgramRunner::run(const std::vector<std::string>& arguments) {
  const auto kib = run_program(program_, arguments);
  if (!kib) return kib.error();
  peak_kib_ = std::max(peak_kib_, *kib);
  return {};
}

Result<std::vector<Chunk>> ProgramEncoder::encode(const PointCloud& sweep) {
  auto bytes = encode_sweep(sweep, runner_);
  if (!bytes) return bytes.error();
  return std::vector<Chunk>{{*std::move(bytes), 1}};
}

Result<std::vector<PointCloud>> ProgramDecoder::decode(const Chunk& chunk) {
  auto sweep = decode_sweep(chunk.bytes, runner_);
  if (!sweep) return sweep.error();
  return std::vector<PointCloud>{*std::move(sweep)};
}

}  // namespace pointreel
