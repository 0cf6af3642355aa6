// level2/decode/report_writer.h -- fills in a DecodeReport, and keeps it small whatever the input
// is.
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

    // Beyond DecodeReport::max_problems the last of the least severity are counted only.
    void add(Problem problem);
    void add(Severity severity, std::string_view code, std::string message,
             std::optional<std::uint64_t> offset = std::nullopt);
    // Bytes that hold nothing usable: an error, and the stream's corruption if it is the first.
    // `stream_offset` is into the message stream; `found_at`, where it differs, the place at which
    // the damage showed.
    void damage(std::string_view code, std::string reason, std::uint64_t stream_offset,
                std::uint64_t dropped, std::optional<std::uint64_t> found_at = std::nullopt);
    // Something that is odd about a message, of which nothing is lost for it: each kind is one
    // problem, with a count.
    void oddity(Severity severity, std::string_view code, std::string_view message,
                std::uint64_t stream_offset);
    // As damage(), of a message or a part of one, for a reason that many may have: each is one
    // problem, with a count.
    void refuse(std::string_view code, std::string_view reason, std::uint64_t stream_offset,
                std::uint64_t dropped);
    // The report of what follows in the stream: counts are added, offsets and record numbers go on.
    void append(DecodeReport next);
    // Says how many problems are not listed.
    void finish();

  private:
    void add_counted(Problem problem);

    DecodeReport& report_;
};

}  // namespace stormcellar::level2
