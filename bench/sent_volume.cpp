#include "bench/sent_volume.h"

#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "synth/replay_pieces.h"

namespace stormcellar::bench {

namespace fs = std::filesystem;

Result<SentPieces> read_sent_volume(const fs::path& path) {
    auto bytes = read_file(path);
    if (!bytes) return pass_on(bytes);
    SentPieces volume{path, std::move(*bytes), {}};
    auto decoded = level2::decode(volume.bytes);
    if (!decoded) return pass_on(decoded);
    volume.decoded = std::move(decoded->volume);
    const bool is_sound = volume.decoded.header && !volume.decoded.station.empty() &&
                          synth::has_ldm_records(volume.bytes);
    if (!is_sound) return fail(ErrorCode::unsupported, "{}: no LDM records", path.native());
    return volume;
}

std::string chunk_name(const SentPieces& volume, std::size_t number, bool is_last) {
    // format_utc() gives 2022-03-17T00:08:42Z
    const std::string time = format_utc(volume.decoded.header->time());
    return fmt::format("{}{}{}-{}{}{}-{:03}-{}", time.substr(0, 4), time.substr(5, 2),
                       time.substr(8, 2), time.substr(11, 2), time.substr(14, 2),
                       time.substr(17, 2), number,
                       number == 1 ? "S"
                       : is_last   ? "E"
                                   : "I");
}

std::chrono::steady_clock::time_point append_piece(const fs::path& path,
                                                   std::span<const std::byte> bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::app);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    file.flush();
    const auto closed = std::chrono::steady_clock::now();
    file.close();
    return closed;
}

double bzip2_of(std::span<const std::byte> piece) {
    const Bytes bytes(piece.begin(), piece.end());
    Bytes peeled;
    const auto records = ldm_records(bytes, peeled);
    double least_s = 1e9;
    for (int run = 0; run < 3; ++run)
        keep_least_seconds(least_s, [&] { bunzip_all(records); });
    return least_s;
}

}  // namespace stormcellar::bench
