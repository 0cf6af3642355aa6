#include "level2/decode.h"

#include <new>
#include <utility>

#include <fmt/format.h>

#include "base/file_system.h"
#include "base/station_table.h"
#include "level2/archive_header.h"
#include "level2/bzip2_stream.h"
#include "level2/compress_stream.h"
#include "level2/content.h"
#include "level2/gzip_stream.h"
#include "level2/message_reader.h"
#include "level2/record_queue.h"
#include "level2/report_writer.h"
#include "level2/sweep_builder.h"

namespace stormcellar::level2 {
namespace {

constexpr int most_layers = 4;  // gzip around bzip2 around gzip ...
// Something compressed inside something compressed is held whole; no volume comes near this.
constexpr std::size_t inner_limit_bytes = std::size_t{256} << 20;
// A volume has some hundreds.
constexpr std::uint64_t most_records = 100'000;

// One decode, from the outermost layer inwards.
class Decoder {
  public:
    explicit Decoder(const DecodeOptions& options) : options_(options) {}
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    Result<Decoded> run(std::span<const std::byte> bytes);

  private:
    // What comes out of a compressed layer: messages, read at once, or something to peel further,
    // which is held until it is whole.
    struct LayerOutput {
        explicit LayerOutput(MessageReader& reader) : feed(reader) {}
        MessageFeed feed;
        std::vector<std::byte> inner;
        bool first = true;
        bool messages = false;
    };
    // Each gives an error only where nothing can be kept: limits, and content of another kind.
    Status read_layer(std::span<const std::byte> bytes, int depth);
    // Everything that a stream of pieces gives.
    template <class Stream>
    Status take_all(Stream& stream, LayerOutput& output);
    Status read_gzip(std::span<const std::byte> bytes, int depth);
    Status read_compress(std::span<const std::byte> bytes, int depth);
    Status read_bzip2(std::span<const std::byte> bytes, int depth);
    Status read_ldm(std::span<const std::byte> bytes);
    Status read_record(const RecordQueue::Item& item);
    Status read_record_blocks(const RecordQueue::Item& item);
    std::span<const std::byte> strip_header(std::span<const std::byte> bytes);
    Status take_output(LayerOutput& output, std::span<const std::byte> piece);
    Status end_output(LayerOutput& output, int depth);
    Status next_block(BzipBlocks& blocks, std::optional<BzipBlocks::Block>& block);
    void report_gzip_end(const GzipStream& gzip);
    void report_part(const LdmPart& part);
    Status count_output(std::size_t bytes);
    Status check_arrays() const;
    Result<Decoded> finish();
    void report_position(const Volume& volume);
    void report_time(const Volume& volume);
    void report_end(const Volume& volume);
    [[nodiscard]] std::size_t output_left() const {
        return static_cast<std::size_t>(options_.output_limit_bytes - produced_bytes_);
    }

