#include "web/data/raw/raw_opener.h"

#include <algorithm>
#include <array>
#include <span>

#include <fcntl.h>
#include <unistd.h>

#include "base/beneath.h"
#include "base/checksum.h"
#include "level2/containers/chunk_once.h"
#include "pipeline/drop/cataloged_volume.h"
#include "pipeline/drop/chunk_path.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "web/data/grids/memory_file.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;
using catalog::CatalogEntry;
using catalog::CatalogReader;
using catalog::FileState;

constexpr std::size_t most_chunks = 2000;
constexpr std::size_t most_remembered = 65'536;
constexpr std::uint64_t most_raw_bytes = std::uint64_t{1} << 30;
constexpr std::size_t hashed_at_once = std::size_t{1} << 20;

tl::unexpected<RawFailure> missing(RawMissing why, std::string reason) {
    return tl::unexpected(RawFailure{why, std::move(reason)});
}

// Makes a failure from an error. The catalog knew the file, so "not found" means that the file is
// gone.
tl::unexpected<RawFailure> missing(const Error& error) {
    switch (error.code) {
        case ErrorCode::not_found:
            return missing(RawMissing::gone, error.message);
        case ErrorCode::corrupt:
        case ErrorCode::not_a_file:
        case ErrorCode::unsupported:
            return missing(RawMissing::changed, error.message);
        default:
            return missing(RawMissing::trouble, error.message);
    }
}

UtcTime time_of_ns(std::int64_t ns) {
    return UtcTime{std::chrono::milliseconds{ns / 1'000'000}};
}

std::int64_t modified_ns_of(const struct stat& facts) {
    return static_cast<std::int64_t>(facts.st_mtim.tv_sec) * 1'000'000'000 + facts.st_mtim.tv_nsec;
}

bool is_growing(const CatalogEntry& entry) {
    return !catalog::has_final_hash(entry);
}

std::string settled_tag(std::uint64_t hash, std::uint64_t size_bytes) {
    return fmt::format("\"{:016x}-{}\"", hash, size_bytes);
}

Result<std::uint64_t> hash_of(const Descriptor& file, std::uint64_t size_bytes,
                              const fs::path& path) {
    std::vector<std::byte> buffer(std::min<std::uint64_t>(size_bytes, hashed_at_once));
    Xxh3Stream stream;
    for (std::uint64_t at = 0; at < size_bytes;) {
        const auto want = std::min<std::uint64_t>(buffer.size(), size_bytes - at);
        const auto got = ::pread(file.number(), buffer.data(), want, static_cast<off_t>(at));
        if (got < 0) return fail(ErrorCode::io, "{}: cannot be read", path.native());
        if (got == 0) return fail(ErrorCode::corrupt, "{}: was cut", path.native());
        stream.append(std::span{buffer}.first(static_cast<std::size_t>(got)));
        at += static_cast<std::uint64_t>(got);
    }
    return stream.value();
}

// Returns the rows of a volume's chunks in the order of their numbers, one for each number.
Result<std::vector<CatalogEntry>> chunk_rows(const CatalogReader& catalog,
                                             const CatalogEntry& entry) {
    const auto first = pipeline::ChunkPath::of(entry.path);
    if (!first) return fail(ErrorCode::internal, "{}: is no chunk", entry.path.native());
    const std::string prefix = (entry.path.parent_path() / first->prefix).native();
    auto rows = catalog.files_with_prefix(entry.station, prefix, most_chunks);
    if (!rows) return rows;
    std::map<int, CatalogEntry> by_number;
    for (CatalogEntry& row : *rows) {
        const auto chunk = pipeline::ChunkPath::of(row.path);
        if (!chunk || chunk->key != first->key) continue;
        by_number.try_emplace(chunk->name.number, std::move(row));
    }
    std::vector<CatalogEntry> chunks;
    int due = 1;
    for (auto& [number, row] : by_number) {
        // If the volume grows, stop at a gap and at a chunk that was not read yet, because later
        // chunks do not continue the file.
        if (is_growing(entry) && (number > due || row.content_hash == 0)) break;
        due = number + 1;
        chunks.push_back(std::move(row));
    }
    return chunks;
}

