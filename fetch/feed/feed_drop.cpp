#include "fetch/feed/feed_drop.h"

#include <algorithm>
#include <system_error>

#include "base/system_error.h"
#include "base/unsynced_files.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::feed {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t least_counted = std::uint64_t{16} << 10;
constexpr std::size_t most_removed = 200;

std::uint64_t counted_bytes(std::uint64_t size) {
    return std::max(size, least_counted);
}

// Returns the names of the entries of this type in a directory; none if the directory cannot be
// read. Does not follow links.
std::vector<std::string> names_in(const fs::path& directory, fs::file_type type) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator one(directory, error), end; !error && one != end;
         one.increment(error)) {
        std::error_code ignored;
        if (one->symlink_status(ignored).type() == type) names.push_back(one->path().filename());
    }
    return names;
}

}  // namespace

Result<FeedDrop> FeedDrop::open(FileSystem& file_system, fs::path directory, DropLimits limits,
                                UtcTime now) {
    FeedDrop drop(file_system, std::move(directory), limits);
    std::error_code error;
    fs::create_directories(drop.directory_, error);
    if (error) return fail(ErrorCode::io, "{}: {}", drop.directory_.native(), error.message());
    if (Status read = drop.read(now); !read) return pass_on(read);
    return drop;
}

Status FeedDrop::read(UtcTime now) {
    for (const std::string& station : names_in(directory_, fs::file_type::directory)) {
        if (!is_icao(station)) continue;
        for (const std::string& number : names_in(directory_ / station, fs::file_type::directory)) {
            if (!parse_volume_number(number)) continue;
            const fs::path directory = directory_ / station / number;
            if (Status swept = remove_temporaries(*file_system_, directory); !swept) return swept;
            if (Status read = read_volumes(directory, station + "/" + number + "/", now); !read)
                return read;
        }
    }
    return {};
}

Status FeedDrop::read_volumes(const fs::path& directory, const std::string& prefix, UtcTime now) {
    for (const std::string& name : names_in(directory, fs::file_type::regular)) {
        const auto key = parse_chunk_key(prefix + name, now);
        std::error_code gone;
        const std::uint64_t size = key ? fs::file_size(directory / name, gone) : 0;
        if (!key || gone) continue;
        if (size == 0) {
            if (Status removed = file_system_->remove(directory / name); !removed) return removed;
            continue;
        }
        volumes_[{key->volume, key->station}] += counted_bytes(size);
        bytes_ += counted_bytes(size);
    }
    return {};
}

bool FeedDrop::has(const ChunkKey& key, std::uint64_t size) const {
    std::error_code error;
    const std::uint64_t found = fs::file_size(directory_ / to_string(key), error);
    return !error && found == size;
}

Status FeedDrop::write(const ChunkKey& key, std::span<const std::byte> bytes) {
    const fs::path path = directory_ / to_string(key);
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) return system_failure(path.parent_path().native(), error.value());
    const std::uint64_t replaced = fs::file_size(path, error);
    UnsyncedFiles unsynced(*file_system_);
    if (Status written = write_file_atomically(unsynced, path, bytes); !written) return written;
    const std::uint64_t more = counted_bytes(bytes.size()) - (error ? 0 : counted_bytes(replaced));
    volumes_[{key.volume, key.station}] += more;
    bytes_ += more;
    return {};
}

std::vector<VolumeId> FeedDrop::newest_of(const std::string& station, std::size_t most) const {
    std::vector<VolumeId> newest;
    for (auto one = volumes_.rbegin(); one != volumes_.rend() && newest.size() < most; ++one)
        if (one->first.second == station) newest.insert(newest.begin(), one->first.first);
    return newest;
}

std::size_t FeedDrop::prune(UtcTime now) {
    std::size_t removed = 0;
    while (!volumes_.empty() && removed < most_removed) {
        const UtcTime newest = std::min(now, volumes_.rbegin()->first.first.time);
        const Volume oldest = volumes_.begin()->first;
        if (oldest.first.time >= newest - limits_.age && bytes_ <= limits_.bytes) break;
        remove(oldest);
        ++removed;
    }
    return removed;
}

void FeedDrop::remove(const Volume& volume) {
    const auto& [id, station] = volume;
    const fs::path directory = directory_ / directory_of(station, id.number);
    const std::string prefix = fs::path{prefix_of(station, id)}.filename().native() + "-";
    for (const std::string& name : names_in(directory, fs::file_type::regular))
        if (name.starts_with(prefix)) (void)file_system_->remove(directory / name);
    std::error_code ignored;
    fs::remove(directory_ / station / std::to_string(id.number), ignored);  // if empty
    fs::remove(directory_ / station, ignored);                              // if empty
    bytes_ -= volumes_[volume];
    volumes_.erase(volume);
}

}  // namespace stormcellar::feed
