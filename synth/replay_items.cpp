// Finds the files to play, and their order.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include <fcntl.h>

#include "level2/containers/archive_header.h"
#include "level2/containers/gzip_stream.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/station_table.h"
#include "synth/replay.h"
#include "synth/replay_pieces.h"

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t start_bytes = 64U << 10U;  // enough for the header, gzipped or not

void read_facts(ReplayItem& item, std::span<const std::byte> bytes) {
    level2::GzipStream gzip(bytes);
    if (level2::is_gzip(bytes)) bytes = gzip.next();
    item.has_records = has_ldm_records(bytes);
    if (const auto header = level2::read_archive_header(bytes)) {
        item.time = header->time();
        item.station = header->icao;
        item.number = header->volume_number();
    }
    if (item.station.empty()) item.station = station_in_name(item.name.filename().string());
}

// Reads the start of a file. If a file cannot be read, this is reported when its turn comes.
void read_start(ReplayItem& item) {
    std::vector<char> start(start_bytes);
    std::ifstream file(item.source, std::ios::binary);
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    read_facts(item, std::as_bytes(std::span(start)));
}

// Returns the members of a tar or zip archive, or none if `source` is not an archive.
std::vector<ReplayItem> members_of(const fs::path& source) {
    std::vector<ReplayItem> items;
    const Descriptor file{::open(source.c_str(), O_RDONLY | O_CLOEXEC)};
    auto reader = file.is_open() ? archive::ArchiveReader::open(file.number()) : std::nullopt;
    while (reader) {
        const auto member = reader->next();
        if (!member) break;
        ReplayItem item;
        item.source = member_path(source, member->name);
        item.name = member->name;
        const auto start = std::span{member->bytes}.first(
            std::min<std::size_t>(start_bytes, member->bytes.size()));
        read_facts(item, start);
        items.push_back(std::move(item));
    }
    return items;
}

Result<std::vector<ReplayItem>> items_of(const fs::path& source) {
    std::error_code problem;
    if (!fs::exists(source, problem)) {
        return fail(ErrorCode::not_found, "{}: there is no such file or directory",
                    source.native());
    }
    std::vector<ReplayItem> items;
    const auto add = [&items](const fs::path& path, fs::path name) {
        ReplayItem item;
        item.source = path;
        item.name = std::move(name);
        items.push_back(std::move(item));
    };
    if (fs::is_regular_file(source, problem)) {
        items = members_of(source);
        if (items.empty()) add(source, source.filename());
        return items;
    }
    if (!fs::is_directory(source, problem)) {
        return fail(ErrorCode::not_a_file, "{}: is neither a file nor a directory",
                    source.native());
    }
    fs::recursive_directory_iterator walk(source, problem);
    for (; !problem && walk != fs::recursive_directory_iterator(); walk.increment(problem)) {
        const fs::path& path = walk->path();
        const bool hidden = path.filename().native().starts_with('.');
        if (!hidden && walk->is_regular_file(problem)) {
            add(path, path.lexically_relative(source));
        }
    }
    if (problem) return fail(ErrorCode::io, "{}: {}", source.native(), problem.message());
    return items;
}

// Compares by time, then by name. Items without a time come last.
bool earlier(const ReplayItem& a, const ReplayItem& b) {
    if (a.time.has_value() != b.time.has_value()) return a.time.has_value();
    if (a.time && *a.time != *b.time) return *a.time < *b.time;
    return a.name < b.name;
}

}  // namespace

Result<std::vector<ReplayItem>> find_replay_items(const std::vector<fs::path>& sources) {
    std::vector<ReplayItem> items;
    for (const fs::path& source : sources) {
        auto found = items_of(source);
        if (!found) return pass_on(found);
        std::move(found->begin(), found->end(), std::back_inserter(items));
    }
    if (items.empty()) return fail(ErrorCode::not_found, "there are no files to replay");
    std::set<fs::path> names;
    for (ReplayItem& item : items) {
        if (!names.insert(item.name).second) {
            return fail(ErrorCode::bad_argument, "{}: another file has the same name",
                        item.source.native());
        }
        std::error_code ignored;
        // The starts of members have been read already.
        if (fs::exists(item.source, ignored)) read_start(item);
    }
    std::sort(items.begin(), items.end(), earlier);
    return items;
}

}  // namespace stormcellar::synth
