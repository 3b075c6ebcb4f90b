// A Result that must be an Error.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "pointreel/result.h"

namespace pointreel {

// Checks the code and that the message holds every one of `parts`, such as "poses.txt:2:".
template <class T>
void expect_error(const Result<T>& result, ErrorCode code, std::initializer_list<std::string> parts) {
  ASSERT_FALSE(result);
  EXPECT_EQ(to_string(result.error().code), to_string(code)) << result.error().message;
  for (const std::string& part : parts) {
    EXPECT_NE(result.error().message.find(part), std::string::npos)
        << "no '" << part << "' in: " << result.error().message;
  }
}

template <class T>
void expect_error(const Result<T>& result, ErrorCode code, const std::string& part) {
  expect_error(result, code, {part});
}

}  // namespace pointreel
