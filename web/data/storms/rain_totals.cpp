#include "web/data/storms/rain_totals.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/stat.h>

#include "render/products/rain_of_domain.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t bytes_beside_file = 16384;

// A directory that is removed with its files.
class ShortLivedDirectory {
  public:
    ShortLivedDirectory() {
        std::error_code error;
        std::string name = (fs::temp_directory_path(error) / "stormcellar-rain-XXXXXX").native();
        if (!error && ::mkdtemp(name.data()) != nullptr) path_ = name;
    }
    ShortLivedDirectory(const ShortLivedDirectory&) = delete;
    ShortLivedDirectory& operator=(const ShortLivedDirectory&) = delete;
    ~ShortLivedDirectory() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    [[nodiscard]] const fs::path& path() const { return path_; }  // empty: could not be made

  private:
    fs::path path_;
};

// Returns the total as an open file that no longer has a name.
Result<cache::GridFile> file_of(const render::RainTotalGrid& total) {
    const auto bricks = total.bricks();
    if (!bricks) return pass_on(bricks);
    const ShortLivedDirectory directory;
    if (directory.path().empty())
        return fail(ErrorCode::no_space, "there is no directory for a rain total");
    const fs::path path = directory.path() / "total.scg";
    const auto written =
        cache::write_grid_file(real_file_system(), path, total.description(), bricks->view());
    if (!written) return pass_on(written);
    return cache::GridFile::open(path);
}

// Tells files apart. A grid that is made again is another file.
std::string stamps_of(const std::vector<cache::StoreEntry>& entries) {
    std::string all;
    for (const cache::StoreEntry& entry : entries) {
        struct stat facts {};
        if (::stat(entry.path.c_str(), &facts) != 0) continue;
        all += fmt::format("{} {} {} {}.{}\n", entry.path.native(), facts.st_ino, facts.st_size,
                           facts.st_mtim.tv_sec, facts.st_mtim.tv_nsec);
    }
    return all;
}

Error not_ready() {
    return {ErrorCode::busy, "the rain total is being made; ask again in some seconds"};
}

}  // namespace

struct RainTotals::Wish {
    render::RainOfDomain rain;
    UtcTime time;
    std::vector<cache::StoreEntry> entries;
    std::uint64_t changes = 0;  // in the domain before the entries were listed
    std::string inputs;
};

RainTotals::RainTotals(RainTotalsOptions options)
    : options_(std::move(options)),
      kept_({.weight = options_.budget_bytes}),
      makers_(1, options_.most_in_line) {}

RainTotals::~RainTotals() {
    is_stopping_ = true;
}

level2::Moment RainTotals::listed_moment(const Grids& grids, std::string_view domain) {
    const bool has_reflectivity = grids.newest(domain, level2::Moment::ref).has_value();
    return has_reflectivity ? level2::Moment::ref : level2::Moment::rate;
}

Result<RainTotals::Wish> RainTotals::wish_of(const Name& name) const {
    const auto& [domain, hours, time] = name;
    Grids& grids = *options_.grids;
    Wish wish;
    wish.changes = grids.changes_of(cache::group_of(domain));
    const auto last = grids.find(domain, listed_moment(grids, domain), time);
    if (!last) return pass_on(last);
    const cache::GridDescription& description = (*last)->file.description();
    wish.time = time;
    wish.rain = {domain, render::span_ending(render::middle_of(description), hours), time,
                 options_.threads, [this] { return is_stopping_.load(); }};
    const auto store = cache::StoreReader::open(grids.cache());
    if (!store) return pass_on(store);
    auto entries = render::rain_entries(*store, wish.rain);
    if (!entries) return pass_on(entries);
    wish.entries = std::move(*entries);
    wish.inputs = stamps_of(wish.entries);
    const double columns = static_cast<double>(description.spec.nx) * description.spec.ny *
                           static_cast<double>(wish.entries.size());
    if (wish.entries.size() > options_.most_grids || columns > options_.most_columns) {
        return fail(ErrorCode::bad_argument,
                    "the rain total of {} grids of {} by {} columns is too large for this server; "
                    "`stormcellar frame` makes it",
                    wish.entries.size(), description.spec.nx, description.spec.ny);
    }
    return wish;
}

Result<RainTotals::Total> RainTotals::make(const Wish& wish) const {
    const auto total = render::rain_total_of(wish.entries, wish.rain);
    if (!total) return pass_on(total);
    auto file = file_of(*total);
    if (!file) return pass_on(file);
    std::string id = fmt::format("rain{:016x}", file->checksum());
    return std::make_shared<const OpenGrid>(OpenGrid{
        std::move(*file), wish.rain.domain, level2::Moment::rate, wish.time, std::move(id)});
}

RainTotals::Total RainTotals::find_if_kept(const std::string& domain, int hours, UtcTime time) {
    const std::uint64_t changes = options_.grids->changes_of(cache::group_of(domain));
    const MutexLock lock(mutex_);
    const Kept* const kept = kept_.find({domain, hours, time});
    return kept != nullptr && kept->changes == changes && kept->total ? *kept->total : nullptr;
}

Result<RainTotals::Total> RainTotals::find(const std::string& domain, int hours, UtcTime time) {
    if (auto kept = find_if_kept(domain, hours, time)) return kept;
    const Name name{domain, hours, time};
    const auto wish = wish_of(name);
    if (!wish) return pass_on(wish);
    const MutexLock lock(mutex_);
    if (Kept* const kept = kept_.find(name); kept != nullptr && kept->inputs == wish->inputs) {
        kept->changes = wish->changes;
        return kept->total;
    }
    return wait_for(name, wish->inputs);
}

RainTotals::Kept RainTotals::made_now(const Name& name) const {
    auto wish = wish_of(name);
    if (!wish) return {{}, 0, pass_on(wish)};
    auto total = make(*wish);
    // After any other error, another try may have more success.
    const bool is_final = total || total.error().code == ErrorCode::bad_argument;
    return {is_final ? std::move(wish->inputs) : std::string{}, wish->changes, std::move(total)};
}

// Puts the total in line, and waits for it if nobody else waits.
Result<RainTotals::Total> RainTotals::wait_for(const Name& name, const std::string& inputs) {
    if (making_.insert(name).second) {
        const auto work = [this, name](WorkQueue::Turn turn) {
            std::optional<Kept> kept;
            try {
                if (turn == WorkQueue::Turn::came) kept = made_now(name);
            } catch (const std::exception&) {
                kept =
                    Kept{{}, 0, fail(ErrorCode::exhausted, "there is no memory for a rain total")};
            }
            const MutexLock done(mutex_);
            if (kept) {
                const std::uint64_t bytes = kept->total ? (*kept->total)->file.bytes() : 0;
                kept_.keep(name, std::move(*kept), bytes + bytes_beside_file);
                ++made_;
            }
            making_.erase(name);
            ready_.notify_all();
        };
        const MutexUnlock unlocked(mutex_);
        if (!makers_.add({}, work)) {
            const MutexLock again(mutex_);
            making_.erase(name);
            ready_.notify_all();
        }
    }
    if (is_waiting_) return tl::unexpected(not_ready());
    is_waiting_ = true;
    const auto end = std::chrono::steady_clock::now() + options_.patience;
    while (making_.contains(name) && ready_.wait_until(mutex_, end) != std::cv_status::timeout) {
    }
    is_waiting_ = false;
    const Kept* const kept = kept_.find(name);
    if (kept == nullptr || (making_.contains(name) && kept->inputs != inputs))
        return tl::unexpected(not_ready());
    return kept->total;
}

}  // namespace stormcellar::web
