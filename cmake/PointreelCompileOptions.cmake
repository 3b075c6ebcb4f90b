# One place for the flags that every target of this project is built with.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

add_library(pointreel_options INTERFACE)
target_compile_features(pointreel_options INTERFACE cxx_std_20)
# -ffp-contract=off: decoding must give the same bits on every processor, so no fused multiply-add.
# -fno-math-errno, -fno-trapping-math: no result changes, but square roots and selections become SIMD code.
target_compile_options(pointreel_options INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math -Wall -Wextra -Wpedantic -Wshadow
                                                   -Wconversion -Wno-sign-conversion -Werror)

set(POINTREEL_SANITIZE "" CACHE STRING "Comma-separated sanitizers: address,undefined or thread")
if(POINTREEL_SANITIZE)
  target_compile_options(pointreel_options INTERFACE -fsanitize=${POINTREEL_SANITIZE} -fno-sanitize-recover=all
                                                     -fno-omit-frame-pointer)
  target_link_options(pointreel_options INTERFACE -fsanitize=${POINTREEL_SANITIZE})
endif()

option(POINTREEL_COVERAGE "Instrument for gcov" OFF)
if(POINTREEL_COVERAGE)
  target_compile_options(pointreel_options INTERFACE --coverage)
  target_link_options(pointreel_options INTERFACE --coverage)
endif()
