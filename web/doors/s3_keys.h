// web/doors/s3_keys.h -- raw volumes in the order of their keys in the public bucket,
// YYYY/MM/DD/STATION/NAME.
//
// Keys sort by day, then by station, then by time. A walk asks the catalog for one station and one
// day at a time, by index; only where a day is at its end it asks all stations for their next
// volume.
//
// Threads   Many threads may use one object.
// Errors    Those of RawFiles.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "web/data/raw_files.h"

namespace stormcellar::web {

[[nodiscard]] std::string s3_key(const RawVolume& volume);

struct S3Key {
    std::chrono::sys_days day;
    std::string station, name;
};
// None if no volume can have the key.
[[nodiscard]] std::optional<S3Key> parse_s3_key(std::string_view key);

struct S3Object {
    std::string key;
    RawVolume volume;
};

class S3Keys {
  public:
    explicit S3Keys(std::shared_ptr<RawFiles> files) : files_(std::move(files)) {}

    // Returns objects from the first key on that is not less than `from`, at most `most` of them.
    // With `most` > 1 they may be fewer although there are more: only none means that the end is
    // reached.
    [[nodiscard]] Result<std::vector<S3Object>> from(std::string_view from, std::size_t most) const;

  private:
    using Stations = std::vector<std::string>;  // sorted
    [[nodiscard]] Result<Stations> stations() const;
    [[nodiscard]] Result<std::vector<S3Object>> of_day(std::chrono::sys_days day,
                                                       std::string_view from,
                                                       const Stations& stations,
                                                       std::size_t most) const;
    // The first day from this one on that has a volume.
    [[nodiscard]] Result<std::optional<std::chrono::sys_days>> next_day(
        std::chrono::sys_days day, const Stations& stations) const;
    const std::shared_ptr<RawFiles> files_;
};

}  // namespace stormcellar::web
