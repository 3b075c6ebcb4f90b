#include "codecs/video_coder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <cstring>

namespace pointreel {
namespace {

constexpr int kSweepsPerKeyFrame = 30;
// All frames have one size, wider than the first image: later sweeps may have a twelfth more columns.
constexpr int kSpareColumnsShare = 6;

struct Free {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using Context = std::unique_ptr<AVCodecContext, Free>;
using Frame = std::unique_ptr<AVFrame, Free>;
using PacketPointer = std::unique_ptr<AVPacket, Free>;

AVPixelFormat pixel_format(int bits) {
  return bits == 12 ? AV_PIX_FMT_GRAY12 : AV_PIX_FMT_GRAY10;
}

Error failure(const std::string& what, int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return {ErrorCode::unsupported, what + ": " + text.data()};
}

Result<Context> open_encoder(const VideoSettings& settings, int columns, int rows, int threads) {
  const AVCodec* codec = avcodec_find_encoder_by_name(settings.encoder.c_str());
  if (codec == nullptr) return Error{ErrorCode::unsupported, "libavcodec has no " + settings.encoder};
  Context context(avcodec_alloc_context3(codec));
  context->width = columns;
  context->height = rows;
  context->pix_fmt = pixel_format(settings.bits);
  context->time_base = {1, 10};
  context->gop_size = kSweepsPerKeyFrame;
  context->thread_count = threads;
  for (const auto& [name, value] : settings.options)
    av_opt_set(context.get(), name.c_str(), value.c_str(), AV_OPT_SEARCH_CHILDREN);
  if (const int code = avcodec_open2(context.get(), codec, nullptr); code < 0)
    return failure(settings.encoder + " cannot be opened", code);
  return context;
}

class VideoEncoder final : public ImageEncoder {
 public:
  VideoEncoder(VideoSettings settings, int threads) : settings_(std::move(settings)), threads_(threads) {}

  Result<std::vector<Bytes>> encode(const LevelImage& image) override {
    if (!context_) {
      const int columns = (image.columns + image.columns / kSpareColumnsShare + 15) / 16 * 16;
      auto context = open_encoder(settings_, columns, image.rows, threads_);
      if (!context) return context.error();
      context_ = *std::move(context);
    }
    if (image.columns > context_->width || image.rows != context_->height)
      return Error{ErrorCode::unsupported, "a sweep has many more columns than the first"};
    const Frame frame(av_frame_alloc());
    frame->width = context_->width;
    frame->height = context_->height;
    frame->format = context_->pix_fmt;
    frame->pts = next_pts_++;
    if (const int code = av_frame_get_buffer(frame.get(), 0); code < 0) return failure("no frame", code);
    const auto columns = static_cast<std::size_t>(image.columns);
    const auto width = static_cast<std::size_t>(frame->width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(image.rows); ++row) {
      auto* line = reinterpret_cast<std::uint16_t*>(frame->data[0] +
                                                    row * static_cast<std::size_t>(frame->linesize[0]));
      std::copy_n(&image.level[row * columns], columns, line);
      std::fill(line + columns, line + width, line[columns - 1]);
    }
    return packets_after(frame.get());
  }

  Result<std::vector<Bytes>> finish() override { return packets_after(nullptr); }

 private:
  Result<std::vector<Bytes>> packets_after(const AVFrame* frame) {
    std::vector<Bytes> packets;
    if (!context_) return packets;
    if (const int code = avcodec_send_frame(context_.get(), frame); code < 0)
      return failure(settings_.encoder + " refused a frame", code);
    const PacketPointer packet(av_packet_alloc());
    while (avcodec_receive_packet(context_.get(), packet.get()) >= 0) {
      packets.emplace_back(packet->data, packet->data + packet->size);
      av_packet_unref(packet.get());
    }
    return packets;
  }

  VideoSettings settings_;
  int threads_;
  Context context_;
  std::int64_t next_pts_ = 0;
};

class VideoDecoder final : public ImageDecoder {
 public:
  VideoDecoder(const VideoSettings& settings, int threads) : name_(settings.decoder) {
    const AVCodec* codec = avcodec_find_decoder_by_name(name_.c_str());
    context_.reset(avcodec_alloc_context3(codec));
    context_->thread_count = threads;
    open_code_ = avcodec_open2(context_.get(), codec, nullptr);
  }

  Result<std::vector<LevelImage>> decode(std::span<const std::uint8_t> bytes) override {
    // libavcodec reads a little past the end.
    const PacketPointer packet(av_packet_alloc());
    if (open_code_ < 0) return failure(name_ + " cannot be opened", open_code_);
    if (const int code = av_new_packet(packet.get(), static_cast<int>(bytes.size())); code < 0)
      return failure("no packet", code);
    std::memcpy(packet->data, bytes.data(), bytes.size());
    return images_after(packet.get());
  }

  Result<std::vector<LevelImage>> finish() override { return images_after(nullptr); }

 private:
  Result<std::vector<LevelImage>> images_after(const AVPacket* packet) {
    if (const int code = avcodec_send_packet(context_.get(), packet); code < 0)
      return failure(name_ + " refused a packet", code);
    std::vector<LevelImage> images;
    const Frame frame(av_frame_alloc());
    while (avcodec_receive_frame(context_.get(), frame.get()) >= 0) {
      LevelImage image{frame->height, frame->width, {}};
      const auto columns = static_cast<std::size_t>(image.columns);
      image.level.resize(static_cast<std::size_t>(image.rows) * columns);
      for (std::size_t row = 0; row < static_cast<std::size_t>(image.rows); ++row) {
        std::memcpy(&image.level[row * columns],
                    frame->data[0] + row * static_cast<std::size_t>(frame->linesize[0]),
                    columns * sizeof(std::uint16_t));
      }
      images.push_back(std::move(image));
    }
    return images;
  }

  std::string name_;
  Context context_;
  int open_code_ = 0;
};

}  // namespace

bool can_encode(const VideoSettings& settings) {
  const AVCodec* codec = avcodec_find_encoder_by_name(settings.encoder.c_str());
  if (codec == nullptr || codec->pix_fmts == nullptr) return false;
  for (const AVPixelFormat* format = codec->pix_fmts; *format != AV_PIX_FMT_NONE; ++format) {
    if (*format == pixel_format(settings.bits)) return true;
  }
  return false;
}

ImageCoder video_coder(const VideoSettings& settings) {
  av_log_set_level(AV_LOG_ERROR);
  return {settings.name, settings.text,
          [settings](int threads) { return std::make_unique<VideoEncoder>(settings, threads); },
          [settings](int threads) { return std::make_unique<VideoDecoder>(settings, threads); }, true};
}

}  // namespace pointreel
