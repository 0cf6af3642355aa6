// list_radials: prints what the decoder reads, line by line, for a comparison with other readers.
//
// usage: list_radials FILE [REWRITTEN]
//
// Prints JSON lines: one for the header and the pattern, then one for each radial. For each moment
// it prints the number of gates, the number of values, and the CRC-32 of the codes (16-bit
// big-endian). Codes below threshold and range folded count as 0, because not every reader
// distinguishes them. If REWRITTEN is given, the program also encodes the volume to that file.
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/checksum.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"

namespace stormcellar::level2 {
namespace {

using Json = nlohmann::ordered_json;

Json pattern_of(const Vcp& vcp) {
    auto cuts = Json::array();
    for (const VcpCut& cut : vcp.cuts) {
        cuts.push_back({{"elevation_deg", cut.elevation_deg},
                        {"channel", cut.channel_configuration},
                        {"waveform", cut.waveform},
                        {"prf", cut.surveillance_prf},
                        {"pulses", cut.surveillance_pulses},
                        {"azimuth_rate_code", cut.azimuth_rate_code},
                        {"thresholds", cut.thresholds_eighth_db},
                        {"sails", cut.is_sails()},
                        {"mrle", cut.is_mrle()},
                        {"base_tilt", cut.is_base_tilt()}});
    }
    return {{"number", vcp.pattern_number}, {"version", vcp.version}, {"cuts", cuts}};
}

Json head_of(const Volume& volume) {
    Json head = {{"station", volume.station}, {"vcp", volume.vcp.value_or(0)}};
    if (volume.header) {
        head["filename"] = volume.header->filename;
        head["date"] = volume.header->date;
        head["ms"] = volume.header->ms;
        head["icao"] = volume.header->icao;
    }
    if (volume.vcp_message) head["pattern"] = pattern_of(*volume.vcp_message);
    if (volume.block) {
        head["latitude_deg"] = volume.block->latitude_deg;
        head["longitude_deg"] = volume.block->longitude_deg;
        head["site_height_m"] = volume.block->site_height_m;
        head["tower_height_m"] = volume.block->tower_height_m;
        head["block_vcp"] = volume.block->vcp;
    }
    return head;
}

Json moment_of(const SweepMoment& moment, std::size_t radial) {
    const int gates = moment.gate_counts[radial];
    std::vector<std::byte> codes;
    int valid = 0;
    for (int gate = 0; gate < gates; ++gate) {
        const std::uint16_t code = moment.code(radial, gate);
        const unsigned kept = code < 2 ? 0 : code;
        valid += code < 2 ? 0 : 1;
        codes.push_back(static_cast<std::byte>(kept >> 8));
        codes.push_back(static_cast<std::byte>(kept & 0xFFU));
    }
    return {{"gates", gates},
            {"first_m", moment.first_gate_m},
            {"spacing_m", moment.gate_spacing_m},
            {"bits", moment.word_size_bits},
            {"scale", moment.scale},
            {"offset", moment.offset},
            {"valid", valid},
            {"crc32", crc32(codes)}};
}

Json radial_of(const Sweep& sweep, std::size_t index) {
    const Radial& radial = sweep.radials[index];
    const NexradTime time = nexrad_from_time(radial.time);
    Json line = {{"message_type", sweep.message_type},
                 {"elevation_number", sweep.elevation_number},
                 {"azimuth_number", radial.azimuth_number},
                 {"azimuth_deg", radial.azimuth_deg},
                 {"elevation_deg", radial.elevation_deg},
                 {"status", radial.status},
                 {"date", time.day},
                 {"ms", time.milliseconds},
                 {"nyquist_mps", radial.nyquist_mps},
                 {"unambiguous_range_m", radial.unambiguous_range_m}};
    auto moments = Json::object();
    for (const SweepMoment& moment : sweep.moments) {
        if (moment.gate_counts[index] > 0)
            moments[std::string{moment_name(moment.moment)}] = moment_of(moment, index);
    }
    line["moments"] = std::move(moments);
    return line;
}

Status rewrite(const Volume& volume, const std::filesystem::path& path) {
    const auto encoded = encode(volume);
    if (!encoded) return tl::unexpected(encoded.error());
    const auto bytes = encoded->joined();
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return fail(ErrorCode::io, "{} cannot be written", path.string());
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (std::fclose(file) != 0 || !written)
        return fail(ErrorCode::io, "{} cannot be written", path.string());
    return {};
}

int run(int argc, char** argv) {
    if (argc != 2 && argc != 3) {
        fmt::print(stderr, "usage: list_radials FILE [REWRITTEN]\n");
        return 2;
    }
    const auto bytes = read_file(argv[1]);
    if (!bytes) {
        fmt::print(stderr, "{}\n", bytes.error().message);
        return 1;
    }
    const auto decoded = decode(*bytes);
    if (!decoded) {
        fmt::print(stderr, "{}\n", decoded.error().message);
        return 1;
    }
    const Volume& volume = decoded->volume;
    if (argc == 3) {
        if (const Status written = rewrite(volume, argv[2]); !written) {
            fmt::print(stderr, "{}\n", written.error().message);
            return 3;
        }
    }
    fmt::print("{}\n", head_of(volume).dump());
    for (const Sweep& sweep : volume.sweeps) {
        for (std::size_t i = 0; i < sweep.radials.size(); ++i)
            fmt::print("{}\n", radial_of(sweep, i).dump());
    }
    return 0;
}

}  // namespace
}  // namespace stormcellar::level2

int main(int argc, char** argv) {
    return stormcellar::level2::run(argc, argv);
}