    const DecodeOptions& options_;
    DecodeReport report_data_;
    ReportWriter report_{report_data_};
    SweepBuilder builder_{options_.output_limit_bytes};
    MessageReader reader_{builder_, report_};
    std::optional<VolumeHeader> header_;
    std::uint64_t produced_bytes_ = 0;
    bool cut_ = false;  // the input ends too early
};

Status Decoder::count_output(std::size_t bytes) {
    if (bytes > output_left()) {
        return fail(ErrorCode::unsupported, "decompresses to more than the limit of {} bytes",
                    options_.output_limit_bytes);
    }
    produced_bytes_ += bytes;
    return {};
}

Status Decoder::check_arrays() const {
    if (!reader_.full()) return {};
    return fail(ErrorCode::unsupported, "its arrays take more than the limit of {} bytes",
                options_.output_limit_bytes);
}

std::span<const std::byte> Decoder::strip_header(std::span<const std::byte> bytes) {
    auto header = read_archive_header(bytes);
    if (!header) {
        report_.add(Severity::note, "no_volume_header", "no 24-byte volume header");
        return bytes;
    }
    header_ = std::move(*header);
    return bytes.subspan(archive_header_bytes);
}

Status Decoder::read_layer(std::span<const std::byte> bytes, int depth) {
    if (depth == most_layers) {
        return fail(ErrorCode::unsupported, "more than {} layers of compression", most_layers - 1);
    }
    switch (content_anywhere(bytes)) {
        case Content::gzip:
            report_data_.container += "gzip+";
            return read_gzip(bytes, depth);
        case Content::bzip2:
            report_data_.container += "bzip2-whole-file+";
            return read_bzip2(bytes, depth);
        case Content::compress:
            report_data_.container += "compress+";
            return read_compress(bytes, depth);
        case Content::ldm:
            report_data_.container += "ldm-bzip2";
            return read_ldm(strip_header(bytes));
        case Content::messages:
            report_data_.container += "uncompressed";
            reader_.read(strip_header(bytes), true);
            return check_arrays();
        case Content::unknown:
            break;
    }
    if (read_archive_header(bytes)) {
        // Too short to know what it begins.
        if (bytes.size() < archive_header_bytes + message_header_bytes) {
            return fail(ErrorCode::truncated, "holds a volume header and next to nothing else");
        }
        return fail(ErrorCode::corrupt, "holds a volume header and no readable message");
    }
    return fail(ErrorCode::not_level2, "{}not a Level II file",
                depth == 0 ? "" : "what it holds, decompressed, is ");
}

Status Decoder::take_output(LayerOutput& output, std::span<const std::byte> piece) {
    if (Status counted = count_output(piece.size()); !counted) return counted;
    if (std::exchange(output.first, false)) {
        output.messages = content_at_start(piece) == Content::messages;
        if (output.messages) {
            report_data_.container += "uncompressed";
            piece = strip_header(piece);
        }
    }
    if (output.messages) {
        output.feed.append(piece);
        return check_arrays();
    }
    if (output.inner.size() + piece.size() > inner_limit_bytes) {
        return fail(ErrorCode::not_level2, "holds more than {} bytes that are not messages",
                    inner_limit_bytes);
    }
    output.inner.insert(output.inner.end(), piece.begin(), piece.end());
    return {};
}

Status Decoder::end_output(LayerOutput& output, int depth) {
    if (output.messages) {
        output.feed.end();
        return check_arrays();
    }
    if (output.inner.empty()) {
        return fail(cut_ ? ErrorCode::truncated : ErrorCode::corrupt,
                    "a compressed file of which nothing is whole");
    }
    return read_layer(output.inner, depth + 1);
}

template <class Stream>
Status Decoder::take_all(Stream& stream, LayerOutput& output) {
    for (;;) {
        const double begin_s = thread_cpu_s();
        const std::span<const std::byte> piece = stream.next();
        report_data_.decompress_s += thread_cpu_s() - begin_s;
        if (piece.empty()) return {};
        if (Status taken = take_output(output, piece); !taken) return taken;
    }
}

Status Decoder::read_gzip(std::span<const std::byte> bytes, int depth) {
    GzipStream gzip{bytes};
    LayerOutput output{reader_};
    if (Status taken = take_all(gzip, output); !taken) return taken;
    report_gzip_end(gzip);
    return end_output(output, depth);
}

Status Decoder::read_compress(std::span<const std::byte> bytes, int depth) {
    CompressStream stream{bytes};
    LayerOutput output{reader_};
    if (Status taken = take_all(stream, output); !taken) return taken;
    if (stream.end() != CompressEnd::whole) {
        cut_ = stream.end() == CompressEnd::truncated;
        report_.add(Severity::error, "corrupt_compress", "the .Z file is damaged",
                    stream.position());
        if (!report_data_.corruption) {
            report_data_.corruption = {reader_.offset(), report_data_.problems.back().message};
        }
    }
    return end_output(output, depth);
}

void Decoder::report_gzip_end(const GzipStream& gzip) {
    const std::uint64_t position = gzip.position();
    switch (gzip.end()) {
        case GzipEnd::none:
        case GzipEnd::whole:
            return;
        case GzipEnd::truncated:
            cut_ = true;
            report_.add(Severity::error, "truncated_gzip", "the gzip file is cut", position);
            break;
        case GzipEnd::corrupt:
            report_.add(Severity::error, "corrupt_gzip", "the gzip file is damaged", position);
            break;
        case GzipEnd::bad_checksum:
            report_.add(Severity::error, "gzip_checksum", "the gzip file contradicts its checksum",
                        position);
            break;
        case GzipEnd::trailing_garbage:
            report_.add(Severity::warning, "gzip_trailer",
                        "something else follows the end of the gzip data", position);
            return;
    }
    if (!report_data_.corruption) {
        report_data_.corruption = {reader_.offset(), report_data_.problems.back().message};
    }
}

Status Decoder::next_block(BzipBlocks& blocks, std::optional<BzipBlocks::Block>& block) {
    const double begin_s = thread_cpu_s();
    block = blocks.next(output_left());
    report_data_.decompress_s += thread_cpu_s() - begin_s;
    if (block && block->status == BzipStatus::too_large) return count_output(output_left() + 1);
    return {};
}

Status Decoder::read_bzip2(std::span<const std::byte> bytes, int depth) {
    BzipBlocks blocks{bytes};
    LayerOutput output{reader_};
    for (;;) {
        std::optional<BzipBlocks::Block> block;
        if (Status read = next_block(blocks, block); !read) return read;
        if (!block) break;
        if (block->status == BzipStatus::whole) {
            if (Status taken = take_output(output, block->data); !taken) return taken;
            continue;
        }
        output.feed.end();
        report_.damage("corrupt_bzip2",
                       fmt::format("a bzip2 block at byte {} is damaged", block->position),
                       reader_.offset(), block->compressed_bytes);
        reader_.lose_sync();
    }
    if (!blocks.ended()) {
        cut_ = true;
        report_.add(Severity::error, "truncated_bzip2", "the bzip2 file is cut", bytes.size());
    }
    return end_output(output, depth);
}

Status Decoder::read_ldm(std::span<const std::byte> bytes) {
    report_data_.ldm_records = 0;
    report_data_.negative_control_words = 0;
    RecordQueue queue{bytes, options_.threads};
    while (const auto item = queue.next()) {
        report_data_.decompress_s += item->cpu_s;
        if (item->part.kind != LdmPart::Kind::record) {
            report_part(item->part);
            continue;
        }
        if (++*report_data_.ldm_records > most_records) {
            return fail(ErrorCode::unsupported, "more than {} LDM records", most_records);
        }
        if (item->part.negative) ++*report_data_.negative_control_words;
        if (Status read = read_record(*item); !read) return read;
    }
    return {};
}

void Decoder::report_part(const LdmPart& part) {
    if (part.kind == LdmPart::Kind::header) {
        builder_.further_header(part.header);
        report_.add(Severity::note, "further_volume_header",
                    fmt::format("a further volume header, {}", part.header.filename),
                    reader_.offset());
    } else if (part.kind == LdmPart::Kind::garbage) {
        report_.damage("not_a_record",
                       fmt::format("no LDM record at byte {} behind the header", part.position),
                       reader_.offset(), part.bytes.size());
    }
}

Status Decoder::read_record(const RecordQueue::Item& item) {
    const LdmPart& part = item.part;
    if (item.result.status == BzipStatus::no_memory) throw std::bad_alloc{};
    if (item.result.status != BzipStatus::whole) return read_record_blocks(item);
    if (Status counted = count_output(item.output.size()); !counted) return counted;
    reader_.read(item.output, true);
    const auto behind = part.bytes.subspan(item.result.input_bytes);
    if (part.bad_length || part.cut) {
        report_.add(Severity::warning, "bad_control_word",
                    fmt::format("the length of LDM record {} at byte {} is wrong",
                                *report_data_.ldm_records, part.position),
                    reader_.offset());
    }
    if (!all_zero(behind)) {
        report_.damage("not_a_record",
                       fmt::format("something that is no record follows LDM record {}",
                                   *report_data_.ldm_records),
                       reader_.offset(), behind.size());
    }
    return check_arrays();
}

// A record that is damaged, or larger than what is held at once.
Status Decoder::read_record_blocks(const RecordQueue::Item& item) {
    const LdmPart& part = item.part;
    const bool is_cut = part.cut || item.result.status == BzipStatus::truncated;
    const std::uint64_t number = *report_data_.ldm_records;
    BzipBlocks blocks{part.bytes};
    MessageFeed feed{reader_};
    bool all_good = true;
    for (;;) {
        std::optional<BzipBlocks::Block> block;
        if (Status read = next_block(blocks, block); !read) return read;
        if (!block) break;
        if (block->status == BzipStatus::whole) {
            if (Status counted = count_output(block->data.size()); !counted) return counted;
            feed.append(block->data);
            if (Status fits = check_arrays(); !fits) return fits;
            continue;
        }
        all_good = false;
        feed.end();
        report_.damage(is_cut ? "truncated_record" : "corrupt_record",
                       fmt::format("LDM record {} is {} at byte {} behind the header", number,
                                   is_cut ? "cut" : "damaged", part.position + block->position),
                       reader_.offset(), block->compressed_bytes);
        reader_.lose_sync();
    }
    feed.end();
    cut_ = cut_ || is_cut;
    if (all_good && !blocks.ended()) {
        report_.damage("truncated_record", fmt::format("LDM record {} is cut", number),
                       reader_.offset(), 0);
    }
    return check_arrays();
}

Result<Decoded> Decoder::run(std::span<const std::byte> bytes) {
    if (bytes.empty()) return fail(ErrorCode::empty, "the file is empty");
    if (Status read = read_layer(bytes, 0); !read) return pass_on(read);
    return finish();
}

Result<Decoded> Decoder::finish() {
    Decoded decoded;
    decoded.volume = builder_.finish(report_data_);
    Volume& volume = decoded.volume;
    volume.header = std::move(header_);
    if (volume.station.empty() && volume.header) volume.station = volume.header->icao;
    if (volume.station.empty()) volume.station = options_.fallback_station;
    report_position(volume);
    report_time(volume);
    report_end(volume);
    report_.finish();
    decoded.report = std::move(report_data_);
    bool anything = false;
    for (const auto& [type, count] : decoded.report.message_counts)
        anything = anything || type != 0;
    if (!anything) {
        return fail(cut_ ? ErrorCode::truncated : ErrorCode::corrupt, "nothing in it is whole: {}",
                    decoded.report.corruption ? decoded.report.corruption->reason
                                              : "neither radials nor metadata");
    }
    return decoded;
}

void Decoder::report_end(const Volume& volume) {
    if (volume.sweeps.empty()) {
        report_.add(Severity::warning, "no_radials", "metadata without radials");
    } else if (!has_ended(volume)) {
        report_.add(Severity::warning, "no_end_of_volume",
                    "the volume stops before its end: its last radial is not marked as the last");
    }
}

void Decoder::report_time(const Volume& volume) {
    const auto start = volume.start_time();
    if (volume.header && start != volume.header->time()) {
        report_.add(Severity::warning, "header_time",
                    fmt::format("the volume header's date, day {} of the radar's calendar, is {}",
                                volume.header->date,
                                start ? "not that of the radials: theirs is taken"
                                      : "impossible, and no radial has a better one"));
    }
}

void Decoder::report_position(const Volume& volume) {
    const auto antenna = antenna_position(volume);
    if (!antenna) {
        report_.add(Severity::warning, "no_position",
                    "neither the file nor the station table says where the radar stands");
    } else if (antenna->disagreement) {
        report_.add(Severity::warning, "position_disagrees", *antenna->disagreement);
    }
}

}  // namespace

Result<Decoded> decode(std::span<const std::byte> bytes, const DecodeOptions& options) {
    try {
        Decoder decoder{options};
        return decoder.run(bytes);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::unsupported, "it takes more memory than there is");
    }
}

Result<Decoded> decode_file(const std::filesystem::path& path, const DecodeOptions& options) {
    const auto bytes = read_file(path);
    if (!bytes) return pass_on(bytes);
    DecodeOptions with_station = options;
    if (with_station.fallback_station.empty()) {
        const std::string name = path.filename().string().substr(0, 4);
        if (find_station(name)) with_station.fallback_station = name;
    }
    auto decoded = decode(*bytes, with_station);
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", path.string(), decoded.error().message);
    }
    return decoded;
}

}  // namespace stormcellar::level2
