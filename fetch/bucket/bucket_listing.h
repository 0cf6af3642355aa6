// fetch/bucket/bucket_listing.h -- reads the listing of a public bucket of Level II files.
//
// The keys of the bucket are YYYY/MM/DD/STATION/NAME (docs/data-sources.md). A GET of
// ?list-type=2&prefix=... returns a listing (ListObjectsV2 of Amazon S3 and compatible servers). A
// long listing comes in pages. Each page but the last has a token, with which to ask for the next
// page.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::fetch {

struct BucketObject {
    std::string key;
    std::uint64_t size_bytes = 0;
    std::optional<UtcTime> modified;
    std::string tag;  // ETag of the content, in quotes; empty if the listing has none
};

struct ListingPage {
    std::vector<BucketObject> objects;
    std::vector<std::string> folders;  // prefixes that a listing by folders returns, each ending in
                                       // '/'
    std::string next_token;            // empty: this is the last page
};

struct ListingQuestion {
    std::string prefix;
    std::string start_after = {};  // list only keys after this key; empty: all
    bool by_folders = false;       // list the folders below the prefix, and no objects
    int most_keys = 1000;          // in one page
    std::string token = {};        // next_token of the page before; empty: ask for the first page
};

// Parses a page. Errors: corrupt if the text is not a listing, or if it has more pages but no
// token.
[[nodiscard]] Result<ListingPage> parse_listing(std::span<const std::byte> xml);

// Returns the URL of a listing. `source` is the URL of the bucket: "https://HOST" or
// "https://HOST/BUCKET".
[[nodiscard]] std::string listing_url(std::string_view source, std::string_view prefix,
                                      std::string_view token);
[[nodiscard]] std::string listing_url(std::string_view source, const ListingQuestion& question);
[[nodiscard]] std::string object_url(std::string_view source, std::string_view key);

// Returns a prefix such as "2017/01/01/KTLX/" for each station and each day from `from` to `to`.
// The day before `from` is not needed, because a volume is listed under the day of its start.
[[nodiscard]] std::vector<std::string> prefixes_of(const std::vector<std::string>& stations,
                                                   UtcTime from, UtcTime to);

// Returns the last part of a key.
[[nodiscard]] std::string_view name_of_key(std::string_view key);
// Returns the time in a name such as KTLX20170101_030027_V06; none if the name has no time.
[[nodiscard]] std::optional<UtcTime> start_in_name(std::string_view name);
// Returns true for a name of metadata without radials, such as KTLX20170101_030027_V06_MDM.
[[nodiscard]] bool is_metadata_name(std::string_view name);

}  // namespace stormcellar::fetch
