#include "stormcellar/level2/encode.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>

#include <bzlib.h>

#include "level2/encode/encode_checks.h"
#include "level2/encode/encode_messages.h"
#include "level2/encode/read_back.h"

namespace stormcellar::level2 {
namespace {

constexpr int legacy_radials_per_record = 100;  // for builds up to 8 (ICD 2620010A to C)

UtcTime first_time(const Volume& volume) {
    return volume.start_time().value_or(UtcTime{});
}

std::vector<std::byte> encode_header(const Volume& volume) {
    const NexradTime start = nexrad_from_time(first_time(volume));
    const bool legacy = !volume.sweeps.empty() && volume.sweeps.front().message_type == 1;
    const VolumeHeader made{legacy ? "AR2V0001.001" : "AR2V0006.001", start.day, start.milliseconds,
                            volume.station};
    const VolumeHeader& header = volume.header ? *volume.header : made;
    ByteWriter out;
    out.text(header.filename, 12);
    out.u32(header.date);
    out.u32(header.ms);
    out.text(header.icao, 4);
    return out.take();
}

// Compresses messages into one LDM record. The caller fills in the control word at its start.
Result<EncodedRecord> compress(std::span<const std::byte> messages, int level) {
    // This is the bound that libbz2's manual gives for BZ2_bzBuffToBuffCompress.
    const std::size_t bound = messages.size() + messages.size() / 100 + 600;
    if (bound > std::numeric_limits<std::int32_t>::max()) {
        return refuse("a record of {} bytes is too large", messages.size());
    }
    EncodedRecord record;
    record.bytes.resize(4 + bound);
    auto size = static_cast<unsigned int>(bound);
    // libbz2 takes its input as char* but does not write to it.
    char* source = const_cast<char*>(reinterpret_cast<const char*>(messages.data()));
    char* target = reinterpret_cast<char*>(record.bytes.data() + 4);
    const int code = BZ2_bzBuffToBuffCompress(
        target, &size, source, static_cast<unsigned int>(messages.size()), level, 0, 0);
    if (code != BZ_OK) {
        return fail(ErrorCode::internal, "bzip2 could not compress a record (code {})", code);
    }
    record.bytes.resize(4 + size);
    return record;
}

void set_control_word(EncodedRecord& record, bool last) {
    const auto size = static_cast<std::int32_t>(record.bytes.size() - 4);
    ByteWriter word;
    word.u32(static_cast<std::uint32_t>(last ? -size : size));
    std::copy(word.bytes().begin(), word.bytes().end(), record.bytes.begin());
}

// The radials [first, end) of a sweep.
struct Stretch {
    std::size_t sweep = 0;
    std::size_t first = 0;
    std::size_t end = 0;
};

class RecordMaker {
  public:
    RecordMaker(const Volume& volume, const EncodeOptions& options)
        : volume_(volume), options_(options), run_(volume), read_back_(volume) {}

    Status make_all(EncodedVolume& encoded);

  private:
    Status add_metadata(EncodedVolume& encoded);
    Status add_radials(EncodedVolume& encoded, const Stretch& stretch);
    Status add_record(EncodedVolume& encoded, std::span<const std::byte> messages) const;

