// Prints the digest of all that a reel decodes to, by every SIMD path of this build that the processor has:
// they must agree.
#include <cstdio>
#include <fstream>

#include "support/simd_paths.h"
#include "support/sweep_digest.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: decode_digest FILE.reel\n");
    return 2;
  }
  std::string first;
  bool agree = true;
  pointreel::for_each_simd_path([&](const char* path) {
    std::ifstream stream(argv[1], std::ios::binary);
    const auto digest = pointreel::digest_of_reel(stream, argv[1]);
    const std::string now = digest ? *digest : digest.error().message + "\n";
    if (first.empty()) {
      first = now;
      std::fputs(now.c_str(), stdout);
    } else if (now != first) {
      std::fprintf(stderr, "%s decodes to something else:\n%s", path, now.c_str());
      agree = false;
    }
  });
  return agree ? 0 : 1;
}
