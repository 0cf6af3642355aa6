#include "stormcellar/level2/chunk_directory.h"

#include <map>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/live_volume.h"

namespace stormcellar::level2 {
namespace {

namespace fs = std::filesystem;

struct Found {
    // By number. If a number comes twice, LiveVolume takes the better chunk.
    std::multimap<int, std::pair<ChunkName, fs::path>> chunks;
    std::set<std::string> volumes;
};

// Returns true for a file that its sender has not finished.
bool is_temporary(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with('.') || name.ends_with(".part") || name.ends_with(".tmp") ||
           name.ends_with('~');
}

Result<Found> find_chunks(const fs::path& directory) {
    std::error_code error;
    fs::directory_iterator entry{directory, error};
    if (error) {
        return fail(
            error == std::errc::permission_denied ? ErrorCode::permission : ErrorCode::not_found,
            "{}: {}", directory.string(), error.message());
    }
    Found found;
    for (; entry != fs::directory_iterator{}; entry.increment(error)) {
        std::error_code ignored;
        const auto name = parse_chunk_name(entry->path().filename().string());
        if (!name || is_temporary(entry->path()) || !entry->is_regular_file(ignored)) continue;
        found.volumes.insert(name->volume);
        found.chunks.emplace(name->number, std::pair{*name, entry->path()});
    }
    // The loop also ends at an error.
    if (error) return fail(ErrorCode::io, "{}: {}", directory.string(), error.message());
    if (found.chunks.empty()) {
        return fail(ErrorCode::not_found,
                    "{}: holds no chunks (files named like 20220317-000842-001-S)",
                    directory.string());
    }
    if (found.volumes.size() > 1) {
        return fail(ErrorCode::bad_argument, "{}: holds chunks of {} volumes ({})",
                    directory.string(), found.volumes.size(), fmt::join(found.volumes, ", "));
    }
    return found;
}

std::string station_of(const fs::path& directory) {
    const fs::path path = directory.lexically_normal();
    for (const fs::path& part : {path.filename(), path.parent_path().filename()}) {
        std::string name = station_in_name(part.string());
        if (!name.empty()) return name;
    }
    return {};
}

}  // namespace

Result<Decoded> decode_chunk_directory(const fs::path& directory, const DecodeOptions& options) {
    const auto found = find_chunks(directory);
    if (!found) return pass_on(found);
    LiveOptions live;
    live.decode = options;
    if (live.decode.fallback_station.empty()) live.decode.fallback_station = station_of(directory);
    LiveVolume volume{live};
    for (const auto& [number, chunk] : found->chunks) {
        const auto& [name, path] = chunk;
        const auto bytes = read_file(path);
        if (!bytes) return pass_on(bytes);
        const auto added = volume.add(number, name.kind, *bytes, {});
        if (added == LiveVolume::Added::another_volume) {
            return fail(ErrorCode::bad_argument, "{}: chunk {} belongs to another volume",
                        directory.string(), to_string(name));
        }
        if (!added && added.error().code == ErrorCode::exhausted) {
            return fail(ErrorCode::exhausted, "{}: {}", path.string(), added.error().message);
        }
        // a chunk that is not accepted is named in the volume's report
    }
    auto decoded = volume.finish();
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", directory.string(), decoded.error().message);
    }
    return decoded;
}

Result<Decoded> decode_path(const fs::path& path, const DecodeOptions& options) {
    std::error_code error;
    if (fs::is_directory(path, error)) return decode_chunk_directory(path, options);
    return decode_file(path, options);
}

}  // namespace stormcellar::level2
