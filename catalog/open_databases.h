// catalog/open_databases.h -- the databases of a catalog that are open: a bounded set, of which the
// least recently used is closed first.
//
// An open database takes three descriptors (itself, its WAL and the WAL's index). Whoever works on
// one holds a lease and its slot's mutex; only a database that nobody has leased is closed to make
// room, so none is ever closed under somebody's hands. Where all are leased, the bound is exceeded
// by as many as threads work at once.
// What a slot remembers of a closed database costs some 200 bytes; a slot that remembers nothing is
// dropped with its last lease, so that asking for names leaves nothing behind.
// Cost: a lease takes 0.1 microseconds. To close a database that was written to is a checkpoint of
// its WAL, which is synced: 0.4 ms; to open it again takes 0.5 ms (medians of 200, 2026-11-25, a
// shared cloud machine of two cores; tests/catalog/open_databases_test.cpp prints them).
// Inside the catalog room only. Thread contract: any thread; what a slot holds is guarded by its
// mutex.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <sys/types.h>

#include "catalog/station_database.h"

namespace stormcellar::catalog {

// Tells whether a path still names the file that it named.
struct FileIdentity {
    dev_t device = 0;
    ino_t inode = 0;
    bool operator==(const FileIdentity&) const = default;

    static FileIdentity of(const std::filesystem::path& path);
};

// Whether a database has a row of a path whose guessed_home() is another.
enum class Strays : std::uint8_t {
    unknown,
    none,
    some,
    too_many_rows,  // to look through them while a file waits; mark_missing() does
};

// The place of one database.
struct Slot {
    std::mutex mutex;  // guards what follows
    std::unique_ptr<StationDatabase> database;
    FileIdentity file;                             // that was opened last; none: not yet
    std::atomic<Strays> strays = Strays::unknown;  // written under the mutex, read without

  private:
    friend class OpenDatabases;
    // Guarded by the mutex of OpenDatabases.
    std::string name_;
    std::size_t leases_ = 0;
    bool is_counted_ = false;
    std::list<Slot*>::iterator place_;  // among the open ones, while it is counted
};

class OpenDatabases {
  public:
    explicit OpenDatabases(std::size_t most_open) : most_open_(most_open) {}

    // A slot that stays, and whose database stays open if it is, as long as this object lives.
    class Lease {
      public:
        Lease(OpenDatabases& all, Slot& slot) : all_(all), slot_(slot) {}
        ~Lease() { all_.give_back(slot_); }
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        Slot& operator*() const { return slot_; }
        Slot* operator->() const { return &slot_; }

      private:
        OpenDatabases& all_;
        Slot& slot_;
    };
    // The most recently used one from now on.
    [[nodiscard]] Lease lease(const std::string& name);

    // To be called before the slot's database is opened, with a lease and the slot's mutex: closes
    // the least recently used ones as far as the bound wants it.
    void make_room(Slot& slot);
    // Closes the slot's database, or takes make_room() back; with a lease and the slot's mutex.
    void close(Slot& slot);
    // Closes so many that nobody has leased, least recently used first; gives how many were closed.
    std::size_t close_idle(std::size_t count);

    [[nodiscard]] std::size_t open_count() const;
    [[nodiscard]] std::size_t slot_count() const;

  private:
    void give_back(Slot& slot);
    bool close_one_idle();
    // With mutex_.
    void drop_if_empty(Slot& slot);

    const std::size_t most_open_;
    mutable std::mutex mutex_;  // guards what follows, not what slots hold
    std::map<std::string, std::unique_ptr<Slot>, std::less<>> slots_;
    std::list<Slot*> open_;  // most recently used first
};

// Whether this process can open no further database at the moment.
[[nodiscard]] bool is_out_of_descriptors();
// What a database gives then: nobody's fault, and to be tried again.
[[nodiscard]] tl::unexpected<Error> no_descriptor(const std::filesystem::path& database);

}  // namespace stormcellar::catalog
