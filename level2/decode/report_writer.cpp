#include "level2/decode/report_writer.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

void add_count(std::optional<std::uint64_t>& total, std::optional<std::uint64_t> more) {
    if (more) total = total.value_or(0) + *more;
}

}  // namespace

std::string_view severity_name(Severity severity) {
    constexpr std::array<std::string_view, 3> names = {"note", "warning", "error"};
    return names[static_cast<std::size_t>(severity)];
}

std::string Problem::text() const {
    std::string text =
        ldm_record ? fmt::format("LDM record {}: {}", *ldm_record, message) : message;
    if (dropped_bytes > 0) text += fmt::format("; {} bytes dropped", dropped_bytes);
    if (count > 1) text += fmt::format(" ({} times)", count);
    return text;
}

void ReportWriter::add(Problem problem) {
    if (problem.count > 0) {
        add_counted(std::move(problem));
        return;
    }
    if (problem.severity == Severity::error) ++report_.errors;
    std::vector<Problem>& problems = report_.problems;
    const auto of_one_place = [](const Problem& p) { return p.count == 0; };
    const auto many = std::count_if(problems.begin(), problems.end(), of_one_place);
    if (static_cast<std::size_t>(many) >= DecodeReport::max_problems) {
        ++report_.problems_left_out;
        // Remove the last of the least severe problems to make room.
        auto least = problems.end();
        for (auto p = problems.begin(); p != problems.end(); ++p) {
            if (of_one_place(*p) && (least == problems.end() || p->severity <= least->severity)) {
                least = p;
            }
        }
        if (least->severity >= problem.severity) return;
        problems.erase(least);
    }
    problems.push_back(std::move(problem));
}

// Adds a problem with a count. There is no limit, because there are few kinds of such problems.
void ReportWriter::add_counted(Problem problem) {
    if (problem.severity == Severity::error) report_.errors += problem.count;
    const auto same = [&](const Problem& other) {
        return other.count > 0 && other.severity == problem.severity &&
               other.code == problem.code && other.message == problem.message;
    };
    const auto there = std::ranges::find_if(report_.problems, same);
    if (there == report_.problems.end()) {
        report_.problems.push_back(std::move(problem));
        return;
    }
    there->count += problem.count;
    there->dropped_bytes += problem.dropped_bytes;
}

void ReportWriter::add(Severity severity, std::string_view code, std::string message,
                       std::optional<std::uint64_t> offset) {
    add(Problem{severity, std::string{code}, std::move(message), offset, std::nullopt});
}

void ReportWriter::damage(std::string_view code, std::string reason, std::uint64_t stream_offset,
                          std::uint64_t dropped, std::optional<std::uint64_t> found_at) {
    report_.bytes_dropped += dropped;
    if (!report_.corruption) report_.corruption = {found_at.value_or(stream_offset), reason};
    add(Severity::error, code, fmt::format("{}; {} bytes dropped", reason, dropped), stream_offset);
}

void ReportWriter::oddity(Severity severity, std::string_view code, std::string_view message,
                          std::uint64_t stream_offset) {
    add(Problem{severity, std::string{code}, std::string{message}, stream_offset, {}, 1});
}

void ReportWriter::refuse(std::string_view code, std::string_view reason,
                          std::uint64_t stream_offset, std::uint64_t dropped) {
    report_.bytes_dropped += dropped;
    if (!report_.corruption) report_.corruption = {stream_offset, std::string{reason}};
    add(Problem{
        Severity::error, std::string{code}, std::string{reason}, stream_offset, {}, 1, dropped});
}

void ReportWriter::append(DecodeReport next) {
    const std::uint64_t offset = report_.message_bytes;
    const std::uint64_t errors = report_.errors + next.errors;
    for (Problem& problem : next.problems) {
        if (problem.offset) *problem.offset += offset;
        if (problem.ldm_record) *problem.ldm_record += report_.ldm_records.value_or(0);
        add(std::move(problem));
    }
    report_.errors = errors;
    report_.problems_left_out += next.problems_left_out;
    if (!report_.corruption && next.corruption) {
        report_.corruption = {next.corruption->offset + offset, std::move(next.corruption->reason)};
    }
    add_count(report_.ldm_records, next.ldm_records);
    add_count(report_.negative_control_words, next.negative_control_words);
    if (next.rda_status) report_.rda_status = std::move(next.rda_status);
    report_.message_bytes += next.message_bytes;
    report_.bytes_dropped += next.bytes_dropped;
    report_.decompress_s += next.decompress_s;
    for (const auto& [type, count] : next.message_counts)
        report_.message_counts[type] += count;
    for (const auto& [compression, count] : next.radial_compression)
        report_.radial_compression[compression] += count;
}

void ReportWriter::finish() {
    if (report_.problems_left_out == 0) return;
    report_.problems.push_back(
        {Severity::note, "more_problems",
         fmt::format("{} further problems are not listed", report_.problems_left_out), std::nullopt,
         std::nullopt});
}

}  // namespace stormcellar::level2