// Describes the chunks by their rows. The same contents give the same tag.
RawFacts facts_of_rows(const std::vector<CatalogEntry>& chunks, bool grows) {
    RawFacts facts;
    Xxh3Stream hashes;
    std::int64_t newest_ns = 0;
    for (const CatalogEntry& chunk : chunks) {
        facts.size_bytes += chunk.size_bytes;
        newest_ns = std::max(newest_ns, chunk.modified_ns);
        const std::array<std::uint64_t, 2> words = {chunk.content_hash, chunk.size_bytes};
        hashes.append(std::as_bytes(std::span{words}));
    }
    facts.modified = time_of_ns(newest_ns);
    facts.tag = grows ? fmt::format("\"g{:016x}-{}\"", hashes.value(), facts.size_bytes)
                      : settled_tag(hashes.value(), facts.size_bytes);
    return facts;
}

std::string facts_key(const CatalogEntry& entry) {
    return fmt::format("{}\n{:x}\n{}", entry.path.native(), entry.content_hash,
                       entry.volume.radial_count);
}

}  // namespace

RawOpener::State RawOpener::state_of(const struct stat& facts) {
    const auto changed_ns =
        static_cast<std::int64_t>(facts.st_ctim.tv_sec) * 1'000'000'000 + facts.st_ctim.tv_nsec;
    return {facts.st_dev, facts.st_ino, facts.st_size, modified_ns_of(facts), changed_ns};
}

// Compares the contents with the row. Reads each state of a file only once.
Status RawOpener::check_hash(const CatalogEntry& entry, const Descriptor& file,
                             const struct stat& facts) {
    const auto size_bytes = static_cast<std::uint64_t>(facts.st_size);
    const State state = state_of(facts);
    {
        const MutexLock lock(mutex_);
        const auto known = hashes_.find(state);
        if (known != hashes_.end()) {
            return catalog::check_cataloged(entry, size_bytes, known->second);
        }
    }
    const auto hash = hash_of(file, size_bytes, entry.path);
    if (!hash) return pass_on(hash);
    struct stat after {};
    const bool stayed = ::fstat(file.number(), &after) == 0 && state_of(after) == state;
    if (stayed) {
        const MutexLock lock(mutex_);
        if (hashes_.size() >= most_remembered) hashes_.clear();
        hashes_.insert_or_assign(state, *hash);
    }
    return catalog::check_cataloged(entry, size_bytes, *hash);
}

OpenedRawOrMissing RawOpener::open(const CatalogReader& catalog, const CatalogEntry& entry) {
    if (pipeline::is_of_chunks(entry)) return open_chunks(catalog, entry);
    const auto root = catalog::root_of(catalog, entry.path);
    if (!root) return missing(RawMissing::trouble, root.error().message);
    const auto opened = open_beneath(*root, entry.path);
    if (!opened) return missing(opened.error());
    auto file = std::make_shared<const Descriptor>(*opened);
    struct stat facts {};
    if (::fstat(file->number(), &facts) != 0) {
        return missing(RawMissing::trouble, entry.path.native() + ": its size cannot be read");
    }
    const auto size_bytes = static_cast<std::uint64_t>(facts.st_size);
    if (size_bytes > most_raw_bytes) {
        return missing(RawMissing::changed, entry.path.native() + ": is larger than 1 GiB");
    }
    const UtcTime modified = time_of_ns(modified_ns_of(facts));
    if (!is_growing(entry)) {
        // Compare the size first, because the file may be far larger now.
        if (size_bytes != entry.size_bytes) {
            return missing(RawMissing::changed, entry.path.native() + ": has another size");
        }
        if (Status same = check_hash(entry, *file, facts); !same) return missing(same.error());
        return OpenedRaw{file, size_bytes, modified, settled_tag(entry.content_hash, size_bytes)};
    }
    // Refuse a file with a second name. It may be a hard link to a file that only the server may
    // read, and a growing file has no hash yet that would reveal this.
    if (facts.st_nlink > 1 || size_bytes < entry.size_bytes) {
        return missing(RawMissing::changed,
                       entry.path.native() + ": was cut, or has a second name, while it grows");
    }
    return OpenedRaw{
        file, size_bytes, modified,
        fmt::format("\"{:x}-{:x}-{:x}\"", facts.st_ino, size_bytes, modified_ns_of(facts))};
}

