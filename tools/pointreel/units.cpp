#include "pointreel/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>

namespace pointreel {
namespace {

struct Unit {
  std::string_view name;
  double factor;
};

Result<double> parse_quantity(std::string_view text, std::span<const Unit> units, std::string_view what) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view suffix = text.substr(static_cast<std::size_t>(end - text.data()));
  if (error == std::errc{} && std::isfinite(value)) {
    for (const Unit& unit : units) {
      if (suffix == unit.name) return value * unit.factor;
    }
  }
  std::string names;
  for (const Unit& unit : units) {
    if (!unit.name.empty()) names += fmt::format("{}{}", names.empty() ? "" : ", ", unit.name);
  }
  return Error{ErrorCode::invalid_argument,
               fmt::format("'{}' is not {} (a number, then one of: {})", text, what, names)};
}

}  // namespace

Result<double> parse_length_m(std::string_view text) {
  static constexpr std::array<Unit, 4> kUnits = {{{"", 1}, {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}}};
  return parse_quantity(text, kUnits, "a length");
}

Result<double> parse_angle_rad(std::string_view text) {
  static constexpr double kRadiansPerDegree = std::numbers::pi / 180;
  static constexpr std::array<Unit, 3> kUnits = {
      {{"", kRadiansPerDegree}, {"deg", kRadiansPerDegree}, {"rad", 1}}};
  return parse_quantity(text, kUnits, "an angle");
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

std::string format_bytes(double bytes) {
  if (bytes < 1e3) return fmt::format("{:.0f} B", bytes);
  if (bytes < 1e6) return fmt::format("{:.1f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.2f} MB", bytes / 1e6);
  return fmt::format("{:.2f} GB", bytes / 1e9);
}

}  // namespace pointreel
