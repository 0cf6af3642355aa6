#include "tests/catalog/power_cut_vfs.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>

#include <sqlite3.h>

#include "stormcellar/base/file_system.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t sector = 512;

// Our part of an open file. SQLite's own part follows it in memory.
struct OpenFile {
    sqlite3_file base;
    PowerCutVfs* disk;
    char* path;  // owned; null for temporary files, which are not tracked
    bool sync_directory;
};
constexpr std::size_t own_bytes = (sizeof(OpenFile) + 15) / 16 * 16;

OpenFile& ours(sqlite3_file* file) {
    return *reinterpret_cast<OpenFile*>(file);
}
sqlite3_file* real(sqlite3_file* file) {
    return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + own_bytes);
}
const sqlite3_io_methods& methods(sqlite3_file* file) {
    return *real(file)->pMethods;
}
PowerCutVfs::File& record(sqlite3_file* file) {
    return ours(file).disk->file(ours(file).path);
}

std::vector<std::byte> contents(const std::string& path) {
    if (!fs::exists(path)) return {};
    auto bytes = read_file(path);
    if (!bytes) throw std::runtime_error(bytes.error().message);
    return std::move(*bytes);
}

int close_file(sqlite3_file* file) {
    const int result = methods(file).xClose(real(file));
    delete[] ours(file).path;
    return result;
}
int read_from(sqlite3_file* file, void* to, int count, sqlite3_int64 offset) {
    return methods(file).xRead(real(file), to, count, offset);
}
int write_to(sqlite3_file* file, const void* from, int count, sqlite3_int64 offset) {
    if (ours(file).path != nullptr) {
        if (!ours(file).disk->may_go_on()) return SQLITE_IOERR_WRITE;
        const auto* bytes = static_cast<const std::byte*>(from);
        record(file).changes.push_back(
            {static_cast<std::uint64_t>(offset), {bytes, bytes + count}, std::nullopt});
    }
    return methods(file).xWrite(real(file), from, count, offset);
}
int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
    if (ours(file).path != nullptr) {
        if (!ours(file).disk->may_go_on()) return SQLITE_IOERR_TRUNCATE;
        record(file).changes.push_back({0, {}, static_cast<std::uint64_t>(size)});
    }
    return methods(file).xTruncate(real(file), size);
}
int sync_file(sqlite3_file* file, int /*flags*/) {
    if (ours(file).path == nullptr) return SQLITE_OK;
    if (!ours(file).disk->may_go_on()) return SQLITE_IOERR_FSYNC;
    PowerCutVfs::File& kept = record(file);
    kept.synced = contents(ours(file).path);
    kept.changes.clear();
    if (ours(file).sync_directory) ours(file).disk->sync_names();
    ours(file).sync_directory = false;
    return SQLITE_OK;
}
int file_size(sqlite3_file* file, sqlite3_int64* size) {
    return methods(file).xFileSize(real(file), size);
}
int lock_file(sqlite3_file* file, int level) {
    return methods(file).xLock(real(file), level);
}
int unlock_file(sqlite3_file* file, int level) {
    return methods(file).xUnlock(real(file), level);
}
int check_lock(sqlite3_file* file, int* out) {
    return methods(file).xCheckReservedLock(real(file), out);
}
int control(sqlite3_file* file, int operation, void* argument) {
    if (operation == SQLITE_FCNTL_SIZE_HINT || operation == SQLITE_FCNTL_CHUNK_SIZE) {
        return SQLITE_OK;  // ignore hints that would change the file without our knowledge
    }
    return methods(file).xFileControl(real(file), operation, argument);
}
int sector_size(sqlite3_file* file) {
    return methods(file).xSectorSize(real(file));
}
int characteristics(sqlite3_file* file) {
    return methods(file).xDeviceCharacteristics(real(file));
}
int map_shared(sqlite3_file* file, int page, int size, int extend, void volatile** where) {
    return methods(file).xShmMap(real(file), page, size, extend, where);
}
int lock_shared(sqlite3_file* file, int offset, int count, int flags) {
    return methods(file).xShmLock(real(file), offset, count, flags);
}
void shared_barrier(sqlite3_file* file) {
    methods(file).xShmBarrier(real(file));
}
int unmap_shared(sqlite3_file* file, int remove) {
    return methods(file).xShmUnmap(real(file), remove);
}

constexpr sqlite3_io_methods our_methods = {
    2,           close_file,     read_from,    write_to, truncate_file, sync_file,       file_size,
    lock_file,   unlock_file,    check_lock,   control,  sector_size,   characteristics, map_shared,
    lock_shared, shared_barrier, unmap_shared, nullptr,  nullptr};

}  // namespace

struct PowerCutVfs::Vfs {
    sqlite3_vfs base{};
};

