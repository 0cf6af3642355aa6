#include "level2/report_writer.h"

#include <fmt/format.h>

namespace stormcellar::level2 {

std::string_view severity_name(Severity severity) {
    switch (severity) {
        case Severity::note:
            return "note";
        case Severity::warning:
            return "warning";
        case Severity::error:
            break;
    }
    return "error";
}

void ReportWriter::add(Severity severity, std::string_view code, std::string message,
                       std::optional<std::uint64_t> offset) {
    if (report_.problems.size() >= max_problems) {
        ++left_out_;
        return;
    }
    report_.problems.push_back({severity, std::string{code}, std::move(message), offset});
}

void ReportWriter::damage(std::string_view code, std::string reason, std::uint64_t stream_offset,
                          std::uint64_t dropped, std::optional<std::uint64_t> found_at) {
    report_.bytes_dropped += dropped;
    if (!report_.corruption) report_.corruption = {found_at.value_or(stream_offset), reason};
    add(Severity::error, code, fmt::format("{}; {} bytes dropped", reason, dropped), stream_offset);
}

void ReportWriter::finish() {
    if (left_out_ == 0) return;
    report_.problems.push_back({Severity::note, "more_problems",
                                fmt::format("{} further problems are not listed", left_out_),
                                std::nullopt});
    left_out_ = 0;
}

}  // namespace stormcellar::level2
