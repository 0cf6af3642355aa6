#include "level2/encode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <bzlib.h>

#include "level2/encode_messages.h"

namespace stormcellar::level2 {
namespace {

template <class... Args>
tl::unexpected<Error> refuse(fmt::format_string<Args...> format, Args&&... args) {
    return fail(ErrorCode::bad_argument, "cannot write the volume: {}",
                fmt::format(format, std::forward<Args>(args)...));
}

template <class Integer>
bool fits(double number) {
    return number >= std::numeric_limits<Integer>::min() &&
           number <= std::numeric_limits<Integer>::max();
}

Status check_moment(const Sweep& sweep, const SweepMoment& moment) {
    const auto name = moment_name(moment.moment);
    const int number = sweep.elevation_number;
    if (moment.word_size_bits != 8 && moment.word_size_bits != 16) {
        return refuse("{} of elevation {} has codes of {} bits", name, number,
                      moment.word_size_bits);
    }
    if (moment.gate_stride < 0 || moment.gate_counts.size() != sweep.radials.size()) {
        return refuse("{} of elevation {} has {} rows for {} radials", name, number,
                      moment.gate_counts.size(), sweep.radials.size());
    }
    const std::size_t codes =
        moment.word_size_bits == 8 ? moment.codes8.size() : moment.codes16.size();
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    if (codes != stride * sweep.radials.size()) {
        return refuse("{} of elevation {} has {} codes for {} rows of {}", name, number, codes,
                      sweep.radials.size(), stride);
    }
    const auto too_long = [stride](std::uint16_t gates) { return gates > stride; };
    if (std::any_of(moment.gate_counts.begin(), moment.gate_counts.end(), too_long)) {
        return refuse("{} of elevation {} counts more gates than a row holds", name, number);
    }
    if (!fits<std::int16_t>(moment.first_gate_m) || !fits<std::uint16_t>(moment.gate_spacing_m)) {
        return refuse("{} of elevation {} begins at {} m and steps by {} m", name, number,
                      moment.first_gate_m, moment.gate_spacing_m);
    }
    if (!fits<std::uint8_t>(moment.control_flags) ||
        !fits<std::int16_t>(moment.snr_threshold_db * 8.0) ||
        !fits<std::int16_t>(moment.folding_threshold_db * 10.0)) {
        return refuse("{} of elevation {} has flags or thresholds beyond message 31", name, number);
    }
    return {};
}

Status check_sweep(const Sweep& sweep) {
    const int number = sweep.elevation_number;
    if (sweep.message_type != 31) {
        return refuse("elevation {} came in message {}, not 31", number, sweep.message_type);
    }
    if (!fits<std::uint8_t>(number)) return refuse("elevation number {}", number);
    const float spacing = sweep.azimuth_spacing_deg;
    if (spacing != 0 && spacing != 0.5F && spacing != 1) {
        return refuse("elevation {} has radials every {} degrees, not 0.5 or 1", number, spacing);
    }
    for (const Radial& radial : sweep.radials) {
        if (!fits<std::uint16_t>(nexrad_from_time(radial.time).day)) {
            return refuse("elevation {} has a radial of {}; message 31 ends in 2149", number,
                          format_utc(radial.time));
        }
        if (!fits<std::uint16_t>(radial.nyquist_mps * 100.0) ||
            !fits<std::uint16_t>(radial.unambiguous_range_m / 100.0)) {
            return refuse("elevation {} has a Nyquist velocity of {} m/s at {} m", number,
                          radial.nyquist_mps, radial.unambiguous_range_m);
        }
    }
    for (const SweepMoment& moment : sweep.moments) {
        Status checked = check_moment(sweep, moment);
        if (!checked) return checked;
    }
    return {};
}

Status check_volume(const Volume& volume) {
    if (volume.header) {
        if (volume.header->filename.size() > 12) {
            return refuse("the header's name '{}' is longer than 12", volume.header->filename);
        }
        if (!volume.header->icao.empty() && volume.header->icao.size() != 4) {
            return refuse("the header's site '{}' is not four characters", volume.header->icao);
        }
    }
    if (const auto start = volume.start_time();
        start && !fits<std::uint16_t>(nexrad_from_time(*start).day)) {
        return refuse("the volume begins at {}; messages end in 2149", format_utc(*start));
    }
    if (volume.radial_count() == 0) {
        if (!volume.header) return refuse("neither header nor radials");
        return {};
    }
    if (volume.station.size() != 4) {
        return refuse("the station '{}' is not four characters", volume.station);
    }
    if (!volume.block) return refuse("no position: the volume data block is missing");
    if (volume.block->size_bytes != 44 + volume.block->rest.size()) {
        return refuse("the volume data block says {} bytes and holds {}", volume.block->size_bytes,
                      44 + volume.block->rest.size());
    }
    for (const Sweep& sweep : volume.sweeps) {
        Status checked = check_sweep(sweep);
        if (!checked) return checked;
    }
    return {};
}

UtcTime first_time(const Volume& volume) {
    return volume.start_time().value_or(UtcTime{});
}

std::vector<std::byte> encode_header(const Volume& volume) {
    const NexradTime start = nexrad_from_time(first_time(volume));
    const VolumeHeader made{"AR2V0006.001", start.day, start.milliseconds, volume.station};
    const VolumeHeader& header = volume.header ? *volume.header : made;
    ByteWriter out;
    out.text(header.filename, 12);
    out.u32(header.date);
    out.u32(header.ms);
    out.text(header.icao, 4);
    return out.take();
}

// Messages as one LDM record: the size of its bzip2 stream, then the stream.
Result<EncodedRecord> compress(std::span<const std::byte> messages, int level) {
    // The bound that libbz2's manual gives for BZ2_bzBuffToBuffCompress.
    const std::size_t bound = messages.size() + messages.size() / 100 + 600;
    if (bound > std::numeric_limits<std::int32_t>::max()) {
        return refuse("a record of {} bytes is too large", messages.size());
    }
    EncodedRecord record;
    record.bytes.resize(4 + bound);
    auto size = static_cast<unsigned int>(bound);
    // libbz2 takes its input as char* and only reads it.
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

Status append_sweep(std::vector<EncodedRecord>& records, const Volume& volume, const Sweep& sweep,
                    const EncodeOptions& options, MessageRun& run) {
    const auto step = static_cast<std::size_t>(options.radials_per_record);
    for (std::size_t first = 0; first < sweep.radials.size(); first += step) {
        const std::size_t end = std::min(first + step, sweep.radials.size());
        ByteWriter messages;
        for (std::size_t i = first; i < end; ++i) {
            Status written = append_radial(messages, volume, sweep, i, run);
            if (!written) return written;
        }
        auto record = compress(messages.bytes(), options.compression_level);
        if (!record) return pass_on(record);
        records.push_back(std::move(*record));
    }
    return {};
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

Result<EncodedVolume> encode(const Volume& volume, const EncodeOptions& options) {
    if (options.compression_level < 1 || options.compression_level > 9 ||
        options.radials_per_record < 1) {
        return refuse("compression level {}, {} radials a record", options.compression_level,
                      options.radials_per_record);
    }
    const Status checked = check_volume(volume);
    if (!checked) return pass_on(checked);

    EncodedVolume encoded;
    encoded.header = encode_header(volume);
    MessageRun run(volume);
    ByteWriter metadata;
    const Status written = append_metadata(metadata, volume, first_time(volume), run);
    if (!written) return pass_on(written);
    auto record = compress(metadata.bytes(), options.compression_level);
    if (!record) return pass_on(record);
    encoded.records.push_back(std::move(*record));
    for (const Sweep& sweep : volume.sweeps) {
        const Status appended = append_sweep(encoded.records, volume, sweep, options, run);
        if (!appended) return pass_on(appended);
    }
    for (EncodedRecord& each : encoded.records) {
        set_control_word(each, &each == &encoded.records.back());
    }
    return encoded;
}

}  // namespace stormcellar::level2
