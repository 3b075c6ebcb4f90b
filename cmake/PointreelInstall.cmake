# `cmake --install`: library, headers, tool, CMake package and pkg-config file.
