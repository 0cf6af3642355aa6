#include "stormcellar/level2/decode.h"

#include <algorithm>
#include <functional>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "level2/containers/archive_header.h"
#include "level2/containers/bzip2_stream.h"
#include "level2/containers/compress_stream.h"
#include "level2/containers/content.h"
#include "level2/containers/gzip_stream.h"
#include "level2/decode/message_reader.h"
#include "level2/decode/record_plan.h"
#include "level2/decode/record_queue.h"
#include "level2/decode/volume_builder.h"
#include "level2/foreign/foreign.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

constexpr int most_layers = 4;  // gzip around bzip2 around gzip ...

// The output of a compressed layer: either messages, which are read at once, or another layer,
// which is held until it is complete.
struct LayerOutput {
    LayerOutput(std::uint64_t limit_bytes, const Selection& selection)
        : room(limit_bytes), builder(room, rows_of_a_stretch, selection) {}
    ArrayRoom room;
    FragmentBuilder builder;
    MessageReader reader{builder};
    MessageFeed feed{reader};
    std::vector<std::byte> inner;
    bool first = true;
    bool messages = false;
};

class Decoder {
  public:
    explicit Decoder(const DecodeOptions& options) : options_(options) {}
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    Result<Decoded> run(std::span<const std::byte> bytes);

  private:
    // The read functions return an error only if nothing can be kept, because a limit is exceeded
    // or the content is not Level II.
    Status read_layer(std::span<const std::byte> bytes, int depth);
    // Reads all pieces of a stream.
    template <class Stream>
    Status take_all(Stream& stream, LayerOutput& output);
    Status read_gzip(std::span<const std::byte> bytes, int depth);
    Status read_compress(std::span<const std::byte> bytes, int depth);
    Status read_bzip2(std::span<const std::byte> bytes, int depth);
    Status read_ldm(std::span<const std::byte> bytes);
    Result<bool> read_parts(const RecordQueue::Source& source,
                            const std::function<bool(const Fragment&)>& check);
    Status read_messages(std::span<const std::byte> bytes);
    // Reads a file of another format. Its volume is the whole result.
    Status read_foreign(std::span<const std::byte> bytes);
    Status take_output(LayerOutput& output, std::span<const std::byte> piece);
    Status end_output(LayerOutput& output, int depth);
    // Appends the messages read so far to the volume.
    Status flush(LayerOutput& output);
    void report_container(const LayerOutput& output, Severity severity, std::string_view code,
                          std::string message, std::uint64_t position);
    void report_gzip_end(const GzipStream& gzip, const LayerOutput& output);

    const DecodeOptions& options_;
    VolumeBuilder builder_{options_.output_limit_bytes, options_.most_array_bytes()};
    std::optional<Decoded> foreign_;
};

Status Decoder::flush(LayerOutput& output) {
    const Fragment::Failure failure = output.reader.failure();
    std::optional<Fragment> fragment = output.reader.take_fragment();
    if (!fragment) {
        if (failure == Fragment::Failure::none) return {};
        fragment.emplace();
    }
    fragment->failure = failure;
    Status taken = builder_.append(std::move(*fragment));
    output.room.set_limit(builder_.arrays_left());
    return taken;
}

// Recognizes the content by its bytes and reads it. For a compressed layer, the called functions
// call this function again with the content.
Status Decoder::read_layer(std::span<const std::byte> bytes, int depth) {
    if (depth == most_layers) {
        return fail(ErrorCode::unsupported, "has more than {} layers of compression",
                    most_layers - 1);
    }
    std::string& container = builder_.report_data().container;
    if (is_foreign(bytes)) return read_foreign(bytes);
    switch (content_anywhere(bytes)) {
        case Content::gzip:
            container += "gzip+";
            return read_gzip(bytes, depth);
        case Content::bzip2:
            container += "bzip2-whole-file+";
            return read_bzip2(bytes, depth);
        case Content::compress:
            container += "compress+";
            return read_compress(bytes, depth);
        case Content::ldm:
            container += "ldm-bzip2";
            return read_ldm(builder_.begin_stream(bytes));
        case Content::messages:
            container += "uncompressed";
            return read_messages(builder_.begin_stream(bytes));
        case Content::unknown:
            break;
    }
    if (read_archive_header(bytes)) {
        // There are too few bytes to recognize the content.
        if (bytes.size() < archive_header_bytes + message_header_bytes) {
            return fail(ErrorCode::truncated, "holds a volume header and almost nothing else");
        }
        return fail(ErrorCode::corrupt, "holds a volume header and no readable message");
    }
    return fail(ErrorCode::not_level2, "{}not a Level II file",
                depth == 0 ? "" : "what it holds, decompressed, is ");
}

