#include "pointreel/field_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace pointreel {
namespace {

Error not_a_field(std::string_view item) {
  return {ErrorCode::invalid_argument,
          fmt::format("'{}' is not all, none, NAME or NAME:STEP with a STEP of 0 or more", item)};
}

std::optional<double> parse_step(std::string_view text) {
  double step = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(step) || step < 0) return {};
  return step;
}

}  // namespace

Result<FieldSelection> parse_field_selection(std::string_view text) {
  FieldSelection selection;
  selection.all_others = false;
  if (text == "none") return selection;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view item = text.substr(begin, end - begin);
    begin = end + 1;
    if (item == "all") {
      selection.all_others = true;
      continue;
    }
    if (item == "none") {
      return Error{ErrorCode::invalid_argument, fmt::format("'{}': none stands alone", text)};
    }
    const std::size_t colon = item.rfind(':');
    const auto step = colon == std::string_view::npos ? 0 : parse_step(item.substr(colon + 1));
    FieldStep field{std::string(item.substr(0, colon)), step.value_or(0)};
    if (field.name.empty() || !step) return not_a_field(item);
    if (selection.find(field.name) != nullptr) {
      return Error{ErrorCode::invalid_argument, fmt::format("'{}' is named twice", field.name)};
    }
    selection.named.push_back(std::move(field));
  }
  return selection;
}

Result<void> require_fields(const FieldSelection& selection, const PointCloud& cloud,
                            const std::string& file) {
  for (const FieldStep& field : selection.named) {
    if (cloud.find_field(field.name) != nullptr) continue;
    std::vector<std::string_view> names;
    for (const Field& present : cloud.fields) names.push_back(present.name);
    return Error{ErrorCode::invalid_argument,
                 fmt::format("--fields: {} has no field {} (it has {})", file, field.name,
                             names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")))};
  }
  return {};
}

std::string describe_field(const FieldSelection& selection, std::string_view name) {
  const FieldStep* named = selection.find(name);
  return named == nullptr || named->step == 0 ? fmt::format("{} (exact)", name)
                                              : fmt::format("{} (within {:g})", name, named->step);
}

bool keeps(const FieldSelection& selection, std::string_view name) {
  return selection.all_others || selection.find(name) != nullptr;
}

}  // namespace pointreel
