// A benchmark that cannot read its input has nothing left to do: errors become exceptions that main() prints.
#pragma once

#include <stdexcept>
#include <utility>

#include "pointreel/result.h"

namespace pointreel {

template <class T>
T require(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

inline void require(const Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

}  // namespace pointreel
