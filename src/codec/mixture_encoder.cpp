// The sensor's grid, methods `mixture` and `planes`: prepare (codec/sweep_preparation.h) -> find planes ->
// predict and code the cells -> order and verify the points -> fields -> packet.
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "codec/field_sections.h"
#include "codec/grid_points.h"
#include "codec/gridded_geometry.h"
#include "codec/method.h"
#include "codec/mixture_payload.h"
#include "codec/sections.h"
#include "codec/sweep_preparation.h"
#include "codec/wire.h"
#include "scatter/scattered_points.h"
#include "sensor/sensor_coding.h"

namespace pointreel {
namespace {

class MixtureEncoder final : public Encoder::Implementation {
 public:
  MixtureEncoder(const StreamHeader& header, const MixtureOptions& options, int threads)
      : header_(header), fields_(options.fields), threads_(threads), preparation_(header, options, threads) {}

  const StreamHeader& header() const override { return header_; }

  Packets encode(PosedSweep sweep) override {
    auto coded = code_cells(preparation_.prepare(std::move(sweep)), {});
    return finish_packet(std::move(coded));
  }

  // Three sweeps at once: where the bands of one leave a thread free, the next is prepared, the points of the
  // one before are coded, and the one after the next is fetched.
  void encode_all(const NextSweep& next, const TakePackets& take) override {
    if (threads_ == 1) return Encoder::Implementation::encode_all(next, take);
    std::optional<PosedSweep> fetched = next();
    std::optional<Result<PreparedSweep>> prepared;
    std::optional<Result<CodedSweep>> coded;
    bool wanted = true;
    while (wanted && (fetched || prepared || coded)) {
      const bool more = fetched.has_value();
      auto to_prepare = std::exchange(fetched, std::nullopt);
      auto to_code = std::exchange(prepared, std::nullopt);
      auto to_finish = std::exchange(coded, std::nullopt);
      const std::array<std::function<void()>, 3> others = {
          [&] {
            if (more) prepared = preparation_.prepare(*std::move(to_prepare));
          },
          [&] {
            if (to_finish) wanted = take(finish_packet(*std::move(to_finish)));
          },
          [&] {
            if (more) fetched = next();
          }};
      if (to_code)
        coded = code_cells(*std::move(to_code), others);
      else
        run_all(threads_, others);
    }
  }

  Packets finish() override { return std::vector<Packet>{}; }

 private:
  struct CodedSweep {
    PreparedSweep prepared;
    EncodedCells cells;  // of a sweep with a grid
  };

  Result<CodedSweep> code_cells(Result<PreparedSweep> prepared, BesideTasks beside) {
    if (!prepared || !prepared->model) {
      run_all(threads_, beside);
      if (!prepared) return prepared.error();
      return CodedSweep{*std::move(prepared), {}};
    }
    CodedSweep coded{*std::move(prepared), {}};
    PreparedSweep& sweep = coded.prepared;
    const auto prediction =
        sweep.motion ? std::optional(Prediction{last_image_.reference, last_image_.planes, *sweep.motion})
                     : std::nullopt;
    coded.cells =
        encode_cells(geometry_setting(header_, *sweep.model, threads_, warp_memory_, beside), sweep.gridded,
                     *sweep.cells, prediction ? &*prediction : nullptr, sweep.packet.statistics);
    if (sweep.is_reference) last_image_ = std::move(coded.cells.image);
    return coded;
  }

  // Points, fields and the packet.
  Packets finish_packet(Result<CodedSweep> coded) {
    if (!coded) return coded.error();
    PreparedSweep& sweep = coded->prepared;
    const EncodedCells& cells = coded->cells;
    Packet& packet = sweep.packet;
    ByteWriter writer;
    EncodedPoints encoded;
    if (sweep.model) {
      if (packet.kind == FrameKind::key) {
        put_model(*sweep.model, writer, packet.statistics);
      } else {
        writer.put(sweep.motion ? SweepCoding::predicted : SweepCoding::gridded);
      }
      encoded =
          encode_points({*sweep.model, header_.max_error_m, threads_}, sweep.cloud, std::move(sweep.gridded),
                        *sweep.cells, cells, sweep.bursts, writer, packet.statistics);
    } else {
      encoded = encode_scattered_sweep(sweep.cloud, writer, packet.statistics);
    }
    const auto find_cells = [&] {
      return sweep.model ? point_cells(sweep.cells->coding, encoded.points, cells.range_of_cell_m, threads_)
                         : points_without_cells(sweep.cloud.size());
    };
    encode_fields(fields_, sweep.cloud, encoded.output_order, find_cells, threads_, writer,
                  packet.statistics);
    packet.payload = writer.take();
    std::vector<Packet> packets;
    packets.push_back(std::move(packet));
    return packets;
  }

  static void put_model(const SensorModel& model, ByteWriter& writer, FrameStatistics& statistics) {
    const auto bytes = encode_sensor_model(model);
    writer.put(SweepCoding::gridded_model);
    put_section(writer, bytes);
    statistics.model_bits += bits_of(bytes.size());
  }

  EncodedPoints encode_scattered_sweep(const PointCloud& cloud, ByteWriter& writer,
                                       FrameStatistics& statistics) const {
    writer.put(SweepCoding::scattered);
    auto points = encode_scattered(cloud.positions, header_.max_error_m);
    put_section(writer, points.bytes);
    statistics.scattered_bits += bits_of(points.bytes.size());
    EncodedPoints encoded;
    encoded.output_order = std::move(points.order);
    return encoded;
  }

  StreamHeader header_;
  FieldSelection fields_;
  int threads_;
  SweepPreparation preparation_;
  CodedImage last_image_;  // of the last sweep that may be predicted from
  WarpMemory warp_memory_;
};

}  // namespace

Result<std::unique_ptr<Encoder::Implementation>> make_mixture_encoder(const EncoderOptions& options,
                                                                      const Runtime& runtime) {
  StreamHeader header;
  header.method = options.method;
  header.max_error_m = options.mixture.max_error_m;
  header.group = options.mixture.group;
  header.effort = options.mixture.effort;
  header.planes.grid = PlaneGrid::sensor;
  if (const auto valid = validate(header); !valid) return valid.error();
  for (const FieldStep& field : options.mixture.fields.named) {
    if (!(field.step >= 0 && field.step <= 1e300)) {
      return Error{ErrorCode::invalid_argument, "fields: the step of " + field.name + " must be 0 or more"};
    }
  }
  return std::unique_ptr<Encoder::Implementation>(
      std::make_unique<MixtureEncoder>(header, options.mixture, resolve_threads(runtime.threads)));
}

}  // namespace pointreel
