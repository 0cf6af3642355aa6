#include "catalog/open_databases.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::catalog {

FileIdentity FileIdentity::of(const std::filesystem::path& path) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0) return {};
    return {facts.st_dev, facts.st_ino};
}

OpenDatabases::Lease OpenDatabases::lease(const std::string& name) {
    const MutexLock lock(mutex_);
    auto found = slots_.find(name);
    if (found == slots_.end()) {
        found = slots_.emplace(name, std::make_unique<Slot>()).first;
        found->second->name_ = name;
    }
    Slot& slot = *found->second;
    ++slot.leases_;
    if (slot.is_counted_) open_.splice(open_.begin(), open_, slot.place_);
    return {*this, slot};
}

void OpenDatabases::give_back(Slot& slot) {
    const MutexLock lock(mutex_);
    --slot.leases_;
    drop_if_empty(slot);
}

void OpenDatabases::drop_if_empty(Slot& slot) {
    // Without leases the mutex is free. With leases, a thread may be changing the slot.
    if (slot.leases_ > 0 || slot.is_counted_ || !slot.mutex.try_lock()) return;
    const bool remembers = slot.file != FileIdentity{} || slot.strays != Strays::unknown;
    slot.mutex.unlock();
    if (!remembers) slots_.erase(slots_.find(slot.name_));
}

void OpenDatabases::make_room(Slot& slot) {
    std::size_t beyond = 0;
    {
        const MutexLock lock(mutex_);
        if (slot.is_counted_) return;
        open_.push_front(&slot);
        slot.place_ = open_.begin();
        slot.is_counted_ = true;
        if (open_.size() > most_open_) beyond = open_.size() - most_open_;
    }
    close_idle(beyond);
}

void OpenDatabases::close(Slot& slot) {
    slot.database.reset();
    const MutexLock lock(mutex_);
    if (!slot.is_counted_) return;
    open_.erase(slot.place_);
    slot.is_counted_ = false;
}

std::size_t OpenDatabases::close_idle(std::size_t count) {
    std::size_t closed = 0;
    while (closed < count && close_one_idle())
        ++closed;
    return closed;
}

// Closes the least recently used database that has no lease, or returns false if there is no such
// database. Does not hold `mutex_` meanwhile, because a checkpoint takes milliseconds. A thread
// that wants this database waits for the mutex of the slot, and then opens the database again.
bool OpenDatabases::close_one_idle() {
    Slot* victim = nullptr;
    {
        const MutexLock lock(mutex_);
        for (auto slot = open_.rbegin(); slot != open_.rend() && victim == nullptr; ++slot) {
            if ((*slot)->leases_ == 0) victim = *slot;
        }
        // Nobody has a lease, so the mutex is free.
        if (victim == nullptr || !victim->mutex.try_lock()) return false;
        ++victim->leases_;
    }
    close(*victim);
    victim->mutex.unlock();
    give_back(*victim);
    return true;
}

std::size_t OpenDatabases::open_count() const {
    const MutexLock lock(mutex_);
    return open_.size();
}

std::size_t OpenDatabases::slot_count() const {
    const MutexLock lock(mutex_);
    return slots_.size();
}

tl::unexpected<Error> no_descriptor(const std::filesystem::path& database) {
    return fail(ErrorCode::exhausted, "{}: {}", database.native(),
                std::system_category().message(EMFILE));
}

bool is_out_of_descriptors() {
    // SQLite opens the database, its WAL and the index, and for a moment their directory.
    std::array<Descriptor, 4> tries;
    for (Descriptor& one : tries) {
        one = Descriptor{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
        if (one.number() < 0) return errno == EMFILE || errno == ENFILE;
    }
    return false;
}

}  // namespace stormcellar::catalog
