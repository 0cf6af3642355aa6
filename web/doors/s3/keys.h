// web/doors/s3/keys.h -- lists raw volumes in the order of their keys in the public bucket,
// YYYY/MM/DD/STATION/NAME.
//
// Keys are in the order of days, then of stations, then of times. A walk through the keys reads one
// station and one day at a time, through the catalog's index. At the end of a day it asks all
// stations for their next volume. A walk has an end, so a list of one station's day reads nothing
// else.
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
// Returns the parts of a key, or none if no volume can have this key.
[[nodiscard]] std::optional<S3Key> parse_s3_key(std::string_view key);

struct S3Object {
    std::string key;
    RawVolume volume;
};

// A bucket during one list.
class S3Walk {
  public:
    virtual ~S3Walk() = default;
    // Returns at most `most` objects, from the first key that is not less than `from`, with keys
    // less than `end` (empty: no bound). If `most` is above 1, the result may be shorter although
    // more objects follow; only an empty result means that there are no more. If `most` is 1, the
    // object may lack its size, time and tag, which complete() adds.
    [[nodiscard]] virtual Result<std::vector<S3Object>> between(std::string_view from,
                                                                std::string_view end,
                                                                std::size_t most) = 0;
    virtual Status complete(S3Object& object) = 0;
};

// The bucket of volumes. The stations are read once, at the first query.
class S3Keys final : public S3Walk {
  public:
    explicit S3Keys(std::shared_ptr<RawFiles> files) : files_(std::move(files)) {}
    [[nodiscard]] Result<std::vector<S3Object>> between(std::string_view from, std::string_view end,
                                                        std::size_t most) override;
    Status complete(S3Object& /*object*/) override { return {}; }

  private:
    using Stations = std::vector<std::string>;  // sorted
    [[nodiscard]] Status find_stations();
    [[nodiscard]] Result<std::vector<S3Object>> of_day(std::chrono::sys_days day,
                                                       std::string_view from, std::string_view end,
                                                       std::size_t most) const;
    // Returns the first day, not before `day`, that has a volume.
    [[nodiscard]] Result<std::optional<std::chrono::sys_days>> next_day(
        std::chrono::sys_days day) const;
    const std::shared_ptr<RawFiles> files_;
    std::optional<Stations> stations_;
};

}  // namespace stormcellar::web
