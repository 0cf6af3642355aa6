#include "catalog/catalog_parts.h"

#include <algorithm>
#include <system_error>

#include <sys/stat.h>

#include "base/station_table.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

// The rows of one database that are looked through for strays while a new file waits: some
// milliseconds. Larger ones are looked through with mark_missing().
constexpr std::int64_t most_looked_through = 10'000;

std::string summary_of(const std::vector<std::string>& damage) {
    std::string first = damage.front().substr(0, damage.front().find('\n'));
    if (damage.size() == 1) return first;
    return fmt::format("{}, and {} more", first, damage.size() - 1);
}

}  // namespace

std::string station_of(const std::string& name) {
    return name == unknown_station ? std::string{} : name;
}

FileIdentity FileIdentity::of(const fs::path& path) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0) return {};
    return {facts.st_dev, facts.st_ino};
}

Status Catalog::Impl::open(Slot& place, const std::string& name, bool create) {
    const fs::path path = path_of(name);
    if (place.database && place.file != FileIdentity::of(path)) {
        place.database.reset();  // what we write there would be seen by nobody
        is_listing_old_ = true;
        if (writing) note_repair({station_of(name), path, {}, "was deleted or replaced"});
    }
    if (place.database) return {};
    if (writing) {
        if (Status adopted = adopt_mended_database(path); !adopted) return adopted;
    }
    std::error_code ignored;
    if (!(writing && create) && !fs::exists(path, ignored)) {
        return fail(ErrorCode::not_found, "{}: the catalog knows no station {}", directory.native(),
                    name);
    }
    auto opened = writing ? StationDatabase::open_for_writing(path, station_of(name))
                          : StationDatabase::open_for_reading(path, station_of(name));
    if (!opened) return pass_on(opened);
    place.database = std::move(*opened);
    place.file = FileIdentity::of(path);
    place.strays = Strays::unknown;
    is_listing_old_ = true;
    return {};
}

bool Catalog::Impl::mend(Slot& place, const std::string& name) {
    place.database.reset();
    place.strays = Strays::unknown;
    const fs::path path = path_of(name);
    const auto found = examine_database(path);
    if (!found || found->foreign) return false;
    if (found->damage.empty()) return true;
    auto repair = repair_database(path, station_of(name), summary_of(found->damage));
    if (!repair) return false;
    note_repair(std::move(*repair));
    return true;
}

Result<std::vector<std::string>> Catalog::Impl::names() const {
    std::vector<std::string> found;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path& path = entry->path();
        const std::string stem = path.stem().string();
        if (path.extension() == database_ending && (is_icao(stem) || stem == unknown_station)) {
            found.push_back(stem);
        }
    }
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    std::sort(found.begin(), found.end());
    return found;
}

Result<std::vector<std::string>> Catalog::Impl::names_that_may_have(const fs::path& path) {
    if (!writing) return names();
    std::vector<std::string> found;
    {
        const std::scoped_lock lock(listed_mutex_);
        if (is_listing_old_.exchange(false) || !listed_) {
            auto now = names();
            if (!now) {
                is_listing_old_ = true;
                return now;
            }
            listed_ = std::move(*now);
        }
        found = *listed_;
    }
    const std::string_view home = guessed_home(path.native());
    std::erase_if(found,
                  [&](const std::string& name) { return name != home && !may_have_strays(name); });
    return found;
}

std::vector<fs::path> Catalog::Impl::paths_below(StationDatabase& database, const fs::path& below,
                                                 const std::string& name) {
    Slot& place = slot(name);
    if (place.strays == Strays::unknown || place.strays == Strays::too_many_rows) {
        const auto has_one =
            database.has_path([&](std::string_view path) { return guessed_home(path) != name; });
        place.strays = *has_one ? Strays::some : Strays::none;
    }
    return database.paths_below(below);
}

bool Catalog::Impl::may_have_strays(const std::string& name) {
    Slot& place = slot(name);
    if (place.strays == Strays::unknown) {
        const std::scoped_lock lock(place.mutex);
        // Damage is mended where the database is asked, or its own station's files come.
        const auto looked = attempt(place, name, false, [&](StationDatabase& database) {
            if (place.strays != Strays::unknown) return true;  // somebody else did meanwhile
            const auto has_one =
                database.has_path([&](std::string_view path) { return guessed_home(path) != name; },
                                  most_looked_through);
            place.strays = !has_one   ? Strays::too_many_rows
                           : *has_one ? Strays::some
                                      : Strays::none;
            return true;
        });
        if (!looked && looked.error().code == ErrorCode::not_found) is_listing_old_ = true;
    }
    return place.strays != Strays::none;
}

}  // namespace stormcellar::catalog
