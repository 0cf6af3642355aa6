// catalog/catalog_parts.h -- the state of a catalog: its databases, which are opened when needed
// and repaired when damaged. Used only inside the catalog room.
//
// Threads   As CatalogReader; one thread at a time uses each database.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "catalog/open_databases.h"
#include "catalog/path_filter.h"
#include "catalog/path_homes.h"
#include "catalog/station_database.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {

inline constexpr std::string_view database_ending = ".sqlite";

// Returns the station of a database's name; an empty text for the database of unknown stations.
[[nodiscard]] std::string station_of(const std::string& name);

// Returns the names of all databases in a directory, sorted, whether or not their stations are
// known.
[[nodiscard]] Result<std::vector<std::string>> database_names(
    const std::filesystem::path& directory);

struct CatalogReader::Impl {
    Impl(std::filesystem::path its_directory, CatalogOptions its_options, bool is_writing)
        : directory(std::move(its_directory)),
          options(std::move(its_options)),
          writing(is_writing),
          databases(options.most_open),
          strays_(is_writing ? std::make_unique<PathFilter>() : nullptr) {}

    const std::filesystem::path directory;
    const CatalogOptions options;
    const bool writing;
    OpenDatabases databases;
    PathHomes homes;
    Mutex repairs_mutex;
    std::vector<Repair> repairs STORMCELLAR_GUARDED_BY(repairs_mutex);

    [[nodiscard]] std::filesystem::path path_of(const std::string& name) const {
        return directory / (name + std::string{database_ending});
    }

    // Returns true if the rule lets a station have a database of its own.
    [[nodiscard]] bool knows(std::string_view station) const;
    // Returns the name of the database with the station's rows. Names that knows() has not accepted
    // never become names of files.
    [[nodiscard]] std::string name_for(std::string_view station) const {
        return std::string{knows(station) ? station : unknown_station};
    }
    [[nodiscard]] std::string_view home_of(std::string_view path) const {
        return guessed_home(path, options.stations.get());
    }

    // The result of `work` on a database.
    template <class Work>
    using Done = Result<std::invoke_result_t<Work&, StationDatabase&>>;
    // Runs `work` on the database of this name. Opens the database if necessary. A writer also
    // repairs a damaged database. A missing database is created by a writer if `create` is set;
    // otherwise the error is not_found. An error is listed as a trouble of the station until a
    // later call succeeds.
    template <class Work>
    Done<Work> with(const std::string& name, bool create, Work work) {
        const OpenDatabases::Lease place = databases.lease(name);
        const MutexLock lock(place->mutex);
        if (auto slow = slow_trouble(name)) return tl::unexpected<Error>(std::move(*slow));
        const auto began = std::chrono::steady_clock::now();
        auto done = attempt(*place, name, create, work);
        if (!done && writing && done.error().code == ErrorCode::corrupt && mend(*place, name)) {
            done = attempt(*place, name, create, work);
        }
        note_outcome(name, done ? nullptr : &done.error(), began);
        return done;
    }

    // Calls with() on behalf of another station. Does not try a database that was in trouble
    // seconds ago, because a try may last until a failing disk gives up.
    template <class Work>
    Done<Work> with_neighbor(const std::string& name, Work work) {
        if (auto recent = recent_trouble(name)) return tl::unexpected<Error>(std::move(*recent));
        return with(name, false, std::move(work));
    }

    template <class Work>
    Done<Work> attempt(Slot& place, const std::string& name, bool create, Work work)
        STORMCELLAR_REQUIRES(place.mutex) {
        const std::filesystem::path path = path_of(name);
        if (Status ready = open(place, name, create); !ready) return pass_on(ready);
        const bool is_snapshot = place.database->is_snapshot();
        try {
            auto done = work(*place.database);
            if (is_snapshot) databases.close(place);
            return done;
        } catch (const SQLite::Exception& error) {
            // If SQLite cannot open a file for writing, it opens the file for reading and never
            // tries again to write.
            const bool is_stuck = writing && code_of(error) == ErrorCode::permission;
            if (is_snapshot || is_stuck) databases.close(place);
            if (code_of(error) == ErrorCode::io && is_out_of_descriptors())
                return no_descriptor(path);
            return fail(code_of(error), "{}: {}", path.native(), error.what());
        }
    }

