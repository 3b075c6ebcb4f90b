// Result<T>: a value or an Error. No exception crosses Pointreel's API, and the library never prints.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace pointreel {

enum class ErrorCode : std::uint8_t {
  invalid_argument,  // the caller's option or input value cannot be used
  io_error,          // the operating system refused to open, read or write
  corrupt,           // bytes contradict the format or their checksum
  truncated,         // the bytes end before the format says they do
  unsupported,       // valid, but of a kind or version this build does not handle
  resource_limit,    // would take more memory than a sane input can ask for
};

std::string_view to_string(ErrorCode code);

struct Error {
  ErrorCode code;
  std::string message;  // one sentence naming the file, offset or option
};

// Holds T or Error. Test with `if (result)` before `*result`; `error()` only where the test failed.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return state_.index() == 0; }
  T& operator*() & { return std::get<0>(state_); }
  const T& operator*() const& { return std::get<0>(state_); }
  T&& operator*() && { return std::get<0>(std::move(state_)); }
  T* operator->() { return &std::get<0>(state_); }
  const T* operator->() const { return &std::get<0>(state_); }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

// Success without a value.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : state_(std::move(error)) {}

  explicit operator bool() const { return state_.index() == 0; }
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<std::monostate, Error> state_;
};

}  // namespace pointreel