Status Decoder::read_foreign(std::span<const std::byte> bytes) {
    auto decoded = decode_foreign(bytes, options_.selection, options_.most_array_bytes(),
                                  options_.fallback_station);
    if (!decoded) return pass_on(decoded);
    decoded->report.container.insert(0, builder_.report_data().container);
    foreign_ = std::move(*decoded);
    return {};
}

Status Decoder::read_messages(std::span<const std::byte> bytes) {
    LayerOutput output{builder_.arrays_left(), options_.selection};
    for (std::size_t at = 0; at < bytes.size(); at += stretch_bytes) {
        output.feed.append(bytes.subspan(at, std::min(stretch_bytes, bytes.size() - at)));
        if (Status flushed = flush(output); !flushed) return flushed;
    }
    output.feed.end();
    return flush(output);
}

// Takes a piece of the output of a compressed layer. If the first piece begins with messages, every
// piece is read at once. Otherwise the output is another layer, whose pieces are collected first.
Status Decoder::take_output(LayerOutput& output, std::span<const std::byte> piece) {
    if (Status counted = builder_.count_output(piece.size()); !counted) return counted;
    if (std::exchange(output.first, false)) {
        output.messages = content_at_start(piece) == Content::messages;
        if (output.messages) {
            builder_.report_data().container += "uncompressed";
            piece = builder_.begin_stream(piece);
        }
    }
    if (output.messages) {
        output.feed.append(piece);
        return flush(output);
    }
    if (output.inner.size() + piece.size() > most_packed_bytes) {
        return fail(ErrorCode::not_level2, "holds more than {} bytes that are not messages",
                    most_packed_bytes);
    }
    if (Status held = builder_.hold(piece.size()); !held) return held;
    output.inner.insert(output.inner.end(), piece.begin(), piece.end());
    return {};
}

Status Decoder::end_output(LayerOutput& output, int depth) {
    if (output.messages) {
        output.feed.end();
        return flush(output);
    }
    if (output.inner.empty()) {
        return fail(builder_.is_cut() ? ErrorCode::truncated : ErrorCode::corrupt,
                    "is a compressed file of which no part is intact");
    }
    return read_layer(output.inner, depth + 1);
}

template <class Stream>
Status Decoder::take_all(Stream& stream, LayerOutput& output) {
    for (;;) {
        const double begin_s = thread_cpu_s();
        const std::span<const std::byte> piece = stream.next();
        builder_.report_data().decompress_s += thread_cpu_s() - begin_s;
        if (piece.empty()) return {};
        if (Status taken = take_output(output, piece); !taken) return taken;
    }
}

// Reports a damaged container. From the reader's position on, its messages are wrong or missing.
void Decoder::report_container(const LayerOutput& output, Severity severity, std::string_view code,
                               std::string message, std::uint64_t position) {
    DecodeReport& report = builder_.report_data();
    if (severity == Severity::error && !report.corruption) {
        report.corruption = {report.message_bytes + output.reader.offset(), message};
    }
    builder_.report().add(severity, code, std::move(message), position);
}

Status Decoder::read_gzip(std::span<const std::byte> bytes, int depth) {
    GzipStream gzip{bytes};
    LayerOutput output{builder_.arrays_left(), options_.selection};
    if (Status taken = take_all(gzip, output); !taken) return taken;
    report_gzip_end(gzip, output);
    return end_output(output, depth);
}

Status Decoder::read_compress(std::span<const std::byte> bytes, int depth) {
    CompressStream stream{bytes};
    LayerOutput output{builder_.arrays_left(), options_.selection};
    if (Status taken = take_all(stream, output); !taken) return taken;
    if (stream.end() != CompressEnd::whole) {
        if (stream.end() == CompressEnd::truncated) builder_.set_cut();
        report_container(output, Severity::error, "corrupt_compress", "the .Z file is damaged",
                         stream.position());
    }
    return end_output(output, depth);
}

void Decoder::report_gzip_end(const GzipStream& gzip, const LayerOutput& output) {
    const std::uint64_t position = gzip.position();
    switch (gzip.end()) {
        case GzipEnd::none:
        case GzipEnd::whole:
            return;
        case GzipEnd::truncated:
            builder_.set_cut();
            report_container(output, Severity::error, "truncated_gzip", "the gzip file is cut",
                             position);
            return;
        case GzipEnd::corrupt:
            report_container(output, Severity::error, "corrupt_gzip", "the gzip file is damaged",
                             position);
            return;
        case GzipEnd::bad_checksum:
            builder_.set_incomplete();
            report_container(output, Severity::error, "gzip_checksum",
                             "the gzip file contradicts its checksum", position);
            return;
        case GzipEnd::trailing_garbage:
            report_container(output, Severity::warning, "gzip_trailer",
                             "something else follows the end of the gzip data", position);
            return;
    }
}

