// Prints how many points a sweep has.
#include <pointreel/io.h>
#include <pointreel/point_cloud.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: point_count SWEEP\n";
    return 2;
  }
  const pointreel::Result<pointreel::PointCloud> sweep = pointreel::read_cloud(argv[1]);
  if (!sweep) {
    std::cerr << sweep.error().message << '\n';
    return 1;
  }
  std::cout << sweep->size() << '\n';
}
