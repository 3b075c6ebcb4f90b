#include "codecs/codec.h"

#include <algorithm>
#include <sstream>

namespace pointreel {
namespace {

std::vector<CodecFamily>& registered() {
  static std::vector<CodecFamily> families;
  return families;
}

class SingleSweepEncoder final : public SweepEncoder {
 public:
  explicit SingleSweepEncoder(const SingleSweepCodec& codec) : codec_(codec) {}
  Result<std::vector<Chunk>> encode(const PointCloud& sweep) override {
    auto bytes = codec_.encode_sweep(sweep);
    if (!bytes) return bytes.error();
    return std::vector<Chunk>{{*std::move(bytes), 1}};
  }

 private:
  const SingleSweepCodec& codec_;
};

class SingleSweepDecoder final : public SweepDecoder {
 public:
  explicit SingleSweepDecoder(const SingleSweepCodec& codec) : codec_(codec) {}
  Result<std::vector<PointCloud>> decode(const Chunk& chunk) override {
    auto cloud = codec_.decode_sweep(chunk.bytes);
    if (!cloud) return cloud.error();
    return std::vector<PointCloud>{*std::move(cloud)};
  }
  bool order_kept() const override { return codec_.keeps_order(); }

 private:
  const SingleSweepCodec& codec_;
};

// "name:package name:package ...", from CMake.
std::vector<CodecFamily> families_not_built() {
  std::vector<CodecFamily> families;
  std::istringstream list(POINTREEL_CODECS_NOT_BUILT);
  for (std::string entry; list >> entry;) {
    const std::size_t colon = entry.find(':');
    const Error error{ErrorCode::unsupported, "built without " + entry.substr(colon + 1)};
    families.push_back({entry.substr(0, colon), [error]() -> Result<Codecs> { return error; }});
  }
  return families;
}

}  // namespace

CodecRegistration::CodecRegistration(std::string name, std::function<Result<Codecs>()> settings) {
  registered().push_back({std::move(name), std::move(settings)});
}

std::vector<CodecFamily> codec_families() {
  std::vector<CodecFamily> families = registered();
  std::sort(families.begin(), families.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  for (CodecFamily& family : families_not_built()) families.push_back(std::move(family));
  return families;
}

std::unique_ptr<SweepEncoder> SingleSweepCodec::encoder(const DriveContext&) const {
  return std::make_unique<SingleSweepEncoder>(*this);
}

std::unique_ptr<SweepDecoder> SingleSweepCodec::decoder(const DriveContext&) const {
  return std::make_unique<SingleSweepDecoder>(*this);
}

}  // namespace pointreel
