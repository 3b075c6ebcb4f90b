#include "pointreel/encode_live.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "common/stopwatch.h"
#include "pointreel/console.h"
#include "pointreel/encode_report.h"
#include "pointreel/exit_code.h"
#include "pointreel/field_choice.h"
#include "pointreel/folder_watch.h"
#include "pointreel/reel_output.h"
#include "pointreel/stop_event.h"
#include "pointreel/sweep_stream.h"

namespace pointreel {
namespace {

// What becomes of arriving sweeps: packets in the output, and totals.
class LiveEncode {
 public:
  LiveEncode(const EncodeArguments& arguments, const FieldSelection& fields, Encoder& encoder)
      : arguments_(arguments), fields_(fields), encoder_(encoder) {}

  // An error ends the encoding: of the output, or of a field that was asked for and is not there.
  Result<void> take(ArrivedSweep sweep) {
    if (!sweep.cloud) {
      leave_out(sweep.cloud.error());
      return {};
    }
    if (!output_) {
      if (auto begun = begin(sweep); !begun) return begun;
    }
    const Stopwatch start;
    const auto packets = encoder_.encode(*std::move(sweep.cloud));
    pending_ms_ += start.elapsed_ms();
    if (!packets) {
      leave_out({packets.error().code, sweep.name + ": " + packets.error().message});
      return {};
    }
    arrivals_[taken_count_++] = sweep.arrived;
    return write(*packets);
  }

  Result<void> finish() {
    if (!output_) return {};
    const Stopwatch start;
    const auto packets = encoder_.finish();
    pending_ms_ += start.elapsed_ms();
    if (!packets) {
      leave_out(packets.error());
    } else if (auto written = write(*packets); !written) {
      return written;
    }
    auto finished = output_->writer().finish();
    totals_.bytes = output_->writer().bytes_written();
    return finished;
  }

  EncodeTotals& totals() { return totals_; }
  bool left_some_out() const { return left_some_out_; }

 private:
  // Not before there is a sweep: an existing output is given up only for a new one.
  Result<void> begin(const ArrivedSweep& sweep) {
    if (auto chosen = require_fields(fields_, *sweep.cloud, sweep.name); !chosen) return chosen;
    auto output = ReelOutput::open(arguments_.output, encoder_.header());
    if (!output) return output.error();
    output_ = *std::move(output);
    for (const Field& field : sweep.cloud->fields) totals_.fields.push_back(field.name);
    return {};
  }

  Result<void> write(const std::vector<Packet>& packets) {
    for (const Packet& packet : packets) {
      if (auto written = output_->writer().write(packet); !written) return written;
      const auto now = ArrivalClock::now();
      totals_.add(packet);
      totals_.bytes = output_->writer().bytes_written();
      totals_.ms_per_frame.push_back(pending_ms_ / static_cast<double>(packets.size()));
      const auto arrival = arrivals_.extract(packet.frame);
      if (arrival && arrival.mapped()) {
        const std::chrono::duration<double, std::milli> latency = now - *arrival.mapped();
        totals_.latency_ms.push_back(latency.count());
      }
    }
    if (!packets.empty()) pending_ms_ = 0;
    return {};
  }

  void leave_out(const Error& error) {
    print_error(error);
    left_some_out_ = true;
  }

  const EncodeArguments& arguments_;
  const FieldSelection& fields_;
  Encoder& encoder_;
  std::unique_ptr<ReelOutput> output_;
  EncodeTotals totals_;
  std::map<std::uint32_t, std::optional<ArrivalClock::time_point>>
      arrivals_;  // of frames without a packet yet
  std::uint32_t taken_count_ = 0;
  double pending_ms_ = 0;
  bool left_some_out_ = false;
};

Result<std::unique_ptr<SweepSource>> open_source(const EncodeArguments& arguments, const StopEvent& stop) {
  if (!arguments.follow) return std::unique_ptr<SweepSource>(std::make_unique<SweepStream>(stop));
  auto folder = FolderWatch::create(arguments.inputs.front(), arguments.idle_s, stop);
  if (!folder) return folder.error();
  return std::unique_ptr<SweepSource>(*std::move(folder));
}

}  // namespace

int encode_live(const EncodeArguments& arguments, const EncoderOptions& options, Encoder& encoder) {
  const StopEvent stop;
  const auto source = open_source(arguments, stop);
  if (!source) {
    print_error(source.error());
    return kFailed;
  }
  const Stopwatch start;
  LiveEncode live(arguments, options.mixture.fields, encoder);
  Result<void> good;
  while (auto sweep = (*source)->next()) {
    good = live.take(*std::move(sweep));
    if (!good) break;
  }
  if (good) good = live.finish();
  if (!good) print_error(good.error());
  EncodeTotals& totals = live.totals();
  if (totals.frames == 0) {
    if (good && !live.left_some_out())
      print_error({ErrorCode::invalid_argument, arguments.inputs.front() + ": no sweep came"});
    return kFailed;
  }
  totals.live = true;
  totals.wall_s = start.elapsed_ms() / 1000;
  print_report(totals, encoder.header(), options.mixture.fields, arguments.output, arguments.json);
  return good && !live.left_some_out() ? kDone : kDataLoss;
}

}  // namespace pointreel
