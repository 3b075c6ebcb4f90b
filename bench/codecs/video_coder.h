// Range images as the frames of a grey video, through libavcodec.
#pragma once

#include <map>
#include <string>

#include "codecs/image_codec.h"

namespace pointreel {

struct VideoSettings {
  std::string name;                            // "H.264"
  std::string encoder;                         // libavcodec's name, "libx264"
  std::string decoder;                         // "h264"
  int bits = 10;                               // of a pixel
  std::map<std::string, std::string> options;  // of the encoder
  std::string text;                            // what settings() says
};

// False where libavcodec was built without the encoder or its pixels.
bool can_encode(const VideoSettings& settings);

ImageCoder video_coder(const VideoSettings& settings);

}  // namespace pointreel
