// Pointreel's own methods behind the bench's interface: the bytes are those of a whole .reel file.
#pragma once

#include <string>
#include <utility>

#include "codecs/codec.h"
#include "pointreel/codec.h"

namespace pointreel {

class ReelCodec final : public Codec {
 public:
  ReelCodec(std::string series, std::string settings, EncoderOptions options)
      : series_(std::move(series)), settings_(std::move(settings)), options_(std::move(options)) {}

  std::string series() const override { return series_; }
  std::string settings() const override { return settings_; }
  bool carries_fields() const override;
  int threads(const DriveContext& drive) const override { return drive.threads; }
  // Only the paper's grid is given poses: the others find the motion themselves.
  std::unique_ptr<SweepEncoder> encoder(const DriveContext& drive) const override;
  std::unique_ptr<SweepDecoder> decoder(const DriveContext& drive) const override;

 private:
  std::string series_, settings_;
  EncoderOptions options_;
};

}  // namespace pointreel
