#include "web/data/zarr/time_numbers.h"

#include <bit>
#include <cstring>
#include <system_error>

#include "base/checksum.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::web {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");
constexpr std::string_view magic = "stormcellar time";  // 16 bytes
constexpr std::size_t number_bytes = 8;

std::vector<std::byte> bytes_of(const std::vector<UtcTime>& times) {
    std::vector<std::byte> bytes(magic.size() + (times.size() + 1) * number_bytes);
    std::memcpy(bytes.data(), magic.data(), magic.size());
    std::byte* at = bytes.data() + magic.size();
    for (const UtcTime time : times) {
        const std::int64_t ms = time.time_since_epoch().count();
        std::memcpy(at, &ms, number_bytes);
        at += number_bytes;
    }
    const std::uint64_t sum = xxh3_64(std::span(bytes).first(bytes.size() - number_bytes));
    std::memcpy(at, &sum, number_bytes);
    return bytes;
}

// Returns the times in the bytes of such a file; none if the bytes are damaged.
std::optional<std::vector<UtcTime>> times_in(std::span<const std::byte> bytes) {
    if (bytes.size() < magic.size() + number_bytes || bytes.size() % number_bytes != 0 ||
        std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
        return std::nullopt;
    const std::size_t end = bytes.size() - number_bytes;
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + end, number_bytes);
    if (sum != xxh3_64(bytes.first(end))) return std::nullopt;
    std::vector<UtcTime> times;
    for (std::size_t at = magic.size(); at < end; at += number_bytes) {
        std::int64_t ms = 0;
        std::memcpy(&ms, bytes.data() + at, number_bytes);
        times.emplace_back(std::chrono::milliseconds{ms});
    }
    return times;
}

}  // namespace

std::filesystem::path TimeNumbers::path_of(const Key& key) const {
    return directory_ / key.first / (key.second + ".times");
}

Result<TimeNumbers::Series*> TimeNumbers::loaded(const Key& key) {
    const auto found = series_.find(key);
    if (found != series_.end()) return &found->second;
    auto times = std::make_shared<std::vector<UtcTime>>();
    if (!directory_.empty()) {
        const auto path = path_of(key);
        const auto bytes = read_file(path, magic.size() + (most_times + 1) * number_bytes);
        if (bytes) {
            auto read = times_in(*bytes);
            if (!read)
                return fail(ErrorCode::corrupt,
                            "{}: the numbers of times are damaged; remove the file to give new "
                            "ones",
                            path.native());
            *times = std::move(*read);
        } else if (bytes.error().code != ErrorCode::not_found) {
            return pass_on(bytes);
        }
    }
    Series series;
    for (std::size_t number = 0; number < times->size(); ++number)
        series.numbers.emplace((*times)[number].time_since_epoch().count(), number);
    series.times = std::move(times);
    return &series_.emplace(key, std::move(series)).first->second;
}

Status TimeNumbers::save(const Key& key, const std::vector<UtcTime>& times) const {
    if (directory_.empty()) return {};
    const auto path = path_of(key);
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (failed) {
        return fail(ErrorCode::io, "{}: cannot be made: {}", path.parent_path().native(),
                    failed.message());
    }
    return write_file_atomically(real_file_system(), path, bytes_of(times));
}

Result<std::shared_ptr<const std::vector<UtcTime>>> TimeNumbers::update(
    std::string_view domain, std::string_view name, std::span<const UtcTime> present) {
    const MutexLock lock(mutex_);
    const Key key{domain, name};
    const auto series = loaded(key);
    if (!series) return pass_on(series);
    std::vector<UtcTime> fresh;
    for (const UtcTime time : present)
        if (!(*series)->numbers.contains(time.time_since_epoch().count())) fresh.push_back(time);
    if (fresh.empty()) return (*series)->times;
    auto times = std::make_shared<std::vector<UtcTime>>(*(*series)->times);
    times->insert(times->end(), fresh.begin(), fresh.end());
    if (times->size() > most_times)
        return fail(ErrorCode::exhausted, "{}: more than {} times have numbers", domain,
                    most_times);
    const Status saved = save(key, *times);
    problem_ = saved ? std::nullopt : std::optional(saved.error().message);
    if (!saved && (*series)->times->empty())
        return fail(ErrorCode::busy, "the numbers of the times of {} cannot be kept now", domain);
    if (!saved) return (*series)->times;
    for (std::size_t number = (*series)->times->size(); number < times->size(); ++number)
        (*series)->numbers.emplace((*times)[number].time_since_epoch().count(), number);
    (*series)->times = std::move(times);
    return (*series)->times;
}

std::optional<std::string> TimeNumbers::problem() const {
    const MutexLock lock(mutex_);
    return problem_;
}

// Ignores a file that cannot be removed: it does no harm, and the next start tries again.
void TimeNumbers::remove_leftovers() const {
    std::error_code failed;
    for (std::filesystem::directory_iterator at(directory_, failed), end; !failed && at != end;
         at.increment(failed)) {
        if (at->is_directory(failed)) (void)remove_temporaries(real_file_system(), at->path());
    }
}

std::optional<UtcTime> TimeNumbers::time_of(std::string_view domain, std::string_view name,
                                            std::size_t number) const {
    const MutexLock lock(mutex_);
    const auto found = series_.find(Key{domain, name});
    if (found == series_.end() || number >= found->second.times->size()) return std::nullopt;
    return (*found->second.times)[number];
}

}  // namespace stormcellar::web
