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

    // Adds a problem. Beyond DecodeReport::max_problems, drops the last of the least severe
    // problems and counts it in problems_left_out.
    void add(Problem problem);
    void add(Severity severity, std::string_view code, std::string message,
             std::optional<std::uint64_t> offset = std::nullopt);
    // Reports bytes that hold nothing usable, as an error. The first such error becomes
    // DecodeReport::corruption. `stream_offset` counts in the message stream; `found_at` is the
    // offset at which the damage was noticed, if that differs.
    void damage(std::string_view code, std::string reason, std::uint64_t stream_offset,
                std::uint64_t dropped, std::optional<std::uint64_t> found_at = std::nullopt);
    // Reports something odd about a message that loses no data. Equal oddities become one problem
    // with a count.
    void oddity(Severity severity, std::string_view code, std::string_view message,
                std::uint64_t stream_offset);
    // Reports a dropped message, or a dropped part of a message, as an error. Calls with the same
    // code and reason become one problem with a count. The first error becomes
    // DecodeReport::corruption, as in damage().
    void refuse(std::string_view code, std::string_view reason, std::uint64_t stream_offset,
                std::uint64_t dropped);
    // Appends the report of the next part of the stream: adds its counts, and shifts its offsets
    // and record numbers behind the present ones.
    void append(DecodeReport next);
    // Adds a note with the number of problems that are not listed, if there are any.
    void finish();

  private:
    void add_counted(Problem problem);

    DecodeReport& report_;
};

}  // namespace stormcellar::level2
