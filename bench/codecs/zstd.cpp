// zstd on the raw floats.
#include <fmt/format.h>
#include <zstd.h>

#include "codecs/float_positions.h"

namespace pointreel {
namespace {

class Zstd final : public SingleSweepCodec {
 public:
  explicit Zstd(int level) : level_(level) {}

  std::string series() const override { return "zstd"; }
  std::string settings() const override { return fmt::format("-{}", level_); }
  bool keeps_order() const override { return true; }
  bool carries_fields() const override { return true; }

  Result<Bytes> encode_sweep(const PointCloud& sweep) const override {
    const auto raw = bytes_of(sweep.positions);
    Bytes bytes(ZSTD_compressBound(raw.size()));
    const std::size_t size = ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), level_);
    if (ZSTD_isError(size) != 0) return Error{ErrorCode::unsupported, ZSTD_getErrorName(size)};
    bytes.resize(size);
    return bytes;
  }

  Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes) const override {
    const auto size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
      return Error{ErrorCode::corrupt, "not a zstd frame"};
    Bytes raw(size);
    const std::size_t decoded = ZSTD_decompress(raw.data(), raw.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(decoded) != 0) return Error{ErrorCode::corrupt, ZSTD_getErrorName(decoded)};
    return cloud_of_bytes(raw);
  }

 private:
  int level_;
};

const CodecRegistration registration("zstd", [] {
  Codecs codecs;
  for (const int level : {3, 19}) codecs.push_back(std::make_unique<Zstd>(level));
  return codecs;
});

}  // namespace
}  // namespace pointreel
