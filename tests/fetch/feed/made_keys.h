// tests/fetch/feed/made_keys.h -- lists the keys of a bucket in memory as Amazon S3 does.
#pragma once

#include <set>
#include <string>

#include "fetch/bucket/bucket_listing.h"
#include "tests/fetch/feed/chunk_bucket.h"

namespace stormcellar::feed {

inline constexpr std::uint64_t made_size = 100;

// Returns the answer to the question as one page of at most 1,000 keys.
[[nodiscard]] inline fetch::ListingPage listed(const std::set<std::string>& keys,
                                               const fetch::ListingQuestion& question) {
    fetch::ListingPage page;
    for (const std::string& key : keys) {
        if (!key.starts_with(question.prefix) || key <= question.start_after) continue;
        const std::size_t slash = key.find('/', question.prefix.size());
        if (question.by_folders && slash != std::string::npos) {
            const std::string folder = key.substr(0, slash + 1);
            if (page.folders.empty() || page.folders.back() != folder)
                page.folders.push_back(folder);
            continue;
        }
        if (page.objects.size() == 1000 ||
            page.objects.size() == static_cast<std::size_t>(question.most_keys))
            break;
        page.objects.push_back({key, made_size, std::nullopt, {}});
    }
    return page;
}

inline void add_volume(std::set<std::string>& keys, int number, UtcTime time, int chunks,
                       bool has_end = true) {
    for (int i = 1; i <= chunks; ++i)
        keys.insert(key_of("KTLX", number, time, i,
                           i == 1                   ? 'S'
                           : i == chunks && has_end ? 'E'
                                                    : 'I'));
}

}  // namespace stormcellar::feed
