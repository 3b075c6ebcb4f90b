// Prints how many points of a sweep come back from a reel.
#include <pointreel/io.h>
#include <pointreel/pointreel.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: point_count SWEEP\n";
    return 2;
  }
  const auto sweep = pointreel::read_cloud(argv[1]);
  if (!sweep) {
    std::cerr << sweep.error().message << '\n';
    return 1;
  }
  const auto reel = pointreel::encode({&*sweep, 1});
  if (!reel) {
    std::cerr << reel.error().message << '\n';
    return 1;
  }
  const auto decoded = pointreel::decode(*reel);
  if (!decoded) {
    std::cerr << decoded.error().message << '\n';
    return 1;
  }
  std::cout << decoded->front().cloud.size() << '\n';
}
