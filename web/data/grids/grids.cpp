#include "web/data/grids/grids.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <deque>
#include <map>
#include <unordered_map>
#include <utility>

#include <sys/stat.h>

#include "base/beneath.h"
#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/cache/grid_name.h"
#include "web/data/grids/cache_watch.h"

namespace stormcellar::web {

// Identifies a file. A later file with the same name differs in at least one member.
struct GridFileStamp {
    std::uint64_t device = 0, inode = 0, size = 0;
    std::int64_t modified_ns = 0;
    bool operator==(const GridFileStamp&) const = default;
};

namespace {

constexpr std::size_t most_evicted_remembered = 65536;
constexpr std::size_t opening_locks = 32;
// After this time, look at the file itself again, because the watch does not see changes of
// directories above the cache.
constexpr std::chrono::milliseconds look_again_after{100};

GridFileStamp stamp_of_grid(const struct stat& facts) {
    return {facts.st_dev, facts.st_ino, static_cast<std::uint64_t>(facts.st_size),
            std::int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec};
}

// Returns how much memory an open grid holds. Codes that are mapped do not count.
std::uint64_t memory_of(const cache::GridFile& file) {
    const grid::BrickView view = file.view();
    std::uint64_t bytes = 16384 + view.bricks.size_bytes() + view.states.size();
    if (file.packing() == cache::Packing::none) return bytes;
    const auto stored =
        std::count_if(view.bricks.begin(), view.bricks.end(),
                      [](const auto& brick) { return brick.kind == grid::BrickKind::stored; });
    return bytes + static_cast<std::uint64_t>(stored) * grid::brick_cells *
                       static_cast<std::uint64_t>(view.quantization.code_bytes);
}

}  // namespace

struct Grids::Impl {
    explicit Impl(GridsOptions given)
        : options(std::move(given)),
          open({.weight = options.most_open_bytes, .values = options.most_open}) {}

    void take(const CacheChange& change);
    void remember_evicted(const cache::GridName& name) STORMCELLAR_REQUIRES(names_mutex);
    void drop_open(const cache::GridName& name);
    std::shared_ptr<const OpenGrid> find_open(const cache::GridName& name,
                                              const GridFileStamp& stamp);
    void keep_open(const cache::GridName& name, const GridFileStamp& stamp,
                   const std::shared_ptr<const OpenGrid>& grid);

    using OfDomain = std::map<level2::Moment, std::vector<UtcTime>>;
    struct Open {
        GridFileStamp stamp;
        std::shared_ptr<const OpenGrid> grid;
        // The time at which the open file was last compared with the file that has its name now,
        // and the count of changes at that time.
        std::chrono::steady_clock::time_point seen_at{};
        std::uint64_t seen_changes = 0;
    };
    // Returns the grid if it was compared a moment ago and nothing has changed since.
    std::shared_ptr<const OpenGrid> find_seen(const cache::GridName& name);

    const GridsOptions options;
    std::atomic<std::uint64_t> changes{0};

    mutable SharedMutex names_mutex;
    std::map<std::string, OfDomain, std::less<>> names STORMCELLAR_GUARDED_BY(names_mutex);
    // Counts of changes by group.
    std::map<std::string, std::uint64_t, std::less<>> changes_of
        STORMCELLAR_GUARDED_BY(names_mutex);
    // The number of the last eviction of each name. An entry of `evicted_order` with another number
    // is out of date.
    std::map<cache::GridName, std::uint64_t> evicted STORMCELLAR_GUARDED_BY(names_mutex);
    std::deque<std::pair<std::uint64_t, cache::GridName>> evicted_order
        STORMCELLAR_GUARDED_BY(names_mutex);
    std::uint64_t evictions STORMCELLAR_GUARDED_BY(names_mutex) = 0;

    Mutex open_mutex;
    RecentlyUsed<cache::GridName, Open> open STORMCELLAR_GUARDED_BY(open_mutex);
    std::array<Mutex, opening_locks> opening;  // each is for the grids whose paths hash to it

    Mutex listeners_mutex;
    std::vector<std::function<void(const CacheChange&)>> listeners
        STORMCELLAR_GUARDED_BY(listeners_mutex);