namespace {

PowerCutVfs& disk_of(sqlite3_vfs* vfs) {
    return *static_cast<PowerCutVfs*>(vfs->pAppData);
}
// Returns SQLite's own VFS, on which PowerCutVfs is based.
sqlite3_vfs* below(sqlite3_vfs* vfs) {
    return vfs->pNext;
}

int open_file(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* out_flags) {
    auto* opened = new (file) OpenFile{};
    opened->disk = &disk_of(vfs);
    const bool is_new = path != nullptr && !fs::exists(path);
    if (is_new && (flags & SQLITE_OPEN_CREATE) != 0 && !opened->disk->may_go_on()) {
        return SQLITE_CANTOPEN;
    }
    if (path != nullptr) opened->disk->file(path);  // records its state before opening
    const int result = below(vfs)->xOpen(below(vfs), path, real(file), flags, out_flags);
    if (result != SQLITE_OK) return result;
    opened->base.pMethods = &our_methods;
    if (path == nullptr) return result;
    opened->path = new char[std::strlen(path) + 1];
    std::strcpy(opened->path, path);
    if (is_new) {
        PowerCutVfs::File& made = opened->disk->file(path);
        if (!made.exists && !made.name_synced) {
            made.changes = {{0, {}, 0}};  // the deleted file is still on the disk
            made.name_synced = true;
        } else if (!made.exists) {
            made = {{}, {}, true, false};
        }
        made.exists = true;
        constexpr int journals =
            SQLITE_OPEN_WAL | SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_SUPER_JOURNAL;
        opened->sync_directory = (flags & journals) != 0;
    }
    return result;
}
int delete_file(sqlite3_vfs* vfs, const char* path, int sync_directory) {
    PowerCutVfs& disk = disk_of(vfs);
    if (!disk.may_go_on()) return SQLITE_IOERR_DELETE;
    PowerCutVfs::File& file = disk.file(path);
    const int result = below(vfs)->xDelete(below(vfs), path, 0);
    if (result != SQLITE_OK) return result;
    file.exists = false;
    file.name_synced = false;
    if (sync_directory != 0) disk.sync_names();
    return result;
}
int access_file(sqlite3_vfs* vfs, const char* path, int flags, int* out) {
    return below(vfs)->xAccess(below(vfs), path, flags, out);
}
int full_path(sqlite3_vfs* vfs, const char* path, int count, char* out) {
    return below(vfs)->xFullPathname(below(vfs), path, count, out);
}

}  // namespace

PowerCutVfs::PowerCutVfs() : vfs_(std::make_unique<Vfs>()) {
    sqlite3_vfs* const own = sqlite3_vfs_find(nullptr);
    vfs_->base = *own;  // randomness, time and so on
    vfs_->base.zName = "power-cut";
    vfs_->base.szOsFile = static_cast<int>(own_bytes) + own->szOsFile;
    vfs_->base.pAppData = this;
    vfs_->base.xOpen = open_file;
    vfs_->base.xDelete = delete_file;
    vfs_->base.xAccess = access_file;
    vfs_->base.xFullPathname = full_path;
    sqlite3_vfs_register(&vfs_->base, 1);
}

PowerCutVfs::~PowerCutVfs() {
    sqlite3_vfs_unregister(&vfs_->base);
}

bool PowerCutVfs::may_go_on() {
    const std::uint64_t number = operations_++;
    return !fail_from_ || number < *fail_from_;
}

PowerCutVfs::File& PowerCutVfs::file(const std::string& path) {
    const auto found = files_.find(path);
    if (found != files_.end()) return found->second;
    const bool exists = fs::exists(path);
    return files_[path] = {contents(path), {}, exists, true};
}

void PowerCutVfs::sync_names() {
    for (auto& [path, file] : files_)
        file.name_synced = true;
}

std::vector<std::byte> PowerCutVfs::after_cut(const File& file, Kept kept,
                                              std::minstd_rand& random) const {
    std::vector<std::byte> bytes = file.synced;
    if (kept == Kept::nothing) return bytes;
    const auto keep = [&] { return kept == Kept::everything || random() % 2 == 0; };
    for (const Change& change : file.changes) {
        if (change.cut_to) {
            if (keep()) bytes.resize(std::min<std::uint64_t>(bytes.size(), *change.cut_to));
            continue;
        }
        for (std::size_t at = 0; at < change.bytes.size();) {
            const std::size_t place = change.offset + at;
            const std::size_t count = std::min(change.bytes.size() - at, sector - place % sector);
            if (keep()) {
                bytes.resize(std::max(bytes.size(), place + count));
                std::copy_n(change.bytes.begin() + static_cast<std::ptrdiff_t>(at), count,
                            bytes.begin() + static_cast<std::ptrdiff_t>(place));
            }
            at += count;
        }
    }
    return bytes;
}

void PowerCutVfs::power_cut(Kept kept, unsigned seed) {
    std::minstd_rand random(seed + 1);
    for (const auto& [path, file] : files_) {
        const bool as_now = file.name_synced || kept == Kept::everything ||
                            (kept == Kept::some && random() % 2 == 0);
        const bool exists = as_now ? file.exists : !file.exists;
        if (!exists) {
            fs::remove(path);
            continue;
        }
        // If the disk lost the deletion, the file has its synced contents.
        const std::vector<std::byte> bytes =
            file.exists ? after_cut(file, kept, random) : file.synced;
        testing::write_bytes(path, bytes);
        // The index of the WAL is never synced and never trusted.
        if (path.ends_with(".sqlite")) fs::remove(path + "-shm");
    }
    files_.clear();
    fail_from_.reset();
}

}  // namespace stormcellar::testing
