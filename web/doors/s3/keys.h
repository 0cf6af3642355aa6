// web/doors/s3/keys.h -- raw volumes in the order of their keys in the public bucket,
// YYYY/MM/DD/STATION/NAME.
//
// Keys are in the order of days, then of stations, then of times. A walk reads one station and one
// day at a time through the catalog's index; at the end of a day it asks all stations for their
// next volume. A walk has an end bound, so a list of one station's day reads nothing else.
//
// Threads   One thread at a time.
// Errors    Those of RawFiles.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "web/data/raw/raw_files.h"

namespace stormcellar::web {

[[nodiscard]] std::string s3_key(const RawVolume& volume);

struct S3Key {
    std::chrono::sys_days day;
    std::string station, name;
};
// Returns none if no volume can have the key.
[[nodiscard]] std::optional<S3Key> parse_s3_key(std::string_view key);

struct S3Object {
    std::string key;
    RawVolume volume;
};

// The bucket as one list sees it. It reads the stations once, at its first query.
class S3Keys {
  public:
    explicit S3Keys(std::shared_ptr<RawFiles> files) : files_(std::move(files)) {}

    // Returns objects from the first key that is not less than `from`, with keys less than `end`
    // (empty: no bound), at most `most` of them. With `most` > 1 the result may be shorter although
    // more objects follow; only an empty result means that the end is reached.
    [[nodiscard]] Result<std::vector<S3Object>> between(std::string_view from, std::string_view end,
                                                        std::size_t most);

  private:
    using Stations = std::vector<std::string>;  // sorted
    [[nodiscard]] Status find_stations();
    [[nodiscard]] Result<std::vector<S3Object>> of_day(std::chrono::sys_days day,
                                                       std::string_view from, std::string_view end,
                                                       std::size_t most) const;
    // Returns the first day, `day` or later, that has a volume.
    [[nodiscard]] Result<std::optional<std::chrono::sys_days>> next_day(
        std::chrono::sys_days day) const;
    const std::shared_ptr<RawFiles> files_;
    std::optional<Stations> stations_;
};

}  // namespace stormcellar::web
