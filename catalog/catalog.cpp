#include "catalog/catalog.h"

#include <algorithm>
#include <mutex>
#include <span>
#include <utility>

#include "base/beneath.h"
#include "base/file_system.h"
#include "base/station_table.h"
#include "catalog/catalog_parts.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t files_a_step = 1000;

// The database that a station's rows stand in. Nothing unchecked becomes a file name.
std::string database_name(std::string_view station) {
    return std::string{is_icao(station) ? station : unknown_station};
}

// Of a station that a user asks for. Lower case is no other station's answer.
Result<std::string> name_asked_for(std::string_view station) {
    if (station.empty() || is_icao(station)) return database_name(station);
    return fail(ErrorCode::bad_argument, "'{}' is no station: four letters and digits, as in KTLX",
                station);
}

// Of another station's database: whether it concerns a file of this one. A damaged, foreign or
// missing database does not; it is named when its own station's files come, or when it is asked.
bool is_ours_to_solve(const Error& error) {
    return error.code != ErrorCode::not_found && error.code != ErrorCode::corrupt &&
           error.code != ErrorCode::unsupported;
}

}  // namespace

Catalog::Catalog(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Catalog::Catalog(Catalog&&) noexcept = default;
Catalog& Catalog::operator=(Catalog&&) noexcept = default;
Catalog::~Catalog() = default;

const fs::path& Catalog::directory() const {
    return impl_->directory;
}

Result<Catalog> Catalog::open_for_writing(fs::path directory) {
    std::error_code error;
    const bool created = fs::create_directories(directory, error);
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    if (created) {
        // state/catalog, as a rule with its parent: SQLite syncs the directory, not its name.
        const fs::path parent = fs::absolute(directory).lexically_normal().parent_path();
        for (const fs::path& above : {parent, parent.parent_path()}) {
            if (Status synced = real_file_system().sync_directory(above); !synced) {
                return pass_on(synced);
            }
        }
    }
    auto impl = std::make_unique<Impl>();
    impl->directory = std::move(directory);
    impl->writing = true;
    return Catalog(std::move(impl));
}

Result<Catalog> Catalog::open_for_reading(fs::path directory) {
    std::error_code ignored;
    if (!fs::is_directory(directory, ignored)) {
        return fail(ErrorCode::not_found, "{}: no such catalog directory", directory.native());
    }
    auto impl = std::make_unique<Impl>();
    impl->directory = std::move(directory);
    return Catalog(std::move(impl));
}

// Called after the path was written into the database of that name.
Status Catalog::forget_elsewhere(const fs::path& path, const std::string& name) {
    const auto home = impl_->homes.exchange(path, name);
    if (home && (home->empty() || *home == name)) return {};
    Status outcome;
    bool is_alone = true;
    const auto names = impl_->names_that_may_have(path);
    if (!names) outcome = pass_on(names);
    for (const std::string& other : names ? *names : std::vector<std::string>{}) {
        if (other == name) continue;
        const auto forgotten = impl_->with(other, false, [&](StationDatabase& database) {
            database.forget(path);
            return true;
        });
        // A damaged database of another station must not hold this file up.
        if (!forgotten && is_ours_to_solve(forgotten.error())) outcome = pass_on(forgotten);
        is_alone = is_alone && forgotten;
    }
    if (!is_alone || !outcome) impl_->homes.forget(path);
    return outcome;
}

Status Catalog::note_file(const FileFacts& facts) {
    const std::string name = database_name(facts.station);
    const auto noted = impl_->with(name, true, [&](StationDatabase& database) {
        impl_->expect_row(facts.path, name);
        if (!database.is_settled(facts.path, 0, 0)) database.register_file(facts);
        return true;
    });
    if (!noted) return pass_on(noted);
    if (impl_->homes.set_if_free(facts.path, name)) return {};
    // Somebody who has read it has put it where it belongs meanwhile.
    const auto forgotten = impl_->with(name, false, [&](StationDatabase& database) {
        database.forget(facts.path);
        return true;
    });
    if (!forgotten) return pass_on(forgotten);
    return {};
}

Result<Registered> Catalog::register_file(const FileFacts& facts) {
    const std::string name = database_name(facts.station);
    auto registered = impl_->with(name, true, [&](StationDatabase& database) {
        impl_->expect_row(facts.path, name);
        return database.register_file(facts);
    });
    if (!registered) return registered;
    // What stood there before may have been of another station, or of none that was known.
    if (Status alone = forget_elsewhere(facts.path, name); !alone) return pass_on(alone);
    return registered;
}

Status Catalog::register_files(const std::string& station, const std::vector<FileFacts>& files) {
    const std::string name = database_name(station);
    const auto registered = impl_->with(name, true, [&](StationDatabase& database) {
        for (const FileFacts& file : files)
            impl_->expect_row(file.path, name);
        database.register_files(files);
        return true;
    });
    if (!registered) return pass_on(registered);
    for (const FileFacts& file : files) {
        if (Status alone = forget_elsewhere(file.path, name); !alone) return alone;
    }
    return {};
}

Result<int> Catalog::mark_gone(const fs::path& path) {
    const auto home = impl_->homes.of(path);
    if (home && home->empty()) return 0;
    const auto names = home ? Result<std::vector<std::string>>{std::vector<std::string>{*home}}
                            : impl_->names_that_may_have(path);
    if (!names) return pass_on(names);
    int marked = 0;
    for (const std::string& name : *names) {
        // To look is cheaper than to begin to write.
        const auto here = impl_->with(name, false, [&](StationDatabase& database) {
            return database.is_settled(path, 0, 0) ? database.mark_gone({path}) : 0;
        });
        if (!here && is_ours_to_solve(here.error())) return pass_on(here);
        marked += here.value_or(0);
    }
    return marked;
}

Result<int> Catalog::mark_missing(const fs::path& directory, const std::function<void()>& step) {
    const auto names = impl_->names();
    if (!names) return pass_on(names);
    int marked = 0;
    for (const std::string& name : *names) {
        const auto paths = impl_->with(name, false, [&](StationDatabase& database) {
            return impl_->paths_below(database, directory, name);
        });
        if (!paths && is_ours_to_solve(paths.error())) return pass_on(paths);
        if (!paths) continue;
        if (step) step();
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
        if (!here) return pass_on(here);
        marked += *here;
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
        if (!rows && is_ours_to_solve(rows.error())) return pass_on(rows);
        if (step) step();
        // Others may write between two batches.
        for (std::size_t i = 0; rows && i < rows->size(); i += files_a_step) {
            const auto batch = std::span{*rows}.subspan(i).first(
                std::min<std::size_t>(files_a_step, rows->size() - i));
            const auto here = impl_->with(name, false, [&](StationDatabase& database) {
                return database.forget_gone(batch, before);
            });
            if (!here) return pass_on(here);
            forgotten += *here;
            if (step) step();
        }
    }
    return forgotten;
}

Result<std::optional<bool>> Catalog::find_settled(const fs::path& path, std::uint64_t size_bytes,
                                                  std::int64_t modified_ns) {
    const auto ask = [&](StationDatabase& database) {
        return database.is_settled(path, size_bytes, modified_ns);
    };
    const auto home = impl_->homes.of(path);
    if (home && home->empty()) return std::optional<bool>{};
    const std::string guess = home.value_or(std::string{guessed_home(path.native())});
    auto guessed = impl_->with(guess, false, ask);
    if (guessed && guessed->has_value()) return guessed;
    if (!guessed && guessed.error().code != ErrorCode::not_found) return guessed;
    if (home) return std::optional<bool>{};

    const auto names = impl_->names_that_may_have(path);
    if (!names) return pass_on(names);
    bool is_sure = true;
    for (const std::string& name : *names) {
        if (name == guess) continue;
        auto here = impl_->with(name, false, ask);
        if (!here && is_ours_to_solve(here.error())) return here;
        if (here && here->has_value()) return here;
        is_sure = is_sure && here;
    }
    if (is_sure && impl_->writing) impl_->homes.set_none(path);
    return std::optional<bool>{};
}

Result<bool> Catalog::is_settled(const fs::path& path, std::uint64_t size_bytes,
                                 std::int64_t modified_ns) {
    const auto found = find_settled(path, size_bytes, modified_ns);
    if (!found) return pass_on(found);
    return found->value_or(false);
}

Result<bool> Catalog::is_known(const fs::path& path) {
    const auto found = find_settled(path, 0, 0);
    if (!found) return pass_on(found);
    return found->has_value();
}

Result<std::vector<std::string>> Catalog::station_names() const {
    auto names = impl_->names();
    if (!names) return names;
    for (std::string& name : *names)
        name = station_of(name);
    std::sort(names->begin(), names->end());
    return names;
}

Status Catalog::examine_all() {
    const auto stations = station_names();
    if (!stations) return pass_on(stations);
    Status outcome;
    for (const std::string& station : *stations) {
        if (Status examined = examine(station); !examined) outcome = std::move(examined);
    }
    return outcome;
}

Status Catalog::examine(std::string_view station) {
    const auto names = impl_->names();
    if (!names) return pass_on(names);
    const auto name = std::find_if(names->begin(), names->end(), [&](const std::string& each) {
        return station_of(each) == station;
    });
    if (name == names->end()) return {};
    // What a crash left unfinished, only one who writes can finish.
    const auto opened = impl_->with(*name, false, [](StationDatabase&) { return true; });
    if (!opened) return pass_on(opened);
    const fs::path path = impl_->path_of(*name);
    const auto found = examine_database(path);
    if (!found) return pass_on(found);
    if (found->damage.empty()) return {};
    Impl::Slot& place = impl_->slot(*name);
    const std::scoped_lock lock(place.mutex);
    if (impl_->mend(place, *name)) return {};
    return fail(ErrorCode::corrupt, "{}: {}, and cannot be mended", path.native(),
                found->damage.front());
}

std::vector<Repair> Catalog::take_repairs() {
    const std::scoped_lock lock(impl_->repairs_mutex);
    return std::exchange(impl_->repairs, {});
}

Result<std::vector<StationSummary>> Catalog::stations() {
    const auto names = impl_->names();
    if (!names) return pass_on(names);
    std::vector<StationSummary> summaries;
    for (const std::string& name : *names) {
        auto summary =
            impl_->with(name, false, [](StationDatabase& database) { return database.summary(); });
        if (!summary) return pass_on(summary);
        summaries.push_back(std::move(*summary));
    }
    return summaries;
}

Result<std::vector<CatalogEntry>> Catalog::list(std::string_view station, const Query& query) {
    const auto name = name_asked_for(station);
    if (!name) return pass_on(name);
    return impl_->with(*name, false,
                       [&](StationDatabase& database) { return database.list(query); });
}

Result<std::optional<CatalogEntry>> Catalog::latest(std::string_view station) {
    const auto name = name_asked_for(station);
    if (!name) return pass_on(name);
    return impl_->with(*name, false,
                       [](StationDatabase& database) { return database.first(true); });
}

Result<std::optional<CatalogEntry>> Catalog::oldest(std::string_view station) {
    const auto name = name_asked_for(station);
    if (!name) return pass_on(name);
    return impl_->with(*name, false,
                       [](StationDatabase& database) { return database.first(false); });
}

}  // namespace stormcellar::catalog