// Reads, block by block, a file that bzip2 compressed as a whole. Each block has its own checksum.
// After a damaged block, the reader must search for the next message.
Status Decoder::read_bzip2(std::span<const std::byte> bytes, int depth) {
    bunzip::Workspace workspace;
    BzipBlocks blocks{bytes, workspace};
    LayerOutput output{builder_.arrays_left(), options_.selection};
    for (;;) {
        const double begin_s = thread_cpu_s();
        const auto block = blocks.next(static_cast<std::size_t>(builder_.output_left()));
        builder_.report_data().decompress_s += thread_cpu_s() - begin_s;
        if (!block) break;
        if (Status counted = builder_.count_output(block->wasted_bytes); !counted) return counted;
        if (block->status == bunzip::Status::too_large) {
            return builder_.too_much_output();
        }
        if (block->status == bunzip::Status::whole) {
            if (Status taken = take_output(output, block->data); !taken) return taken;
            continue;
        }
        output.feed.end();
        output.builder.report().damage(
            "corrupt_bzip2", fmt::format("a bzip2 block at byte {} is damaged", block->position),
            output.reader.offset(), block->compressed_bytes);
        output.reader.lose_sync();
    }
    if (Status flushed = flush(output); !flushed) return flushed;
    if (!blocks.ended()) {
        builder_.set_cut();
        report_container(output, Severity::error, "truncated_bzip2", "the bzip2 file is cut",
                         bytes.size());
    }
    return end_output(output, depth);
}

// Decodes the parts of the source in order. Returns false if `check` rejects a fragment; the caller
// must then discard the builder, except for its decompress_s.
Result<bool> Decoder::read_parts(const RecordQueue::Source& source,
                                 const std::function<bool(const Fragment&)>& check) {
    RecordQueue queue{source, options_.threads, options_.output_limit_bytes, options_.selection};
    while (auto fragment = queue.next(builder_.arrays_left())) {
        if (!check(*fragment)) {
            builder_.report_data().decompress_s += fragment->report.decompress_s;
            return false;
        }
        if (Status taken = builder_.append(std::move(*fragment)); !taken) return pass_on(taken);
    }
    return true;
}

// Reads a file of LDM records. If only some cuts are selected, first tries a plan that skips the
// records of other cuts. If the file does not follow the plan, the state of the builder from before
// the plan is restored.
Status Decoder::read_ldm(std::span<const std::byte> bytes) {
    builder_.report_data().ldm_records = 0;
    builder_.report_data().negative_control_words = 0;
    if (!options_.selection.all_cuts()) {
        if (auto plan = RecordPlan::make(bytes, options_.selection)) {
            const VolumeBuilder before = builder_;
            const auto done = read_parts([&] { return plan->next(); },
                                         [&](const Fragment& f) { return plan->agrees(f); });
            if (!done) return pass_on(done);
            if (*done) {
                plan->report(builder_.report_data());
                return {};
            }
            // The file does not follow its pattern, so read all of it. The time spent on the plan
            // still counts.
            const double spent_s = builder_.report_data().decompress_s;
            builder_ = before;
            builder_.report_data().decompress_s = spent_s;
        }
    }
    LdmFramer framer{bytes};
    const auto done =
        read_parts([&] { return framer.next(); }, [](const Fragment&) { return true; });
    if (!done) return pass_on(done);
    return {};
}

Result<Decoded> Decoder::run(std::span<const std::byte> bytes) {
    if (bytes.empty()) return fail(ErrorCode::empty, "the file is empty");
    if (Status read = read_layer(bytes, 0); !read) return pass_on(read);
    if (foreign_) return std::move(*foreign_);
    return builder_.finish(options_.fallback_station);
}

}  // namespace

Result<Decoded> decode(std::span<const std::byte> bytes, const DecodeOptions& options) {
    try {
        Decoder decoder{options};
        return decoder.run(bytes);
    } catch (const std::bad_alloc&) {
        return no_memory();
    }
}

Result<Decoded> decode_file(const std::filesystem::path& path, const DecodeOptions& options) {
    const auto bytes = read_file(path);
    if (!bytes) return pass_on(bytes);
    DecodeOptions with_station = options;
    if (with_station.fallback_station.empty()) {
        with_station.fallback_station = station_in_name(path.filename().string());
    }
    auto decoded = decode(*bytes, with_station);
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", path.string(), decoded.error().message);
    }
    return decoded;
}

}  // namespace stormcellar::level2
