#include "tests/fuzz/properties.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "level2/containers/compress_stream.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/describe.h"
#include "stormcellar/level2/encode.h"
#include "tests/fuzz/slow_expand.h"
#include "tests/level2/radial_identity.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"

namespace stormcellar::fuzz {
namespace {

using level2::Decoded;
using level2::DecodeOptions;
using level2::DecodeReport;
using level2::Sweep;
using level2::SweepMoment;
using level2::wire::Bytes;

Result<Decoded> decode(std::span<const std::byte> file, int threads) {
    DecodeOptions options;
    options.threads = threads;
    options.output_limit_bytes = output_limit_bytes;
    return level2::decode(file, options);
}

void require_same_problems(const DecodeReport& a, const DecodeReport& b) {
    require(a.problems.size() == b.problems.size(), "{} and {} problems", a.problems.size(),
            b.problems.size());
    for (std::size_t i = 0; i < a.problems.size(); ++i) {
        const level2::Problem& p = a.problems[i];
        const level2::Problem& q = b.problems[i];
        require(p.code == q.code && p.message == q.message && p.offset == q.offset &&
                    p.severity == q.severity,
                "problem {} is '{}' and '{}'", i, p.message, q.message);
    }
}

// Compares the parts of two reports that do not depend on the container.
void require_same_messages(const DecodeReport& a, const DecodeReport& b) {
    require(a.message_bytes == b.message_bytes, "message bytes {} and {}", a.message_bytes,
            b.message_bytes);
    require(a.message_counts == b.message_counts, "the message counts differ");
    require(a.bytes_dropped == b.bytes_dropped, "bytes dropped {} and {}", a.bytes_dropped,
            b.bytes_dropped);
    require(a.corruption.has_value() == b.corruption.has_value(), "one is corrupt");
    if (a.corruption) {
        require(a.corruption->offset == b.corruption->offset, "corruption at {} and {}",
                a.corruption->offset, b.corruption->offset);
    }
    require(a.complete == b.complete, "one is complete");
    require(a.further_volume_starts == b.further_volume_starts, "the volume starts differ");
    require_same_problems(a, b);
}

void require_same(const Decoded& a, const Decoded& b) {
    const std::string where = level2::difference(a.volume, b.volume);
    require(where.empty(), "the volumes differ: {}", where);
    require_same_messages(a.report, b.report);
}

void require_same(const Result<Decoded>& one, const Result<Decoded>& two) {
    require(one.has_value() == two.has_value(), "one thread or two: error or not");
    if (one) return require_same(*one, *two);
    require(one.error().code == two.error().code, "one thread or two: errors differ");
    require(one.error().message == two.error().message, "one thread or two: '{}' and '{}'",
            one.error().message, two.error().message);
}

void require_well_formed(const Sweep& sweep, const SweepMoment& moment) {
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    const std::size_t codes = stride * sweep.radials.size();
    require(moment.gate_counts.size() == sweep.radials.size(), "rows and radials differ");
    require(moment.word_size_bits == 8 || moment.word_size_bits == 16, "{} bits",
            moment.word_size_bits);
    const bool wide = moment.word_size_bits == 16;
    require(moment.codes8.size() == (wide ? 0 : codes), "8-bit codes");
    require(moment.codes16.size() == (wide ? codes : 0), "16-bit codes");
    const auto most = std::max_element(moment.gate_counts.begin(), moment.gate_counts.end());
    require(*most > 0 && *most == stride, "rows of {} gates for {}", stride, *most);
    require(std::isfinite(moment.scale) && std::isfinite(moment.offset), "scale or offset");
}

// Returns the number of repeated radials, which were dropped. The note in the report begins with
// this number.
std::uint64_t radials_that_came_twice(const DecodeReport& report) {
    for (const level2::Problem& problem : report.problems)
        if (problem.code == "radials_came_twice") return std::stoull(problem.message);
    return 0;
}

void require_well_formed(const Decoded& decoded) {
    std::uint64_t radials = 0;
    for (const Sweep& sweep : decoded.volume.sweeps) {
        require(!sweep.radials.empty(), "a sweep without radials");
        require(sweep.message_type == 1 || sweep.message_type == 31, "a sweep of message {}",
                sweep.message_type);
        for (const level2::Radial& radial : sweep.radials) {
            require(radial.azimuth_deg >= 0 && radial.azimuth_deg <= 360, "an azimuth");
            require(std::abs(radial.elevation_deg) <= 180, "an elevation");
        }
        for (const SweepMoment& moment : sweep.moments)
            require_well_formed(sweep, moment);
        radials += sweep.radials.size();
    }
    std::uint64_t counted = 0;
    for (const auto& [type, count] : decoded.report.message_counts)
        counted += type == 1 || type == 31 ? count : 0;
    const std::uint64_t twice = radials_that_came_twice(decoded.report);
    require(counted == radials + twice, "{} radials and {} twice of {} counted", radials, twice,
            counted);
}

void require_well_formed_report(const Decoded& decoded) {
    const DecodeReport& report = decoded.report;
    require(report.bytes_dropped == 0 || !report.problems.empty(), "damage without a problem");
    require(!report.corruption || !report.problems.empty(), "corruption without a problem");
    std::size_t previous = 0;
    for (const std::size_t start : report.further_volume_starts) {
        require(start > previous && start < decoded.volume.sweeps.size(), "volume start {}", start);
        previous = start;
    }
    for (const level2::Problem& problem : report.problems) {
        const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
        require(!problem.code.empty() && !problem.message.empty(), "a problem without words");
        require(std::none_of(problem.message.begin(), problem.message.end(), is_control),
                "a problem is no single line: {}", problem.code);
    }
}

// The writer may refuse a volume with bad_argument. A volume that the writer accepts must be read
// back unchanged.
void require_round_trip(const Decoded& decoded) {
    const auto encoded = level2::encode(decoded.volume, {1, 120});
    if (!encoded) {
        require(encoded.error().code == ErrorCode::bad_argument, "refused as {}",
                encoded.error().message);
        return;
    }
    DecodeOptions options;
    options.output_limit_bytes = output_limit_bytes;
    options.fallback_station = decoded.volume.station;
    const auto again = level2::decode(encoded->joined(), options);
    require(again.has_value(), "what was written cannot be read: {}",
            again ? "" : again.error().message);
    level2::Volume expected = decoded.volume;
    if (!expected.header) expected.header = again->volume.header;
    const std::string where = level2::difference(expected, again->volume);
    require(where.empty(), "written and read again it differs: {}", where);
}

void require_splits(const Decoded& decoded) {
    const auto volumes = level2::split_volumes(decoded);
    require(volumes.size() == decoded.report.further_volume_starts.size() + 1, "{} volumes",
            volumes.size());
    std::size_t sweeps = 0;
    for (const level2::Volume& volume : volumes)
        sweeps += volume.sweeps.size();
    require(sweeps == decoded.volume.sweeps.size(), "sweeps lost in splitting");
}

// Returns good radials for one sweep.
Bytes good_radials(unsigned elevation_number) {
    Bytes all;
    for (unsigned i = 0; i < 3; ++i) {
        level2::wire::Ray ray;
        ray.azimuth_number = i + 1;
        ray.azimuth_deg = static_cast<float>(i);
        ray.elevation_number = elevation_number;
        ray.status = i == 0 ? 3 : 1;
        ray.gates = 30;
        ray.fill = 10 + i;
        const Bytes message = level2::wire::message_31(ray);
        all.insert(all.end(), message.begin(), message.end());
    }
    return all;
}

// Requires that good radials before the stream are kept in their order. Sweeps are sorted by time,
// so sweeps of the stream may come before the sweeps of the good radials. The last good radial may
// be dropped, because the stream can make this radial look as if it had lost bytes.
void require_good_radials_kept(std::span<const std::byte> stream) {
    const Bytes good = good_radials(1);
    const Bytes header = level2::wire::archive_header();
    const auto alone = decode(level2::wire::join({header, good}), 1);
    const auto followed = decode(
        level2::wire::join({header, good, {stream.begin(), stream.end()}, good_radials(2)}), 1);
    require(alone.has_value() && followed.has_value(), "good radials cannot be read");
    const auto expected = level2::identities(alone->volume);
    const auto found = level2::identities(followed->volume);
    auto from = found.begin();
    for (std::size_t i = 0; i + 1 < expected.size(); ++i) {
        from = std::find(from, found.end(), expected[i]);
        require(from != found.end(), "good radial {} is changed or lost", i);
        ++from;
    }
}

}  // namespace

void check_container(std::span<const std::byte> file) {
    const auto one = decode(file, 1);
    // The decoder uses threads only for LDM records. If the decoder fails, no report names the
    // container, so compare in that case too.
    if (!one || one->report.ldm_records) require_same(one, decode(file, 2));
    if (!one) return;
    require_well_formed(*one);
    require_well_formed_report(*one);
    require_splits(*one);
    using Json = nlohmann::ordered_json;
    const Json facts = level2::describe(*one, {"file", file.size()});
    require(!facts.dump(-1, ' ', false, Json::error_handler_t::replace).empty(), "no description");
    require_round_trip(*one);
}

void check_messages(std::span<const std::byte> stream) {
    const Bytes header = level2::wire::archive_header();
    const Bytes messages{stream.begin(), stream.end()};
    const auto plain = decode(level2::wire::join({header, messages}), 1);
    if (plain && plain->report.container == "uncompressed") {
        require_well_formed(*plain);
        require_well_formed_report(*plain);
        const Bytes record = level2::wire::ldm_record(messages, true, 1);
        const auto packed = decode(level2::wire::join({header, record}), 1);
        require(packed.has_value(), "packed into a record it cannot be read");
        require_same(*plain, *packed);
        require_round_trip(*plain);
    }
    require_good_radials_kept(stream);
}

void check_compress(std::span<const std::byte> file) {
    constexpr std::size_t limit = std::size_t{16} << 20;
    level2::CompressStream stream{file};
    std::string text;
    while (text.size() <= limit) {
        const auto piece = stream.next();
        if (piece.empty()) break;
        text.append(reinterpret_cast<const char*>(piece.data()), piece.size());
        require(stream.position() <= file.size(), "a position behind the end");
    }
    const Expanded slow = slow_expand(file, limit);
    const std::size_t both = std::min(text.size(), slow.text.size());
    require(text.compare(0, both, slow.text, 0, both) == 0, "expands to something else");
    if (text.size() <= limit) {
        require(text.size() == slow.text.size(), "expands to {} bytes, not {}", text.size(),
                slow.text.size());
        require(stream.end() == slow.end, "ends otherwise");
    }
    if (file.size() < 2) return;
    const int width = 9 + std::to_integer<int>(file[0]) % 8;
    const Bytes packed =
        level2::wire::compress(file, width, std::to_integer<std::size_t>(file[1]) * 16);
    level2::CompressStream back{packed};
    Bytes plain;
    for (auto piece = back.next(); !piece.empty(); piece = back.next())
        plain.insert(plain.end(), piece.begin(), piece.end());
    require(std::equal(plain.begin(), plain.end(), file.begin(), file.end()),
            "compressed with {} bits it does not come back", width);
}

}  // namespace stormcellar::fuzz
