// level2/decode/report_writer.h -- fills in a DecodeReport, and keeps it small whatever the input.
//
// Threads   One thread at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/level2/decode_report.h"

namespace stormcellar::level2 {

class ReportWriter {
  public:
    explicit ReportWriter(DecodeReport& report) : report_(report) {}

    // Adds a problem. Beyond DecodeReport::max_problems, the last of the least severe problems are
    // only counted.
    void add(Problem problem);
    void add(Severity severity, std::string_view code, std::string message,
             std::optional<std::uint64_t> offset = std::nullopt);
    // Reports bytes that hold nothing usable. This is an error; the first such error is the
    // stream's corruption. `stream_offset` counts in the message stream; `found_at`, if it differs,
    // is the place at which the damage became visible.
    void damage(std::string_view code, std::string reason, std::uint64_t stream_offset,
                std::uint64_t dropped, std::optional<std::uint64_t> found_at = std::nullopt);
    // Reports something odd about a message that costs no data. Each kind is one problem with a
    // count.
    void oddity(Severity severity, std::string_view code, std::string_view message,
                std::uint64_t stream_offset);
    // Does the same as damage() for a message, or a part of one, for a reason that many messages
    // may share. Each reason is one problem with a count.
    void refuse(std::string_view code, std::string_view reason, std::uint64_t stream_offset,
                std::uint64_t dropped);
    // Appends the report of the next part of the stream. Counts are added, and offsets and record
    // numbers continue.
    void append(DecodeReport next);
    // Reports how many problems are not listed.
    void finish();

  private:
    void add_counted(Problem problem);

    DecodeReport& report_;
};

}  // namespace stormcellar::level2
