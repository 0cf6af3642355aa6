#include "tests/fetch/feed/chunk_bucket.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace stormcellar::feed {

std::string dashed_time(UtcTime time) {
    std::string text = format_compact(time);
    text[8] = '-';
    return text;
}

std::string key_of(const std::string& station, int volume, UtcTime time, int number, char kind) {
    return fmt::format("{}/{}/{}-{:03}-{}", station, volume, dashed_time(time), number, kind);
}

// Reads the directory again if another process writes, renames or removes files in it meanwhile.
std::map<std::string, std::string> files_below(const std::filesystem::path& directory) {
    std::map<std::string, std::string> files;
    std::error_code error;
    std::filesystem::recursive_directory_iterator one(directory, error);
    while (!error && one != std::filesystem::recursive_directory_iterator{}) {
        std::error_code gone;
        if (one->is_regular_file(gone)) {
            std::ifstream file(one->path(), std::ios::binary);
            files[one->path().lexically_relative(directory).native()] = {
                std::istreambuf_iterator<char>(file), {}};
        }
        one.increment(error);
    }
    const bool is_there = std::filesystem::exists(directory);
    return error && is_there ? files_below(directory) : files;
}

void ChunkBucket::put(const std::string& key, std::string contents) {
    const std::scoped_lock lock(mutex_);
    const std::uint64_t size = contents.size();
    objects_[key] = {std::move(contents), size, now_utc()};
}

void ChunkBucket::put_volume(const std::string& station, int number, UtcTime time, int chunks,
                             bool has_end) {
    for (int i = 1; i <= chunks; ++i) {
        const char kind = i == 1 ? 'S' : i == chunks && has_end ? 'E' : 'I';
        const std::string key = key_of(station, number, time, i, kind);
        put(key, key);
    }
}

void ChunkBucket::remove(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    objects_.erase(key);
}

void ChunkBucket::say_size(const std::string& key, std::uint64_t bytes) {
    const std::scoped_lock lock(mutex_);
    objects_[key].said_bytes = bytes;
}

std::vector<std::string> ChunkBucket::asked() const {
    const std::scoped_lock lock(mutex_);
    return asked_;
}

std::size_t ChunkBucket::count(std::string_view request) const {
    const std::scoped_lock lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(
        asked_, [&](const std::string& one) { return one.starts_with(request); }));
}

std::map<std::string, std::string> ChunkBucket::objects() const {
    const std::scoped_lock lock(mutex_);
    std::map<std::string, std::string> all;
    for (const auto& [key, object] : objects_)
        all[key] = object.contents;
    return all;
}

std::string ChunkBucket::listing(const testing::Asked& asked) const {
    const std::string prefix = asked.parameter("prefix");
    const std::string after =
        std::max(asked.parameter("start-after"), asked.parameter("continuation-token"));
    const bool by_folders = !asked.parameter("delimiter").empty();
    const std::string most_keys = asked.parameter("max-keys");
    const int most = std::min(page_, most_keys.empty() ? 1000 : std::stoi(most_keys));
    std::string entries, last;
    std::set<std::string> folders;
    int count = 0;
    bool is_cut = false;
    for (const auto& [key, object] : objects_) {
        if (!key.starts_with(prefix) || key <= after) continue;
        const std::size_t slash = key.find('/', prefix.size());
        const bool is_folder = by_folders && slash != std::string::npos;
        const std::string folder = is_folder ? key.substr(0, slash + 1) : "";
        if (is_folder && (folders.contains(folder) || after.starts_with(folder))) {
            last = key;
            continue;
        }
        if (count == most) {
            is_cut = true;
            break;
        }
        ++count;
        last = key;
        if (is_folder) {
            folders.insert(folder);
            entries += fmt::format("<CommonPrefixes><Prefix>{}</Prefix></CommonPrefixes>", folder);
            continue;
        }
        entries += fmt::format(
            "<Contents><Key>{}</Key><LastModified>{}</LastModified><Size>{}</Size></Contents>", key,
            format_utc(object.modified), object.said_bytes);
    }
    if (is_cut) entries += fmt::format("<NextContinuationToken>{}</NextContinuationToken>", last);
    return fmt::format(
        "<?xml version=\"1.0\"?><ListBucketResult><IsTruncated>{}</IsTruncated>{}"
        "</ListBucketResult>",
        is_cut, entries);
}

testing::Reply ChunkBucket::answer(const testing::Asked& asked) {
    const bool lists = asked.parameter("list-type") == "2";
    const std::string key = lists ? "" : asked.key();
    const std::string text = lists ? "LIST " + asked.parameter("prefix") : "GET " + key;
    testing::Reply reply{404, "none"};
    {
        const std::scoped_lock lock(mutex_);
        asked_.push_back(text);
        const auto object = objects_.find(key);
        if (lists) reply = {200, listing(asked)};
        if (object != objects_.end()) reply = {200, object->second.contents};
    }
    return change(text, std::move(reply));
}

}  // namespace stormcellar::feed
