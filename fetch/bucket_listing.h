// fetch/bucket_listing.h -- what a public bucket of Level II files holds, by its listing API.
//
// The bucket's keys are YYYY/MM/DD/STATION/NAME (docs/data-sources.md); a listing is a
// GET of ?list-type=2&prefix=..., in pages that a token continues (Amazon S3, ListObjectsV2). Other
// servers answer the same. Thread contract: functions are pure.
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
    std::string tag;  // of its contents (ETag), in quotes; empty: the listing has none
};

struct ListingPage {
    std::vector<BucketObject> objects;
    std::string next_token;  // empty: this is the last page
};

// Errors: corrupt where the text is no listing, or one that says that it goes on and not where.
[[nodiscard]] Result<ListingPage> parse_listing(std::span<const std::byte> xml);

// `source`: the bucket's address, "https://HOST" or "https://HOST/BUCKET".
[[nodiscard]] std::string listing_url(std::string_view source, std::string_view prefix,
                                      std::string_view token);
[[nodiscard]] std::string object_url(std::string_view source, std::string_view key);

// "2017/01/01/KTLX/" for each day from `from` to `to` and each station. The day before `from` is
// not among them: a volume stands under the day of its start.
[[nodiscard]] std::vector<std::string> prefixes_of(const std::vector<std::string>& stations,
                                                   UtcTime from, UtcTime to);

// The last part of a key.
[[nodiscard]] std::string_view name_of_key(std::string_view key);
// The start that a name like KTLX20170101_030027_V06 gives; none where it gives none.
[[nodiscard]] std::optional<UtcTime> start_in_name(std::string_view name);
// Metadata without radials, as KTLX20170101_030027_V06_MDM.
[[nodiscard]] bool is_metadata_name(std::string_view name);

}  // namespace stormcellar::fetch