    Status open(Slot& place, const std::string& name, bool create)
        STORMCELLAR_REQUIRES(place.mutex);
    // Repairs a damaged database. Returns true if another attempt may succeed, because the database
    // was repaired or is not damaged after all.
    bool mend(Slot& place, const std::string& name) STORMCELLAR_REQUIRES(place.mutex);

    void note_repair(Repair repair) {
        const MutexLock lock(repairs_mutex);
        repairs.push_back(std::move(repair));
    }
    [[nodiscard]] std::vector<Trouble> troubles() const;

    // Returns the names of those databases in the directory whose stations the rule knows, sorted.
    [[nodiscard]] Result<std::vector<std::string>> names();

    // Returns the names of the databases that may have a row of the path. A row in another database
    // than home_of() is a stray: the station of the file's data is not the station in the file's
    // name. A writer sees every write, so it remembers the paths of strays (PathFilter) and need
    // not look up a new file in every database.
    [[nodiscard]] Result<std::vector<std::string>> names_that_may_have(
        const std::filesystem::path& path);
    // Searches a database for strays if names_that_may_have() did not, because the database has too
    // many rows.
    void look_for_strays(StationDatabase& database, const std::string& name);
    // Notes that the database gets a row of the path. Call it before the row is written, with the
    // slot's mutex held.
    void expect_row(const std::filesystem::path& path, const std::string& name);

  private:
    [[nodiscard]] Result<std::unique_ptr<StationDatabase>> open_database(const std::string& name);
    // Returns true if a database may have a stray row of the path. Set `is_likely` if strays_ may
    // have the path.
    [[nodiscard]] bool may_have_stray(const std::string& name, bool is_likely);
    // Adds the paths of the database's strays to strays_. Returns none, and reads nothing, if the
    // database may have more than `most_rows` rows.
    [[nodiscard]] std::optional<Strays> find_strays(StationDatabase& database,
                                                    const std::string& name,
                                                    std::int64_t most_rows);
    void look_for_admitted_stations() STORMCELLAR_REQUIRES(listed_mutex_);
    // Records a trouble or, without an error, the end of a trouble.
    void note_outcome(const std::string& name, const Error* error,
                      std::chrono::steady_clock::time_point began);
    // Returns the trouble of a database that was tried seconds ago.
    [[nodiscard]] std::optional<Error> recent_trouble(const std::string& name) const;
    // Returns recent_trouble(), but only if the try took long, for example because another process
    // has locked the database. Then files of the same station do not try again at once: they would
    // occupy the threads that files of other stations need.
    [[nodiscard]] std::optional<Error> slow_trouble(const std::string& name) const;

    // A trouble that has not ended.
    struct Standing {
        Error error;
        std::chrono::steady_clock::time_point began, tried;
    };
    [[nodiscard]] std::optional<Standing> recently_tried(const std::string& name) const;
    std::atomic<bool> has_troubles_ = false;
    mutable Mutex troubles_mutex_;
    std::map<std::string, Standing, std::less<>> troubles_ STORMCELLAR_GUARDED_BY(troubles_mutex_);

    // The paths of strays in all databases that were searched; null for a reader.
    const std::unique_ptr<PathFilter> strays_;

    // The last result of names(), until a database is opened or found missing. Only for a writer.
    Mutex listed_mutex_;
    std::optional<std::vector<std::string>> listed_ STORMCELLAR_GUARDED_BY(listed_mutex_);
    // Stations admitted by the rule `any` when names were listed last.
    std::size_t admitted_ STORMCELLAR_GUARDED_BY(listed_mutex_) = 0;
    std::atomic<bool> is_listing_old_ = false;
};

}  // namespace stormcellar::catalog
