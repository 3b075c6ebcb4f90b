#include "pointreel/result.h"

namespace pointreel {

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_argument:
      return "invalid argument";
    case ErrorCode::io_error:
      return "I/O error";
    case ErrorCode::corrupt:
      return "corrupt data";
    case ErrorCode::truncated:
      return "truncated data";
    case ErrorCode::unsupported:
      return "unsupported";
    case ErrorCode::resource_limit:
      return "resource limit";
  }
  return "unknown error";
}

}  // namespace pointreel