OpenedRawOrMissing RawOpener::join(const CatalogReader& catalog,
                                   const std::vector<CatalogEntry>& chunks, bool grows) const {
    std::error_code failed;
    const fs::path place = scratch_.empty() ? fs::temp_directory_path(failed) : scratch_;
    if (failed) return missing(RawMissing::trouble, "there is no directory for joined chunks");
    const int number = ::open(place.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (number < 0) return missing(RawMissing::trouble, place.native() + ": no room for chunks");
    const auto file = std::make_shared<const Descriptor>(number);
    std::vector<CatalogEntry> joined;
    std::uint64_t size_bytes = 0;
    for (const CatalogEntry& chunk : chunks) {
        const auto read = catalog::read_cataloged(catalog, chunk);
        if (!read && grows && size_bytes > 0) break;  // serve what came before this chunk
        if (!read) return missing(read.error());
        // Stop at a chunk that has grown after its row was written.
        if (grows && read->bytes.size() != chunk.size_bytes && size_bytes > 0) break;
        const auto once = level2::chunk_once(read->bytes);
        size_bytes += once.size();
        if (size_bytes > most_raw_bytes) {
            return missing(RawMissing::changed, chunk.path.native() + ": the chunks exceed 1 GiB");
        }
        if (!write_all(*file, once))
            return missing(RawMissing::trouble, "joined chunks cannot be written");
        joined.push_back(chunk);
    }
    const RawFacts facts = facts_of_rows(joined, grows);
    return OpenedRaw{file, size_bytes, facts.modified, facts.tag, true};
}

OpenedRawOrMissing RawOpener::open_chunks(const CatalogReader& catalog, const CatalogEntry& entry) {
    const auto chunks = chunk_rows(catalog, entry);
    if (!chunks) return missing(RawMissing::trouble, chunks.error().message);
    if (chunks->empty()) return missing(RawMissing::gone, entry.path.native() + ": has no chunk");
    const bool grows = is_growing(entry);
    const auto root = catalog::root_of(catalog, entry.path);
    if (!root) return missing(RawMissing::trouble, root.error().message);
    for (const CatalogEntry& chunk : *chunks) {
        const auto there = look_beneath(*root, chunk.path);
        if (!there && there.error().code != ErrorCode::not_found) return missing(there.error());
        if (chunk.state == FileState::gone || !there) {
            if (grows && &chunk != &chunks->front()) break;
            return missing(RawMissing::gone, chunk.path.native() + ": is deleted");
        }
    }
    const RawFacts facts = facts_of_rows(*chunks, grows);
    const std::string key = entry.path.native() + '\n' + facts.tag;
    if (const auto known = find_joined(key)) return *known;
    auto joined = join(catalog, *chunks, grows);
    const bool is_as_listed = joined && joined->size_bytes == facts.size_bytes;
    if (joined && (is_as_listed || !grows)) keep_joined(key, *joined);
    // The file held a chunk twice, but the joined volume has it once. Remember the smaller size for
    // lists.
    if (joined && !is_as_listed && !grows) {
        remember_facts(entry, {joined->size_bytes, joined->modified, joined->tag});
    }
    return joined;
}

std::optional<OpenedRaw> RawOpener::find_joined(const std::string& key) {
    const MutexLock lock(mutex_);
    const OpenedRaw* known = joined_.find(key);
    return known == nullptr ? std::nullopt : std::optional(*known);
}

void RawOpener::keep_joined(const std::string& key, const OpenedRaw& joined) {
    if (budget_.values == 0 || joined.size_bytes > budget_.weight) return;
    const MutexLock lock(mutex_);
    joined_.keep(key, joined, joined.size_bytes);
}

Result<RawFacts> RawOpener::facts_of(const CatalogReader& catalog, const CatalogEntry& entry) {
    const bool grows = is_growing(entry);
    if (!pipeline::is_of_chunks(entry)) {
        RawFacts facts{entry.size_bytes, time_of_ns(entry.modified_ns), {}};
        if (grows && entry.modified_ns == catalog::never_read_ns)
            facts.modified = entry.registered_time;
        if (!grows) facts.tag = settled_tag(entry.content_hash, entry.size_bytes);
        return facts;
    }
    if (!grows) {
        const MutexLock lock(mutex_);
        const auto known = facts_.find(facts_key(entry));
        if (known != facts_.end()) return known->second;
    }
    const auto chunks = chunk_rows(catalog, entry);
    if (!chunks) return pass_on(chunks);
    RawFacts facts = facts_of_rows(*chunks, grows);
    if (!grows) remember_facts(entry, facts);
    return facts;
}

void RawOpener::remember_facts(const CatalogEntry& entry, const RawFacts& facts) {
    const MutexLock lock(mutex_);
    if (facts_.size() >= most_remembered) facts_.clear();
    facts_.insert_or_assign(facts_key(entry), facts);
}

}  // namespace stormcellar::web
