// xz (LZMA) on the raw floats.
#include <lzma.h>

#include "base/bytes.h"
#include "codecs/float_positions.h"

namespace pointreel {
namespace {

class Xz final : public SingleSweepCodec {
 public:
  std::string series() const override { return "xz"; }
  std::string settings() const override { return "-9e"; }
  bool keeps_order() const override { return true; }
  bool carries_fields() const override { return true; }

  Result<Bytes> encode_sweep(const PointCloud& sweep) const override {
    const auto raw = bytes_of(sweep.positions);
    ByteWriter writer;
    writer.put<std::uint32_t>(static_cast<std::uint32_t>(raw.size()));
    Bytes bytes(lzma_stream_buffer_bound(raw.size()));
    std::size_t size = 0;
    if (lzma_easy_buffer_encode(9 | LZMA_PRESET_EXTREME, LZMA_CHECK_CRC32, nullptr, raw.data(), raw.size(),
                                bytes.data(), &size, bytes.size()) != LZMA_OK)
      return Error{ErrorCode::unsupported, "lzma_easy_buffer_encode failed"};
    writer.put(std::span(bytes).first(size));
    return writer.take();
  }

  Result<PointCloud> decode_sweep(std::span<const std::uint8_t> bytes) const override {
    ByteReader reader(bytes);
    Bytes raw(reader.get<std::uint32_t>());
    const auto packed = reader.rest();
    std::uint64_t memory_limit = UINT64_MAX;
    std::size_t in = 0, out = 0;
    if (lzma_stream_buffer_decode(&memory_limit, 0, nullptr, packed.data(), &in, packed.size(), raw.data(),
                                  &out, raw.size()) != LZMA_OK)
      return Error{ErrorCode::corrupt, "not an xz stream"};
    return cloud_of_bytes(raw);
  }
};

const CodecRegistration registration("xz", [] {
  Codecs codecs;
  codecs.push_back(std::make_unique<Xz>());
  return codecs;
});

}  // namespace
}  // namespace pointreel
