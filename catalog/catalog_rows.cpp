// What a writer does to all rows now and then: marks those of files that went, and deletes old
// ones. One station's database that cannot be used does not keep it from the others (troubles()).
#include <algorithm>
#include <map>
#include <span>

#include "base/beneath.h"
#include "catalog/catalog_parts.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t files_a_step = 1000;
constexpr std::int64_t rows_a_step = 1000;

}  // namespace

Result<int> Catalog::mark_missing(const fs::path& directory, const std::function<void()>& step) {
    const auto names = impl_->names();
    if (!names) return pass_on(names);
    int marked = 0;
    for (const std::string& name : *names) {
        const auto paths = impl_->with(name, false, [&](StationDatabase& database) {
            return impl_->paths_below(database, directory, name);
        });
        if (step) step();
        if (!paths) continue;
        std::vector<fs::path> gone;
        std::size_t looked_at = 0;
        for (const fs::path& path : *paths) {
            if (step && ++looked_at % files_a_step == 0) step();
            const auto found = look_beneath(directory, path);
            if (!found && found.error().code == ErrorCode::not_found) gone.push_back(path);
        }
        if (gone.empty()) continue;
        const auto here = impl_->with(
            name, false, [&](StationDatabase& database) { return database.mark_gone(gone); });
        if (!here && here.error().code == ErrorCode::no_space) return pass_on(here);
        marked += here.value_or(0);
    }
    return marked;
}

Result<int> Catalog::forget_gone(UtcTime before, const std::function<void()>& step) {
    const auto names = impl_->names();
    if (!names) return pass_on(names);
    int forgotten = 0;
    for (const std::string& name : *names) {
        const auto rows = impl_->with(
            name, false, [&](StationDatabase& database) { return database.gone_before(before); });
        if (step) step();
        // Others may write between two batches.
        for (std::size_t i = 0; rows && i < rows->size(); i += files_a_step) {
            const auto batch = std::span{*rows}.subspan(i).first(
                std::min<std::size_t>(files_a_step, rows->size() - i));
            const auto here = impl_->with(name, false, [&](StationDatabase& database) {
                return database.forget_gone(batch, before);
            });
            if (step) step();
            if (!here && here.error().code == ErrorCode::no_space) return pass_on(here);
            if (!here) break;
            forgotten += *here;
        }
    }
    return forgotten;
}

Result<Rolled> Catalog::roll(const std::function<void()>& step) {
    const auto names = impl_->names();
    if (!names) return pass_on(names);
    Rolled rolled;
    std::map<std::string, std::uint64_t> used;
    // Deletes one batch; gives false where there was nothing to delete.
    const auto shrink = [&](const std::string& name) {
        std::int64_t deleted = 0;
        const auto now = impl_->with(name, false, [&](StationDatabase& database) {
            deleted = database.forget_oldest_gone(rows_a_step);
            return database.used_bytes();
        });
        if (step) step();
        if (!now || deleted == 0) return false;
        rolled.rows += deleted;
        rolled.used_bytes += *now;
        rolled.used_bytes -= std::exchange(used[name], *now);
        return true;
    };
    for (const std::string& name : *names) {
        const auto now = impl_->with(
            name, false, [](StationDatabase& database) { return database.used_bytes(); });
        if (step) step();
        if (!now) continue;
        used[name] = *now;
        rolled.used_bytes += *now;
        const std::uint64_t most = name == unknown_station ? impl_->options.most_unknown_bytes
                                                           : impl_->options.most_station_bytes;
        while (used[name] >= most && shrink(name)) {
        }
    }
    while (rolled.used_bytes > impl_->options.most_bytes && !used.empty()) {
        const auto largest =
            std::max_element(used.begin(), used.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        const std::string name = largest->first;
        if (!shrink(name)) used.erase(name);
    }
    return rolled;
}

}  // namespace stormcellar::catalog
