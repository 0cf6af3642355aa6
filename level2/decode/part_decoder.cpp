#include "level2/decode/part_decoder.h"

#include <algorithm>
#include <cstring>
#include <ctime>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bunzip/bunzip.h"
#include "level2/containers/bzip2_stream.h"
#include "level2/decode/fragment_builder.h"
#include "level2/decode/message_reader.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t piece_bytes = std::size_t{256} << 10;
constexpr std::size_t rows_of_a_sweep = 720;
// A compressed record larger than this holds whole sweeps. Records of live volumes are smaller.
constexpr std::size_t large_record_bytes = std::size_t{512} << 10;

void add_record_problem(FragmentBuilder& builder, Severity severity, std::string_view code,
                        std::string message, std::optional<std::uint64_t> offset) {
    builder.report().add(Problem{severity, std::string{code}, std::move(message), offset, 1});
}

void add_record_damage(FragmentBuilder& builder, std::string_view code, const std::string& reason,
                       std::uint64_t offset, std::uint64_t dropped) {
    DecodeReport& report = builder.report_data();
    report.bytes_dropped += dropped;
    if (!report.corruption) report.corruption = {offset, "an LDM record is damaged: " + reason};
    add_record_problem(builder, Severity::error, code,
                       fmt::format("{}; {} bytes dropped", reason, dropped), offset);
}

}  // namespace

double thread_cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Decompresses a record in pieces and reads its messages as they come. The buffer holds only the
// bytes that the reader has not consumed yet. Returns none if the stream is damaged; read_blocks()
// then reads the record again.
std::optional<Fragment> PartDecoder::read_record(const LdmPart& part, ArrayRoom& room,
                                                 Damage& damage) {
    const bool large = part.bytes.size() > large_record_bytes;
    FragmentBuilder builder{room, large ? rows_of_a_sweep : rows_of_a_record, selection_};
    MessageReader reader{builder};
    bunzip::Reader stream{part.bytes, workspace_};
    auto failure = Fragment::Failure::none;
    std::uint64_t output_bytes = 0;
    double cpu_s = 0;
    buffer_.resize(std::max(buffer_.size(), piece_bytes));
    std::size_t held = 0;
    while (failure == Fragment::Failure::none) {
        if (held == buffer_.size()) buffer_.resize(2 * buffer_.size());
        const double begin_s = thread_cpu_s();
        const std::size_t made = stream.read(std::span{buffer_}.subspan(held));
        cpu_s += thread_cpu_s() - begin_s;
        if (stream.status() != bunzip::Status::whole) {
            damage.is_cut = part.cut || stream.status() == bunzip::Status::truncated;
            damage.wasted_bytes = BzipBlocks::waste_of(output_bytes + made);
            return std::nullopt;
        }
        output_bytes += made;
        if (output_bytes > limit_bytes_) failure = Fragment::Failure::too_much_output;
        const std::size_t there = held + made;
        const std::size_t done = reader.read(std::span{buffer_}.first(there), stream.ended());
        if (failure == Fragment::Failure::none) failure = reader.failure();
        held = there - done;
        std::memmove(buffer_.data(), buffer_.data() + done, held);
        if (stream.ended()) break;
    }
    const auto behind = part.bytes.subspan(stream.input_bytes());
    if (part.bad_length || part.cut) {
        add_record_problem(builder, Severity::warning, "bad_control_word", "its length is wrong",
                           reader.offset());
    }
    if (failure == Fragment::Failure::none && !all_zero(behind)) {
        add_record_damage(builder, "not_a_record", "something that is no record follows it",
                          reader.offset(), behind.size());
    }
    Fragment fragment = builder.take();
    fragment.failure = failure;
    fragment.output_bytes += output_bytes;
    fragment.report.decompress_s = cpu_s;
    return fragment;
}

// Reads a damaged record block by block, because each block has its own checksum.
Fragment PartDecoder::read_blocks(const LdmPart& part, ArrayRoom& room, const Damage& damage) {
    FragmentBuilder builder{room, rows_of_a_record, selection_};
    MessageReader reader{builder};
    MessageFeed feed{reader};
    BzipBlocks blocks{part.bytes, workspace_};
    auto failure = Fragment::Failure::none;
    std::uint64_t output_bytes = damage.wasted_bytes;
    bool all_good = true;
    const double begin_s = thread_cpu_s();
    while (failure == Fragment::Failure::none) {
        const std::uint64_t left = limit_bytes_ - std::min(limit_bytes_, output_bytes);
        const auto block = blocks.next(static_cast<std::size_t>(left));
        if (!block) break;
        output_bytes += block->wasted_bytes;
        if (block->status == bunzip::Status::too_large || output_bytes > limit_bytes_) {
            failure = Fragment::Failure::too_much_output;
        } else if (block->status == bunzip::Status::whole) {
            output_bytes += block->data.size();
            feed.append(block->data);
            failure = reader.failure();
        } else {
            all_good = false;
            feed.end();
            add_record_damage(builder, damage.is_cut ? "truncated_record" : "corrupt_record",
                              fmt::format("{} at its byte {}", damage.is_cut ? "cut" : "damaged",
                                          block->position),
                              reader.offset(), block->compressed_bytes);
            reader.lose_sync();
        }
    }
    feed.end();
    if (all_good && !blocks.ended()) {
        add_record_damage(builder, "truncated_record", "cut", reader.offset(), 0);
    }
    Fragment fragment = builder.take();
    fragment.failure = failure;
    fragment.output_bytes += output_bytes;
    fragment.cut = damage.is_cut;
    fragment.report.decompress_s = thread_cpu_s() - begin_s;
    return fragment;
}

Fragment PartDecoder::decode_record(const LdmPart& part, ArrayRoom& room) {
    Damage damage;
    if (auto fragment = read_record(part, room, damage)) return std::move(*fragment);
    room.clear();
    if (room.ask_for_more()) return read_blocks(part, room, damage);
    Fragment fragment;
    fragment.failure = Fragment::Failure::too_large_arrays;
    return fragment;
}

Fragment PartDecoder::decode_kind(const LdmPart& part, ArrayRoom& room) {
    if (part.kind == LdmPart::Kind::record) {
        Fragment fragment = decode_record(part, room);
        fragment.report.ldm_records = 1;
        fragment.report.negative_control_words = part.negative ? 1 : 0;
        return fragment;
    }
    FragmentBuilder builder{room, 0, selection_};
    if (part.kind == LdmPart::Kind::header) {
        builder.further_header(part.header);
        builder.report().add(Severity::note, "further_volume_header",
                             fmt::format("a further volume header, {}", part.header.filename), 0);
    } else if (part.kind == LdmPart::Kind::garbage) {
        builder.report().damage("not_a_record", "no LDM record where one is due", 0,
                                part.bytes.size());
    }
    return builder.take();
}

Fragment PartDecoder::decode(const LdmPart& part, ArrayRoom room) {
    try {
        return decode_kind(part, room);
    } catch (const std::bad_alloc&) {
        Fragment fragment;
        fragment.failure = Fragment::Failure::no_memory;
        return fragment;
    }
}

}  // namespace stormcellar::level2
