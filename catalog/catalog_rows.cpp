// Defines the regular work of a CatalogWriter on all rows: it marks rows of missing files and
// deletes old rows. If one station's database cannot be used (troubles()), the work continues with
// the other databases.
#include <algorithm>
#include <map>
#include <span>

#include "base/beneath.h"
#include "catalog/catalog_parts.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t files_a_step = 1000;
constexpr std::size_t most_members = 100'000;
constexpr std::int64_t rows_a_step = 1000;

// Returns true if the file at the path does not exist. A member of an archive exists as long as the
// archive does.
bool is_missing(const fs::path& directory, const fs::path& path) {
    const auto stands = [&](const fs::path& one) {
        const auto found = look_beneath(directory, one);
        return found || found.error().code != ErrorCode::not_found;
    };
    if (stands(path)) return false;
    const std::vector<MemberName> names = member_names_in(path);
    return std::none_of(names.begin(), names.end(),
                        [&](const MemberName& name) { return stands(name.archive); });
}

}  // namespace

Result<int> CatalogWriter::mark_missing(const fs::path& directory,
                                        const std::function<void()>& step) {
    const auto names = impl().names();
    if (!names) return pass_on(names);
    int marked = 0;
    for (const std::string& name : *names) {
        StationDatabase::Paths rows{.paths = {}, .last = 0, .are_all = false};
        while (!rows.are_all) {
            auto next = impl().with(name, false, [&](StationDatabase& database) {
                impl().look_for_strays(database, name);
                return database.paths_below(directory, rows.last, files_a_step);
            });
            if (step) step();
            if (!next) break;
            rows = std::move(*next);
            const auto here = mark_missing_of(name, directory, rows.paths);
            if (!here && here.error().code == ErrorCode::no_space) return pass_on(here);
            if (!here) break;
            marked += *here;
        }
    }
    return marked;
}

Result<int> CatalogWriter::mark_former_members(const fs::path& archive,
                                               const std::set<fs::path>& members) {
    const auto names = impl().names();
    if (!names) return pass_on(names);
    const std::string prefix = member_path(archive, "").native();
    int marked = 0;
    for (const std::string& name : *names) {
        const auto here = impl().with(name, false, [&](StationDatabase& database) {
            std::vector<fs::path> former;
            for (CatalogEntry& row : database.files_with_prefix(prefix, most_members)) {
                if (row.state != FileState::gone && !members.contains(row.path))
                    former.push_back(std::move(row.path));
            }
            return former.empty() ? 0 : database.mark_gone(former);
        });
        if (!here && here.error().code == ErrorCode::no_space) return pass_on(here);
        marked += here.value_or(0);
    }
    return marked;
}

// Marks the rows of those paths that are missing, in one station's database.
Result<int> CatalogWriter::mark_missing_of(const std::string& name, const fs::path& directory,
                                           const std::vector<fs::path>& paths) {
    std::vector<fs::path> gone;
    for (const fs::path& path : paths) {
        if (is_missing(directory, path)) gone.push_back(path);
    }
    if (gone.empty()) return 0;
    return impl().with(name, false,
                       [&](StationDatabase& database) { return database.mark_gone(gone); });
}

Result<int> CatalogWriter::forget_gone(UtcTime before, const std::function<void()>& step) {
    const auto names = impl().names();
    if (!names) return pass_on(names);
    int forgotten = 0;
    for (const std::string& name : *names) {
        const auto rows = impl().with(
            name, false, [&](StationDatabase& database) { return database.gone_before(before); });
        if (step) step();
        // Other threads may write between two batches.
        for (std::size_t i = 0; rows && i < rows->size(); i += files_a_step) {
            const auto batch = std::span{*rows}.subspan(i).first(
                std::min<std::size_t>(files_a_step, rows->size() - i));
            const auto here = impl().with(name, false, [&](StationDatabase& database) {
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

Result<Rolled> CatalogWriter::roll(const std::function<void()>& step) {
    const auto names = impl().names();
    if (!names) return pass_on(names);
    Rolled rolled;
    std::map<std::string, std::uint64_t> used;
    // Deletes one batch; returns false if there was nothing to delete.
    const auto shrink = [&](const std::string& name) {
        std::int64_t deleted = 0;
        const auto now = impl().with(name, false, [&](StationDatabase& database) {
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
        const auto now = impl().with(
            name, false, [](StationDatabase& database) { return database.used_bytes(); });
        if (step) step();
        if (!now) continue;
        used[name] = *now;
        rolled.used_bytes += *now;
        const std::uint64_t most = name == unknown_station ? impl().options.most_unknown_bytes
                                                           : impl().options.most_station_bytes;
        while (used[name] >= most && shrink(name)) {
        }
    }
    // Rows of existing files are never deleted. Each database keeps a fair share, so that these
    // rows do not displace the history of other stations.
    const std::uint64_t share = impl().options.most_bytes / std::max<std::size_t>(1, names->size());
    while (rolled.used_bytes > impl().options.most_bytes && !used.empty()) {
        const auto largest =
            std::max_element(used.begin(), used.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        const std::string name = largest->first;
        if (largest->second <= share) break;
        if (!shrink(name)) used.erase(name);
    }
    return rolled;
}

}  // namespace stormcellar::catalog
