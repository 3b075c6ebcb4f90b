// Reels of method `mixture` made to hurt: each value valid by itself.
#include "base/bytes.h"
#include "codec/mixture_payload.h"
#include "codec/sections.h"
#include "sensor/sensor_coding.h"
#include "survival.h"

namespace pointreel {
namespace {

Packet key_packet(std::vector<std::uint8_t> payload, std::uint32_t points) {
  Packet packet;
  packet.points_in = packet.points_out = points;
  packet.payload = std::move(payload);
  return packet;
}

Outcome survive_payload(const std::vector<std::uint8_t>& payload, std::uint32_t points) {
  return survive(reel_of(header_of(mixture_sample(0.02)), {key_packet(payload, points)}));
}

// A sensor model and a grid, then `fill` for all that is range coded.
std::vector<std::uint8_t> gridded_payload(std::size_t rows, std::size_t columns, std::uint8_t fill) {
  SensorModel model;
  for (std::size_t row = 0; row < rows; ++row) {
    model.rows.push_back(rounded({0.1 - 0.01 * static_cast<double>(row), 0.1, 0, 0}));
    model.row_sequence.push_back(static_cast<std::uint16_t>(row));
  }
  model.ticks_per_turn = 65536;
  SweepGrid grid;
  grid.ticks_per_turn = model.ticks_per_turn;
  for (std::size_t column = 0; column < columns; ++column) {
    grid.column_tick.push_back(static_cast<std::uint32_t>(column));
  }
  ByteWriter writer;
  writer.put(SweepCoding::gridded_model);
  put_section(writer, encode_sensor_model(model));
  put_section(writer, encode_sweep_grid(model, grid));
  writer.put(0.04F);
  writer.put(std::uint8_t{0});
  for (int section = 0; section < 300; ++section) put_section(writer, std::vector<std::uint8_t>(40, fill));
  return writer.take();
}

TEST(CraftedMixture, GridsOfEverySize) {
  for (const int fill : {0x00, 0x55, 0xFF}) {
    for (const std::size_t rows : {0u, 1u, 8u, 512u}) {
      for (const std::size_t columns : {0u, 1u, 2u, 32768u}) {
        SCOPED_TRACE(std::to_string(rows) + " x " + std::to_string(columns));
        for (const std::uint32_t points : {0u, 1u, 1u << 23}) {
          survive_payload(gridded_payload(rows, columns, static_cast<std::uint8_t>(fill)), points);
        }
      }
    }
  }
}

TEST(CraftedMixture, ThePacketOfNoColumnsIsRefused) {
  EXPECT_EQ(survive_payload(gridded_payload(8, 0, 0), 0).errors, 1u);
}

TEST(CraftedMixture, OneByteAgainAndAgain) {
  for (std::uint8_t coding = 0; coding <= 3; ++coding) {
    for (const int fill : {0x00, 0x01, 0x55, 0x7F, 0x80, 0xFE, 0xFF}) {
      for (const std::uint32_t points : {0u, 1u, 1u << 23, 0xFFFFFFFFu}) {
        std::vector<std::uint8_t> payload(500, static_cast<std::uint8_t>(fill));
        payload[0] = coding;
        survive_payload(payload, points);
      }
    }
  }
}

}  // namespace
}  // namespace pointreel