    std::unique_ptr<CacheWatch> watch;  // the last member, so that it ends first
};

void Grids::Impl::remember_evicted(const cache::GridName& name) {
    evicted[name] = ++evictions;
    evicted_order.emplace_back(evictions, name);
    while (evicted_order.size() > most_evicted_remembered) {
        const auto found = evicted.find(evicted_order.front().second);
        if (found != evicted.end() && found->second == evicted_order.front().first) {
            evicted.erase(found);
        }
        evicted_order.pop_front();
    }
}

void Grids::Impl::take(const CacheChange& change) {
    if (change.event != CacheEvent::everything) {
        const MutexLock lock(names_mutex);
        ++changes_of[std::string(cache::group_of(change.grid.domain))];
        std::vector<UtcTime>& times = names[change.grid.domain][change.grid.moment];
        const auto at = std::lower_bound(times.begin(), times.end(), change.grid.time);
        const bool is_listed = at != times.end() && *at == change.grid.time;
        if (change.event == CacheEvent::went) {
            if (is_listed) times.erase(at);
            remember_evicted(change.grid);
            OfDomain& of_domain = names[change.grid.domain];
            if (times.empty()) of_domain.erase(change.grid.moment);
            if (of_domain.empty()) names.erase(change.grid.domain);
        } else if (!is_listed) {
            times.insert(at, change.grid.time);
            evicted.erase(change.grid);
        }
    }
    ++changes;
    if (change.event == CacheEvent::went || change.event == CacheEvent::changed) {
        drop_open(change.grid);
    }
    const MutexLock lock(listeners_mutex);
    for (const auto& listener : listeners)
        listener(change);
}

void Grids::Impl::drop_open(const cache::GridName& name) {
    const MutexLock lock(open_mutex);
    open.drop(name);
}

std::shared_ptr<const OpenGrid> Grids::Impl::find_open(const cache::GridName& name,
                                                       const GridFileStamp& stamp) {
    const MutexLock lock(open_mutex);
    Open* found = open.find(name);
    if (found == nullptr || found->stamp != stamp) return nullptr;
    found->seen_at = std::chrono::steady_clock::now();
    found->seen_changes = changes;
    return found->grid;
}

std::shared_ptr<const OpenGrid> Grids::Impl::find_seen(const cache::GridName& name) {
    const MutexLock lock(open_mutex);
    const Open* seen = open.find(name);
    if (seen == nullptr) return nullptr;
    const auto age = std::chrono::steady_clock::now() - seen->seen_at;
    if (seen->seen_changes != changes || age > look_again_after) return nullptr;
    return seen->grid;
}

void Grids::Impl::keep_open(const cache::GridName& name, const GridFileStamp& stamp,
                            const std::shared_ptr<const OpenGrid>& grid) {
    const MutexLock lock(open_mutex);
    open.keep(name, {stamp, grid, {}, 0}, memory_of(grid->file));
}

Grids::Grids(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Grids::~Grids() = default;

Result<std::shared_ptr<Grids>> Grids::open(GridsOptions options) {
    if (options.cache.empty()) {
        return fail(ErrorCode::bad_argument, "no directory of a cache is given");
    }
    auto impl = std::make_unique<Impl>(std::move(options));
    Impl* taking = impl.get();
    impl->watch = CacheWatch::open(impl->options.cache,
                                   [taking](const CacheChange& change) { taking->take(change); });
    return std::shared_ptr<Grids>(new Grids(std::move(impl)));
}

std::vector<std::string> Grids::domains() const {
    impl_->watch->catch_up();
    const SharedLock lock(impl_->names_mutex);
    std::vector<std::string> domains;
    domains.reserve(impl_->names.size());
    for (const auto& [domain, moments] : impl_->names)
        domains.push_back(domain);
    return domains;
}

std::vector<level2::Moment> Grids::moments(std::string_view domain) const {
    impl_->watch->catch_up();
    const SharedLock lock(impl_->names_mutex);
    std::vector<level2::Moment> moments;
    const auto found = impl_->names.find(domain);
    if (found == impl_->names.end()) return moments;
    for (const auto& [moment, times] : found->second)
        moments.push_back(moment);
    return moments;
}

std::vector<UtcTime> Grids::times(std::string_view domain, level2::Moment moment,
                                  std::optional<UtcTime> from, std::optional<UtcTime> to) const {
    impl_->watch->catch_up();
    const SharedLock lock(impl_->names_mutex);
    const auto found = impl_->names.find(domain);
    if (found == impl_->names.end()) return {};
    const auto times = found->second.find(moment);
    if (times == found->second.end()) return {};
    const auto& all = times->second;
    const auto first = from ? std::lower_bound(all.begin(), all.end(), *from) : all.begin();
    const auto last = to ? std::upper_bound(all.begin(), all.end(), *to) : all.end();
    if (first >= last) return {};
    return {first, last};
}

UtcTime newest_believed(std::span<const UtcTime> times) {
    const auto end = std::ranges::partition_point(
        times, [now = now_utc()](UtcTime time) { return is_believed(time, now); });
    return end == times.begin() ? times.back() : *(end - 1);
}

std::optional<UtcTime> Grids::newest(std::string_view domain, level2::Moment moment) const {
    impl_->watch->catch_up();
    const SharedLock lock(impl_->names_mutex);
    const auto found = impl_->names.find(domain);
    if (found == impl_->names.end()) return std::nullopt;
    const auto times = found->second.find(moment);
    if (times == found->second.end()) return std::nullopt;
    return newest_believed(times->second);
}

Result<std::shared_ptr<const OpenGrid>> Grids::find(std::string_view domain, level2::Moment moment,
                                                    UtcTime time) {
    impl_->watch->catch_up();
    const cache::GridName name{std::string(domain), moment, time};
    if (!cache::is_domain_name(domain) || !cache::is_possible(time)) {
        return fail(ErrorCode::not_found, "there is no such domain or time");
    }
    const std::filesystem::path path = impl_->options.cache / cache::relative_path(name);
    // Do not follow a link on the way; then the file is not found.
    const Result<struct stat> facts = look_beneath(impl_->options.cache, path);
    if (!facts && facts.error().code != ErrorCode::not_found) return pass_on(facts);
    if (!facts || !S_ISREG(facts->st_mode)) {
        return fail(ErrorCode::not_found, "there is no grid of {}, {}, at {}", domain,
                    level2::moment_name(moment), format_utc(time));
    }
    if (auto kept = impl_->find_open(name, stamp_of_grid(*facts))) return kept;

    // If several requests want the same grid at the same time, one opens it and the others wait.
    const std::size_t hash = std::hash<std::string>{}(path.native());
    const MutexLock lock(impl_->opening[hash % opening_locks]);
    if (auto kept = impl_->find_open(name, stamp_of_grid(*facts))) return kept;
    Result<cache::GridFile> file = cache::GridFile::open(path);
    if (!file) return pass_on(file);
    std::string id = fmt::format("{:016x}", file->checksum());
    auto grid = std::make_shared<const OpenGrid>(
        OpenGrid{std::move(*file), name.domain, moment, time, std::move(id)});
    // If the file was replaced after the look, the stamp does not match the new file, and the next
    // request opens the new file.
    impl_->keep_open(name, stamp_of_grid(*facts), grid);
    return grid;
}

std::shared_ptr<const OpenGrid> Grids::find_if_open(std::string_view domain, level2::Moment moment,
                                                    UtcTime time) {
    impl_->watch->catch_up();
    const cache::GridName name{std::string(domain), moment, time};
    if (!cache::is_domain_name(domain) || !cache::is_possible(time)) return nullptr;
    if (auto seen = impl_->find_seen(name); seen && !impl_->watch->problem()) return seen;
    const Result<struct stat> facts =
        look_beneath(impl_->options.cache, impl_->options.cache / cache::relative_path(name));
    return facts ? impl_->find_open(name, stamp_of_grid(*facts)) : nullptr;
}

bool Grids::was_evicted(std::string_view domain, level2::Moment moment, UtcTime time) const {
    impl_->watch->catch_up();
    const SharedLock lock(impl_->names_mutex);
    return impl_->evicted.contains({std::string(domain), moment, time});
}

std::uint64_t Grids::changes() const {
    impl_->watch->catch_up();
    return impl_->changes;
}

std::uint64_t Grids::changes_of(std::string_view group) const {
    impl_->watch->catch_up();
    const SharedLock lock(impl_->names_mutex);
    const auto found = impl_->changes_of.find(group);
    return found == impl_->changes_of.end() ? 0 : found->second;
}

void Grids::refresh() {
    impl_->watch->rescan();
}

void Grids::listen(std::function<void(const CacheChange&)> listener) {
    const MutexLock lock(impl_->listeners_mutex);
    impl_->listeners.push_back(std::move(listener));
}

std::optional<std::string> Grids::problem() const {
    return impl_->watch->problem();
}

const std::filesystem::path& Grids::cache() const {
    return impl_->options.cache;
}

}  // namespace stormcellar::web
