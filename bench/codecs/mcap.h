// As much of the MCAP container (mcap.dev/spec) as one message in a file takes.
#pragma once

#include <span>
#include <string>

#include "codecs/codec.h"

namespace pointreel::mcap {

// A file of one message of a ROS 2 topic.
Bytes file_of_message(const std::string& message_type, std::span<const std::uint8_t> message);

// Writers put messages, with what describes them, into chunks that may be compressed. The body of a file's
// only chunk, and a file of nothing else.
Result<Bytes> chunk_of_file(std::span<const std::uint8_t> file);
Bytes file_of_chunk(std::span<const std::uint8_t> chunk);

// The only message in a chunk that is not compressed.
Result<Bytes> message_of_chunk(std::span<const std::uint8_t> chunk);

}  // namespace pointreel::mcap
