// catalog/catalog_parts.h -- the parts of a catalog: its databases, opened when they are needed,
// and mended when they are found damaged.
//
// Inside the catalog room only. Thread contract: that of CatalogReader; one thread at a time uses a
// database.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catalog/open_databases.h"
#include "catalog/path_filter.h"
#include "catalog/path_homes.h"
#include "catalog/station_database.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {

inline constexpr std::string_view database_ending = ".sqlite";

// The station of a database's name; empty: files of no known station.
[[nodiscard]] std::string station_of(const std::string& name);

// The names of all databases in a directory, sorted, whatever their stations.
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
    std::mutex repairs_mutex;  // guards repairs
    std::vector<Repair> repairs;

    [[nodiscard]] std::filesystem::path path_of(const std::string& name) const {
        return directory / (name + std::string{database_ending});
    }

    // Returns true if the station may have a database of its own.
    [[nodiscard]] bool knows(std::string_view station) const;
    // The database that holds a station's rows. No unchecked text becomes a file name.
    [[nodiscard]] std::string name_for(std::string_view station) const {
        return std::string{knows(station) ? station : unknown_station};
    }
    [[nodiscard]] std::string_view home_of(std::string_view path) const {
        return guessed_home(path, options.stations.get());
    }

    // Runs `work` on the database of that name, which is opened if necessary, and mended if it is
    // damaged. A missing database is created if this is a writer and `create` is set; otherwise the
    // error is not_found. A failure is a trouble of that station until a later call succeeds.
    template <class Work>
    auto with(const std::string& name, bool create, Work work)
        -> Result<decltype(work(std::declval<StationDatabase&>()))> {
        const OpenDatabases::Lease place = databases.lease(name);
        const std::scoped_lock lock(place->mutex);
        if (auto slow = slow_trouble(name)) return tl::unexpected<Error>(std::move(*slow));
        const auto began = std::chrono::steady_clock::now();
        auto done = attempt(*place, name, create, work);
        if (!done && writing && done.error().code == ErrorCode::corrupt && mend(*place, name)) {
            done = attempt(*place, name, create, work);
        }
        note_outcome(name, done ? nullptr : &done.error(), began);
        return done;
    }

    // The same on behalf of another station: a database that was in trouble seconds ago is not
    // tried again, because a try may take as long as a disk takes to give up.
    template <class Work>
    auto with_neighbor(const std::string& name, Work work)
        -> Result<decltype(work(std::declval<StationDatabase&>()))> {
        if (auto recent = recent_trouble(name)) return tl::unexpected<Error>(std::move(*recent));
        return with(name, false, std::move(work));
    }

    template <class Work>
    auto attempt(Slot& place, const std::string& name, bool create, Work work)
        -> Result<decltype(work(std::declval<StationDatabase&>()))> {
        const std::filesystem::path path = path_of(name);
        if (Status ready = open(place, name, create); !ready) return pass_on(ready);
        const bool is_snapshot = place.database->is_snapshot();
        try {
            auto done = work(*place.database);
            if (is_snapshot) databases.close(place);
            return done;
        } catch (const SQLite::Exception& error) {
            // If SQLite cannot open a file for writing, it opens it for reading, and that never
            // changes.
            const bool is_stuck = writing && code_of(error) == ErrorCode::permission;
            if (is_snapshot || is_stuck) databases.close(place);
            if (code_of(error) == ErrorCode::io && is_out_of_descriptors())
                return no_descriptor(path);
            return fail(code_of(error), "{}: {}", path.native(), error.what());
        }
    }

    Status open(Slot& place, const std::string& name, bool create);
    // Returns true if another attempt has a chance: the damage was set aside, or was temporary.
    bool mend(Slot& place, const std::string& name);

    void note_repair(Repair repair) {
        const std::scoped_lock lock(repairs_mutex);
        repairs.push_back(std::move(repair));
    }
    [[nodiscard]] std::vector<Trouble> troubles() const;

    // The names of the databases in the directory whose stations are known, sorted.
    [[nodiscard]] Result<std::vector<std::string>> names();

    // The names of the databases that may have a row of the path. A row in another database than
    // home_of() says is a stray: its file is named like one station and holds data of another, or
    // of none. A writer sees all rows that are written and knows the paths of strays (PathFilter),
    // so it need not look for a new file in every station's database.
    [[nodiscard]] Result<std::vector<std::string>> names_that_may_have(
        const std::filesystem::path& path);
    // Examines databases that have too many rows for a file to wait for it.
    void look_for_strays(StationDatabase& database, const std::string& name);
    // Called before the row is written, with the slot's mutex held.
    void expect_row(const std::filesystem::path& path, const std::string& name);

  private:
    [[nodiscard]] Result<std::unique_ptr<StationDatabase>> open_database(const std::string& name);
    // Returns true if a database may have a row of a path whose home is elsewhere. `is_likely`: the
    // path is among those of strays.
    [[nodiscard]] bool may_have_stray(const std::string& name, bool is_likely);
    // Adds the paths of its strays to strays_. None: the database has too many rows, which were not
    // examined.
    [[nodiscard]] std::optional<Strays> find_strays(StationDatabase& database,
                                                    const std::string& name,
                                                    std::int64_t most_rows);
    void look_for_admitted_stations();
    // Notes a trouble or, without an error, that it is over.
    void note_outcome(const std::string& name, const Error* error,
                      std::chrono::steady_clock::time_point began);
    // The trouble of a database that was tried seconds ago.
    [[nodiscard]] std::optional<Error> recent_trouble(const std::string& name) const;
    // The same if the try took long, for example because somebody has locked the database: then its
    // own files do not try again at once either, because a thread that waits here is missing for
    // the other stations.
    [[nodiscard]] std::optional<Error> slow_trouble(const std::string& name) const;

    struct Standing {
        Error error;
        std::chrono::steady_clock::time_point began, tried;
    };
    [[nodiscard]] std::optional<Standing> recently_tried(const std::string& name) const;
    std::atomic<bool> has_troubles_ = false;
    mutable std::mutex troubles_mutex_;  // guards troubles_
    std::map<std::string, Standing, std::less<>> troubles_;

    // The paths of all known strays in all databases; null for a reader.
    const std::unique_ptr<PathFilter> strays_;

    // For a writer: the result of names(), until a database is opened or found to be gone.
    std::mutex listed_mutex_;
    std::optional<std::vector<std::string>> listed_;
    std::size_t admitted_ =
        0;  // stations that the rule `any` had accepted when names were last listed
    std::atomic<bool> is_listing_old_ = false;
};

}  // namespace stormcellar::catalog
