#include "stormcellar/level2/chunk_directory.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/live_volume.h"

namespace stormcellar::level2 {
namespace {

namespace fs = std::filesystem;

// Returns true if the name shows that its sender has not finished the file.
bool is_temporary(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with('.') || name.ends_with(".part") || name.ends_with(".tmp") ||
           name.ends_with('~');
}

// Returns the digits of a name. Names of both forms begin with the time, so the digits sort by
// time.
std::string digits_of(const std::string& text) {
    std::string digits;
    std::ranges::copy_if(text, std::back_inserter(digits),
                         [](char letter) { return letter >= '0' && letter <= '9'; });
    return digits;
}

std::string station_of(const fs::path& directory) {
    std::error_code error;
    fs::path path = fs::absolute(directory.empty() ? "." : directory, error).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    for (const fs::path& part : {path.filename(), path.parent_path().filename()}) {
        std::string name = station_in_name(part.string());
        if (!name.empty()) return name;
    }
    return {};
}

}  // namespace

Result<std::vector<ChunkSet>> chunk_sets(const fs::path& directory) {
    std::error_code error;
    fs::directory_iterator entry{directory, error};
    if (error) {
        return fail(
            error == std::errc::permission_denied ? ErrorCode::permission : ErrorCode::not_found,
            "{}: {}", directory.string(), error.message());
    }
    // The chunks of each volume, sorted by time and number. If two chunks have the same number,
    // LiveVolume keeps the better chunk.
    std::map<std::pair<std::string, std::string>, std::multimap<int, fs::path>> found;
    for (; entry != fs::directory_iterator{}; entry.increment(error)) {
        std::error_code ignored;
        const auto name = parse_chunk_name(entry->path().filename().string());
        if (!name || is_temporary(entry->path()) || !entry->is_regular_file(ignored)) continue;
        found[{digits_of(name->volume), name->volume}].emplace(name->number, entry->path());
    }
    // The loop ends at the last entry or after an error.
    if (error) return fail(ErrorCode::io, "{}: {}", directory.string(), error.message());
    if (found.empty()) {
        return fail(ErrorCode::not_found,
                    "{}: holds no chunks (files named like 20220317-000842-001-S)",
                    directory.string());
    }
    std::vector<ChunkSet> sets;
    for (auto& [volume, chunks] : found) {
        ChunkSet& set = sets.emplace_back(ChunkSet{volume.second, {}});
        for (auto& [number, path] : chunks)
            set.chunks.push_back(std::move(path));
    }
    return sets;
}

Result<Decoded> decode_chunks(const std::vector<fs::path>& chunks, const DecodeOptions& options) {
    if (chunks.empty()) return fail(ErrorCode::empty, "no chunk is named");
    const fs::path directory = chunks.front().parent_path();
    LiveOptions live{.decode = options};
    if (live.decode.fallback_station.empty()) live.decode.fallback_station = station_of(directory);
    LiveVolume volume{live};
    for (const fs::path& path : chunks) {
        const auto name = parse_chunk_name(path.filename().string());
        if (!name) return fail(ErrorCode::bad_argument, "{}: is no chunk", path.string());
        const auto bytes = read_file(path);
        if (!bytes) return pass_on(bytes);
        const auto added = volume.add(name->number, name->kind, *bytes, {});
        if (added == LiveVolume::Added::another_volume) {
            return fail(ErrorCode::bad_argument, "{}: chunk {} belongs to another volume",
                        directory.string(), to_string(*name));
        }
        if (!added && added.error().code == ErrorCode::exhausted) {
            return fail(ErrorCode::exhausted, "{}: {}", path.string(), added.error().message);
        }
        // the report of the volume lists a chunk that add() refused
    }
    auto decoded = volume.finish();
    if (!decoded) {
        return fail(decoded.error().code, "{}: {}", directory.string(), decoded.error().message);
    }
    return decoded;
}

Result<Decoded> decode_chunk_directory(const fs::path& directory, const DecodeOptions& options) {
    const auto sets = chunk_sets(directory);
    if (!sets) return pass_on(sets);
    return decode_chunks(sets->back().chunks, options);
}

Result<Decoded> decode_path(const fs::path& path, const DecodeOptions& options) {
    std::error_code error;
    if (fs::is_directory(path, error)) return decode_chunk_directory(path, options);
    return decode_file(path, options);
}

}  // namespace stormcellar::level2
