// Prints how many bytes a fixed simulated corpus takes under various settings: the lines of sizes.csv.
#include <cstdio>
#include <string>
#include <vector>

#include "pointreel/codec.h"
#include "pointreel/simulator.h"

namespace pointreel {
namespace {

constexpr int kSweeps = 4;

struct Corpus {
  const char* name;
  std::vector<PointCloud> sweeps;
  std::vector<Pose> poses;
};

Corpus corpus(const char* name, SensorKind sensor) {
  SimulatorOptions options;
  options.sensor = sensor;
  Simulator simulator(options);
  Corpus corpus{name, {}, {}};
  for (int i = 0; i < kSweeps; ++i) {
    auto sweep = simulator.next_sweep();
    corpus.sweeps.push_back(std::move(sweep.cloud));
    corpus.poses.push_back(sweep.T_world_sensor);
  }
  return corpus;
}

struct Setting {
  const char* name;
  EncoderOptions options;
};

std::vector<Setting> settings() {
  std::vector<Setting> settings;
  const auto add = [&](const char* name, const auto& change) {
    Setting setting{name, {}};
    setting.options.mixture.fields.all_others = false;
    change(setting.options);
    settings.push_back(setting);
  };
  add("mixture 2cm", [](EncoderOptions&) {});
  add("mixture 2cm fields", [](EncoderOptions& o) { o.mixture.fields.all_others = true; });
  add("mixture 2cm no-temporal", [](EncoderOptions& o) { o.mixture.temporal = false; });
  add("mixture 2cm fast", [](EncoderOptions& o) { o.mixture.effort = Effort::fast; });
  add("mixture 2cm max", [](EncoderOptions& o) { o.mixture.effort = Effort::max; });
  add("mixture 1mm", [](EncoderOptions& o) { o.mixture.max_error_m = 0.001; });
  add("mixture 20cm", [](EncoderOptions& o) { o.mixture.max_error_m = 0.2; });
  add("planes sensor 10cm", [](EncoderOptions& o) {
    o.method = Method::planes;
    o.mixture.max_error_m = 0.1;
  });
  add("planes uniform 0.1", [](EncoderOptions& o) {
    o.method = Method::planes;
    o.planes.grid = PlaneGrid::uniform;
  });
  return settings;
}

// Of all payloads; negative: the encoder refused.
long long bytes_of(const Corpus& corpus, const EncoderOptions& options) {
  auto encoder = Encoder::create(options);
  if (!encoder) return -1;
  long long bytes = 0;
  const auto count = [&](const Result<std::vector<Packet>>& packets) {
    if (!packets) return false;
    for (const Packet& packet : *packets) bytes += static_cast<long long>(packet.payload.size());
    return true;
  };
  for (std::size_t i = 0; i < corpus.sweeps.size(); ++i) {
    // On the sensor's grid the motion is found.
    const bool with_pose = options.method == Method::planes && options.planes.grid == PlaneGrid::uniform;
    if (!count(encoder->encode(corpus.sweeps[i], with_pose ? std::optional(corpus.poses[i]) : std::nullopt)))
      return -1;
  }
  return count(encoder->finish()) ? bytes : -1;
}

}  // namespace
}  // namespace pointreel

int main() {
  using namespace pointreel;
  std::printf("corpus,setting,bytes\n");
  for (const Corpus& corpus :
       {corpus("hdl-64e", SensorKind::hdl_64e), corpus("vlp-16", SensorKind::vlp_16)}) {
    std::size_t points = 0;
    for (const PointCloud& sweep : corpus.sweeps) points += sweep.size();
    std::printf("%s,points,%zu\n", corpus.name, points);
    for (const Setting& setting : settings())
      std::printf("%s,%s,%lld\n", corpus.name, setting.name, bytes_of(corpus, setting.options));
  }
}