    const Volume& volume_;
    const EncodeOptions& options_;
    MessageRun run_;
    ReadBack read_back_;
};

Status RecordMaker::add_record(EncodedVolume& encoded, std::span<const std::byte> messages) const {
    auto record = compress(messages, options_.compression_level);
    if (!record) return pass_on(record);
    encoded.records.push_back(std::move(*record));
    return {};
}

Status RecordMaker::add_metadata(EncodedVolume& encoded) {
    // The decoder accepts no later dates, and a Volume does not keep the date of its metadata, so
    // any date will do.
    const bool is_dated = nexrad_from_time(encoded.start).day <= latest_day;
    ByteWriter messages;
    Status written = append_metadata(messages, volume_, is_dated ? encoded.start : UtcTime{}, run_);
    if (!written) return written;
    if (const auto fault = read_back_.read_record(messages.bytes())) {
        return refuse("its metadata would not be read: {}", fault->reason);
    }
    return add_record(encoded, messages.bytes());
}

Status RecordMaker::add_radials(EncodedVolume& encoded, const Stretch& stretch) {
    const Sweep& sweep = volume_.sweeps[stretch.sweep];
    ByteWriter messages;
    std::vector<std::size_t> ends;
    for (std::size_t i = stretch.first; i < stretch.end; ++i) {
        Status written = sweep.message_type == 1
                             ? append_radial_1(messages, volume_, sweep, i, run_)
                             : append_radial(messages, volume_, sweep, i, run_);
        if (!written) return written;
        ends.push_back(messages.size());
    }
    if (const auto fault = read_back_.read_record(messages.bytes())) {
        const auto at = std::upper_bound(ends.begin(), ends.end(), fault->offset) - ends.begin();
        return refuse("radial {} of sweep {} would not be read: {}",
                      stretch.first + static_cast<std::size_t>(at), stretch.sweep, fault->reason);
    }
    return add_record(encoded, messages.bytes());
}

Status RecordMaker::make_all(EncodedVolume& encoded) {
    if (Status read = read_back_.read_header(encoded.header); !read) return read;
    if (Status added = add_metadata(encoded); !added) return added;
    for (std::size_t i = 0; i < volume_.sweeps.size(); ++i) {
        const Sweep& sweep = volume_.sweeps[i];
        const int most = sweep.message_type == 1
                             ? std::min(options_.radials_per_record, legacy_radials_per_record)
                             : options_.radials_per_record;
        const auto step = static_cast<std::size_t>(most);
        for (std::size_t first = 0; first < sweep.radials.size(); first += step) {
            const std::size_t end = std::min(first + step, sweep.radials.size());
            if (Status added = add_radials(encoded, {i, first, end}); !added) return added;
        }
    }
    return read_back_.finish();
}

}  // namespace

std::vector<std::byte> EncodedVolume::joined() const {
    std::size_t size = header.size();
    for (const EncodedRecord& record : records) {
        size += record.bytes.size();
    }
    std::vector<std::byte> file;
    file.reserve(size);
    file.insert(file.end(), header.begin(), header.end());
    for (const EncodedRecord& record : records) {
        file.insert(file.end(), record.bytes.begin(), record.bytes.end());
    }
    return file;
}

std::vector<EncodedChunk> EncodedVolume::chunks() const {
    // "2022-03-17T00:08:42Z" without its separators is the first part of a chunk's name.
    std::string digits = format_utc(std::chrono::floor<std::chrono::seconds>(start));
    std::erase_if(digits, [](char c) { return c < '0' || c > '9'; });
    const std::string volume = digits.substr(0, 8) + "-" + digits.substr(8, 6);
    std::vector<EncodedChunk> chunks;
    for (const EncodedRecord& record : records) {
        const bool first = chunks.empty();
        const bool last = &record == &records.back();
        EncodedChunk& chunk = chunks.emplace_back();
        chunk.name = {volume, static_cast<int>(chunks.size()),
                      first  ? ChunkKind::start
                      : last ? ChunkKind::end
                             : ChunkKind::intermediate};
        if (first) chunk.bytes = header;
        chunk.bytes.insert(chunk.bytes.end(), record.bytes.begin(), record.bytes.end());
    }
    return chunks;
}

Result<EncodedVolume> encode(const Volume& volume, const EncodeOptions& options) {
    if (options.compression_level < 1 || options.compression_level > 9 ||
        options.radials_per_record < 1) {
        return refuse("compression level {}, {} radials a record", options.compression_level,
                      options.radials_per_record);
    }
    const Status checked = check_encodable(volume);
    if (!checked) return pass_on(checked);

    EncodedVolume encoded;
    encoded.start = first_time(volume);
    encoded.header = encode_header(volume);
    const Status made = RecordMaker{volume, options}.make_all(encoded);
    if (!made) return pass_on(made);
    for (EncodedRecord& each : encoded.records) {
        set_control_word(each, &each == &encoded.records.back());
    }
    return encoded;
}

}  // namespace stormcellar::level2
