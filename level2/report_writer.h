// level2/report_writer.h -- fills in a DecodeReport, and keeps it small whatever the input is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "level2/decode.h"

namespace stormcellar::level2 {

class ReportWriter {
  public:
    static constexpr std::size_t max_problems = 100;

    explicit ReportWriter(DecodeReport& report) : report_(report) {}

    // Beyond max_problems they are counted only; finish() says how many.
    void add(Severity severity, std::string_view code, std::string message,
             std::optional<std::uint64_t> offset = std::nullopt);
    // Bytes that hold nothing usable: an error, and the stream's corruption if it is the first.
    // `stream_offset` is into the message stream; `found_at`, where it differs, the place at which
    // the damage showed.
    void damage(std::string_view code, std::string reason, std::uint64_t stream_offset,
                std::uint64_t dropped, std::optional<std::uint64_t> found_at = std::nullopt);
    void finish();

    [[nodiscard]] DecodeReport& report() { return report_; }

  private:
    DecodeReport& report_;
    std::uint64_t left_out_ = 0;
};

}  // namespace stormcellar::level2
