#include "codec/field_sections.h"

#include <string>
#include <variant>

#include "base/parallel.h"
#include "codec/sections.h"
#include "fields/field_coding.h"

namespace pointreel {
namespace {

PointLayout layout_of(const PointCells& points) {
  return PointLayout({points.rows, points.columns, points.cell_of_point, points.range_m});
}

FieldValues in_order(const FieldValues& values, std::span<const std::uint32_t> order) {
  return std::visit(
      [&](const auto& all) -> FieldValues {
        std::remove_cvref_t<decltype(all)> ordered;
        ordered.reserve(order.size());
        for (const std::uint32_t i : order) ordered.push_back(all[i]);
        return ordered;
      },
      values);
}

}  // namespace

const FieldStep* FieldSelection::find(std::string_view name) const {
  for (const FieldStep& field : named) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

void encode_fields(const FieldSelection& selection, const PointCloud& cloud,
                   std::span<const std::uint32_t> output_order, const FindPointCells& find_cells, int threads,
                   ByteWriter& writer, FrameStatistics& statistics) {
  struct Chosen {
    const Field* field;
    double step;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Chosen> chosen;
  for (const Field& field : cloud.fields) {
    const FieldStep* named = selection.find(field.name);
    if (named != nullptr || selection.all_others) {
      chosen.push_back({&field, named != nullptr ? named->step : 0, {}});
    }
  }
  put_varint(writer, chosen.size());
  if (chosen.empty()) return;
  const PointLayout layout = layout_of(find_cells());
  parallel_for(chosen.size(), threads, [&](std::size_t i) {
    FieldMemory memory;
    const FieldValues& values = chosen[i].field->values;
    chosen[i].bytes = output_order.empty()
                          ? encode_field(values, chosen[i].step, layout, memory)
                          : encode_field(in_order(values, output_order), chosen[i].step, layout, memory);
  });
  for (const Chosen& part : chosen) {
    const std::string& name = part.field->name;
    put_section(writer, {reinterpret_cast<const std::uint8_t*>(name.data()), name.size()});
    writer.put(static_cast<std::uint8_t>(part.field->values.index()));
    put_section(writer, part.bytes);
    statistics.field_bits += bits_of(part.bytes.size() + name.size() + 3);
  }
}

Result<std::vector<Field>> decode_fields(const FindPointCells& find_cells, int threads, ByteReader& reader) {
  const std::uint64_t count = get_varint(reader);
  if (!reader.ok() || count > kMostFields) return Error{ErrorCode::corrupt, "it ends before its fields"};
  struct Part {
    std::span<const std::uint8_t> name, bytes;
    std::uint8_t type = 0;
  };
  std::vector<Part> parts(static_cast<std::size_t>(count));
  for (Part& part : parts) {
    part.name = get_section(reader);
    part.type = reader.get<std::uint8_t>();
    part.bytes = get_section(reader);
    if (!reader.ok()) return Error{ErrorCode::truncated, "it ends within its fields"};
    if (part.type >= std::variant_size_v<FieldValues>) {
      return Error{ErrorCode::corrupt, "a field has the unknown type " + std::to_string(part.type)};
    }
  }
  std::vector<Field> fields(parts.size());
  if (parts.empty()) return fields;
  const PointLayout layout = layout_of(find_cells());
  std::vector<Result<FieldValues>> values(parts.size(), FieldValues{});
  parallel_for(parts.size(), threads, [&](std::size_t i) {
    FieldMemory memory;
    values[i] = decode_field(parts[i].bytes, parts[i].type, layout, memory);
  });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    fields[i].name.assign(parts[i].name.begin(), parts[i].name.end());
    if (!values[i])
      return Error{values[i].error().code, "field " + fields[i].name + ": " + values[i].error().message};
    fields[i].values = *std::move(values[i]);
  }
  return fields;
}

}  // namespace pointreel
