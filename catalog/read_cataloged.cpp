#include "stormcellar/catalog/read_cataloged.h"

#include <algorithm>

#include <sys/stat.h>

#include "base/beneath.h"
#include "base/checksum.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

bool lies_below(const fs::path& root, const fs::path& path) {
    const fs::path relative = path.lexically_relative(root);
    return !relative.empty() && *relative.begin() != "..";
}

Status check_size(const CatalogEntry& entry, std::uint64_t size_bytes) {
    const bool fits =
        has_final_hash(entry) ? size_bytes == entry.size_bytes : size_bytes >= entry.size_bytes;
    if (fits) return {};
    return fail(
        ErrorCode::corrupt, "{}: is not the file that was cataloged: it has {} bytes, not {}{}",
        entry.path.native(), size_bytes, entry.size_bytes, has_final_hash(entry) ? "" : " or more");
}

Result<CatalogedBytes> read_member(const CatalogEntry& entry, const Descriptor& archive,
                                   const MemberName& name) {
    archive::Limits limits;
    limits.small_codecs = true;
    limits.nesting = 0;
    limits.time = std::chrono::seconds{60};
    limits.member_bytes = entry.size_bytes;
    auto member = archive::find_member(archive.number(), name.member, limits);
    if (!member) {
        return fail(member.error().code, "{}: {}", entry.path.native(), member.error().message);
    }
    const std::uint64_t hash = xxh3_64(member->bytes);
    if (Status same = check_cataloged(entry, member->bytes.size(), hash); !same) {
        return pass_on(same);
    }
    return CatalogedBytes{std::move(member->bytes), has_final_hash(entry)};
}

}  // namespace

bool has_final_hash(const CatalogEntry& entry) {
    return entry.state != FileState::seen && entry.modified_ns != never_read_ns &&
           entry.content_hash != 0;
}

Result<fs::path> root_of(const CatalogReader& catalog, const fs::path& path) {
    auto drop = catalog.drop_directory();
    if (drop && lies_below(*drop, path)) return drop;
    if (!drop && drop.error().code != ErrorCode::not_found) return drop;
    return fs::path{"/"};
}

Status check_cataloged(const CatalogEntry& entry, std::uint64_t size_bytes,
                       std::uint64_t content_hash) {
    if (Status sized = check_size(entry, size_bytes); !sized) return sized;
    if (!has_final_hash(entry) || content_hash == entry.content_hash) return {};
    return fail(ErrorCode::corrupt,
                "{}: is not the file that was cataloged: it has the same size but other contents",
                entry.path.native());
}

Result<CatalogedBytes> read_cataloged(const CatalogReader& catalog, const CatalogEntry& entry) {
    const auto root = root_of(catalog, entry.path);
    if (!root) return pass_on(root);
    const auto opened = open_beneath(*root, entry.path);
    if (!opened && opened.error().code == ErrorCode::not_found) {
        for (const MemberName& name : member_names_in(entry.path)) {
            const auto archive = open_beneath(*root, name.archive);
            if (archive) return read_member(entry, Descriptor{*archive}, name);
            const ErrorCode why = archive.error().code;
            if (why != ErrorCode::not_found && why != ErrorCode::not_a_file)
                return pass_on(archive);
        }
    }
    if (!opened) return pass_on(opened);
    const Descriptor file{*opened};
    // Check before reading, because a far larger file may have replaced the cataloged one.
    struct stat facts {};
    if (::fstat(file.number(), &facts) != 0) {
        return fail(ErrorCode::io, "{}: its size cannot be read", entry.path.native());
    }
    if (Status sized = check_size(entry, static_cast<std::uint64_t>(facts.st_size)); !sized) {
        return pass_on(sized);
    }
    // Only a hash can reveal a hard link to a file that only the reader may read. Without a hash,
    // refuse every file with several names.
    if (!has_final_hash(entry) && facts.st_nlink > 1) {
        return fail(ErrorCode::corrupt,
                    "{}: may not be the file that was cataloged: it was still growing then and now "
                    "has {} names",
                    entry.path.native(), facts.st_nlink);
    }
    auto bytes = read_open_file(file.number(), entry.path, default_read_limit);
    if (!bytes) return pass_on(bytes);
    if (Status same = check_cataloged(entry, bytes->size(), xxh3_64(*bytes)); !same) {
        return pass_on(same);
    }
    return CatalogedBytes{std::move(*bytes), has_final_hash(entry)};
}

}  // namespace stormcellar::catalog
