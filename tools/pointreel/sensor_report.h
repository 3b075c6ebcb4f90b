// info --sensor: the sensor that sweeps come from, as method mixture sees it.
#pragma once

#include <string>
#include <vector>

namespace pointreel {

struct SensorReportArguments {
  std::vector<std::string> inputs;  // sweeps: files, folders, globs
  bool rows = false;                // a line per row, too
  bool json = false;
};

// An ExitCode. Sweeps of no rotating sensor are no failure: that is then the report.
int report_sensor(const SensorReportArguments& arguments);

}  // namespace pointreel
