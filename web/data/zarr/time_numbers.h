// web/data/zarr/time_numbers.h -- gives numbers to the times of a domain's grids or a
// station's volumes. The number is the index of the time in the Zarr arrays.
//
// A time gets a number when it is first seen. Times that are seen together get numbers in ascending
// order. A time keeps its number after its grid is evicted and after a restart, so that an index
// that a client holds never means another time. So a grid that comes late has a higher number than
// a newer grid.
//
// With a directory, DIRECTORY/DOMAIN/NAME.times holds the numbers: the 16 bytes "stormcellar
// time", then the times in the order of their numbers (int64, little-endian, milliseconds since
// 1970 UTC), then the XXH3-64 of all bytes before it. The file appears by rename. Each grid adds 8
// bytes. Without a directory the numbers live as long as this object.
//
// Threads   Many threads may use it.
// Errors    io and permission if the numbers cannot be read; busy if the numbers cannot be kept and
//           no time has a number yet; corrupt for a damaged file, which must be removed by hand,
//           because clients may hold its numbers; exhausted beyond `most_times`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::web {

class TimeNumbers {
  public:
    // Enough for ten years of one radar.
    static constexpr std::size_t most_times = std::size_t{1} << 20;

    // If the directory is empty, the numbers are not kept on disk.
    explicit TimeNumbers(std::filesystem::path directory) : directory_(std::move(directory)) {}

    // Gives numbers to those times of `present` (sorted) that have none. Returns the times of all
    // numbers, in the order of the numbers. While numbers cannot be kept, gives no new ones.
    // `domain` must be the name of a domain of the cache or of a station. `name` must be the name
    // of a moment, or another name that a path may have, such as VCP-212.
    [[nodiscard]] Result<std::shared_ptr<const std::vector<UtcTime>>> update(
        std::string_view domain, std::string_view name, std::span<const UtcTime> present);
    // Returns the time that has a number. Returns none if no time has it, or before the first
    // update() of this domain and name. Takes microseconds.
    [[nodiscard]] std::optional<UtcTime> time_of(std::string_view domain, std::string_view name,
                                                 std::size_t number) const;
    // Returns the reason why the last numbers could not be kept. Returns none if they were kept.
    [[nodiscard]] std::optional<std::string> problem() const;
    // Removes files that a killed server left in the directory. Nothing else may write there.
    void remove_leftovers() const;

  private:
    struct Series {
        std::shared_ptr<const std::vector<UtcTime>> times;
        std::unordered_map<std::int64_t, std::size_t> numbers;  // by milliseconds
    };
    using Key = std::pair<std::string, std::string>;  // domain, name

    [[nodiscard]] std::filesystem::path path_of(const Key& key) const;
    [[nodiscard]] Result<Series*> loaded(const Key& key) STORMCELLAR_REQUIRES(mutex_);
    [[nodiscard]] Status save(const Key& key, const std::vector<UtcTime>& times) const;

    const std::filesystem::path directory_;
    mutable Mutex mutex_;
    std::map<Key, Series> series_ STORMCELLAR_GUARDED_BY(mutex_);
    std::optional<std::string> problem_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
