#include "tests/fault/aftermath.h"

#include <map>
#include <set>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/repair.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;

struct Row {
    std::string database, state, reason;
    std::int64_t size_bytes = 0;
};
using Rows = std::multimap<fs::path, Row>;

template <class... Args>
void complain(Aftermath& after, fmt::format_string<Args...> format, Args&&... args) {
    after.problems.push_back(fmt::format(format, std::forward<Args>(args)...));
}

void read_rows(const fs::path& path, Rows& rows, Aftermath& after) {
    try {
        SQLite::Database database(path.native(), SQLite::OPEN_READONLY, 10'000);
        SQLite::Statement found(database, "SELECT path, state, reason, size_bytes FROM file");
        while (found.executeStep()) {
            rows.emplace(fs::path{found.getColumn(0).getString()},
                         Row{path.filename().native(), found.getColumn(1).getString(),
                             found.getColumn(2).getString(), found.getColumn(3).getInt64()});
        }
    } catch (const SQLite::Exception& error) {
        complain(after, "{}: {}", path.native(), error.what());
    }
}

// Reads the catalog's directory. It may contain databases and SQLite's files beside them, damaged
// databases that were set aside, and a file that names the drop directory.
Rows look_at_catalog(const fs::path& directory, Aftermath& after) {
    Rows rows;
    std::error_code error;
    for (fs::directory_iterator at(directory, error), end; !error && at != end;
         at.increment(error)) {
        const fs::path& path = at->path();
        const std::string name = path.filename().native();
        if (name.find(".sqlite.damaged-") != std::string::npos) {
            if (!name.ends_with("-wal") && !name.ends_with("-shm")) ++after.set_aside;
        } else if (name.ends_with(".sqlite")) {
            const auto examined = catalog::examine_database(path);
            if (!examined) complain(after, "{}", examined.error().message);
            if (examined) {
                for (const std::string& damage : examined->damage)
                    complain(after, "{}: {}", path.native(), damage);
            }
            read_rows(path, rows, after);
        } else if (!name.ends_with(".sqlite-wal") && !name.ends_with(".sqlite-shm") &&
                   name != "drop-directory") {
            complain(after, "{}: was left behind", path.native());
        }
    }
    if (error) complain(after, "{}: {}", directory.native(), error.message());
    after.rows = rows.size();
    return rows;
}

void check_row(const fs::path& file, const Row& row, Contents contents, Aftermath& after) {
    std::error_code error;
    if (static_cast<std::int64_t>(fs::file_size(file, error)) != row.size_bytes) {
        complain(after, "{}: registered with {} bytes", file.native(), row.size_bytes);
    }
    if (row.state == "partial" || row.state == "rejected") {
        if (row.reason.empty()) complain(after, "{}: {}, and no reason", file.native(), row.state);
        ++after.with_reason;
    } else if (row.state != "complete") {
        complain(after, "{}: its state is {}", file.native(), row.state);
    }
    const bool fits = contents == Contents::whole_volume ? row.state == "complete"
                      : contents == Contents::junk       ? row.state == "rejected"
                                                         : true;
    if (!fits) complain(after, "{}: is {} ({})", file.native(), row.state, row.reason);
}

void check_files(const std::vector<Delivered>& delivered, const Rows& rows, Aftermath& after) {
    std::set<fs::path> known;
    for (const Delivered& one : delivered) {
        bool all_complete = true;
        for (const fs::path& file : one.files) {
            known.insert(file);
            ++after.files;
            const auto [begin, end] = rows.equal_range(file);
            const auto count = std::distance(begin, end);
            if (count == 0) complain(after, "{}: is not registered", file.native());
            if (count > 1) {
                complain(after, "{}: is registered {} times, in {} and {}", file.native(), count,
                         begin->second.database, std::next(begin)->second.database);
            }
            if (count > 0) check_row(file, begin->second, one.contents, after);
            all_complete = all_complete && count > 0 && begin->second.state == "complete";
        }
        if (one.contents == Contents::part && all_complete) {
            complain(after, "{}: is a part, and registered as complete",
                     one.files.front().native());
        }
    }
    for (const auto& [path, row] : rows) {
        if (!known.contains(path)) {
            complain(after, "{}: was never delivered, and is registered as {}", path.native(),
                     row.state);
        }
    }
}

// Checks that every file below the cache is a sound grid.
void check_cache(const fs::path& directory, Aftermath& after) {
    std::error_code error;
    for (fs::recursive_directory_iterator at(directory, error), end; !error && at != end;
         at.increment(error)) {
        if (at->is_directory()) continue;
        if (at->path().extension() != ".scg") {
            complain(after, "{}: was left behind", at->path().native());
            continue;
        }
        ++after.grids;
        const auto grid = cache::GridFile::open(at->path());
        if (!grid) {
            complain(after, "{}", grid.error().message);
        } else if (const Status verified = grid->verify(); !verified) {
            complain(after, "{}", verified.error().message);
        }
    }
    if (error) complain(after, "{}: {}", directory.native(), error.message());
}

void check_volumes(const fs::path& cache, const std::vector<Delivered>& delivered,
                   Aftermath& after) {
    const auto store = cache::StoreReader::open(cache);
    if (!store) {
        complain(after, "{}", store.error().message);
        return;
    }
    for (const Delivered& one : delivered) {
        if (one.contents != Contents::whole_volume || !one.time) continue;
        ++after.volumes;
        const auto path = store->path_of(one.station, level2::Moment::ref, *one.time);
        const auto grid = path ? cache::GridFile::open(*path) : tl::unexpected(path.error());
        if (!grid) {
            complain(after, "{}: has no grid: {}", one.files.front().native(),
                     grid.error().message);
        } else if (grid->description().provenance.partial) {
            complain(after, "{}: its grid is still that of a part", one.files.front().native());
        } else {
            ++after.gridded;
        }
    }
}

// Checks that no temporary file is left below the directory, by name or unnamed.
void check_leftovers(const fs::path& directory, Aftermath& after) {
    std::error_code error;
    for (fs::recursive_directory_iterator at(directory, error), end; !error && at != end;
         at.increment(error)) {
        if (at->path().filename().native().starts_with(temporary_prefix))
            complain(after, "{}: was left behind", at->path().native());
    }
}

// Checks that the drop directory contains only delivered files.
void check_drop(const fs::path& directory, const std::vector<Delivered>& delivered,
                Aftermath& after) {
    std::set<fs::path> known;
    for (const Delivered& one : delivered)
        known.insert(one.files.begin(), one.files.end());
    std::error_code error;
    for (fs::recursive_directory_iterator at(directory, error), end; !error && at != end;
         at.increment(error)) {
        if (at->is_regular_file() && !known.contains(at->path()))
            complain(after, "{}: nobody delivered it", at->path().native());
    }
}

}  // namespace

std::string Aftermath::problem_text() const {
    std::string text = fmt::format("{} problems\n", problems.size());
    for (std::size_t i = 0; i < problems.size() && i < 20; ++i)
        text += problems[i] + "\n";
    return text;
}

std::string Aftermath::summary() const {
    return fmt::format(
        "{} files, {} rows, {} whole volumes, {} of them gridded, {} grids verified, "
        "{} rows with a reason, {} problems",
        files, rows, volumes, gridded, grids, with_reason, problems.size());
}

Aftermath look_at_aftermath(const Places& places, const std::vector<Delivered>& delivered) {
    Aftermath after;
    const Rows rows = look_at_catalog(places.state / "catalog", after);
    check_files(delivered, rows, after);
    check_cache(places.cache, after);
    check_volumes(places.cache, delivered, after);
    check_leftovers(places.state, after);
    check_drop(places.drop, delivered, after);
    return after;
}

}  // namespace stormcellar::fault
